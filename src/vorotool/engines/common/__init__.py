"""Shared by engines: arrays of labels, input of points, faults."""
