"""Segment diagrams, skeletons, arcs, branches, offsets and their tables."""
