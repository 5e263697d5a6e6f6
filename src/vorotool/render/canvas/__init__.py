"""Layers, palettes, and what draws them as SVG and PNG; no result is known here."""
