"""Regions, outlines and colours of label images."""
