"""Label images of seeds: each pixel has the label of its nearest seed."""
