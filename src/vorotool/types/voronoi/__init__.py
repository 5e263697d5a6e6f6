"""Voronoi diagrams of points, lines and polygons: planar maps of cells."""
