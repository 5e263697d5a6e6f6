"""Exact skeletons as parts of segment Voronoi diagrams, and their check."""
