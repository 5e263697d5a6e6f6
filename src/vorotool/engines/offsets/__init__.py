"""Offset curves of polygons, and their check."""
