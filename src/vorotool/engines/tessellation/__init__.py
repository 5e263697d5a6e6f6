"""Exact digital Voronoi tessellation of images and volumes."""
