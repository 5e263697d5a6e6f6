"""Sets of points and seeds, rasters, label images."""
