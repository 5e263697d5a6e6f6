"""Borders cut by a frame: what lies in it, and where it leaves."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.voronoi.borders import Borders
from vorotool.engines.voronoi.curves import INFINITY, CircularArc, controls_of, parabolas_of
from vorotool.engines.voronoi.moves import Moves
from vorotool.plain import plain
from vorotool.types.box import Extent
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.voronoi.voronoi_map import OUTSIDE

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Place = tuple[float, float]

SIDES = 4
"""Of a frame, counter-clockwise: least y, most x, most y, least x."""

_WITHIN, _OFF, _CROSSING = range(3)

_AT_ONCE = 2**18
"""Pieces that are looked at together, so that what is only compared takes little memory."""

TOUCH = 2.0**-48
"""Of the coordinates, by which a parabola may miss a side of the frame and still be taken to touch it."""


@plain(eq=False)
class CutBorders:
    """Pieces of borders in a frame."""

    piece: Indices  # (c,) int64 array: the piece of the borders that each is, or is a part of
    ends: Indices  # (c, 2) int64 array: source and target, numbers of `places`
    control: Floats  # (c, 2) float64 array: control points of Bezier curves, in input units; NaN of straight lines
    places: Floats  # (v, 2) float64 array: those of the borders in input units, then where they are cut
    radius: Floats  # (v,) float64 array: the distance from the sites there, in input units
    side: Indices  # (v,) int64 array: of the frame, on which a place lies; -1 inside or outside
    center: Floats  # (c, 2) float64 array: of circular arcs, in input units; NaN of others
    moves: Moves  # of places at vertices of the input


class FrameBox:
    """A frame in input units, and on the lattice."""

    def __init__(self, frame: Extent, graph: PlanarGraph) -> None:
        x, y, w, h = frame
        self.low, self.high = np.array([x, y]), np.array([x + w, y + h])
        self.origin, self.scale = np.array(graph.origin), graph.scale
        with np.errstate(over="ignore"):  # the lattice of a single place is finer than anything
            self.least, self.most = (((place - self.origin) / self.scale).tolist() for place in (self.low, self.high))

    def side_of(self, places: Floats) -> Indices:
        """(n,) the side that places in input units lie on; -1 of those strictly inside, -2 outside."""
        side = np.full(len(places), -1, dtype=np.int64)
        x, y = places.T
        for number, hit in (
            (3, x == self.low[0]),
            (2, y == self.high[1]),
            (1, x == self.high[0]),
            (0, y == self.low[1]),
        ):
            side[hit] = number
        is_out = (x < self.low[0]) | (y < self.low[1]) | (x > self.high[0]) | (y > self.high[1])
        side[is_out] = -2
        return side

    def attract(self, places: Floats, chosen: NDArray[np.bool_]) -> None:
        """Move points to the sides of the frame that rounding alone may keep off."""
        moved = places[chosen]
        for side in (self.low, self.high):
            near = np.abs(moved - side) <= TOUCH * np.abs(moved).max(axis=1, keepdims=True)
            np.copyto(moved, side, where=near)
        places[chosen] = moved

    def lattice_line(self, side: int) -> tuple[int, float]:
        """Which coordinate a side holds constant, and its value on the lattice."""
        bound = self.least if side in (0, 3) else self.most
        axis = 1 - side % 2
        return axis, bound[axis]

    def put_on(self, side: int, place: Place) -> Place:
        """A place on the lattice in input units, exactly on a side."""
        found = (np.asarray(place) * self.scale + self.origin).clip(self.low, self.high)
        axis = 1 - side % 2
        found[axis] = (self.low if side in (0, 3) else self.high)[axis]
        return float(found[0]), float(found[1])

    def holds(self, place: Place) -> bool:
        """Whether a place on the lattice is inside."""
        inside: bool = self.least[0] < place[0] < self.most[0] and self.least[1] < place[1] < self.most[1]
        return inside

    def nearest_side(self, place: Place) -> int:
        """The side that a place on the lattice is nearest to, or beyond."""
        x, y = place
        room = (y - self.least[1], self.most[0] - x, self.most[1] - y, x - self.least[0])
        return int(np.argmin(room))


def cut_borders(borders: Borders, graph: PlanarGraph, frame: Extent) -> CutBorders:
    """Cut pieces of borders where they leave a frame; what runs along it is left out."""
    box = FrameBox(frame, graph)
    places = graph.coordinates(borders.places).reshape(-1, 2)
    if np.isfinite(borders.level):
        box.attract(places, borders.radius == borders.level)
    at = np.flatnonzero(borders.radius == 0)
    given = graph.places_as_given(borders.places[at])
    on_side = box.side_of(given) >= 0  # the lattice may have them beside it
    places[at[on_side]] = given[on_side]
    side = box.side_of(places)
    control, center = graph.coordinates(controls_of(borders, graph)), graph.coordinates(borders.center)
    state = _states(borders, places, control, center, borders.level * graph.scale, box)
    kept, crossing = np.flatnonzero(state == _WITHIN), np.flatnonzero(state == _CROSSING)
    cutter = _Cutter(borders, graph, box, side, crossing)
    parts = [part for piece in crossing.tolist() for part in cutter.parts(piece)]
    return cutter.put_together(places, kept, control, center, parts, _moves(at, given, places, box))


def _moves(at: Indices, given: Floats, places: Floats, box: FrameBox) -> Moves:
    """Of places at vertices of the input; what is not in the frame both ways stays."""
    is_moved = (given != places[at]).any(axis=1) & (box.side_of(places[at]) == -1) & (box.side_of(given) == -1)
    return Moves(at[is_moved], given[is_moved])


def _states(
    borders: Borders, places: Floats, control: Floats, center: Floats, radius: float, box: FrameBox
) -> NDArray[np.int8]:
    """Whether pieces are within a box, off it, or cross it, as far as the triangles tell that they lie in."""
    state = np.empty(len(borders.ends), dtype=np.int8)
    padded = np.concatenate([places, [[np.nan, np.nan]]])  # that of -1, at infinity
    for first in range(0, len(state), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        source, target = borders.ends[some].T
        is_finite = (source >= 0) & (target >= 0)
        corners = [padded.take(source, axis=0), padded.take(target, axis=0), control[some]]
        corners[2] = np.where(np.isnan(corners[2]), corners[0], corners[2])
        low, high = _reach(corners)
        _extend_to_circles(low, high, corners, center[some], radius)
        is_within = is_finite & _all_of(low >= box.low) & _all_of(high <= box.high)
        is_off = is_finite & ~(_all_of(low < box.high) & _all_of(high > box.low))
        state[some] = np.where(is_off, _OFF, np.where(is_within, _WITHIN, _CROSSING))
    return state


def _reach(corners: list[Floats]) -> tuple[Floats, Floats]:
    """Least and most coordinates of the triangles that pieces lie in."""
    a, b, c = corners
    return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)


def _extend_to_circles(low: Floats, high: Floats, corners: list[Floats], center: Floats, radius: float) -> None:
    """Add what circular arcs, counter-clockwise and of at most half a circle, reach beyond their ends."""
    arc = np.flatnonzero(~np.isnan(center[:, 0]))
    if not arc.size:
        return
    a, b = (place[arc] - center[arc] for place in corners[:2])
    for axis, sign in ((0, -1), (1, -1), (0, 1), (1, 1)):
        after_first = a[:, 1 - axis] * (sign if axis else -sign) >= 0
        before_last = b[:, 1 - axis] * (-sign if axis else sign) >= 0
        passed = arc[after_first & before_last]
        reach = center[passed, axis] + sign * radius
        if sign < 0:
            low[passed, axis] = np.minimum(low[passed, axis], reach)
        else:
            high[passed, axis] = np.maximum(high[passed, axis], reach)


def _all_of(pairs: NDArray[np.bool_]) -> NDArray[np.bool_]:
    both: NDArray[np.bool_] = pairs[:, 0] & pairs[:, 1]
    return both


@plain
class _Part:
    """A part of a piece: its ends, and the control point on the lattice, if it is a parabola."""

    piece: int
    source: int
    target: int
    control: Place | None


@plain
class _Curve:
    """A straight line, base + t way, or a parabola by its parameter, from one t to another."""

    base: Place
    way: Place
    height: float
    first: float
    last: float

    @property
    def size(self) -> float:
        """How large its coordinates are beside those of the base."""
        return self.height

    def place(self, t: float) -> Place:
        """Where it is at t."""
        (x, y), (u, v) = self.base, self.way
        if not self.height:
            return x + t * u, y + t * v
        n = (t * t - self.height * self.height) / (2 * self.height)
        return x + t * u - n * v, y + t * v + n * u

    def meets(self, axis: int, value: float) -> list[float]:
        """Where a coordinate has a value, at up to two t."""
        if not self.height:
            return [(value - self.base[axis]) / self.way[axis]] if self.way[axis] else []
        across = (-self.way[1], self.way[0])[axis]  # of the axis of the parabola
        a, b = across / (2 * self.height), self.way[axis]
        c = self.base[axis] - across * self.height / 2 - value
        discriminant = b * b - 4 * a * c
        if discriminant < 0:
            return []
        q = -(b + float(np.copysign(np.sqrt(discriminant), b))) / 2
        if not q:  # it touches where t is 0
            return [0.0, 0.0] if a else []
        return [c / q, *([q / a] if a else [])]

    def turn(self, axis: int) -> float | None:
        """Where a coordinate is least or most along a parabola."""
        across = (-self.way[1], self.way[0])[axis]
        return -self.way[axis] * self.height / across if self.height and across else None


class _Cutter:
    """Cuts pieces one by one; there are few that leave a frame."""

    def __init__(self, borders: Borders, graph: PlanarGraph, box: FrameBox, side: Indices, pieces: Indices) -> None:
        self.borders, self.graph, self.box = borders, graph, box
        self.sides = side
        ends = borders.ends[pieces]
        self.side = dict(zip(ends.ravel().tolist(), side[ends].ravel().tolist(), strict=True)) if len(side) else {}
        self.parabolas = dict(self._parabolas(pieces))
        self.cuts: list[tuple[Place, float, int]] = []

    def parts(self, piece: int) -> Iterator[_Part]:
        """The parts of a piece in the frame, in order."""
        curve = self._curve(piece)
        own = [int(end) for end in self.borders.ends[piece]]
        cuts = self._cuts(curve, own)
        stops = [curve.first, *(t for t, _ in cuts), curve.last]
        inside = [self._is_inside(curve, a, b) for a, b in pairwise(stops)]
        for end, at in ((own[0], 0), (own[1], -1)):
            if end >= 0 and self.side[end] == -1 and not inside[at]:  # as far as doubles tell it leaves the frame there
                t = stops[at]
                where = 0 if at == 0 else len(cuts)
                cuts.insert(where, (t, self.box.nearest_side(curve.place(t))))
                stops.insert(where + 1, t)
                inside.insert(0 if at == 0 else len(inside), True)
        begin = None
        for k, is_inside in enumerate([*inside, False]):
            if is_inside and begin is None:
                begin = k
            elif not is_inside and begin is not None:
                yield self._part(piece, curve, (begin, k), stops, cuts, own)
                begin = None

    def _cuts(self, curve: _Curve | CircularArc, own: list[int]) -> list[tuple[float, int]]:
        """Parameters between the ends where a side of the frame is met, in order, and the side."""
        low, high = min(curve.first, curve.last), max(curve.first, curve.last)
        found = []
        for side in range(SIDES):
            axis, value = self.box.lattice_line(side)
            roots = curve.meets(axis, value)
            if not roots and (turn := curve.turn(axis)) is not None:
                slack = TOUCH * (abs(value) + abs(curve.base[axis]) + curve.size)
                if abs(curve.place(turn)[axis] - value) <= slack:  # it touches the frame, as far as doubles tell
                    roots = [turn, turn]
            for end, t in zip(own, (curve.first, curve.last), strict=True):
                if end >= 0 and self.side[end] == side and roots:  # that is where it meets the side
                    roots.remove(min(roots, key=lambda root: abs(root - t)))
            found += [(root, side) for root in roots if low < root < high]
        return sorted(found, reverse=curve.first > curve.last)

    def _is_inside(self, curve: _Curve | CircularArc, a: float, b: float) -> bool:
        if a == b or abs(a) == INFINITY or abs(b) == INFINITY:
            return False
        return self.box.holds(curve.place((a + b) / 2))

    def _part(
        self,
        piece: int,
        curve: _Curve | CircularArc,
        span: tuple[int, int],
        stops: list[float],
        cuts: list[tuple[float, int]],
        own: list[int],
    ) -> _Part:
        first, last = span
        ends = []
        for k, end in ((first, own[0]), (last, own[1])):
            is_own = k in (0, len(stops) - 1)
            if is_own and self.side[end] != -2:
                ends.append(end)
                continue
            place = curve.place(stops[k])
            side = self.box.nearest_side(place) if is_own else cuts[k - 1][1]
            ends.append(self._new(piece, curve, stops[k], place, side))
        control = None
        if isinstance(curve, _Curve) and curve.height:
            t0, t1 = stops[first], stops[last]
            a, b = curve.place(t0), curve.place(t1)
            below = (t1 - t0) * (t1 - t0) / (4 * curve.height)
            control = ((a[0] + b[0]) / 2 + below * curve.way[1], (a[1] + b[1]) / 2 - below * curve.way[0])
        return _Part(piece, ends[0], ends[1], control)

    def _new(self, piece: int, curve: _Curve | CircularArc, t: float, place: Place, side: int) -> int:
        """The number of a new place on a side."""
        if self.borders.sites[piece, 1] == OUTSIDE:
            radius = self.borders.level
        elif isinstance(curve, _Curve) and curve.height:
            radius = (t * t + curve.height * curve.height) / (2 * curve.height)
        else:
            radius = self._distance(int(self.borders.elements[piece, 0]), place, piece)
        self.cuts.append((self.box.put_on(side, place), radius, side))
        return len(self.borders.places) + len(self.cuts) - 1

    def _distance(self, element: int, place: Place, piece: int) -> float:
        """From an element to a place whose nearest point is on it; 0 along a wall."""
        if element == self.borders.elements[piece, 1]:
            return 0.0
        count = len(self.graph.points)
        a, b = self._ends_of(element)
        x, y = place[0] - a[0], place[1] - a[1]
        if element < count:
            return float(np.sqrt(x * x + y * y))
        u, v = b[0] - a[0], b[1] - a[1]
        return float(abs(u * y - v * x) / np.sqrt(u * u + v * v))

    def _ends_of(self, element: int) -> tuple[Place, Place]:
        count = len(self.graph.points)
        ends = [element, element] if element < count else self.graph.segments[element - count]
        (ax, ay), (bx, by) = self.graph.points[ends].tolist()
        return (float(ax), float(ay)), (float(bx), float(by))

    def _curve(self, piece: int) -> _Curve | CircularArc:
        """The curve that a piece is on."""
        borders = self.borders
        source, target = (int(end) for end in borders.ends[piece])
        if piece in self.parabolas:
            return self.parabolas[piece]
        if not np.isnan(borders.center[piece, 0]):
            places = borders.center[piece], borders.places[source], borders.places[target]
            return CircularArc.between(*((float(x), float(y)) for x, y in places))
        if source >= 0 and target >= 0:
            a, b = borders.places[source].tolist(), borders.places[target].tolist()
            way = (b[0] - a[0], b[1] - a[1])
            # from the nearer end: the rounding of a far one would move what is in the frame
            if max(map(abs, a)) <= max(map(abs, b)):
                return _Curve((a[0], a[1]), way, 0.0, 0.0, 1.0)
            return _Curve((b[0], b[1]), way, 0.0, -1.0, 0.0)
        return self._unbounded(borders.elements[piece], source, target)

    def _parabolas(self, pieces: Indices) -> Iterator[tuple[int, _Curve]]:
        """Those among some pieces."""
        borders = self.borders
        is_parabola, parabolas = parabolas_of(self.graph, borders.elements[pieces])
        bent = pieces[is_parabola]
        first, last = (
            parabolas.parameter(borders.places[end], borders.radius[end]).tolist() for end in borders.ends[bent].T
        )
        rows = zip(
            parabolas.focus.tolist(), parabolas.way.tolist(), parabolas.height.tolist(), first, last, strict=True
        )
        for piece, ((x, y), (u, v), *others) in zip(bent.tolist(), rows, strict=True):
            yield piece, _Curve((x, y), (u, v), *others)

    def _unbounded(self, pair: Indices, source: int, target: int) -> _Curve:
        """The bisector of two points, or of a segment and its end: across the way between them."""
        count = len(self.graph.points)
        (la, lb), (ra, rb) = (self._ends_of(int(element)) for element in pair)
        across = (la[0] + lb[0] - ra[0] - rb[0], la[1] + lb[1] - ra[1] - rb[1])
        way = (across[1], -across[0])
        p, q = la if pair[0] < count else ra, ra if pair[1] < count else la
        base = ((p[0] + q[0]) / 2, (p[1] + q[1]) / 2)
        squared = way[0] * way[0] + way[1] * way[1]

        def parameter(end: int) -> float:
            x, y = self.borders.places[end].tolist()
            return float(((x - base[0]) * way[0] + (y - base[1]) * way[1]) / squared)

        first = parameter(source) if source >= 0 else -INFINITY
        return _Curve(base, way, 0.0, first, parameter(target) if target >= 0 else INFINITY)

    def put_together(
        self, places: Floats, kept: Indices, control: Floats, center: Floats, parts: list[_Part], moves: Moves
    ) -> CutBorders:
        """All pieces in the frame, whole ones first."""
        of_parts = np.array([part.control or (np.nan, np.nan) for part in parts]).reshape(-1, 2)
        own = self.borders.ends.take(kept, axis=0)
        pieces = np.concatenate([kept, np.array([part.piece for part in parts], dtype=np.int64)])
        new = np.array([place for place, _, _ in self.cuts]).reshape(-1, 2)
        return CutBorders(
            pieces,
            np.concatenate(
                [own, np.array([(part.source, part.target) for part in parts], dtype=np.int64).reshape(-1, 2)]
            ),
            np.concatenate([control.take(kept, axis=0), self.graph.coordinates(of_parts)]),
            np.concatenate([places, new]),
            self.graph.scale * np.concatenate([self.borders.radius, [radius for _, radius, _ in self.cuts]]),
            np.concatenate([self.sides, np.array([side for _, _, side in self.cuts], dtype=np.int64)]),
            center.take(pieces, axis=0),
            moves,
        )
