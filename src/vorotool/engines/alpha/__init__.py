"""Triangulation -> alpha complex, shape, hull."""
