"""Coordinates as they are written: on a grid, rings valid, coverages without gaps and overlaps."""
