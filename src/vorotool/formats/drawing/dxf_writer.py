"""Writing results as DXF: straight lines, true circular arcs, parabolas and cubic curves as splines."""

from __future__ import annotations

import io
import itertools
from collections.abc import Callable, Iterator, Sequence
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.drawing.dxf_reader import UNITS, ezdxf_module
from vorotool.numeric.arrays import Floats
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.products.registry import Product, write_product
from vorotool.types.alpha.shape import AlphaHull
from vorotool.types.fields import DOWN, YAxis
from vorotool.types.skeleton.discs import Discs
from vorotool.types.skeleton.lines import Centerlines, ExtendedSkeleton, LedOn, SmoothLines
from vorotool.types.skeleton.offsets import Offsets
from vorotool.types.skeleton.points_along import SkeletonPoints
from vorotool.types.skeleton.skeleton import Skeleton

DEPTH = "depth"
"""Layer of the lines in space along points."""


def write_dxf(out: BinaryIO, value: Any, *, product: Product) -> None:
    """Write a result on a layer of its name; offset curves on one for each distance."""
    drawing = DxfDrawing(unit=value.unit, y_axis=value.y_axis)
    if isinstance(value, Skeleton | LedOn | SmoothLines | SkeletonPoints):
        value = value.as_given
    own: dict[type, Callable[[DxfDrawing, Any, str], None]] = {
        Skeleton: _add_skeleton,
        Centerlines: _add_led_on,
        ExtendedSkeleton: _add_led_on,
        SmoothLines: _add_smooth,
        Offsets: _add_offsets,
        AlphaHull: _add_hull,
        Discs: _add_discs,
    }
    if isinstance(value, SkeletonPoints) and product.what == "points":
        _add_points(drawing, value)
    elif type(value) in own:
        own[type(value)](drawing, value, product.what)
    else:
        _add_features(drawing, value, product)
    drawing.write(out)


# ---- curves ----------------------------------------------------------------------------------------
def _add_skeleton(drawing: DxfDrawing, skeleton: Skeleton, what: str) -> None:
    """Lines and parabolas of each branch, as many together as follow each other."""
    for _, arcs in _branches(skeleton):
        _add_arcs(drawing, what, skeleton, arcs)


def _branches(skeleton: Skeleton) -> Iterator[tuple[int, NDArray[np.int64]]]:
    """The number of each branch, and its arcs."""
    for begin, end in itertools.pairwise([*skeleton.branch_starts.tolist(), len(skeleton)]):
        yield int(skeleton.branch[begin]), np.arange(begin, end)


def _add_arcs(drawing: DxfDrawing, layer: str, skeleton: Skeleton, arcs: NDArray[np.int64]) -> None:
    """Arcs that follow each other; those without a length are left out."""
    source, target = skeleton.vertices[skeleton.arcs[arcs]].swapaxes(0, 1)
    kept = (source != target).any(axis=1)
    arcs, source, target = arcs[kept], source[kept], target[kept]
    bent = skeleton.is_parabola[arcs]
    changes = np.flatnonzero(np.diff(bent.astype(np.int8), prepend=-1))
    for begin, end in itertools.pairwise([*changes.tolist(), len(arcs)]):
        if bent[begin]:
            both = np.stack([skeleton.control[arcs[begin:end]], target[begin:end]], axis=1).reshape(-1, 2)
            drawing.spline(layer, np.concatenate([source[begin : begin + 1], both]), 2)
        else:
            drawing.polyline(layer, np.concatenate([source[begin : begin + 1], target[begin:end]]))


def _add_smooth(drawing: DxfDrawing, smoothed: SmoothLines, what: str) -> None:
    """One spline a line."""
    for begin, end in itertools.pairwise(smoothed.start.tolist()):
        control = smoothed.control[begin:end]
        if (control != control[0, 0]).any():
            drawing.spline(what, np.concatenate([control[:1, 0], control[:, 1:].reshape(-1, 2)]), 3)


def _add_led_on(drawing: DxfDrawing, lines: LedOn, what: str) -> None:
    """Arcs of each path, and the straight lines that lead on."""
    for line, (begin, end) in enumerate(itertools.pairwise(lines.arc_starts.tolist())):
        for side, node in enumerate(lines.end_nodes[line].tolist()):
            led_on = np.stack([lines.path.vertices[node], lines.ends[line, side]])
            if not np.isnan(led_on).any() and (led_on[0] != led_on[1]).any():
                drawing.polyline(what, led_on if side else led_on[::-1])
        _add_arcs(drawing, what, lines.path, np.arange(begin, end))


def _add_offsets(drawing: DxfDrawing, offsets: Offsets, what: str) -> None:
    """Rings of arcs and straight lines, on a layer for each distance."""
    bulges = _bulges(offsets.start, offsets.end, offsets.center, offsets.piece_distance > 0)
    distances = offsets.distance[offsets.shape_of_ring].tolist()
    _add_rings(drawing, [f"{what}_{distance:g}" for distance in distances], offsets.start, bulges, offsets.ring_starts)


def _add_discs(drawing: DxfDrawing, discs: Discs, what: str) -> None:
    """Circles of two halves."""
    across = discs.radius[:, None] * (1, 0)
    for ends in np.stack([discs.xy + across, discs.xy - across], axis=1):
        drawing.polyline(what, ends, is_closed=True, bulges=[1.0, 1.0])


def _add_hull(drawing: DxfDrawing, hull: AlphaHull, what: str) -> None:
    """Rings of arcs, and points without extent."""
    bulges = _bulges(hull.start, hull.end, hull.center, np.zeros(len(hull), dtype=bool))
    _add_rings(drawing, [what] * (len(hull.ring_starts) - 1), hull.start, bulges, hull.ring_starts)
    drawing.points(what, hull.shape.family.mesh.points[hull.points])


def _add_rings(
    drawing: DxfDrawing, layers: list[str], start: Floats, bulges: list[float], ring_starts: NDArray[np.int64]
) -> None:
    for layer, (begin, end) in zip(layers, itertools.pairwise(ring_starts.tolist()), strict=True):
        drawing.polyline(layer, start[begin:end], is_closed=True, bulges=bulges[begin:end])


def _bulges(start: Floats, end: Floats, center: Floats, is_left: NDArray[np.bool_]) -> list[float]:
    """Tangents of a quarter of the angles of arcs, by their heights over half their chords; 0 of straight lines."""
    is_arc = ~np.isnan(center[:, 0])
    half = (end - start) / 2
    away = np.where(is_arc[:, None], center - (start + half), 0)
    across = hypotenuse(*half.T)
    radius = hypotenuse(across, hypotenuse(*away.T))
    turn = np.where(is_left, 1.0, -1.0)
    # above 0: the center is on the side that the arc turns to, so that it is at most half a circle
    inner = turn * (half[:, 0] * away[:, 1] - half[:, 1] * away[:, 0])
    beside = np.where(inner < 0, -1, 1) * hypotenuse(*away.T)
    short = np.divide(across, radius + np.abs(beside), out=np.zeros_like(across), where=radius > 0)
    bulge = np.where(beside >= 0, short, np.divide(1.0, short, out=np.zeros_like(short), where=short > 0))
    return [float(value) for value in np.where(is_arc, turn * bulge, 0.0) + 0.0]


# ---- places along a skeleton -----------------------------------------------------------------------
def _add_points(drawing: DxfDrawing, points: SkeletonPoints) -> None:
    """Places at the depth of their radius, and lines in space through them and all nodes."""
    drawing.points("points", np.column_stack([points.xy, -points.radius]))
    skeleton = points.skeleton
    nodes = np.column_stack([skeleton.vertices, -skeleton.radius])
    order = np.argsort(points.arc, kind="stable")
    places = np.column_stack([points.xy, -points.radius])[order]
    first = np.searchsorted(points.arc[order], np.arange(len(skeleton) + 1))
    for number, arcs in _branches(skeleton):
        if points.rings is not None:
            along = points.skeleton.branch[points.arc] == number
            drawing.line_in_space(DEPTH, np.column_stack([points.xy, -points.radius])[along])
            continue
        path: list[Floats] = []
        for arc in arcs.tolist():
            path += [nodes[skeleton.arcs[arc, :1]], places[first[arc] : first[arc + 1]]]
        whole = np.concatenate([*path, nodes[skeleton.arcs[arcs[-1], 1:]]])
        kept = np.append(True, (whole[1:] != whole[:-1]).any(axis=1))
        drawing.line_in_space(DEPTH, whole[kept])


# ---- what has no curves ----------------------------------------------------------------------------
def _add_features(drawing: DxfDrawing, value: Any, product: Product) -> None:
    """What a result has as features in GeoJSON."""
    import orjson

    text = io.BytesIO()
    write_product(text, value, product, "geojson")
    for feature in orjson.loads(text.getvalue())["features"]:
        own = feature.get("properties") or {}
        named = own.get("layer" if product.what == "shape" else "class")
        _add_geometry(drawing, named if isinstance(named, str) and named else product.what, feature["geometry"])


def _add_geometry(drawing: DxfDrawing, layer: str, geometry: Any) -> None:
    if geometry is None:
        return
    kind, places = geometry["type"], geometry.get("coordinates")
    if kind == "GeometryCollection":
        for part in geometry["geometries"]:
            _add_geometry(drawing, layer, part)
    elif kind.startswith("Multi"):
        for part in places:
            _add_geometry(drawing, layer, {"type": kind.removeprefix("Multi"), "coordinates": part})
    elif kind == "Polygon":
        for ring in places:
            drawing.polyline(layer, np.array(ring, dtype=np.float64)[:-1], is_closed=True)
    elif kind == "LineString":
        drawing.polyline(layer, np.array(places, dtype=np.float64))
    else:
        drawing.points(layer, np.array([places], dtype=np.float64))


# ---- the drawing ----------------------------------------------------------------------------------
_NUMBERS = {name: number for number, name in UNITS.items()} | {"µm": 13, "μm": 13}
_VERSION = "R2000"
_COLORS = (1, 5, 3, 6, 4, 2, 30, 7)
"""Of layers, in the order in which they come: red, blue, green, magenta, cyan, yellow, orange, black on white."""
_PLANAR = 8
_FORBIDDEN = '<>/\\":;?*|=`,'


class DxfDrawing:
    """Entities on layers, in the coordinates of the data."""

    def __init__(self, *, unit: str | None, y_axis: YAxis) -> None:
        ezdxf = self._library = ezdxf_module()
        self._turn = -1.0 if y_axis == DOWN else 1.0
        with self._fixed():
            self._document = ezdxf.new(_VERSION, units=_NUMBERS.get(unit or "", 0))
        self._space = self._document.modelspace()
        self._layers: dict[str, str] = {}

    def _fixed(self) -> Any:
        return _FixedMetadata(self._library.options)

    def _on(self, layer: str) -> dict[str, Any]:
        """Attributes of what is on a layer, which is made when it is first there."""
        if layer not in self._layers:
            name = "".join("_" if sign in _FORBIDDEN or not sign.isprintable() else sign for sign in layer)[:255] or "0"
            if name not in self._document.layers:
                self._document.layers.add(name, color=_COLORS[len(self._layers) % len(_COLORS)])
            self._layers[layer] = name
        return {"layer": self._layers[layer]}

    def _placed(self, points: Floats) -> list[tuple[float, ...]]:
        placed = points + 0.0
        placed[:, 1] = placed[:, 1] * self._turn + 0.0  # no -0
        return [tuple(point) for point in placed.tolist()]

    def polyline(
        self, layer: str, points: Floats, *, is_closed: bool = False, bulges: Sequence[float] | None = None
    ) -> None:
        """Add straight lines along points, or arcs, by the bulge at the start of each."""
        placed = self._placed(points)
        if len(placed) == 2 and not is_closed and bulges is None:
            self._space.add_line(*placed, dxfattribs=self._on(layer))
        elif len(placed) > 1:
            turned = [bulge * self._turn for bulge in bulges or [0.0] * len(placed)]
            rows = [(*point, bulge) for point, bulge in zip(placed, turned, strict=True)]
            self._space.add_lwpolyline(rows, format="xyb", close=is_closed, dxfattribs=self._on(layer))
        elif placed:
            self._space.add_point(placed[0], dxfattribs=self._on(layer))

    def spline(self, layer: str, points: Floats, degree: int) -> None:
        """Add curves of a degree that follow each other, as one spline: end, control points, end, and so on."""
        spline = self._space.add_spline(degree=degree, dxfattribs=self._on(layer))
        count = len(points) // degree
        spline.control_points = [(x, y, 0.0) for x, y in self._placed(points)]
        spline.knots = [0.0, *(float(k) for k in range(count + 1) for _ in range(degree)), float(count)]
        spline.dxf.flags = _PLANAR

    def line_in_space(self, layer: str, points: Floats) -> None:
        """Add straight lines along points with heights."""
        if len(points) > 1:
            self._space.add_polyline3d(self._placed(points), dxfattribs=self._on(layer))

    def points(self, layer: str, points: Floats) -> None:
        """Add places, which may have heights."""
        attributes = self._on(layer)
        for point in self._placed(points):
            self._space.add_point(point, dxfattribs=attributes)

    def write(self, out: BinaryIO) -> None:
        """Write all of it."""
        text = io.StringIO()
        with self._fixed():
            self._document.write(text)
        out.write(text.getvalue().encode(self._document.output_encoding, errors="dxfreplace"))


class _FixedMetadata:
    """While this lasts, drawings have no times, names of programs, and random numbers in them."""

    def __init__(self, options: Any) -> None:
        self._options = options

    def __enter__(self) -> None:
        self._before = self._options.write_fixed_meta_data_for_testing
        self._options.write_fixed_meta_data_for_testing = True

    def __exit__(self, *_: object) -> None:
        self._options.write_fixed_meta_data_for_testing = self._before
