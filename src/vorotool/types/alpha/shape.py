"""One alpha shape of points: edges, regions, polygons."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.numbers import nearest_double
from vorotool.products.formats import resolved
from vorotool.types import fields as f
from vorotool.types.alpha.complex import CLASSES, AlphaComplex, Radius
from vorotool.types.fields import record
from vorotool.types.polygons.polygon_set import HOLE, PolygonSet
from vorotool.types.values import Pictured, Tabular, Value, WithParts, counted, placed

if TYPE_CHECKING:
    from vorotool.types.features import Mixture, Rows

POINT_CLASSES = ("isolated", "singular", "boundary", "interior")
"""Classes of points in a shape: on no edge of it, on edges without a triangle only, on the boundary, inside."""


@record
class AlphaShape(Value, Tabular, WithParts, Pictured):
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
    def alpha(self) -> float:
        """The paper's parameter, -1/r."""
        return -nearest_double(1 / self.r)

    @property
    def points(self) -> NDArray[np.float64]:
        """(n, 2) coordinates, in the order of the input."""
        return self.family.points

    @property
    def edges(self) -> NDArray[np.int32]:
        """(k, 2) ends of the singular and boundary edges."""
        return self.family.edges[self.edge_index]

    @property
    def classes(self) -> NDArray[np.str_]:
        """(k,) class of each of these edges."""
        return np.array(CLASSES)[self.kind]

    @property
    def inside(self) -> NDArray[np.bool_]:
        """(t,) whether each triangle is in the shape."""
        return np.greater_equal(self.region, 0)

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
        rows: Rows = resolved("types.alpha.tables:shape_rows")(self, what)
        return rows

    def _features(self, what: str | None = None, _flatten: float | None = None) -> Rows | Mixture:
        features: Rows | Mixture = resolved("types.alpha.tables:shape_features")(self, what)
        return features

    def _matrix(self, what: str) -> NDArray[np.int32]:
        return self.family.edges[np.flatnonzero(self.edge_classes)] if what == "complex" else self.edges

    def _summary(self) -> str:
        sizes = (counted(len(self.points), "point"), counted(self.region_count, "region"))
        text = f"r = {nearest_double(self.r):.6g}, {', '.join(sizes)}, {counted(len(self.edge_index), 'edge')}"
        return placed(text, self.family.mesh.crs)
