"""Skeletons of polygons and lines: arcs of bisectors, each with its clearance radius and its sites."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats
from vorotool.numeric.curves.flatten import curve_tolerances, least_focal_distances, polylines
from vorotool.numeric.numbers import checked_flatten
from vorotool.numeric.parallel import in_chunks
from vorotool.products.formats import resolved
from vorotool.types import fields as f
from vorotool.types.box import extent_sides
from vorotool.types.features import Rows
from vorotool.types.fields import index, numbers, record
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.arc_measures import ArcMeasures
from vorotool.types.skeleton.segment_voronoi import EDGE, SiteTable, ends_of_sites
from vorotool.types.table import Lookup
from vorotool.types.values import Branched, Pictured, Tabular, Value, counted

if TYPE_CHECKING:
    from vorotool.types.features import Rows

INTERIOR, EXTERIOR = 0, 1
"""Sides of an arc: inside a polygon, or in none."""

SIDES = ("interior", "exterior")
KINDS = ("line", "parabola")


@record
class Skeleton(Value, Tabular, Branched, Pictured):
    """A graph of arcs, each a straight line or a part of a parabola, in the units of the input.

    Arcs follow each other branch by branch: a branch is a chain of arcs between nodes with one arc or more than two.
    Those inside polygons come first, polygon by polygon.

    Parameters
    ----------
    vertices : (v, 2) float64 array
        Nodes: centers of discs that touch the boundary without crossing it.
    radius : (v,) float64 array
        Their radii: 0 at corners.
    arcs : (a, 2) int32 array
        Source and target of each arc: two different places, unless a connected part is one place as a whole.
    control : (a, 2) float64 array
        Where the tangents at the ends of a parabola meet: the control point of the quadratic Bezier curve that it is.
        NaN on straight lines.
    sites : (a, 2) int32 array
        The sites left and right of each arc, from source to target and y upwards: rows of `site_table`.
    site_table : SiteTable
        Vertices and edges of `polygons`.
    polygon : (a,) int32 array
        The polygon that the arc is in, the first of several; -1 outside.
    side : (a,) int8 array
        `INTERIOR` or `EXTERIOR`.
    branch : (a,) int32 array
        Number of the branch: from 0, not decreasing.
    length : (a,) float64 array
        True arc lengths.
    error_bound : (a,) float64 array
        How far the arc may be from the skeleton of `polygons`; 0 for exact arcs, which are rounded only.
    polygons : PolygonSet
        As they were used: placed, and cut where they meet, each feature by itself or all together.
    frame : (x, y, w, h), optional
        The rectangle that arcs outside are cut by; with an open border all.
    gap : float
        By how much edges were shortened at both ends; see `vorotool.skeleton_exact`.
    features : {"separate", "together"}
        Whether what is inside a feature is what it would be if there were no others, or all are one arrangement. What
        is outside always is of all of them.
    origin : (float, float)
        Of the lattice that it was computed on: nodes are rounded as doubles that far from it are.
    scale : float
        The step of that lattice; 0 if nothing was placed.
    border : {"closed", "open"}
        Whether polygons go on beyond the frame where they touch its border: their edges there are no sites.

    Raises
    ------
    InputError
        If an array has another shape.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 3.2.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> skeleton = skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]])
    >>> len(skeleton), sorted(map(tuple, skeleton.vertices.tolist()))
    (5, [(0.0, 0.0), (0.0, 2.0), (1.0, 1.0), (3.0, 1.0), (4.0, 0.0), (4.0, 2.0)])
    """

    maker = "skeleton_exact"

    vertices: NDArray[np.float64] = f.position("nodes", 2)
    radius: NDArray[np.float64] = f.length("nodes")
    arcs: NDArray[np.int32] = f.index("arcs", 2)
    control: NDArray[np.float64] = f.position("arcs", 2)
    sites: NDArray[np.int32] = f.index("arcs", 2)
    site_table: SiteTable = f.nested()
    polygon: NDArray[np.int32] = f.index("arcs")
    side: NDArray[np.int8] = f.numbers(np.int8, "arcs")
    branch: NDArray[np.int32] = f.index("arcs")
    length: NDArray[np.float64] = f.length("arcs")
    error_bound: NDArray[np.float64] = f.length("arcs")
    polygons: PolygonSet = f.nested()
    frame: tuple[float, float, float, float] | None = f.position(default=None)
    gap: float = f.length(default=0.0)
    features: str = "separate"
    origin: tuple[float, float] = (0.0, 0.0)
    scale: float = 0.0
    border: str = "closed"

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.frame is not None:
            x, y, w, h = map(float, self.frame)
            object.__setattr__(self, "frame", (x, y, w, h))

    def __len__(self) -> int:
        return len(self.arcs)

    @cached_property
    def is_parabola(self) -> NDArray[np.bool_]:
        """(a,) whether each arc is a part of a parabola."""
        return ~np.isnan(self.control[:, 0])

    @property
    def kind(self) -> NDArray[Any]:
        """(a,) ``line`` or ``parabola``."""
        return np.array(KINDS)[self.is_parabola.astype(np.int8)]

    def side_names(self, arcs: Any = slice(None)) -> Lookup:
        """Return the side of some arcs, or of all, as a column."""
        side = self.side[arcs]
        return Lookup([*SIDES, None], np.where(side < 0, len(SIDES), side).astype(np.int32))

    @cached_property
    def degree(self) -> NDArray[np.int64]:
        """(v,) number of arcs that end at each node."""
        return np.bincount(self.arcs.reshape(-1), minlength=len(self.vertices))

    @cached_property
    def branch_starts(self) -> NDArray[np.int64]:
        """(b,) the first arc of each branch."""
        return np.flatnonzero(np.diff(self.branch, prepend=-1))

    @cached_property
    def branch_ends(self) -> NDArray[np.int32]:
        """(2, b) the nodes that branches begin and end at."""
        last = np.append(self.branch_starts, len(self))[1:] - 1
        return np.stack([self.arcs[self.branch_starts, 0], self.arcs[last, 1]])

    @cached_property
    def on_frame(self) -> NDArray[np.bool_]:
        """(v,) whether each node is an end on the frame."""
        touches: NDArray[np.bool_] = self.touches_frame
        return touches if self.frame is None else touches & (self.degree == 1)

    @cached_property
    def touches_frame(self) -> NDArray[np.bool_]:
        """(v,) whether each node is on the border of the frame: what goes on beyond is cut off.

        Arcs are cut exactly there; a node that happens to be there may be rounded by some ulp.
        """
        if self.frame is None:
            return np.zeros(len(self.vertices), dtype=bool)
        x, y, w, h = self.frame
        sides = np.array([x, x + w, y, y + h])
        apart = np.abs(self.vertices[:, [0, 0, 1, 1]] - sides)
        return np.asarray((apart <= 8 * np.spacing(np.abs(sides).max())).any(axis=1))

    @cached_property
    def site_ends(self) -> NDArray[np.float64]:
        """(s, 2, 2) the ends of each site, with a gap those of the shortened edges; a vertex has one place twice."""
        return self.site_ends_on(1)

    @cached_property
    def as_given(self) -> Skeleton:
        """Skeleton with its corners at the input coordinates: `polygons` and `vertices` are on a lattice."""
        given = self.polygons.as_given
        return self if given is self.polygons else self.with_corners(given)

    def with_corners(self, polygons: PolygonSet) -> Skeleton:
        """Move the nodes at corners to where other polygons, of the same rings, have these."""
        arc, end = np.nonzero(self.radius[self.arcs] == 0)
        node, site = self.arcs[arc, end], self.sites[arc, 0]  # both sites of an arc end at its corner
        here, there = (ends_of_sites(each, self.site_table, site) for each in (self.polygons, polygons))
        at, which = np.nonzero((here == self.vertices[node][:, None]).all(axis=2))
        vertices = self.vertices.copy()
        vertices[node[at][::-1]] = there[at, which][::-1]  # the first of several, written last
        return replace(self, vertices=vertices, polygons=polygons)

    def site_ends_on(self, threads: int) -> NDArray[np.float64]:
        """Compute `site_ends` on several threads, unless they are known; 0 uses all."""
        if "site_ends" not in self.__dict__:
            made = np.empty((len(self.site_table), 2, 2))

            def fill(sites: slice) -> None:
                made[sites] = self._ends_of(sites)

            in_chunks(len(made), fill, threads=threads)
            self.__dict__["site_ends"] = made
        return self.__dict__["site_ends"]

    def _ends_of(self, sites: Any) -> NDArray[np.float64]:
        ends = ends_of_sites(self.polygons, self.site_table, sites)
        if self.gap:
            a, b = ends[..., 0, :], ends[..., 1, :]
            length = np.sqrt(np.square(b - a).sum(axis=-1, keepdims=True))
            way = np.divide(self.gap * (b - a), length, out=np.zeros_like(a), where=length > 0)
            a += way
            b -= way
        return ends

    @cached_property
    def arc_radii(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Smallest and largest radius on each arc, and the integral of the radius along it."""
        return self.arc_radii_on(1)

    def arc_radii_on(self, threads: int) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Compute `arc_radii` on several threads, unless they are known; 0 uses all."""
        if "arc_radii" not in self.__dict__:
            self.__dict__["arc_radii"] = arc_radii(len(self), self._arc_arrays, threads=threads)
        return self.__dict__["arc_radii"]

    def measures(self, arcs: NDArray[np.integer]) -> ArcMeasures:
        """Return points, radii and lengths along some arcs, which may be repeated."""
        return ArcMeasures(*self._arc_arrays(arcs))

    def _arc_arrays(self, arcs: Any) -> tuple[NDArray[Any], ...]:
        """Ends, radii, control points, ends of the sites, whether these are edges, and lengths."""
        sites = self.sites[arcs].T.astype(np.intp, order="C")
        nodes = self.arcs[arcs].astype(np.intp)
        known = "site_ends" in self.__dict__
        return (
            self.vertices.take(nodes, axis=0),
            self.radius.take(nodes),
            self.control[arcs],
            self.site_ends.take(sites, axis=0) if known else self._ends_of(sites),
            self.site_table.kind.take(sites) == EDGE,
            self.length[arcs],
        )

    def flattened(self, tolerance: float | None = None) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Return the arcs as polylines, with parabolas divided evenly in their parameter.

        Parameters
        ----------
        tolerance : float, optional
            How far a polyline may be from its arc; by default the larger of 1/2000 of the extent of the arc and 1/100
            of its least radius.

        Returns
        -------
        points : (k, 2) float64 array
            Places along each arc, its ends included.
        start : (a + 1,) int64 array
            Where the points of each arc begin.

        Raises
        ------
        UsageError
            If the tolerance is not a positive number.
        """
        source, target = self.vertices[self.arcs[:, 0]], self.vertices[self.arcs[:, 1]]
        least = np.where(self.is_parabola, least_focal_distances(source, self.control, target), 0)
        ends = np.stack([source, target], axis=1)
        each = curve_tolerances(ends, least, checked_flatten(tolerance))
        return polylines(source, self.control, target, self.is_parabola, each)

    def _rows(self, what: str | None = None) -> Rows:
        return resolved("types.skeleton.tables:skeleton_rows")(self, what)

    def _features(self, what: str | None = None, flatten: float | None = None) -> Rows:
        return resolved("types.skeleton.tables:skeleton_features")(self, what, flatten)

    def _shown_places(self) -> list[Floats]:
        """Return all polygons, and the frame, if arcs are cut by one."""
        frame = [] if self.frame is None else [np.array(extent_sides(self.frame)).reshape(2, 2)]
        return [self.polygons.xy, *frame]

    def _summary(self) -> str:
        branches = counted(int(self.branch[-1]) + 1 if len(self) else 0, "branch", "branches")
        text = f"{counted(len(self), 'arc')} in {branches}, {counted(len(self.vertices), 'node')}"
        return f"{text}, of {counted(len(self.polygons), 'polygon')}"


def arc_radii(
    count: int, arrays_of: Callable[[slice], tuple[NDArray[Any], ...]], *, threads: int = 1
) -> tuple[Floats, Floats, Floats]:
    """Smallest and largest radius on each of many arcs, and the integral of the radius along it."""
    made = np.empty((3, count))

    def fill(part: slice) -> None:
        made[:, part] = radii_of_arcs(*arrays_of(part))

    in_chunks(count, fill, threads=threads)
    least, most, integral = made
    return least, most, integral


def radii_of_arcs(
    ends: Floats, radius: Floats, control: Floats, sites: Floats, is_edge: NDArray[np.bool_], length: Floats
) -> tuple[Floats, Floats, Floats]:
    """Smallest and largest radius on each arc, and the integral of the radius along it."""
    r0, r1 = np.ascontiguousarray(radius.T)
    least, most = np.minimum(r0, r1), np.maximum(r0, r1)
    integral = length * (r0 + r1) / 2  # between two edges the radius is linear
    rest = np.flatnonzero(~(is_edge[0] & is_edge[1]))
    ends, sites, is_edge = ends.take(rest, axis=0), sites.take(rest, axis=1), is_edge.take(rest, axis=1)
    least[rest] = np.minimum(least[rest], _least_inside(ends, sites, is_edge))
    measures = ArcMeasures(
        ends, radius.take(rest, axis=0), control.take(rest, axis=0), sites, is_edge, length.take(rest)
    )
    integral[rest] = measures.integral
    return least, most, integral


def _least_inside(ends: Floats, sites: Floats, is_edge: NDArray[np.bool_]) -> Floats:
    """Half-way between a vertex and the other site: nearest there, if that is in the middle of the arc; else inf."""
    source, target = _columns(ends)
    left, right = _columns(sites[0]), _columns(sites[1])
    other, first = right[0].copy(), left[0].copy()
    on_left, on_right = map(np.flatnonzero, is_edge)
    other[:, on_right] = _foot(right.take(on_right, axis=2), left[0].take(on_right, axis=1))
    first[:, on_left] = _foot(left.take(on_left, axis=2), right[0].take(on_left, axis=1))
    middle, half = (first + other) / 2, _length(other - first) / 2
    way = target - source
    within = _dot(middle - source, way) * _dot(middle - target, way) < 0
    return np.where(within, half, np.inf)


def _columns(places: Floats) -> Floats:
    """(2, 2, n) of (n, 2, 2): the first and the second of each pair, x and y."""
    return np.ascontiguousarray(np.moveaxis(places, 0, -1))


def _dot(a: Floats, b: Floats) -> Floats:
    return a[0] * b[0] + a[1] * b[1]


def _length(way: Floats) -> Floats:
    return np.sqrt(_dot(way, way))  # the same on every machine, as hypot is not


def _foot(ends: Floats, place: Floats) -> Floats:
    way = ends[1] - ends[0]
    share = _dot(place - ends[0], way) / np.maximum(_dot(way, way), np.finfo(float).tiny)
    return ends[0] + share * way


CRITERIA = ("angle", "chord", "scale", "length", "ratio")
"""By which skeletons are pruned: angles in degrees, chord and length in input units, the others without a unit."""


@record
class CriticalValues(Value, Tabular):
    """Smallest thresholds that remove each point of a skeleton.

    Along an arc values do not decrease from either end to the place that has most.

    Parameters
    ----------
    criterion : {"angle", "chord", "scale", "length", "ratio"}
        What is compared with the threshold.
    ends : (a, 2) float64 array
        Close to the source and to the target of each arc; infinite on what is never removed.
    most : (a,) float64 array
        The largest on each arc.
    kept_arc : (k,) int32 array
        For each component that could be removed as a whole, the arc on which a place is kept nevertheless; increasing.
    kept_place : (k,) float64 array
        Where that is on the arc, from 0 at its source to 1 at its target, by the parameter of the Bezier curve.

    References
    ----------
    See :func:`vorotool.prune`.

    Examples
    --------
    >>> from vorotool import critical_values, skeleton_exact
    >>> values = critical_values(skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]]), "angle")
    >>> values.most.round(9).tolist()
    [90.0, 90.0, 90.0, 90.0, inf]
    """

    criterion: str
    ends: NDArray[np.float64] = numbers(np.float64, "arcs", 2)
    most: NDArray[np.float64] = numbers(np.float64, "arcs")
    kept_arc: NDArray[np.int32] = index("components")
    kept_place: NDArray[np.float64] = numbers(np.float64, "components")

    def __len__(self) -> int:
        return len(self.most)

    def _rows(self, _what: str | None = None) -> Rows:
        source, target = np.ascontiguousarray(self.ends.T)
        return Rows({"arc": np.arange(len(self)), "at_source": source, "at_target": target, "most": self.most})

    def _summary(self) -> str:
        return f"{self.criterion} of {counted(len(self), 'arc')}"


@record
class ArcProfiles(Value):
    """How the two nearest places on the boundary lie along arcs: what cuts inside arcs are computed from."""

    # (a,) int8 array: `BETWEEN_LINES`, `BETWEEN_POINTS`, or `FROM_FOCUS`
    kind: NDArray[np.int8] = numbers(np.int8, "arcs")
    # (a, 2) float64 array: x at the source and at the target; 0 between lines
    ends: NDArray[np.float64] = numbers(np.float64, "arcs", 2)
    # (a,) float64 array: h; between lines the tangent of half the angle
    size: NDArray[np.float64] = numbers(np.float64, "arcs")

    def _summary(self) -> str:
        return counted(len(self.kind), "arc")


BETWEEN_LINES, BETWEEN_POINTS, FROM_FOCUS = 0, 1, 2
"""Kinds of profiles."""
