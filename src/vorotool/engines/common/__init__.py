"""Shared by engines: arrays of labels, faults."""
