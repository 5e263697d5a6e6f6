"""Segment diagrams, skeletons, branches, centerlines, offsets, and their tables."""
