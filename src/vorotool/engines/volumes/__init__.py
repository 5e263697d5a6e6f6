"""Exact digital Voronoi tessellation of volumes."""
