"""Self-contained HTML pages: alpha shapes of all radii, cells, slices of volumes, skeletons with their pruning."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path
from sys import float_info
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from vorotool.errors import LimitError, option
from vorotool.numeric.arrays import starts_of
from vorotool.numeric.numbers import nearest_double
from vorotool.products.formats import AS_MESH, AS_PICTURE, AS_SVG
from vorotool.render.canvas.styles import cell_color
from vorotool.render.label_images.svg import crack_loops
from vorotool.types.alpha.complex import AlphaComplex
from vorotool.types.alpha.radii import Radius
from vorotool.types.alpha.space import SpaceAlphaComplex
from vorotool.types.box import bounds
from vorotool.types.features import Lines
from vorotool.types.fields import is_up
from vorotool.types.images import LabelImage
from vorotool.types.mesh.cells import CellSet
from vorotool.types.mesh.tetrahedralization import Tetrahedralization, scaled_norms
from vorotool.types.pixels import SQUARE, PixelSides
from vorotool.types.polygons.polygon_set import LINE, PolygonSet
from vorotool.types.skeleton.skeleton import ArcProfiles, CriticalValues, Skeleton
from vorotool.types.table import Table
from vorotool.types.voronoi.tables import cell_rings
from vorotool.types.voronoi.voronoi_map import VoronoiMap

_PLACE, _VIEW = "/*DATA*/null", "/*VIEW*/"


def write_page(out: BinaryIO, name: str, data: Mapping[str, Any], view: str = "") -> None:
    """Write the page of a name with its data, and with the script of a view where it has several."""
    page = Path(__file__).with_name(name).read_text(encoding="utf-8")
    if view:
        page = page.replace(_VIEW, Path(__file__).with_name(view).read_text(encoding="utf-8").rstrip())
    before, after = page.split(_PLACE)
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    out.write(f"{before}{text.replace('<', chr(92) + 'u003c')}{after}".encode())  # no text ends the script


class Extent:
    """What a page shows; its coordinates begin in the upper left corner, in parts of the larger side."""

    def __init__(self, low: ArrayLike, high: ArrayLike, *, y_up: bool) -> None:
        box = np.array([low, high], dtype=np.float64)
        self._exponent = int(np.frexp(np.abs(box).max())[1])  # a power of two keeps differences within range
        (self._left, top), (_, bottom) = np.ldexp(box, -self._exponent)
        span = np.ldexp(box[1], -self._exponent) - np.ldexp(box[0], -self._exponent)
        self._side, self._top, self._y_up = float(span.max()) or 1.0, bottom if y_up else top, y_up
        self.sides = {"width": float(span[0]) / self._side or 1e-9, "height": float(span[1]) / self._side or 1e-9}

    def places(self, xy: NDArray[np.float64]) -> str:
        """Give coordinates as text."""
        x, y = np.ldexp(xy, -self._exponent).T
        down = self._top - y if self._y_up else y - self._top
        return packed(np.stack([x - self._left, down], axis=1) / self._side, "<f4")


def json_value(value: Any) -> Any:
    """Give a number or a text as JSON has them; what is missing or no number is None."""
    if value is np.ma.masked:
        return None
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(value, float):
        return value if isfinite(value) else None
    return value if value is None or isinstance(value, bool | int | str) else str(value)


def packed(values: ArrayLike, dtype: DTypeLike) -> str:
    """Give the bytes of an array as text."""
    return b64encode(np.ascontiguousarray(values, dtype=dtype).tobytes()).decode()


MOST_POINTS = 100_000
"""Some 30 MB of data: browsers draw so many in about a second."""

MOST_SIMPLICES = 1_000_000
"""Edges and triangles in space: some 70 MB of data."""

ALPHA_PAGE = "alpha_page.html"


def check_family_size(family: AlphaComplex | SpaceAlphaComplex) -> None:
    """Refuse a page that no browser would draw."""
    if isinstance(family, SpaceAlphaComplex):
        _check_simplices(len(family.edges) + len(family.triangle_min))
    else:
        _check_count(len(family.points), MOST_POINTS, "points", f"use {AS_PICTURE}")


def _check_simplices(count: int) -> None:
    _check_count(count, MOST_SIMPLICES, "edges and triangles", f"use {AS_MESH}, or {AS_PICTURE}")


def _check_count(count: int, most: int, what: str, instead: str) -> None:
    if count > most:
        raise LimitError(f"{count} {what} are too many for a page, at most {most}: {instead}")


def write_alpha_html(
    out: BinaryIO,
    family: AlphaComplex | SpaceAlphaComplex,
    curves: Table,
    *,
    r: Radius | None = None,
    unit: str | None = None,
) -> None:
    """Write a page with a slider over r: the shape, the classes of its parts, and curves."""
    check_family_size(family)
    names = [name for name in curves if name != "r"]
    data = {
        "title": "Alpha shape",
        "r": _first_radius(family, r),
        "unit": unit or "",
        "spectrum": packed(family.spectrum, "<f8"),
        "curves": {name: packed(curves[name], "<f8" if name in _MEASURES else "<i4") for name in names},
    }
    if isinstance(family, SpaceAlphaComplex):
        write_page(out, ALPHA_PAGE, data | _in_space(family), "space_view.js")
    else:
        write_page(out, ALPHA_PAGE, data | _in_plane(family), "plane_view.js")


_MEASURES = ("perimeter", "area", "volume")
"""Curves that are no counts."""


def _in_plane(family: AlphaComplex) -> dict[str, Any]:
    """Give the places of points, edges and triangles, and their ranks."""
    points, mesh = family.points, family.mesh
    low, high = bounds(points) if len(points) else (np.zeros(2), np.zeros(2))
    extent = Extent(low, high, y_up=is_up(mesh))
    whole = {"edges": family.edges, "triangles": mesh.triangles}
    whole |= {name: getattr(family, name) for name in ("rank_min", "rank_mid", "rank_max", "triangle_rank")}
    return {
        **extent.sides,
        "xy": extent.places(points),
        **{name: packed(values, "<i4") for name, values in whole.items()},
    }


def _in_space(family: SpaceAlphaComplex) -> dict[str, Any]:
    """Give the places of points around their middle, and edges and triangles with ranks: those that are ever seen."""
    triangles, edges, mesh = family.ranks("triangles"), family.ranks("edges"), family.mesh
    edges[:, 1] = np.minimum(edges[:, 1], _on_triangles(family))
    points = np.where(mesh.is_duplicate, -1, len(family.spectrum)).astype(np.int32)
    np.minimum.at(points, family.edges, edges[:, :1])
    return _of_mesh(mesh, (family.triangles, triangles), (family.edges, edges), points)


_Ranked = tuple[NDArray[np.int32], NDArray[np.int32]]
"""Corners of simplices, and their three ranks."""


def _of_mesh(mesh: Tetrahedralization, triangles: _Ranked, edges: _Ranked, points: NDArray[np.int32]) -> dict[str, Any]:
    return {
        "distinct": len(points) - mesh.duplicates,
        "places": packed(_around_middle(mesh.points), "<f4"),
        **_ranked("triangle", *triangles),
        **_ranked("edge", *edges),
        "point_min": packed(points, "<i4"),
    }


def write_space_html(out: BinaryIO, mesh: Tetrahedralization) -> None:
    """Write a page with a triangulation in space: the viewer of alpha shapes without a radius."""
    check_space_size(mesh)
    faces, edges = mesh.hull if len(mesh) else mesh.planar, mesh.edges
    sides = _keys(faces[:, [0, 1, 0, 2, 1, 2]].reshape(-1, 2))
    seen, inner = np.array([[-1, -1, 0], [-1, 0, 0]], dtype=np.int32)  # as surfaces are, and as what is singular
    of_edges = np.where(np.isin(_keys(edges), sides)[:, None], seen, inner)
    nowhere = np.full(len(mesh.points), -1, dtype=np.int32)
    shown = _of_mesh(mesh, (faces, np.tile(seen, (len(faces), 1))), (edges, of_edges), nowhere)
    data = {"title": "Delaunay triangulation", "r": 1, "unit": "", "spectrum": "", "curves": {}}
    write_page(out, ALPHA_PAGE, data | shown, "space_view.js")


def check_space_size(mesh: Tetrahedralization) -> None:
    """Refuse a page that no browser would draw."""
    _check_simplices(len(mesh.edges) + len(mesh.hull))


def _on_triangles(family: SpaceAlphaComplex) -> NDArray[np.int32]:
    """Give the first rank at which each edge is on a triangle."""
    keys = _keys(family.edges)
    order = np.argsort(keys)
    first = np.full(len(keys), len(family.spectrum), dtype=np.int32)
    for pair in ([0, 1], [0, 2], [1, 2]):
        sides = order[np.searchsorted(keys, _keys(family.triangles[:, pair]), sorter=order)]
        np.minimum.at(first, sides, family.triangle_min)
    return first


def _keys(pairs: NDArray[np.int32]) -> NDArray[np.int64]:
    """Give numbers of pairs of indices, whatever their order."""
    return pairs.min(axis=1).astype(np.int64) << 32 | pairs.max(axis=1)


def _ranked(name: str, corners: NDArray[np.int32], ranks: NDArray[np.int32]) -> dict[str, str]:
    """Give simplices and their ranks, without those that bound a tetrahedron as soon as another one."""
    is_seen = ranks[:, 0] < ranks[:, 2]
    columns = dict(zip(("min", "mid", "max"), ranks[is_seen].T, strict=True))
    return {f"{name}s": packed(corners[is_seen], "<u4")} | {
        f"{name}_{each}": packed(values, "<i4") for each, values in columns.items()
    }


def _around_middle(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Move the middle of points to 0, and the farthest one to the distance 1."""
    if not len(points):
        return points
    exponent = -int(np.frexp(np.abs(points).max())[1])  # a power of two keeps differences within range
    near = np.ldexp(points, exponent)
    near = near - (near.min(axis=0) + near.max(axis=0)) / 2
    return near / (float(scaled_norms(near).max()) or 1.0)


def _first_radius(family: AlphaComplex | SpaceAlphaComplex, r: Radius | None) -> float:
    """The radius, or one beyond all where it is infinite."""
    finite = family.spectrum[np.isfinite(family.spectrum)]
    largest = float(finite[-1]) if len(finite) else 1.0
    if r is None:
        return float(finite[len(finite) // 2]) if len(finite) else largest
    chosen = nearest_double(r)
    return chosen if isfinite(chosen) else min(2 * largest, float_info.max)


MOST_CELLS, MOST_VERTICES = 100_000, 3_000_000
"""Some 30 MB of data: browsers draw so many in about a second."""

CELLS_PAGE = "cells_page.html"

_FINE = 2.0**-12
"""How far lines may be from curves: of the larger side of the frame."""


class Shapes(NamedTuple):
    """Outlines of cells or of labels."""

    xy: NDArray[np.float64]  # (n, 2) float64 array: vertices
    rings: NDArray[np.integer]  # (r + 1,) integer array: where each ring begins among them, and n
    shapes: NDArray[np.integer]  # (k + 1,) integer array: where each shape begins among the rings, and r
    ids: Sequence[str]
    bounds: tuple[float, float, float, float]  # what the page shows
    y_up: bool = False  # y goes upwards
    sites: Lines = Lines(np.zeros((0, 2)), np.zeros(1, dtype=np.int64))  # what the cells are of, drawn over them


def shapes_of_cells(cells: CellSet) -> Shapes:
    """Give the outlines of cells."""
    rings, polygons, of_cells = cells.nesting
    ids = [str(label) for label in cells.label_array.tolist()]
    up = is_up(cells)
    sites = Lines(cells.sites, np.arange(len(cells.sites) + 1))
    of_rings = np.asarray(polygons)[np.asarray(of_cells)]
    return Shapes(cells.coordinates, rings, of_rings, ids, cells.frame.sides, up, sites)


def shapes_of_map(cells: VoronoiMap) -> Shapes:
    """Give the outlines of the cells of a Voronoi map, with lines instead of curves."""
    x, y, w, h = cells.frame
    xy, rings = cell_rings(cells, _FINE * max(w, h))
    ids = [str(label) for label in (range(1, len(cells) + 1) if cells.ids is None else cells.ids)]
    up = is_up(cells.polygons)
    bounds, sites = (x, y, x + w, y + h), _outlines(cells.polygons)
    return Shapes(xy, rings, cells.polygon_starts[cells.cell_starts], ids, bounds, up, sites)


def _outlines(polygons: PolygonSet) -> Lines:
    """Give the rings of polygons, each with its first vertex at the end, and lines; a point has one vertex."""
    first, last = polygons.ring_starts[:-1], polygons.ring_starts[1:]
    is_closed = polygons.ring_kind != LINE
    xy = np.insert(polygons.xy, last[is_closed], polygons.xy[first[is_closed]], axis=0)
    return Lines(xy, starts_of(last - first + is_closed))


def shapes_of_labels(labels: NDArray[Any], *, y_up: bool = False, sides: PixelSides = SQUARE) -> Shapes:
    """Give the outlines of the labels of an image along the cracks between its pixels; 0 is none."""
    found = list(crack_loops(labels))
    loops = [loop for _, own in found for loop in own]
    xy = np.array([place for loop in loops for place in loop], dtype=np.float64).reshape(-1, 2)
    ids = [str(label) for label, _ in found]
    rings = starts_of(np.array([len(loop) for loop in loops], dtype=np.int64))
    shapes = starts_of(np.array([len(own) for _, own in found], dtype=np.int64))
    down, across = map(float, sides.lengths)
    height, width = labels.shape
    return Shapes(xy * (across, down), rings, shapes, ids, (0.0, 0.0, width * across, height * down), y_up)


def write_cells_html(out: BinaryIO, shapes: Shapes, classes: ArrayLike, columns: Mapping[str, Sequence[Any]]) -> None:
    """Write a page on which the cell that is pointed at is named, with its values."""
    check_cells_size(len(shapes.ids), len(shapes.xy) + len(shapes.sites.xy))
    classes, extent = np.asarray(classes), Extent(shapes.bounds[:2], shapes.bounds[2:], y_up=shapes.y_up)
    data = {
        **extent.sides,
        "xy": extent.places(shapes.xy),
        "rings": packed(shapes.rings, "<i4"),
        "shapes": packed(shapes.shapes, "<i4"),
        "classes": packed(classes, "<i4"),
        "sites": extent.places(shapes.sites.xy),
        "lines": packed(shapes.sites.starts, "<i4"),
        **named_cells(shapes.ids, classes, columns),
    }
    write_page(out, CELLS_PAGE, data)


def named_cells(ids: Sequence[str], classes: NDArray[Any], columns: Mapping[str, Sequence[Any]]) -> dict[str, Any]:
    """Give the colors of cells, their ids and their values."""
    return {
        "colors": [cell_color(number) for number in range(int(classes.max(initial=0)) + 1)],
        "ids": list(ids),
        "columns": [{"name": name, "values": [json_value(each) for each in own]} for name, own in columns.items()],
    }


def write_labels_html(
    out: BinaryIO,
    image: LabelImage,
    colors: tuple[NDArray[Any], NDArray[Any]],
    table: Table,
    more: Mapping[str, Sequence[Any]] | None = None,
    *,
    y_up: bool,
) -> None:
    """Write a page that names the region that is pointed at, with its row of a table."""
    shapes = shapes_of_labels(image.labels, y_up=y_up, sides=image.sides)
    write_cells_html(out, shapes, colors[1], columns_of(table, colors[0]) | dict(more or {}))


def columns_of(table: Table, labels: NDArray[Any]) -> dict[str, Sequence[Any]]:
    """Give the rows of some labels."""
    rows = {int(label): row for row, label in enumerate(table["label"])}
    chosen = [rows[int(label)] for label in labels]
    return {name: [table[name][row] for row in chosen] for name in table if name != "label"}


def check_cells_size(cells: int, vertices: int = 0) -> None:
    """Refuse a page that no browser would draw."""
    for count, most, what in ((cells, MOST_CELLS, "cells"), (vertices, MOST_VERTICES, "vertices of cells")):
        _check_count(count, most, what, f"use {AS_SVG} or png")


MOST_VOXELS = 1 << 26
"""Voxels of a page: 512 x 512 x 256 of them."""

MOST_RUNS = 3_000_000
"""Runs of voxels of one label: some 30 MB of data."""

VOLUME_PAGE = "volume_page.html"


class Runs(NamedTuple):
    """A volume of labels as runs along its rows."""

    rows: NDArray[np.int64]  # (D * H + 1,) int64 array: where the runs of each row begin, and their number
    ends: NDArray[np.int64]  # (r,) int64 array: the column behind each run
    # (r,) int64 array: index of the label of each run among the known ones, from 1; 0 is none
    regions: NDArray[np.int64]


def runs_of(labels: NDArray[Any], known: NDArray[Any]) -> Runs:
    """Give the runs of a volume."""
    _, height, width = labels.shape
    counts, ends, regions = [], [], []
    for values in labels:
        is_last = np.ones((height, width), bool)
        is_last[:, :-1] = values[:, 1:] != values[:, :-1]
        counts.append(is_last.sum(axis=1))
        ends.append(np.nonzero(is_last)[1] + 1)
        own = values[is_last]
        regions.append(np.where(own == 0, 0, np.searchsorted(known, own) + 1))
    return Runs(starts_of(np.concatenate(counts)), np.concatenate(ends), np.concatenate(regions))


def check_volume_page(shape: tuple[int, ...], labels: int = 0, runs: int = 0) -> None:
    """Refuse a page that no browser would show."""
    depth, height, width = shape
    instead = f"use {option('--what color -f png, or --what labels', 'labels in TIFF, NPY or Zarr')}"
    if depth * height * width > MOST_VOXELS:
        size = f"{width} x {height} x {depth}"
        raise LimitError(f"{size} voxels are too many for a page, at most {MOST_VOXELS}: {instead}")
    for count, most, what in ((labels, MOST_CELLS, "labels"), (runs, MOST_RUNS, "runs of voxels")):
        _check_count(count, most, what, instead)


def write_volume_html(
    out: BinaryIO,
    labels: NDArray[Any],
    colors: tuple[NDArray[Any], NDArray[Any]],
    columns: Mapping[str, Sequence[Any]],
    *,
    first: int = 0,
    units: ArrayLike = (1, 1, 1),
) -> None:
    """Write a page with a slider over the slices of a volume, on which the region that is pointed at is named."""
    known, classes = np.asarray(colors[0]), np.asarray(colors[1])
    check_volume_page(labels.shape, len(known))
    runs = runs_of(labels, known)
    check_volume_page(labels.shape, len(known), len(runs.ends))
    depth, height, width = labels.shape
    _, side_y, side_x = (float(unit) for unit in np.asarray(units))
    data = {
        "width": width,
        "height": height,
        "depth": depth,
        "first": first,
        "sides": [side_x, side_y],
        "rows": packed(runs.rows, "<i4"),
        "ends": packed(runs.ends, "<i4"),
        "regions": packed(runs.regions, "<i4"),
        "classes": packed(np.append(0, classes), "<i4"),
        **named_cells([str(label) for label in known.tolist()], classes, columns),
    }
    write_page(out, VOLUME_PAGE, data)


MOST_ARCS = 100_000
"""Some 20 MB of data: browsers draw so many in about a second."""

SKELETON_PAGE = "skeleton_page.html"


def check_skeleton_size(skeleton: Skeleton) -> None:
    """Refuse a page that no browser would draw."""
    for count, what in ((len(skeleton), "arcs"), (len(skeleton.polygons.xy), "vertices of polygons")):
        _check_count(count, MOST_ARCS, what, f"use {AS_PICTURE}")


def write_skeleton_html(
    out: BinaryIO,
    skeleton: Skeleton,
    values: Sequence[CriticalValues],
    profiles: ArcProfiles,
    *,
    shown: tuple[str, float] | None = None,
) -> None:
    """Write a page with a slider over the threshold of each criterion."""
    check_skeleton_size(skeleton)
    data = _shapes(skeleton)
    data["shown"] = list(shown or (values[0].criterion, 0.0))
    data["profiles"] = {
        "kind": packed(profiles.kind, "<i1"),
        "ends": packed(profiles.ends, "<f8"),
        "size": packed(profiles.size, "<f8"),
    }
    data["criteria"] = {
        own.criterion: {
            "ends": packed(own.ends, "<f8"),
            "most": packed(own.most, "<f8"),
            "keptArc": packed(own.kept_arc, "<i4"),
            "keptPlace": packed(own.kept_place, "<f8"),
        }
        for own in values
    }
    write_page(out, SKELETON_PAGE, data)


def _shapes(skeleton: Skeleton) -> dict[str, Any]:
    """Arrays as the page decodes them."""
    polygons = skeleton.polygons
    shown = np.concatenate([polygons.xy, skeleton.vertices])
    low, high = bounds(shown) if len(shown) else (np.zeros(2), np.ones(2))
    extent = Extent(low, high, y_up=is_up(skeleton))
    return {
        **extent.sides,
        "xy": extent.places(skeleton.vertices),
        "radius": packed(skeleton.radius, "<f8"),
        "arcs": packed(skeleton.arcs, "<i4"),
        "control": extent.places(skeleton.control),
        "length": packed(skeleton.length, "<f8"),
        "rings": extent.places(polygons.xy),
        "ringStart": packed(polygons.ring_starts, "<i4"),
        "ringKind": packed(polygons.ring_kind, "<i1"),
    }
