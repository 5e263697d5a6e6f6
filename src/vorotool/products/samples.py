"""Small files to try commands on, which are in the package."""

from __future__ import annotations

SAMPLES = {
    "dots.csv": "53 points in 512 x 512 pixels",
    "six-seeds.csv": "6 points in 16 x 16 pixels",
    "blobs.png": "a mask of 24 ellipses, 300 x 200 pixels",
    "cells.png": "a label image: the regions of blobs.png",
    "nuclei.tif": "a mask of 40 nuclei, a stack of 192 x 144 x 24 voxels of 0.325 x 0.325 x 1.5 µm",
    "shape.json": "a polygon",
    "two-shapes.json": "two polygons, one with a hole",
    "segments.wkt": "four line segments",
    "great-lakes.geojson": "three lakes in longitude and latitude (Natural Earth, public domain)",
}
"""Their names, and what is in them; the files are in the folder ``samples`` of the package."""
