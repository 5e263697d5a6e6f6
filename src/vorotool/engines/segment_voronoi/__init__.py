"""Planar graph -> segment Voronoi diagram, and its check."""
