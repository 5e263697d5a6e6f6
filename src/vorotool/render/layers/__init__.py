"""Layers of a picture from a result, one module a kind of result."""
