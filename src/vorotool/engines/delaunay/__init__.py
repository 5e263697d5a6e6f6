"""Delaunay triangulations of points, their Voronoi cells and edges."""
