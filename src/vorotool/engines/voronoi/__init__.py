"""Voronoi diagrams of points, lines and polygons."""
