"""Many inputs: which they are, what becomes of each, who does it, what was done already."""
