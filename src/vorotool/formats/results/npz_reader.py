"""Skeletons and cells that were written as NPZ: read as the JSON that would hold the same."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import isnan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, option
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.npz_columns import npz_columns, npz_holds
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.polygons.json import read_json
from vorotool.formats.results.placed_polygons import LATTICE_STEP
from vorotool.formats.results.skeleton_json import TYPE, VERSION
from vorotool.formats.results.skeleton_json import read_skeleton as read_skeleton_json
from vorotool.formats.results.voronoi_json import sites_of_map
from vorotool.formats.results.voronoi_npz import read_voronoi as read_map
from vorotool.formats.text.json_writer import SITE_KINDS
from vorotool.geometry.arguments.sites import Sites, as_sites
from vorotool.geometry.polygons.polygon_set import LINE, PolygonSet
from vorotool.geometry.ragged import divides
from vorotool.geometry.skeleton.skeleton import KINDS, SIDES, Skeleton
from vorotool.types.axis import MEMBER as Y_AXIS

_CELLS = option("delaunay --what cells", "voronoi_cells")
_AS_JSON = option("-f json", 'fmt="json"')

Arrays = Mapping[str, NDArray[Any]]


def read_skeleton(source: Source, options: ReadOptions) -> Skeleton:
    """Read a skeleton; ids, properties and the coordinate reference system of its polygons are in its JSON alone."""
    document = _skeleton(source.name, npz_columns(source, options))
    return read_skeleton_json(Source(source.name, b"", "json", document), options)


def read_polygons(source: Source, options: ReadOptions) -> PolygonSet:
    """Read the polygons of cells, or those that a skeleton is of."""
    holds = npz_holds(source.data)
    if holds == "points":
        raise InputError(
            f"{source.name} holds no polygons that are read: an NPZ has those of cells ({_CELLS}) or of a "
            f"skeleton; of others, and of offset curves, give the JSON ({_AS_JSON}), and unpack what is no NPZ"
        )
    if holds == "voronoi":
        return read_map(source, options).polygons
    arrays = npz_columns(source, options)
    document = _skeleton(source.name, arrays) if holds == "skeleton" else _cells(source.name, arrays)
    return read_json(Source(source.name, b"", "json", document), options)


def read_sites(source: Source, options: ReadOptions) -> Sites:
    """Read the sites of a Voronoi map, or polygons as `read_polygons`, each feature a site."""
    if npz_holds(source.data) == "voronoi":
        options.note(f"{source.name} holds a Voronoi map: the sites in it are read")
        return sites_of_map(read_map(source, options))
    return as_sites(read_polygons(source, options))


# ---- skeletons -----------------------------------------------------------------------------------
_VERTEX = ("vertex_x", "vertex_y", "vertex_r")
_ARC = ("source", "target", "kind", "control_x", "control_y", "site_a", "site_b", "polygon", "side", "branch")
_MEASURES = ("length", "error_bound")
_SITE = ("kind", "polygon", "ring", "index", "source_ring", "source_index")


def _skeleton(name: str, arrays: Arrays) -> dict[str, Any]:
    vertices = _lists(name, arrays, _VERTEX, "finite")
    arcs = _lists(name, arrays, [f"arc_{each}" for each in (*_ARC, *_MEASURES)])
    sites = _lists(name, arrays, [f"site_{each}" for each in _SITE])
    frame, gap = (_lists(name, arrays, [each], "finite")[0] for each in ("frame", "gap"))
    step = _lists(name, arrays, [LATTICE_STEP], "finite")[0] if LATTICE_STEP in arrays else []
    single = {"gap": gap, LATTICE_STEP: step}
    return {
        "type": TYPE,
        "version": VERSION,
        **_axis(arrays),
        "polygons": _polygons(name, arrays),
        "sites": [
            {
                "kind": _named(SITE_KINDS, kind),
                "polygon": polygon,
                "ring": ring,
                "index": index,
                "source": None if source_ring == -1 else [source_ring, source_index],
            }
            for kind, polygon, ring, index, source_ring, source_index in zip(*sites, strict=True)
        ],
        "vertices": [{"x": x, "y": y, "r": r} for x, y, r in zip(*vertices, strict=True)],
        "arcs": [_arc(*values) for values in zip(*arcs, strict=True)],
    } | ({"frame": frame} if frame else {}) | {name: each[0] for name, each in single.items() if each}  # fmt: skip


def _arc(*values: Any) -> dict[str, Any]:
    source, target, kind, cx, cy, site_a, site_b, polygon, side, branch, length, bound = values
    return {
        "source": source,
        "target": target,
        "kind": _named(KINDS, kind),
        "control": None if _is_nan(cx) and _is_nan(cy) else [cx, cy],
        "sites": [site_a, site_b],
        "polygon": None if polygon == -1 else polygon,
        "side": None if side == -1 else _named(SIDES, side),
        "branch": branch,
        "length": length,
        "error_bound": None if _is_nan(bound) else bound,
    }


def _is_nan(value: Any) -> bool:
    return isinstance(value, float) and isnan(value)


def _named(names: Sequence[str], number: Any) -> Any:
    """The name that a number stands for; what stands for none stays, for the reader to refuse."""
    return names[number] if type(number) is int and 0 <= number < len(names) else number


def _polygons(name: str, arrays: Arrays) -> list[dict[str, Any]]:
    """Rings in flat arrays as shells with their holes, and lines."""
    x, y = _lists(name, arrays, ["ring_x", "ring_y"], "finite")
    (start,) = _lists(name, arrays, ["ring_start"])
    kind, owner = _lists(name, arrays, ["ring_kind", "ring_polygon"])
    rings = _divided(name, "ring_start", start, list(map(list, zip(x, y, strict=True))))
    if not len(rings) == len(kind) == len(owner):
        raise InputError(f"{name}: ring_kind and ring_polygon are not of as many rings as ring_start; write it again")
    polygons: list[dict[str, Any]] = []
    for ring, own, polygon in zip(rings, kind, owner, strict=True):
        if polygon == len(polygons):
            polygons.append({"line": ring} if own == LINE else {"shell": ring, "holes": []})
        elif polygons and polygon == len(polygons) - 1 and "holes" in polygons[-1]:
            polygons[-1]["holes"].append(ring)
        else:
            raise InputError(f"{name}: ring_polygon has {polygon} after {len(polygons) - 1}; number polygons from 0")
    return polygons


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
            raise InputError(f"{name}: {each} holds what is no finite number; write it again")
    return [arrays[each].tolist() for each in names]


def _divided(name: str, what: str, start: list[Any], items: list[Any]) -> list[Any]:
    """Lists of items, by where each begins, and the end; none is empty but those of cells."""
    array = np.array(start)
    if array.dtype.kind not in "iu" or not divides(array.astype(np.int64), len(items)):
        raise InputError(f"{name}: {what} should grow from 0 to {len(items)}; write it again")
    parts = [items[begin:end] for begin, end in pairwise(start)]
    if what != "cell_starts" and not all(parts):
        raise InputError(f"{name}: {what} has the same place twice, where a part would be empty; write it again")
    return parts
