"""Triangulations, cells, digital triangulations and their tables."""
