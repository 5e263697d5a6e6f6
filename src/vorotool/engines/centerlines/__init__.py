"""Centerlines of skeletons, and where they end."""
