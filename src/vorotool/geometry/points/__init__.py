"""Point sets, seed sets, rasters, label images."""
