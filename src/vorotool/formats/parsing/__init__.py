"""Shared by readers: GeoJSON, reference systems, names of formats, options."""
