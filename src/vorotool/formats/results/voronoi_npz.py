"""Voronoi maps as NPZ: the arrays that a map holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.geojson import read_y_axis
from vorotool.formats.parsing.npz_columns import npz_columns
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.results.json_reader import JsonRows, opened_rows, read_unit
from vorotool.formats.results.voronoi_checks import check_map, naming_values
from vorotool.formats.results.voronoi_json import (
    TYPE,
    VERSION,
    check_described,
    described,
    described_rows,
    named_rows,
    read_described,
    read_frame,
)
from vorotool.formats.text.tables import json_bytes, write_arrays
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.voronoi.voronoi_map import OUTSIDE, VoronoiMap
from vorotool.types.axis import UNSTATED

Arrays = Mapping[str, NDArray[Any]]

_VERTEX = ("vertex_x", "vertex_y", "vertex_r")
_ENDS = ("arc_source", "arc_target")
_SIDES = ("arc_left", "arc_right")
_CURVES = ("arc_control_x", "arc_control_y", "arc_center_x", "arc_center_y")
_STARTS = {"ring_start": "cell_ring_start", "polygon_start": "cell_polygon_start", "cell_start": "cell_start"}
_RINGS = ("ring_start", "ring_kind", "ring_polygon")
_MOST = 2**31 - 1


def write_npz(out: BinaryIO, cells: VoronoiMap, *, threads: int = 0) -> None:
    """Write the arrays of a map, as `voronoi_arrays` gives them."""
    write_arrays(out, voronoi_arrays(cells), threads=threads)


def voronoi_arrays(cells: VoronoiMap) -> dict[str, NDArray[Any]]:
    """1-D arrays of all that a map holds; what belongs to no cell is -1, and ``about`` the UTF-8 of JSON."""
    polygons = cells.polygons
    about: dict[str, Any] = {"type": TYPE, "version": VERSION, **described(cells)}
    about["sites"] = described_rows(len(cells), cells.ids, cells.properties)
    about["polygons"] = described_rows(len(polygons), polygons.ids, polygons.properties)
    assert polygons.feature is not None
    return {
        "vertex_x": cells.vertices[:, 0],
        "vertex_y": cells.vertices[:, 1],
        "vertex_r": cells.radius,
        "arc_source": cells.arcs[:, 0],
        "arc_target": cells.arcs[:, 1],
        "arc_left": cells.sites[:, 0],
        "arc_right": cells.sites[:, 1],
        "arc_control_x": cells.control[:, 0],
        "arc_control_y": cells.control[:, 1],
        "arc_center_x": cells.center[:, 0],
        "arc_center_y": cells.center[:, 1],
        "arc_cut": cells.is_cut,
        "cell_ring_arcs": cells.ring_arcs,
        "cell_ring_start": cells.ring_start,
        "cell_polygon_start": cells.polygon_start,
        "cell_start": cells.cell_start,
        "ring_x": polygons.xy[:, 0],
        "ring_y": polygons.xy[:, 1],
        **{name: getattr(polygons, name) for name in ("ring_start", "ring_kind", "ring_polygon")},
        "polygon_feature": polygons.feature,
        "polygon_site": cells.polygon_site,
        "frame": np.array(cells.frame, dtype=np.float64),
        "about": np.frombuffer(json_bytes(about), dtype=np.uint8),
    }


def read_voronoi(source: Source, options: ReadOptions) -> VoronoiMap:
    """Read a Voronoi map that was written as NPZ."""
    held = _Held(source.name, npz_columns(source, options))
    about = opened_rows(Source(f"{source.name}, about", held.bytes("about"), "json"), TYPE, VERSION, "Voronoi map")
    sites = about.list_of("sites")
    check_described(about, "sites", sites)
    with naming_values(source.name):
        made = VoronoiMap(
            frame=read_frame(source.name, held.numbers("frame").tolist()),
            polygons=_polygons(held, about, options),
            polygon_site=held.indices("polygon_site", None, 0, len(sites)).astype(np.int32),
            **_arrays(held, len(sites)),
            **read_described(source.name, about.document, options),
            **(named_rows(sites) if options.properties else {}),
        )
    if len(made) != len(sites):
        raise InputError(f"{source.name}: there are {len(made)} cells, but {len(sites)} sites; write it again")
    check_map(source.name, made)
    return made


def _arrays(held: _Held, sites: int) -> dict[str, Any]:
    """The arrays of a map, by its fields."""
    vertices, ends, sides = held.together(_VERTEX), held.together(_ENDS), held.together(_SIDES)
    curves = held.together((*_CURVES, "arc_cut"))
    count = len(vertices["vertex_x"])
    control, center = _places(held, curves)
    return {
        "vertices": np.stack([held.numbers(name, vertices[name]) for name in _VERTEX[:2]], axis=1),
        "radius": held.numbers("vertex_r", vertices["vertex_r"], may_be_nan=True),
        "arcs": np.stack([held.indices(name, ends[name], 0, count) for name in _ENDS], axis=1),
        "sites": np.stack([held.indices(name, sides[name], OUTSIDE, sites) for name in _SIDES], axis=1),
        "control": control,
        "center": center,
        "is_cut": held.indices("arc_cut", curves["arc_cut"], 0, 2).astype(bool),
        "ring_arcs": held.indices("cell_ring_arcs", None, -_MOST, _MOST),
        **{name: held.indices(array, None, 0, _MOST) for name, array in _STARTS.items()},
    }


class _Held:
    """Arrays of an archive, each of which must be as it should."""

    def __init__(self, name: str, arrays: Arrays) -> None:
        self.name, self.arrays = name, arrays

    def array(self, name: str) -> NDArray[Any]:
        """An array that must be there."""
        if name not in self.arrays:
            raise InputError(f"{self.name} has no array {name}: write it again")
        return self.arrays[name]

    def bytes(self, name: str) -> bytes:
        """An array of bytes."""
        array = self.array(name)
        if array.dtype != np.uint8:
            raise InputError(f"{self.name}: {name} is of type {array.dtype}; write bytes (uint8)")
        return array.tobytes()

    def together(self, names: Sequence[str]) -> dict[str, NDArray[Any]]:
        """Arrays of one length."""
        arrays = {name: self.array(name) for name in names}
        if len({len(values) for values in arrays.values()}) > 1:
            sizes = ", ".join(f"{name} {len(values)}" for name, values in arrays.items())
            raise InputError(f"{self.name}: arrays of different lengths belong together ({sizes}); write it again")
        return arrays

    def numbers(
        self, name: str, values: NDArray[Any] | None = None, *, may_be_nan: bool = False
    ) -> NDArray[np.float64]:
        """Numbers, which are finite, or are not there at all."""
        array = self.array(name) if values is None else values
        if array.dtype.kind not in "iuf" or not (np.isfinite(array) | (may_be_nan & np.isnan(array))).all():
            raise InputError(f"{self.name}: {name} holds what is no finite number; write it again")
        return array.astype(np.float64)

    def indices(self, name: str, values: NDArray[Any] | None, low: int, high: int) -> NDArray[np.int64]:
        """Whole numbers from one to below another."""
        array = self.array(name) if values is None else values
        if array.dtype.kind not in "iub":
            raise InputError(f"{self.name}: {name} is of type {array.dtype}; write whole numbers")
        wrong = np.flatnonzero((array < low) | (array >= high))
        if wrong.size:
            at = int(wrong[0])
            raise InputError(f"{self.name}: {name} {at} is {array[at]}; write a whole number from {low} to {high - 1}")
        return array.astype(np.int64)


def _places(held: _Held, curves: Mapping[str, NDArray[Any]]) -> list[NDArray[np.float64]]:
    """Control points and centers: no arc has both, and none has half of one."""
    x, y, u, v = (held.numbers(name, curves[name], may_be_nan=True) for name in _CURVES)
    wrong = np.flatnonzero((np.isnan(x) != np.isnan(y)) | (np.isnan(u) != np.isnan(v)) | ~(np.isnan(x) | np.isnan(u)))
    if wrong.size:
        raise InputError(
            f"{held.name}: arc {wrong[0]} has half a control point or center, or both; write one of them, or NaN"
        )
    return [np.stack(pair, axis=1) for pair in ((x, y), (u, v))]


def _polygons(held: _Held, about: JsonRows, options: ReadOptions) -> PolygonSet:
    document = about.document
    items = about.list_of("polygons")
    check_described(about, "polygons", items)
    x, y = (held.numbers(name, values) for name, values in held.together(("ring_x", "ring_y")).items())
    options.check_vertices(held.name, len(x))
    fields: dict[str, Any] = {name: held.indices(name, None, 0, _MOST) for name in _RINGS}
    return PolygonSet(
        xy=np.stack([x, y], axis=1),
        feature=held.indices("polygon_feature", None, 0, _MOST).astype(np.int32),
        y_axis=read_y_axis(held.name, document, UNSTATED),
        crs=document.get("crs"),
        connectivity=document.get("connectivity"),
        unit=read_unit(held.name, document),
        **fields,
        **(named_rows(items) if options.properties else {}),
    )
