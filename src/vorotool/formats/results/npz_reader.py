"""Polygons in archives: of cells, and of results that have polygons."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.sites import Sites, as_sites
from vorotool.errors import InputError, option
from vorotool.formats.io.arrays import npz_columns, npz_holds, present_values
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.json import read_y_axis
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.results.rows import ArrayRows
from vorotool.formats.results.skeleton_files import read_offsets, read_skeleton
from vorotool.formats.results.voronoi_files import read_sites as read_map_sites
from vorotool.formats.results.voronoi_files import read_voronoi
from vorotool.numeric.arrays import divides, owners
from vorotool.types.fields import MEMBER as Y_AXIS
from vorotool.types.fields import UNSTATED
from vorotool.types.polygons.polygon_set import HOLE, SHELL, PolygonSet, set_of_rings

_CELLS = option("delaunay --what cells", "voronoi_cells")
_AS_JSON = option("-f json", 'fmt="json"')


def read_polygons(source: Source, options: ReadOptions) -> PolygonSet:
    """Read the polygons of cells, or those that a skeleton is of."""
    holds = npz_holds(source.data)
    if holds == "points":
        raise InputError(
            f"{source.name} holds no polygons: an NPZ file has polygons for cells ({_CELLS}) and skeletons only; for "
            f"other results give the JSON ({_AS_JSON}); unpack other archives"
        )
    if holds == "polygons":
        return _cells(ArrayRows(source.name, npz_columns(source, options), {}), options)
    if holds == "voronoi":
        return read_voronoi(source, options).polygons
    return (read_offsets if holds == "offsets" else read_skeleton)(source, options).polygons


def read_sites(source: Source, options: ReadOptions) -> Sites:
    """Read the sites of a Voronoi map, or polygons as `read_polygons`, each feature a site."""
    if npz_holds(source.data) == "voronoi":
        options.note(f"{source.name} holds a Voronoi map: its sites are read")
        return read_map_sites(source, options)
    return as_sites(read_polygons(source, options))


# ---- cells ---------------------------------------------------------------------------------------
_OF_CELLS = (Y_AXIS, "cell_starts", "polygon_starts", "ring_starts", "vertex_x", "vertex_y", "frame")


def _cells(rows: ArrayRows, options: ReadOptions) -> PolygonSet:
    """Read cells, each of which is a feature."""
    rows.together("vertex_")
    points = np.stack([rows.reals("vertex_x"), rows.reals("vertex_y")], axis=1)
    options.check_vertices(rows.name, len(points))
    rings = _starts(rows, "ring_starts", len(points), 1)
    polygons = _starts(rows, "polygon_starts", len(rings) - 1, 1)
    cells = _starts(rows, "cell_starts", len(polygons) - 1, 0)
    cell = owners(np.diff(cells))
    kind = np.full(len(rings) - 1, HOLE)
    kind[polygons[:-1]] = SHELL
    axis = rows.arrays.get(Y_AXIS, np.zeros(0)).tolist()
    return set_of_rings(
        points,
        np.diff(rings),
        kind,
        owners(np.diff(polygons), dtype=np.int32),
        feature=np.unique(cell, return_inverse=True)[1].reshape(-1).astype(np.int32),
        y_axis=read_y_axis(rows.name, {Y_AXIS: axis[0] if len(axis) == 1 else axis} if axis else {}, UNSTATED),
        **(_described(rows, cell, len(cells) - 1) if options.properties else {}),
    )


def _starts(rows: ArrayRows, name: str, count: int, least: int) -> NDArray[np.int64]:
    """Read where each of some items begins, and the end; none is empty but cells."""
    start = rows.array(name)
    if start.dtype.kind not in "iu" or not divides(start.astype(np.int64), count):
        raise InputError(f"{rows.name}: {name} should increase from 0 to {count}; write it again")
    if (np.diff(start.astype(np.int64)) < least).any():
        raise InputError(f"{rows.name}: {name} repeats a number, so that a part is empty; write it again")
    return start.astype(np.int64)


def _described(rows: ArrayRows, cell: NDArray[np.int64], count: int) -> dict[str, Any]:
    """Ids and properties of the cells of polygons."""
    names = [name for name in rows.arrays if name not in _OF_CELLS and not name.endswith("_missing")]
    columns = {name: present_values(rows.arrays[name], rows.arrays.get(f"{name}_missing")) for name in names}
    if any(len(values) != count for values in columns.values()):
        raise InputError(f"{rows.name}: its columns have other lengths than the {count} cells; write it again")
    ids = columns.pop("id", columns.get("label", [None] * count))
    of_polygons = {name: [values[i] for i in cell.tolist()] for name, values in columns.items()}
    return {"ids": [ids[i] for i in cell.tolist()], "properties": of_polygons}
