"""Diagram + distance -> offset curves, and their check."""
