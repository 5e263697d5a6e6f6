"""Readers of polygons, one module a format."""
