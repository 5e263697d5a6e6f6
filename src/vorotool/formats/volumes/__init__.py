"""Volumes in files: stacks of images, arrays of three axes, and lists of points with a z."""
