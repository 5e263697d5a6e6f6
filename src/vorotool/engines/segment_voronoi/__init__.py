"""Voronoi diagrams of segments, and their check."""
