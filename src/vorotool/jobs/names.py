"""Names that a command and what makes its results share; nothing heavy is imported for them."""

from __future__ import annotations

from itertools import chain

TABLES = ("csv", "json", "npz")
"""Formats of tables."""
PICTURES = ("svg", "png")
"""Formats of pictures."""
METHODS = ("exact", "digital", "digital-valid")
"""Ways of triangulating."""
MESH_LAYERS = ("cells", "triangles", "diagram", "edges", "points", "labels")
"""Layers of pictures of a triangulation, from below."""
OF_ONE_SHAPE = frozenset({"edges", "polygons", "complex", "general", "hull", "points", "table"})
"""Results of `alphashape` that are of one radius; the others are of all."""
SKELETON_LAYERS = ("polygons", "elements", "points", "skeleton", "nodes", "labels")
"""Layers of pictures of skeletons, from below."""
DERIVED = {
    "offset": ("polygons", "offset"),
    "shape": ("shape",),
    "points": ("polygons", "skeleton", "transects", "points"),
    "transects": ("polygons", "skeleton", "transects", "points"),
}
"""Results of the skeleton commands that follow from a skeleton or its diagram, with the layers of their pictures."""
SKELETON_FORMATS = {
    "skeleton": ("json", "csv", "geojson", "npz", "wkt", "graphml", *PICTURES, "html"),
    "diagram": ("json", "csv", "geojson", "npz", "wkt", *PICTURES),
    "elements": (*TABLES, *PICTURES),
    "centerline": ("geojson", *TABLES, "wkt", *PICTURES),
    "offset": ("json", "csv", "geojson", "npz", "wkt", *PICTURES),
    "shape": ("json", "geojson", "wkt", "poly", *PICTURES),
    "points": ("csv", "json", "npz", "geojson", "wkt", *PICTURES),
    "transects": ("geojson", "wkt", *TABLES, *PICTURES),
    "branches": TABLES,
    "table": TABLES,
}
ALL_SKELETON_LAYERS = tuple(dict.fromkeys([*SKELETON_LAYERS, *chain.from_iterable(DERIVED.values())]))
"""Layers of all pictures."""

APPROXIMATE_LAYERS = (*ALL_SKELETON_LAYERS, "exact")
"""Beside approximate skeletons pictures can show exact ones."""

PICTURE_LAYERS = {
    "svg": APPROXIMATE_LAYERS,
    "png": APPROXIMATE_LAYERS,
}
