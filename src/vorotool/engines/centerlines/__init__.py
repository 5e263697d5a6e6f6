"""Skeleton -> centerlines, and where they end."""
