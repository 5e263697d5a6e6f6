"""Necks of polygons, and the parts that these are cut into there."""
