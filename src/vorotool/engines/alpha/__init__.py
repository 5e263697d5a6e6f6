"""Alpha complexes, alpha shapes and alpha hulls of triangulations, and their checks."""
