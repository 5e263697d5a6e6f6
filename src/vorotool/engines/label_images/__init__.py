"""Regions, outlines and colors of label images."""
