"""Approximate skeletons from samples of the boundary, with certified bounds of the error."""
