"""Polygon readers, one module a format."""
