"""The curves of borders (paper, section 3.2), with parameters along them, and the straight lines that cut them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.voronoi.borders import Borders
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Columns, Floats, Indices, crosses, dots, norms
from vorotool.types.polygons.planar_graph import PlanarGraph

FAR = 2.0**34
"""Beyond all that is on the lattice: ends that are farther away tell less of a line than its two elements do."""


NO_REGION = -1
"""The region of what no cell may have."""

SLACK = 2.0**-12
"""Of a step of the lattice: a place is on an edge that it misses by less. It is a thousand times what the coordinates
there, below 2^30, are rounded by, and what is drawn to an edge so moves by 2^-43 of the extent."""

ROUNDING = 2.0**-42
"""Of coordinates on the lattice: a thousand times what they are rounded by, of those of frames beyond 2^30, too."""

ROUNDING_GIVEN = 2.0**-51
"""Of coordinates in input units: what differs by less may be the same number there, or come from the same one."""


@frozen(eq=False)
class CutCurves(Columns):
    """Curves on the lattice, from one parameter to another."""

    base: Floats  # (k, 2) float64 array: a place of a line; the focus of a parabola; the center of a circle
    # (k, 2) float64 array: along a line; the unit vector along a directrix, or to the middle of a circular arc
    way: Floats
    height: Floats  # (k,) float64 array: of the focus above the directrix; 0 of others
    round: Floats  # (k,) float64 array: radius of a circle; 0 of others
    first: Floats  # (k,) float64 array: parameters at source and target, which may be infinite
    last: Floats  # (k,) float64 array: parameters at source and target, which may be infinite
    origin: Floats  # (k, 2) float64 array: a point that distances are measured from; NaN where that is a segment
    # (k, 3) float64 array: normal form of the segment that they are measured from otherwise; 0 along walls
    line: Floats

    def place(self, t: Floats) -> Floats:
        """(k, 2) where each is at its parameter."""
        is_bent = self.height > 0
        if not is_bent.any() and not self.round.any():
            return self.base + t[:, None] * self.way
        h = np.where(is_bent, self.height, 1)
        up = np.where(is_bent, (t * t - h * h) / (2 * h), 0)
        across = np.stack([-self.way[:, 1], self.way[:, 0]], axis=1)
        along, beside = t, up
        if self.round.any():
            is_round = self.round > 0
            finite = np.where(is_round, t, 0)
            square = 1 + finite * finite
            along = np.where(is_round, self.round * (1 - finite * finite) / square, t)
            beside = np.where(is_round, self.round * 2 * finite / square, up)
        return self.base + along[:, None] * self.way + beside[:, None] * across

    def tangent(self, t: Floats) -> Floats:
        """(k, 2) the direction at a parameter, towards rising ones."""
        is_bent = self.height > 0
        slope = np.where(is_bent, t / np.where(is_bent, self.height, 1), 0)
        across = np.stack([-self.way[:, 1], self.way[:, 0]], axis=1)
        is_round = self.round > 0
        along, beside = np.where(is_round, -2 * t, 1), np.where(is_round, 1 - t * t, slope)
        return along[:, None] * self.way + beside[:, None] * across

    def radius(self, t: Floats) -> Floats:
        """(k,) the distance from both sites at a parameter."""
        h = np.where(self.height > 0, self.height, 1)
        place = self.place(t)
        offset = place - self.origin
        of_line = np.abs(dots(place, self.line[:, :2]) - self.line[:, 2])
        straight = np.where(np.isnan(self.origin[:, 0]), of_line, norms(offset))
        return np.where(self.height > 0, (t * t + h * h) / (2 * h), straight)

    def control(self, t0: Floats, t1: Floats) -> Floats:
        """(k, 2) where the tangents at two parameters meet; NaN of lines."""
        is_bent = self.height > 0
        below = (t1 - t0) * (t1 - t0) / (4 * np.where(is_bent, self.height, 1))
        down = np.stack([self.way[:, 1], -self.way[:, 0]], axis=1)
        made: Floats = (self.place(t0) + self.place(t1)) / 2 + below[:, None] * down
        made[~is_bent] = np.nan
        return made

    def depth(self, t0: Floats, t1: Floats) -> Floats:
        """(k,) how far a curve is from its chord at most; 0 of lines."""
        cosine = (1 + t0 * t1) / np.sqrt((1 + t0 * t0) * (1 + t1 * t1))
        control = self.control(t0, t1)
        bend = np.nan_to_num(self.place(t0) - 2 * control + self.place(t1))
        return np.where(self.round > 0, self.round * (1 - cosine), norms(bend) / 4)

    def hull(self, t0: Floats, t1: Floats) -> Floats:
        """(k, 5, 2) closed rings of tangents and a chord around circular arcs."""
        a, b, middle = (self.place(t) - self.base for t in (t0, t1, (t0 + t1) / 2))
        square = (self.round * self.round)[:, None]
        corners = [(one + middle) * square / (square + dots(one, middle)[:, None]) for one in (a, b)]
        return np.stack([a, corners[0], corners[1], b, a], axis=1) + self.base[:, None]

    def meets(self, place: Floats, normal: Floats, slack: Floats) -> Floats:
        """(k, 2) parameters where each meets a straight line, missed by some slack at most; NaN elsewhere."""
        across = normal[:, 1] * self.way[:, 0] - normal[:, 0] * self.way[:, 1]
        is_bent = self.height > 0
        h = np.where(is_bent, self.height, 1)
        a = np.where(is_bent, across / (2 * h), 0)
        ahead = b = dots(normal, self.way)
        far = dots(normal, self.base - place)
        c = far - np.where(is_bent, h * across / 2, 0)
        is_round = self.round > 0
        a, c = np.where(is_round, far - self.round * b, a), np.where(is_round, far + self.round * b, c)
        b = np.where(is_round, 2 * self.round * across, b)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            discriminant = np.where(is_round, 4 * (self.round - far) * (self.round + far), b * b - 4 * a * c)
            touches = (np.abs(discriminant) <= 4 * np.abs(a) * slack) & (a != 0)
            touches = np.where(is_round, np.abs(np.abs(far) - self.round) <= slack, touches)
            q = -(b + np.copysign(np.sqrt(np.maximum(discriminant, 0)), b)) / 2
            roots = np.stack([c / q, q / a], axis=1)
            roots[discriminant < 0] = np.nan
            to_line = np.copysign(1, far)  # a circle touches it in the direction of its normal
            at = np.where(is_round, -to_line * across / (1 - to_line * ahead), -b / (2 * a))
            roots[touches, 0] = at[touches]
            roots[touches, 1] = np.nan
        roots[~np.isfinite(roots)] = np.nan
        return roots

    def between(self, least: Floats, most: Floats) -> tuple[Floats, Floats]:
        """(k,) parameters between which each may be in a box, the larger one first where it is in none."""
        low, high = np.minimum(self.first, self.last), np.maximum(self.first, self.last)
        reach = norms(np.maximum(np.abs(least - self.base), np.abs(most - self.base)))  # of the farthest corner
        is_bent = self.height > 0
        square = self.height * (2 * reach - self.height)
        side = np.sqrt(np.maximum(square, 0))
        with np.errstate(divide="ignore", invalid="ignore"):
            far = [(each - self.base) / self.way for each in (least, most)]
        is_along = self.way == 0
        is_in = (least <= self.base) & (self.base <= most)
        first = np.where(is_along, np.where(is_in, -np.inf, np.inf), np.minimum(*far)).max(axis=1)
        last = np.where(is_along, np.where(is_in, np.inf, -np.inf), np.maximum(*far)).min(axis=1)
        is_line = ~is_bent & (self.round == 0)
        first = np.where(is_line, first, np.where(is_bent, np.where(square < 0, np.inf, -side), -1.0))
        last = np.where(is_line, last, np.where(is_bent, side, 1.0))
        return np.maximum(low, first), np.minimum(high, last)

    def nearest(self, place: Floats) -> tuple[Floats, Floats]:
        """(k,) the parameter where each comes nearest to a place close to it, and about how near."""
        is_bent = self.height > 0
        h = np.where(is_bent, self.height, 1)
        offset = place - self.base
        along = dots(offset, self.way)
        beside = crosses(self.way, offset)
        squared = dots(self.way, self.way)
        slope = along / h
        of_bent = np.abs(beside - (along * along - h * h) / (2 * h)) / np.sqrt(1 + slope * slope)
        t = np.where(is_bent, along, along / squared)
        miss = np.where(is_bent, of_bent, np.abs(beside) / np.sqrt(squared))
        is_round = np.flatnonzero(self.round > 0)
        size = norms(offset[is_round])
        ahead = size + along[is_round]
        t[is_round] = np.where(ahead > 0, beside[is_round] / np.where(ahead > 0, ahead, 1), np.inf)
        miss[is_round] = np.abs(size - self.round[is_round])
        return t, miss


class CutEdges:
    """Segments between regions, as straight lines on the lattice."""

    def __init__(
        self,
        points: Floats,  # (n, 2): their ends there
        places: Floats,  # (n, 2): in input units
        given: Floats,  # (n, 2): the same, as the input has them: see `_as_given`
        ends: Indices,  # (m, 2): source and target, numbers of points
        regions: Indices,  # (m, 2): left and right, two different ones; `NO_REGION` where nothing is shared out
        is_enclosure: NDArray[np.bool_],  # (m,) whether an enclosure runs along it
        scale: float | None = None,  # the step of the lattice, where places are given in input units, and not on it
    ) -> None:
        self.points, self.places, self.given = points, places, given
        self.ends, self.regions, self.is_enclosure = ends, regions, is_enclosure
        self.lines = points[ends]  # (m, 2, 2)
        way = self.lines[:, 1] - self.lines[:, 0]
        self.length = norms(way)
        self.forward = way / np.where(self.length > 0, self.length, 1)[:, None]  # beyond all borders both ends are one
        self.normal = np.stack([-self.forward[:, 1], self.forward[:, 0]], axis=1)
        # what coordinates are rounded by: of a side of a frame the one that it is at tells
        off = np.maximum(SLACK, ROUNDING * np.abs(points))
        if scale is not None:
            with np.errstate(over="ignore"):
                off = np.maximum(off, np.minimum(ROUNDING_GIVEN * np.abs(places) / scale, np.abs(points)))
        same = way == 0
        across = np.where(same, off[ends[:, 0]], np.inf).min(axis=1)
        # (m,) that places may miss edges by
        self.slack = np.where(same.any(axis=1), across, off[ends].max(axis=(1, 2)))
        self.end_slack = off.max(axis=1)[ends]  # (m, 2) and their ends

    def along(self, edge: Indices, places: Floats) -> Floats:
        """(k,) how far along edges places are."""
        return dots(self.forward[edge], places - self.lines[edge, 0])

    def beside(self, edge: Indices, places: Floats) -> Floats:
        """(k,) how far from the lines of edges."""
        return np.abs(dots(self.normal[edge], places - self.lines[edge, 0]))

    def place(self, ends: Floats, edge: Indices, far: Floats) -> Floats:
        """(k, 2) places along edges with such ends (m, 2, 2); between ends of one coordinate they have that too."""
        a, b = ends[edge].swapaxes(0, 1)
        part = (far / self.length[edge])[:, None]
        return np.where(part < 1 / 2, a + part * (b - a), b - (1 - part) * (b - a))

    def at_ends(self, edge: Indices, far: Floats) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Whether what is so far along edges is at their sources, or before, and at their targets, or beyond."""
        slack = self.end_slack[edge].T
        return far <= slack[0], far >= self.length[edge] - slack[1]


def controls_of(borders: Borders, graph: PlanarGraph) -> Floats:
    """(b, 2) control points of the Bezier curves that the pieces of borders are, on the lattice; NaN of lines."""
    core = _core.kernel.PlanarGraph(graph.points, graph.segments, graph.segment_faces)
    return _core.voronoi.control_points(core, borders.ends, borders.elements, borders.places, borders.radius, 1, None)


def cut_curves(borders: Borders, graph: PlanarGraph, pieces: Indices) -> CutCurves:
    """Give the curves that some pieces of borders are on."""
    elements, ends = borders.elements[pieces], borders.ends[pieces]
    count = len(graph.points)
    places = np.concatenate([borders.places, [[0.0, 0.0]]])  # of -1, at infinity, none
    a, b = places[ends[:, 0]], places[ends[:, 1]]
    size = np.where(ends.T < 0, np.inf, np.abs(np.stack([a, b])).max(axis=2))
    is_near_first = size[0] <= size[1]
    base, way = np.where(is_near_first[:, None], a, b), b - a
    first = np.where(is_near_first, 0.0, -1.0)
    last = first + 1
    corners = graph.points.astype(np.float64)
    of = [_ends(graph, element) for element in elements.T]
    knows = ((elements < count).any(axis=1)) & _are_apart(elements, graph) & np.isnan(borders.center[pieces, 0])
    chosen = np.flatnonzero((size.max(axis=0) > FAR) & knows)
    (la, lb), (ra, rb) = ((corners[one[chosen]], corners[other[chosen]]) for one, other in of)
    across = la + lb - ra - rb
    straight = np.stack([across[:, 1], -across[:, 0]], axis=1)
    left_is_point, right_is_point = (elements[chosen] < count).T
    p, q = np.where(left_is_point[:, None], la, ra), np.where(right_is_point[:, None], ra, la)
    middle = (p + q) / 2
    base[chosen], way[chosen] = middle, straight
    squared = dots(straight, straight)
    for end, place, where, infinite in ((0, a, first, -np.inf), (1, b, last, np.inf)):
        t = dots(place[chosen] - middle, straight) / squared
        where[chosen] = np.where(ends[chosen, end] < 0, infinite, t)
    height, radius = np.zeros((2, len(pieces)))
    _take_parabolas(borders, graph, pieces, (base, way, height, first, last))
    _take_circles(borders, pieces, (base, way, radius, first, last))
    return CutCurves(base, way, height, radius, first, last, *_measured_from(graph, elements))


def _take_parabolas(borders: Borders, graph: PlanarGraph, pieces: Indices, curves: tuple[Floats, ...]) -> None:
    """Write the parabolas among pieces into arrays of base, way, height, first and last."""
    base, way, height, first, last = curves
    count = len(graph.points)
    point, segment = np.sort(borders.elements[pieces], axis=1).T
    mixed = np.flatnonzero((point < count) & (segment >= count))
    if not mixed.size:
        return
    focus, a, b = (graph.points[at].astype(np.int64) for at in (point[mixed], *_ends(graph, segment[mixed])))
    along, offset = b - a, focus - a
    double = crosses(along, offset)
    above = double != 0
    chosen, focus = mixed[above], focus[above].astype(np.float64)
    along = np.where(double[:, None] < 0, -along, along)[above].astype(np.float64)
    length = norms(along)
    along, high = along / length[:, None], np.abs(double[above]).astype(np.float64) / length
    base[chosen], way[chosen], height[chosen] = focus, along, high
    for end, where in zip(borders.ends[pieces[chosen]].T, (first, last), strict=True):
        place, radius = borders.places[end], borders.radius[end]
        t = dots(along, place - focus)
        # on the steep sides of a sharp parabola the radius tells more than the place
        is_steep = high * radius < np.abs(t) * np.abs(place).sum(axis=1)
        where[chosen] = np.where(is_steep, np.copysign(np.sqrt(np.maximum(high * (2 * radius - high), 0)), t), t)


def _take_circles(borders: Borders, pieces: Indices, curves: tuple[Floats, ...]) -> None:
    """Write the circles among pieces, counter-clockwise, into arrays of base, way, radius, first and last."""
    base, way, radius, first, last = curves
    chosen = np.flatnonzero(~np.isnan(borders.center[pieces, 0]))
    if not chosen.size:
        return
    center = borders.center[pieces[chosen]]
    a, b = (borders.places[end] - center for end in borders.ends[pieces[chosen]].T)
    chord = b - a
    is_short = (dots(a, b) > 0)[:, None]
    middle = np.where(is_short, a + b, np.stack([chord[:, 1], -chord[:, 0]], axis=1))
    middle /= norms(middle)[:, None]
    size = norms(a)
    base[chosen], way[chosen], radius[chosen] = center, middle, size
    for place, where in ((a, first), (b, last)):
        beside = crosses(middle, place)
        where[chosen] = beside / (size + dots(middle, place))


def _ends(graph: PlanarGraph, element: Indices) -> tuple[Indices, Indices]:
    """Points at the ends of elements, of a point itself twice."""
    count = len(graph.points)
    segment = np.maximum(element - count, 0)
    ends = graph.segments[segment] if len(graph) else np.zeros((len(element), 2), dtype=np.int64)
    point = np.minimum(element, max(count - 1, 0))
    is_point = element < count
    return np.where(is_point, point, ends[:, 0]), np.where(is_point, point, ends[:, 1])


def _are_apart(elements: Indices, graph: PlanarGraph) -> NDArray[np.bool_]:
    """Whether two elements have a straight bisector that they tell: two points, or a segment and its end."""
    count = len(graph.points)
    low, high = np.sort(elements, axis=1).T
    first, second = _ends(graph, high)
    return (high < count) | ((low < count) & ((first == low) | (second == low)))


def _measured_from(graph: PlanarGraph, elements: Indices) -> tuple[Floats, Floats]:
    """Points to measure distances from, the left one of two; else the line along the left segment; nothing of walls."""
    left, right = elements.T
    count = len(graph.points)
    at = np.where(left < count, left, right)
    is_point = at < count
    points = graph.points.astype(np.float64)
    origin = np.full((len(elements), 2), np.nan)
    origin[is_point] = points[at[is_point]]
    line = np.zeros((len(elements), 3))
    apart = np.flatnonzero(~is_point & (left != right))
    one, other = _ends(graph, left[apart])
    way = points[other] - points[one]
    normal = np.stack([-way[:, 1], way[:, 0]], axis=1) / norms(way)[:, None]
    line[apart] = np.column_stack([normal, dots(normal, points[one])])
    return origin, line
