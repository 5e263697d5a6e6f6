"""Triangulations that are read off a label image, and how they differ from the exact ones."""
