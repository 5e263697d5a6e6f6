"""Circular and parabolic arcs, flattening, bit-stable inverse functions."""
