"""Skeletons without the pieces that matter less than a threshold, and their check."""
