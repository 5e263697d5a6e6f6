"""Volumes: their voxels, seeds and labels."""
