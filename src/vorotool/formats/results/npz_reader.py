"""Polygons in archives: of cells, and of results that have polygons."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.sites import Sites, as_sites
from vorotool.errors import InputError, option
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.npz_columns import npz_columns, npz_holds
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.polygons.json import read_json
from vorotool.formats.results.offset_files import read_archive as read_offsets
from vorotool.formats.results.skeleton_files import read_archive as read_skeleton
from vorotool.formats.results.voronoi_files import read_archive as read_map
from vorotool.formats.results.voronoi_files import sites_of_map
from vorotool.numeric.ragged import divides
from vorotool.types.axis import MEMBER as Y_AXIS
from vorotool.types.polygons.polygon_set import PolygonSet

_CELLS = option("delaunay --what cells", "voronoi_cells")
_AS_JSON = option("-f json", 'fmt="json"')

Arrays = Mapping[str, NDArray[Any]]


def read_polygons(source: Source, options: ReadOptions) -> PolygonSet:
    """Read the polygons of cells, or those that a skeleton is of."""
    holds = npz_holds(source.data)
    if holds == "points":
        raise InputError(
            f"{source.name} holds no polygons: an NPZ file has polygons for cells ({_CELLS}) and skeletons only; for "
            f"other results give the JSON ({_AS_JSON}); unpack other archives"
        )
    if holds == "voronoi":
        return read_map(source, options).polygons
    if holds == "offsets":
        return read_offsets(source, options).polygons
    if holds == "skeleton":
        return read_skeleton(source, options).polygons
    document = _cells(source.name, npz_columns(source, options))
    return read_json(Source(source.name, b"", "json", document), options)


def read_sites(source: Source, options: ReadOptions) -> Sites:
    """Read the sites of a Voronoi map, or polygons as `read_polygons`, each feature a site."""
    if npz_holds(source.data) == "voronoi":
        options.note(f"{source.name} holds a Voronoi map: its sites are read")
        return sites_of_map(read_map(source, options))
    return as_sites(read_polygons(source, options))


# ---- cells ---------------------------------------------------------------------------------------
_OF_CELLS = (Y_AXIS, "cell_starts", "polygon_starts", "ring_starts", "vertex_x", "vertex_y", "frame")


def _cells(name: str, arrays: Arrays) -> dict[str, Any]:
    x, y = _lists(name, arrays, ["vertex_x", "vertex_y"], "finite")
    nested: list[Any] = list(map(list, zip(x, y, strict=True)))
    for each in ("ring_starts", "polygon_starts", "cell_starts"):
        (start,) = _lists(name, arrays, [each])
        nested = _divided(name, each, start, nested)
    names = [each for each in arrays if each not in _OF_CELLS and not each.endswith("_missing")]
    columns = {each: _present(arrays[each], arrays.get(f"{each}_missing")) for each in names}
    if any(len(values) != len(nested) for values in columns.values()):
        raise InputError(f"{name}: its columns have other lengths than the {len(nested)} cells; write it again")
    ids = columns.pop("id", columns.get("label", [None] * len(nested)))
    polygons = []
    for cell, parts in enumerate(nested):
        properties = {each: values[cell] for each, values in columns.items()}
        for part, (shell, *holes) in enumerate(parts, 1):
            found = {"id": ids[cell], "part": part, "properties": properties, "shell": shell, "holes": holes}
            polygons.append(found)
    return {"polygons": polygons, **_axis(arrays)}


def _present(values: NDArray[Any], missing: NDArray[Any] | None) -> list[Any]:
    listed: list[Any] = values.tolist()
    if missing is None or len(missing) != len(listed):
        return listed
    return [None if none else value for value, none in zip(listed, missing.tolist(), strict=True)]


def _axis(arrays: Arrays) -> dict[str, Any]:
    """Which way y goes, where there is a word for it."""
    found = arrays.get(Y_AXIS)
    return {} if found is None else {Y_AXIS: found.tolist()[0] if found.size == 1 else found.tolist()}


# ---- arrays --------------------------------------------------------------------------------------
def _lists(name: str, arrays: Arrays, names: Sequence[str], numbers: str = "any") -> list[list[Any]]:
    """Arrays that must be there, of one length, as lists."""
    absent = [each for each in names if each not in arrays]
    if absent:
        raise InputError(f"{name} has no array {absent[0]}: write it again, or give the JSON ({_AS_JSON})")
    if len({len(arrays[each]) for each in names}) > 1:
        sizes = ", ".join(f"{each} {len(arrays[each])}" for each in names)
        raise InputError(f"{name}: arrays that belong together are of different lengths ({sizes}); write it again")
    for each in names if numbers == "finite" else ():
        if arrays[each].dtype.kind not in "iuf" or not np.isfinite(arrays[each]).all():
            raise InputError(f"{name}: {each} holds a number that is not finite; write it again")
    return [arrays[each].tolist() for each in names]


def _divided(name: str, what: str, start: list[Any], items: list[Any]) -> list[Any]:
    """Lists of items, by where each begins, and the end; none is empty but those of cells."""
    array = np.array(start)
    if array.dtype.kind not in "iu" or not divides(array.astype(np.int64), len(items)):
        raise InputError(f"{name}: {what} should increase from 0 to {len(items)}; write it again")
    parts = [items[begin:end] for begin, end in pairwise(start)]
    if what != "cell_starts" and not all(parts):
        raise InputError(f"{name}: {what} repeats a number, so that a part is empty; write it again")
    return parts
