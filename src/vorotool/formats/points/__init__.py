"""Readers of points, one module a format."""
