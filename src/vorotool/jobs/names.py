"""Names that a command and what makes its results share; nothing heavy is imported for them."""

from __future__ import annotations

METHODS = ("exact", "digital", "digital-valid")
"""Ways of triangulating."""
OF_ONE_SHAPE = frozenset({"edges", "polygons", "complex", "general", "hull", "points", "table"})
"""Results of `alphashape` that are of one radius; the others are of all."""
DERIVED = frozenset({"offset", "shape", "points", "transects"})
"""Results of the skeleton commands that follow from a skeleton or its diagram."""
