"""Skeleton -> pruned skeleton, and its check."""
