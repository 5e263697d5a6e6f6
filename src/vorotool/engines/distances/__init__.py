"""Distances between points, lines and polygons: the Hausdorff distance, and the smallest one."""
