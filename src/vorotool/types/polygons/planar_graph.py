"""The planar straight-line graph of polygons and lines on an integer lattice."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vorotool import _core
from vorotool.errors import InputError
from vorotool.numeric.arrays import Floats, crosses, dots, owners
from vorotool.types import fields as f
from vorotool.types.features import Corners, Rows
from vorotool.types.fields import record
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.segment_voronoi import ends_of_sites
from vorotool.types.values import Geometric, Graph, Pictured, Tabular, Value, counted

if TYPE_CHECKING:
    from vorotool.types.skeleton.skeleton import Skeleton

REPAIRS = (
    "repeated_vertices",
    "touching_vertices",
    "crossings",
    "moved_edges",
    "idle_segments",
    "empty_polygons",
)
"""Names of the counts, in the order of the core: see `PlanarGraph.repairs`."""

_FAR = 2.0**30
"""Beyond all points of a lattice."""


@record
class PlanarGraph(Value, Tabular, Geometric, Graph, Pictured):
    """Distinct lattice points, and segments between them that meet at common ends only.

    Lattice point (i, j) stands for ``origin + scale * (i, j)``, where ``scale`` is a power of two; ``|i|`` and
    ``|j|`` are below 2^30. Segments and points are in the order of the input edges and vertices; crossings follow
    the vertices.

    A face is a connected region between the segments. It lies in a polygon if it is inside the shell and in none of the
    holes, each ring by the even-odd rule: twice covered by one ring is outside, a hole reaches nowhere beyond its
    shell, and where holes overlap is a hole. Polygons may overlap: a face then lies in several of them. A hole whose
    vertices are at one or two places is a point or a segment that its polygon lies around.

    Parameters
    ----------
    points : (n, 2) int32 array
        Lattice points, all different; every one is a site of the segment Voronoi diagram.
    segments : (m, 2) int32 array
        Ends of each segment, directed as the first edge that it is part of.
    point_vertex : (n,) int32 array
        The first vertex of the input at each point; -1 for a crossing of edges.
    source_starts : (m + 1,) int32 array
        Where the edges of each segment begin in `source_edge`.
    source_edge : (k,) int32 array
        The edges of the input that a segment is part of, ascending. Edge k goes from vertex k of the input to the next
        one of its ring.
    segment_faces : (m, 2) int32 array
        The faces left and right of each segment (as seen along it, y upwards). Face 0 is the unbounded one.
    face_starts : (f + 1,) int32 array
        Where the polygons of each face begin in `face_polygon`.
    face_polygon : (l,) int32 array
        The polygons that each face lies in, ascending.
    origin : tuple of float
        The place of lattice point (0, 0).
    scale : float
        The step of the lattice in input units, a power of two.
    largest_move : float
        By how much a vertex or a point of an edge was moved at most, in input units, rounded up: 0 if nothing was.
    repairs : dict of str to int
        ``repeated_vertices``: edges without length, left out. ``touching_vertices``: a vertex inside an edge cuts it.
        ``crossings``: places where edges cross, each now a point of the graph. ``moved_edges``: edges that are led
        through neighboring lattice points, by less than a step, since a crossing is on no lattice point.
        ``idle_segments``: parts of edges that bound nothing, such as spikes, left out. ``empty_polygons``: polygons
        without any inside.
    polygons : PolygonSet, optional
        The input.
    vertices : (v, 2) int32 array, optional
        Where the vertices of the input are on the lattice.
    point_holes : (h, 3) int32 array, optional
        Holes of one place where no segment ends: the point, the face that it is in, and the polygon.

    Raises
    ------
    InputError
        If an array has another shape.

    Examples
    --------
    >>> square = PlanarGraph([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1], [1, 2], [2, 3], [3, 0]], [0, 1, 2, 3],
    ...     [0, 1, 2, 3, 4], [0, 1, 2, 3], [[1, 0]] * 4, [0, 0, 1], [0], origin=(10.0, 20.0), scale=0.5)
    >>> square.coordinates().tolist()
    [[10.0, 20.0], [10.5, 20.0], [10.5, 20.5], [10.0, 20.5]]
    >>> square.faces, square.is_inside.tolist()
    (2, [False, True])
    """

    maker = "planar_graph"

    points: NDArray[np.int32] = f.index("points", 2)
    segments: NDArray[np.int32] = f.index("segments", 2)
    point_vertex: NDArray[np.int32] = f.index("points")
    source_starts: NDArray[np.int32] = f.index("sources")
    source_edge: NDArray[np.int32] = f.index("edges")
    segment_faces: NDArray[np.int32] = f.index("segments", 2)
    face_starts: NDArray[np.int32] = f.index("faces")
    face_polygon: NDArray[np.int32] = f.index("polygons")
    origin: tuple[float, float] = (0.0, 0.0)
    scale: float = 1.0
    largest_move: float = 0.0
    repairs: dict[str, int] = field(default_factory=lambda: dict.fromkeys(REPAIRS, 0))
    polygons: PolygonSet | None = None
    vertices: NDArray[np.int32] | None = None
    point_holes: NDArray[np.int32] = field(default_factory=lambda: np.empty((0, 3), dtype=np.int32))

    def __post_init__(self) -> None:
        super().__post_init__()
        if len(self.source_starts) - 1 != len(self.segments):
            raise InputError("source_starts must have one more entry than the segments")

    def __len__(self) -> int:
        return len(self.segments)

    @property
    def faces(self) -> int:
        """Number of faces, the unbounded one included."""
        return len(self.face_starts) - 1

    @property
    def is_inside(self) -> NDArray[np.bool_]:
        """(f,) whether each face lies in any polygon."""
        return np.diff(self.face_starts) > 0

    @property
    def source_count(self) -> NDArray[np.int32]:
        """(m,) number of input edges that each segment is part of."""
        return np.diff(self.source_starts)

    def polygons_of(self, face: int) -> NDArray[np.int32]:
        """Polygons that a face lies in, ascending."""
        return self.face_polygon[self.face_starts[face] : self.face_starts[face + 1]]

    def sources_of(self, segment: int) -> NDArray[np.int32]:
        """Input edges that a segment is part of, ascending."""
        return self.source_edge[self.source_starts[segment] : self.source_starts[segment + 1]]

    def coordinates(self, points: ArrayLike | None = None) -> NDArray[np.float64]:
        """Input coordinates of lattice points, by default of all points of the graph; each rounded once.

        Parameters
        ----------
        points : (..., 2) array-like, optional
            Lattice coordinates, which need not be whole.
        """
        lattice = np.asarray(self.points if points is None else points, dtype=np.float64)
        return off_lattice(lattice, self.origin, self.scale)

    @cached_property
    def coordinates_as_given(self) -> NDArray[np.float64]:
        """(n, 2) for each point the coordinates of the first vertex of the input there, else of the lattice."""
        places = self.coordinates()
        if self.polygons is not None and self.largest_move:
            known = np.flatnonzero(self.point_vertex >= 0)
            places[known] = self.polygons.xy[self.point_vertex[known]]
        return places

    def places_as_given(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, 2) input coordinates of places on the lattice; of those that are points, `coordinates_as_given`."""
        made = self.coordinates(places)
        if not self.largest_move:
            return made
        x, y = places.T
        whole = np.flatnonzero((np.abs(x) < _FAR) & (np.abs(y) < _FAR) & (x == np.rint(x)) & (y == np.rint(y)))
        point = self.points_at(places[whole])
        made[whole[point >= 0]] = self.coordinates_as_given[point[point >= 0]]
        return made

    def points_at(self, places: NDArray[Any]) -> NDArray[np.int64]:
        """(k,) the point at each place of the lattice; -1 where there is none."""
        if not len(places):
            return np.empty(0, dtype=np.int64)
        count, both = len(self.points), np.concatenate([self.points, places.astype(np.int32)])
        first = _core.arrangement.first_at_place(both, None)[count:].astype(np.int64)
        return np.where(first < count, first, -1)

    def _features(self, _what: str | None = None, _flatten: float | None = None) -> Rows:
        (a, b), (left, right) = np.ascontiguousarray(self.segments.T), np.ascontiguousarray(self.segment_faces.T)
        columns = {"point_a": a, "point_b": b, "face_left": left, "face_right": right}
        return Rows(columns, {}, self.polygons, None, Corners(self.coordinates(), self.segments))

    def _summary(self) -> str:
        sizes = (counted(len(self.points), "point"), counted(len(self), "segment"), counted(self.faces, "face"))
        return ", ".join(sizes)


def off_lattice(places: Floats, origin: tuple[float, float], scale: float) -> Floats:
    """(..., 2) coordinates of places on a lattice, each rounded once."""
    made = scale * places
    for axis, start in enumerate(origin):  # NumPy goes down a column much faster than over many short rows
        made[..., axis] += start
    return made


def packed(places: NDArray[Any]) -> NDArray[np.int64]:
    """One number for each place of the lattice."""
    x, y = places.astype(np.int64).T
    return x * 2**32 + y


def places_as_given(
    places: Floats,
    polygon: NDArray[np.integer],
    polygons: PolygonSet,
    *,
    together: bool,
    back: bool = False,
    others: tuple[NDArray[np.integer], Floats, Floats] | None = None,
) -> Floats:
    """Move places at vertices that an engine has moved to where these were given, of several the first, or back."""
    given = polygons.as_given
    if given is polygons or not len(places):
        return places
    here, there = (given.xy, polygons.xy) if back else (polygons.xy, given.xy)
    own = polygons.ring_polygon[owners(np.diff(polygons.ring_starts))]
    if others is not None:
        own, here, there = (np.concatenate(pair) for pair in zip((own, here, there), others, strict=True))
    group = np.zeros(len(polygons), dtype=np.int64) if together else np.asarray(polygons.feature, dtype=np.int64)
    x, y = np.concatenate([here, places]).T
    keys = np.concatenate([group[own], group[polygon]]), x, y
    order = np.lexsort(keys)  # stable: of equal places the first comes first
    is_new = np.ones(len(order), dtype=bool)
    is_new[1:] = np.any([key[order[1:]] != key[order[:-1]] for key in keys], axis=0)
    vertex = np.empty_like(order)
    vertex[order] = order[is_new][np.cumsum(is_new) - 1]
    vertex = vertex[len(here) :]
    made = places.copy()
    known = np.flatnonzero(vertex < len(here))
    made[known] = there[vertex[known]]
    return made


def moved_feet(skeleton: Skeleton, site: NDArray[np.integer], feet: Floats, *, back: bool = False) -> Floats:
    """Move feet to the vertices and edges that they are on, where these were given, or back."""
    polygons = skeleton.polygons
    if polygons.as_given is polygons:
        return feet
    here, there = skeleton.site_ends[site], ends_of_sites(polygons.as_given, skeleton.site_table, site)
    if back:
        here, there = there, here
    way = here[..., 1, :] - here[..., 0, :]
    square = dots(way, way)
    t = np.divide(dots(feet - here[..., 0, :], way), square, out=np.zeros(site.shape), where=square > 0)
    together = skeleton.features == "together"
    polygon = skeleton.site_table.polygon[site].reshape(-1)
    moved = places_as_given(feet.reshape(-1, 2), polygon, polygons, together=together, back=back)
    moved = moved.reshape(-1, 2, 2).copy()
    is_inner = (t > 0) & (t < 1)
    moved[is_inner] = projected(there[is_inner], feet[is_inner])
    return moved


def projected(edge: Floats, place: Floats) -> Floats:
    """Return the nearest place on each edge, which is an end of it exactly where nothing nearer is inside."""
    a, b = edge[:, 0], edge[:, 1]
    way, from_a = b - a, place - a
    square = dots(way, way)
    off = (crosses(way, from_a)) / square
    near = place - off[:, None] * np.stack([-way[:, 1], way[:, 0]], axis=1)
    near = np.where(way == 0, a, near)
    t = (dots(from_a, way) / square)[:, None]
    return np.asarray(np.where(t <= 0, a, np.where(t >= 1, b, near)))
