"""Segments and polygons on the lattice: placed, cut where they meet, repaired; their planar graph."""
