"""Circular and parabolic arcs: flattening, and inverse functions that are the same on all machines."""
