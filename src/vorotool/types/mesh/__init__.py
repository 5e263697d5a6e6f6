"""Triangulations, cells and digital triangulations, and their tables."""
