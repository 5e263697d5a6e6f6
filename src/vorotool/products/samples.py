"""The samples: small files to try commands on, which come with the package."""

from __future__ import annotations

SAMPLES = {
    "dots.csv": "53 points in 512 x 512 pixels",
    "dot-pattern.csv": "160 points in 128 x 128 pixels, which outline a shape",
    "six-seeds.csv": "6 points in 16 x 16 pixels",
    "blobs.png": "a mask of 24 ellipses, 300 x 200 pixels",
    "cells.png": "a label image: the regions of blobs.png",
    "nuclei.ome.tif": "the mask of blobs.png as an OME-TIFF with pixels of 0.325 um",
    "nuclei.tif": "a mask of 40 nuclei, a stack of 192 x 144 x 24 voxels of 0.325 x 0.325 x 1.5 um",
    "shape.json": "a polygon",
    "two-shapes.json": "two polygons, one with a hole",
    "logo.svg": "a drawing in curves, 90 x 40 mm",
    "segments.wkt": "four line segments",
    "houses.geojson": "72 houses in four blocks, in meters",
    "streets.geojson": "the two streets between the houses",
    "great-lakes.geojson": "three lakes in longitude and latitude (Natural Earth, public domain)",
}
"""What each sample is, by its name; the files are in the folder ``samples`` of the package."""
