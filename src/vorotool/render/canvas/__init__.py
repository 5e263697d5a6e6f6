"""Layers, palettes, SVG and PNG back ends; knows no result type."""
