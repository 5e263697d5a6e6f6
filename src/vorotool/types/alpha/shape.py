"""Alpha shapes of points, and alpha hulls."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import owners, starts_of, within
from vorotool.numeric.curves.inverse_functions import PI, cosine_and_sine, hypotenuse, inverse_sine
from vorotool.numeric.numbers import nearest_double
from vorotool.products.formats import resolved
from vorotool.types import fields as f
from vorotool.types.alpha.complex import CLASSES, AlphaComplex
from vorotool.types.alpha.radii import OfFamily, Radius
from vorotool.types.features import Mixture, Rows, of_points
from vorotool.types.fields import record
from vorotool.types.polygons.polygon_set import HOLE, SHELL, PolygonSet, set_of_rings
from vorotool.types.table import Lookup, Table
from vorotool.types.values import Geometric, Pictured, Tabular, Value, WithParts, counted

if TYPE_CHECKING:
    from vorotool.types.features import Mixture, Rows

POINT_CLASSES = ("isolated", "singular", "boundary", "interior")
"""Classes of points in a shape: on no edge of it, on edges without a triangle only, on the boundary, inside."""


@record
class AlphaShape(Value, OfFamily, Tabular, WithParts, Pictured):
    """Alpha shape of points for one radius r (the paper's α is -1/r).

    Parameters
    ----------
    family : AlphaComplex
        The shapes of all radii.
    r : float or Fraction
        The radius.
    edge_index : (k,) int32 array
        Edges of the family that are singular or boundary, increasing.
    kind : (k,) uint8 array
        Indices of their classes in `CLASSES`.
    region : (t,) int32 array
        Region of each triangle of the mesh, from 0; -1 for triangles outside the shape.
    polygons : PolygonSet
        One polygon per region, in their order, with ids from 1: a counter-clockwise shell and clockwise holes, each
        ring without repeated vertices. Regions, and rings of one region, may touch at points.
    cavity_count : int
        Bounded components of the complement; one enclosed by several regions is not a hole of any polygon.
    has_thresholds : bool
        Whether small holes were filled or small regions left out.

    Examples
    --------
    >>> from vorotool import alpha_shape
    >>> shape = alpha_shape([[0, 0], [4, 0], [0, 3], [9, 9]], r=2.5)
    >>> shape.edges.tolist(), shape.classes.tolist(), shape.isolated.tolist()
    ([[1, 2], [0, 2], [0, 1]], ['boundary', 'boundary', 'boundary'], [3])
    >>> shape.area, shape.perimeter, shape.polygons.ring(0).tolist()
    (6.0, 12.0, [[4.0, 0.0], [0.0, 3.0], [0.0, 0.0]])
    """

    maker = "alpha_shape"

    family: AlphaComplex = f.nested()
    r: Radius = f.length()
    edge_index: NDArray[np.int32] = f.index("edges")
    kind: NDArray[np.uint8] = f.numbers(np.uint8, "edges")
    region: NDArray[np.int32] = f.index("triangles")
    polygons: PolygonSet = f.nested()
    cavity_count: int
    has_thresholds: bool = False

    @property
    def edges(self) -> NDArray[np.int32]:
        """(k, 2) ends of the singular and boundary edges."""
        return self.family.edges[self.edge_index]

    @property
    def classes(self) -> NDArray[np.str_]:
        """(k,) class of each of these edges."""
        return np.array(CLASSES)[self.kind]

    @property
    def region_count(self) -> int:
        """Number of regions: triangles joined through edges."""
        return len(self.polygons)

    @property
    def area(self) -> float:
        """Area of the shape."""
        return float(self.region_areas.sum())

    @property
    def perimeter(self) -> float:
        """Length of the boundary edges."""
        return float(self.family.lengths[self.edge_index[self.kind == CLASSES.index("boundary")]].sum())

    @cached_property
    def region_areas(self) -> NDArray[np.float64]:
        """(regions,) areas."""
        inside = self.inside
        areas = self.family.mesh.areas[inside]
        return np.bincount(self.region[inside], areas, self.region_count).astype(np.float64)

    @cached_property
    def edge_classes(self) -> NDArray[np.uint8]:
        """Return the (e,) indices of the classes of all edges of the family in `CLASSES`."""
        classes = np.zeros(len(self.family), dtype=np.uint8)
        sides = self.family.sides
        both = np.append(self.inside, False)[sides].all(axis=1)  # side -1 is none
        classes[both] = CLASSES.index("interior")
        classes[self.edge_index] = self.kind
        return classes

    @cached_property
    def point_classes(self) -> NDArray[np.uint8]:
        """Return the (n,) indices of the classes of the points in `POINT_CLASSES`; duplicates share one."""
        found = np.zeros(len(self.points), dtype=np.uint8)
        mesh = self.family.mesh
        found[mesh.triangles[self.inside].reshape(-1)] = POINT_CLASSES.index("interior")
        for name in ("singular", "boundary"):  # a point on both bounds the shape
            ends = self.edges[self.kind == CLASSES.index(name)].reshape(-1)
            if name == "singular":
                ends = ends[found[ends] == 0]
            found[ends] = POINT_CLASSES.index(name)
        return found[mesh.first]

    @cached_property
    def point_regions(self) -> NDArray[np.int32]:
        """Return the (n,) first region of which each point is a vertex, from 0; -1 if there is none."""
        mesh, none = self.family.mesh, np.iinfo(np.int32).max
        found = np.full(len(self.points), none, dtype=np.int32)
        inside = self.inside
        np.minimum.at(found, mesh.triangles[inside], self.region[inside][:, None])
        found[found == none] = -1
        return found[mesh.first]

    @property
    def isolated(self) -> NDArray[np.int32]:
        """Return the 0-based points on no edge of the shape, without duplicates."""
        mesh = self.family.mesh
        is_first = mesh.first == np.arange(len(mesh.first))
        return np.flatnonzero((self.point_classes == 0) & is_first).astype(np.int32)

    @property
    def hole_count(self) -> int:
        """Number of holes of all polygons."""
        return int((self.polygons.ring_kind == HOLE).sum())

    @cached_property
    def holes_of_regions(self) -> NDArray[np.int64]:
        """(regions,) number of holes of each polygon."""
        holes = self.polygons.ring_polygon[self.polygons.ring_kind == HOLE]
        return np.bincount(holes, minlength=self.region_count)

    def _rows(self, what: str | None = None) -> Rows:
        return resolved("types.alpha.tables:shape_rows")(self, what)

    def _features(self, what: str | None = None, _flatten: float | None = None) -> Rows | Mixture:
        return resolved("types.alpha.tables:shape_features")(self, what)

    def _matrix(self, what: str) -> NDArray[np.int32]:
        return self.family.edges[np.flatnonzero(self.edge_classes)] if what == "complex" else self.edges

    def _summary(self) -> str:
        sizes = (counted(len(self.points), "point"), counted(self.region_count, "region"))
        return f"r = {nearest_double(self.r):.6g}, {', '.join(sizes)}, {counted(len(self.edge_index), 'edge')}"


FINENESS = 7.529816085545908e-05
"""Of the radius: how far the chords of flattened hulls may be from their arcs: 1 - cos(π/256), 256 to a circle."""


@record
class AlphaHull(Value, Tabular, Geometric, Pictured):
    """Alpha hull: the complement of all open discs of radius r that contain no point.

    Arcs run clockwise around their centers, with the hull on their left. The arcs of each ring are consecutive: each
    begins where another one ends.

    Parameters
    ----------
    shape : AlphaShape
        The shape of the same radius.
    start, end, center : (k, 2) float64 array
        Ends of the arcs, and centers of their circles, in input units.
    edge : (k,) int32 array
        The boundary edge of the family that each arc belongs to.
    ring_starts : (q + 1,) int64 array
        The first arc of each ring, and k.
    points : (p,) int32 array
        Isolated points of the hull: those neither on an arc nor inside.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.3; Edelsbrunner, Kirkpatrick and Seidel 1983.
    """

    shape: AlphaShape = f.nested()
    start: NDArray[np.float64] = f.position("arcs", 2)
    end: NDArray[np.float64] = f.position("arcs", 2)
    center: NDArray[np.float64] = f.position("arcs", 2)
    edge: NDArray[np.int32] = f.index("arcs")
    ring_starts: NDArray[np.int64] = f.starts("rings", "arcs", least=1)
    points: NDArray[np.int32] = f.index("points")

    def __len__(self) -> int:
        return len(self.start)

    @property
    def r(self) -> float:
        """Radius of all arcs."""
        return float(self.shape.r)

    @cached_property
    def angles(self) -> NDArray[np.float64]:
        """(k,) angle of each arc at its center, in radians: at most π, since an arc is less than half a circle."""
        return 2 * inverse_sine(hypotenuse(*(self.end - self.start).T) / 2 / self.r)

    @property
    def perimeter(self) -> float:
        """Length of all arcs."""
        return float(self.angles.sum() * self.r)

    def flattened(self, tolerance: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Return the rings as polygons, with chords within a tolerance of the arcs.

        Returns
        -------
        xy : (n, 2) float64 array
            Vertices of all rings, each once.
        ring_starts : (q + 1,) int64 array
            The first vertex of each ring, and n.
        """
        if not len(self):  # of an image without foreground the radius is infinite
            return np.empty((0, 2)), np.zeros(1, np.int64)
        # A chord over an angle a is off by r (1 - cos(a / 2)), which is 2 r times the square of sin(a / 4).
        widest = 4 * float(inverse_sine(sqrt(tolerance / self.r / 2))) or PI / 512
        counts = np.maximum(np.ceil(self.angles / widest), 1).astype(np.int64)
        arc, step = owners(counts), within(counts)
        turned = self.angles[arc] * (step / counts[arc])
        offset = self.start[arc] - self.center[arc]
        cosine, sine = cosine_and_sine(turned)
        x = offset[:, 0] * cosine + offset[:, 1] * sine
        y = offset[:, 1] * cosine - offset[:, 0] * sine
        xy = np.where((step == 0)[:, None], self.start[arc], self.center[arc] + np.stack([x, y], axis=1))
        return xy, starts_of(counts)[self.ring_starts]

    def polygons(self) -> list[list[NDArray[np.float64]]]:
        """Return the flattened rings of each polygon: the counter-clockwise shell, then its clockwise holes."""
        import shapely

        xy, starts = self.flattened(self.r * FINENESS)
        exponent = int(np.frexp(np.abs(xy).max(initial=0.0))[1])
        near_one = np.ldexp(xy, -exponent)  # of any magnitude areas are floating-point numbers then
        spans = [slice(a, b) for a, b in zip(starts[:-1].tolist(), starts[1:].tolist(), strict=True)]
        rings, small = [xy[span] for span in spans], [near_one[span] for span in spans]
        areas = np.array([_signed_area(ring) for ring in small])
        shells = sorted(np.flatnonzero(areas > 0).tolist(), key=lambda k: (areas[k], k))
        polygons = {k: [rings[k]] for k in shells}
        for k in np.flatnonzero(areas < 0).tolist():
            middle = shapely.Polygon(small[k]).representative_point()
            for shell in shells:
                if areas[shell] > -areas[k] and shapely.contains(shapely.Polygon(small[shell]), middle):
                    polygons[shell].append(rings[k])
                    break
        return [polygons[k] for k in sorted(polygons)]

    def table(self) -> Table:
        """Return a table of the arcs: ``x0, y0, x1, y1, cx, cy, r, label_a, label_b, ring``.

        The labels are those of the points on the circle of the arc; rings count from 1.
        """
        family = self.shape.family
        labels = family.mesh.label_array
        ends = family.edges[self.edge]
        rings = owners(np.diff(self.ring_starts)) + 1
        ends_of_arcs = {"0": self.start, "1": self.end}
        return Table(
            {
                **{f"{axis}{end}": places[:, k] for end, places in ends_of_arcs.items() for k, axis in enumerate("xy")},
                "cx": self.center[:, 0],
                "cy": self.center[:, 1],
                "r": np.full(len(self), self.r),
                "label_a": Lookup(labels, np.ascontiguousarray(ends[:, 0])),
                "label_b": Lookup(labels, np.ascontiguousarray(ends[:, 1])),
                "ring": rings,
            }
        )

    def _rows(self, _what: str | None = None) -> Rows:
        return Rows(self.table())

    def _features(self, _what: str | None = None, _flatten: float | None = None) -> Mixture:
        mesh, polygons = self.shape.family.mesh, self.polygons()
        counts = np.array([len(rings) for rings in polygons], dtype=np.int64)
        rings = [ring for each in polygons for ring in each]
        kinds = np.where(within(counts) == 0, SHELL, HOLE)
        xy = np.concatenate([np.empty((0, 2)), *rings])
        shapes = set_of_rings(xy, [len(ring) for ring in rings], kinds, owners(counts))
        named = {"class": ["hull"] * len(polygons)}
        points = {"class": ["point"] * len(self.points), "label": mesh.label_array[self.points]}
        return Mixture(
            (
                Rows(named, {}, mesh, None, replace(shapes, properties=named)),
                Rows(points, {}, mesh, self.points, of_points(mesh.points[self.points])),
            )
        )

    def _summary(self) -> str:
        rings = counted(len(self.ring_starts) - 1, "ring")
        return f"r = {self.r:.6g}, {counted(len(self), 'arc')}, {rings}"


def _signed_area(ring: NDArray[np.float64]) -> float:
    x, y = (ring - ring[0]).T
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum()) / 2
