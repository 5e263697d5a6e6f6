"""Alpha complexes, shapes and hulls, and their tables."""
