"""Names that a command and what makes its results share; nothing heavy is imported for them."""

from __future__ import annotations

OF_ONE_SHAPE = frozenset({"edges", "polygons", "complex", "general", "hull", "points", "table"})
"""Results of `alphashape` that are of one radius; the others are of all."""
PLOTS = ("curves", "persistence")
"""Those whose picture is a plot over the radius."""
