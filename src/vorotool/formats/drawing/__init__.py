"""Drawings: SVG and DXF, whose curves become polylines where they are read."""
