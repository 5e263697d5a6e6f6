"""Boundary samples -> approximate skeleton with certified error; comparison."""
