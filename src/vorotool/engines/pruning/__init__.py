"""Skeletons without the pieces that matter less than a threshold, or with near junctions made one; their checks."""
