"""Segments or polygons -> lattice placement, planar graph, repaired polygons."""
