"""Polygons and lines as they are written."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.written.report import report_emptied
from vorotool.formats.written.rings import written_rings
from vorotool.numeric.coordinate_grid import current_decimals, on_grid
from vorotool.numeric.ragged import Nesting, owners
from vorotool.numeric.row_index import index_of_rows
from vorotool.types.polygons.polygon_set import HOLE, SHELL, PolygonSet


def written_polygons(polygons: PolygonSet) -> PolygonSet:
    """Round polygons to the decimals of the file, and repair those that are invalid then."""
    if polygons.is_line.any() or (np.diff(polygons.ring_starts) < 3).any():
        return replace(polygons, xy=on_grid(polygons.xy))
    assert polygons.feature is not None
    first = np.flatnonzero(np.diff(polygons.feature, prepend=-1))
    nesting = Nesting(polygons.ring_starts, polygons.polygon_starts, np.append(first, len(polygons)))
    made = written_rings(polygons.xy, nesting, decimals=current_decimals())
    if made.nesting is nesting:
        return polygons if made.points is polygons.xy else replace(polygons, xy=made.points)
    report_emptied(made.emptied, "feature")
    return _with_rings(polygons, made.points, made.nesting, first)


def _with_rings(polygons: PolygonSet, points: NDArray[np.float64], nesting: Nesting, first: NDArray[Any]) -> PolygonSet:
    """Give the features of polygons other rings; what is known of a feature is that of its first polygon."""
    rings, parts, cells = nesting
    feature = owners(np.diff(cells))
    source = first[feature]
    kind = np.full(len(rings) - 1, HOLE)
    kind[parts[:-1]] = SHELL
    rows = source.tolist()
    _, numbered = np.unique(feature, return_inverse=True)
    return replace(
        polygons,
        xy=points,
        ring_starts=rings,
        ring_kind=kind,
        ring_polygon=owners(np.diff(parts), dtype=np.int32),
        ids=None if polygons.ids is None else [polygons.ids[i] for i in rows],
        feature=numbered.reshape(-1).astype(np.int32),
        properties={name: [values[i] for i in rows] for name, values in polygons.properties.items()},
        index=index_of_rows(polygons.index, source),
    )
