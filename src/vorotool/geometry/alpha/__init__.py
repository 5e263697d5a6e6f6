"""Alpha complexes, shapes, hulls and their tables."""
