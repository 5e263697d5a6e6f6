"""Label image -> regions, outlines, simplified rings."""
