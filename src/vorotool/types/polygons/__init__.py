"""Sets of polygons, their conversion, and planar graphs."""
