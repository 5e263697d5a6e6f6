"""Polygon sets, repairs, conversion to shapely/GeoPandas, planar graphs."""
