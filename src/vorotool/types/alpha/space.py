"""Alpha shapes of points in space: the family of all radii, and one of them."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import UsageError
from vorotool.numeric.arrays import Booleans, Floats, Indices
from vorotool.numeric.numbers import nearest_double, shown_number
from vorotool.types import fields as f
from vorotool.types.alpha.complex import CLASSES
from vorotool.types.alpha.radii import OfFamily, Radius, RankedRadii, checked_radius, squared_radius_of
from vorotool.types.features import Rows
from vorotool.types.fields import record
from vorotool.types.mesh.tetrahedralization import EDGES, FACES, Tetrahedralization, scaled_norms
from vorotool.types.table import Computed, Lookup, Table
from vorotool.types.values import Tabular, Value, counted

_BLOCK = 1 << 13
"""Triangles that are measured at a time."""
SIMPLICES = ("points", "edges", "triangles", "tetrahedra")
"""What alpha shapes in space consist of, by how many corners it has."""


@record
class SpaceAlphaComplex(Value, RankedRadii, Tabular):
    """Family of alpha shapes of points in space: the radii at which simplices enter, bound and go inside.

    A simplex is in the shape for r_min ≤ r. It bounds a tetrahedron of the shape for r_mid ≤ r < r_max, and is singular
    below r_mid. A tetrahedron has its circumradius three times. r_min of a triangle is that of its smallest sphere
    through the corners, if neither opposite corner is strictly inside (it is a Gabriel triangle), else r_mid, the
    smaller radius of its tetrahedra; r_max is the larger one. r_min of an edge is half its length, if it is a Gabriel
    edge, else the least r_min of its triangles; r_mid and r_max are the least and the greatest radius of its
    tetrahedra. r_max is infinite on the hull.

    Every decision is exact, and so is the order of the radii: comparisons use ranks, indices in the spectrum. The
    doubles of the radii do not decrease with the rank; their relative error is less than 2⁻⁴⁰, mostly less than 2⁻⁵⁰.

    Parameters
    ----------
    mesh : Tetrahedralization
        Triangulation of the points.
    edges : (e, 2) int32 array
        Ends of each edge, the smaller index first.
    facet : (m,) int32 array
        4 t + k of each triangle: of tetrahedron t the face opposite to corner k. None if the mesh has triangles only.
    tetrahedron_rank : (t,) int32 array
        Indices of the circumradii in the spectrum.
    triangle_min : (m,) int32 array
        Indices of r_min.
    edge_min, edge_mid, edge_max : (e,) int32 array
        Indices of these radii; the length of the spectrum for infinite ones.
    spectrum : (s,) float64 array
        Radii at which the shape changes, each exact value once, increasing; two of them may have one double.
    witness : (s,) int32 array
        A tetrahedron with this radius, t plus a triangle, or t + m plus an edge.

    References
    ----------
    Edelsbrunner and Mücke 1994; Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.3.

    Examples
    --------
    >>> from vorotool import alpha_complex
    >>> family = alpha_complex([[0, 0, 0], [4, 0, 0], [0, 3, 0], [0, 0, 2]])
    >>> family.spectrum.round(3).tolist()
    [1.0, 1.5, 1.803, 2.0, 2.236, 2.5, 2.693]
    >>> family.radii("tetrahedra").round(3).tolist()
    [[2.693, 2.693, 2.693]]
    """

    maker = "alpha_complex"
    doubt = 2.0**-39

    mesh: Tetrahedralization = f.nested()
    edges: NDArray[np.int32] = f.index("edges", 2)
    facet: NDArray[np.int32] = f.index("facets")
    tetrahedron_rank: NDArray[np.int32] = f.index("tetrahedra")
    triangle_min: NDArray[np.int32] = f.index("triangles")
    edge_min: NDArray[np.int32] = f.index("edges")
    edge_mid: NDArray[np.int32] = f.index("edges")
    edge_max: NDArray[np.int32] = f.index("edges")
    spectrum: NDArray[np.float64] = f.length("radii")
    witness: NDArray[np.int32] = f.index("radii")

    def __len__(self) -> int:
        return len(self.tetrahedron_rank)

    @property
    def points(self) -> Floats:
        """(n, 3) coordinates, in the order of the input."""
        return self.mesh.points

    @property
    def tetrahedra(self) -> NDArray[np.int32]:
        """(t, 4) corners."""
        return self.mesh.tetrahedra

    @cached_property
    def triangles(self) -> NDArray[np.int32]:
        """Return the (m, 3) triangles, counter-clockwise as seen from outside of the tetrahedron of their facet."""
        if not len(self.mesh):
            return self.mesh.planar
        t, k = np.divmod(self.facet, 4)
        return self.mesh.tetrahedra[t[:, None], FACES[k]]

    @cached_property
    def sides(self) -> NDArray[np.int32]:
        """Return the (m, 2) tetrahedra on both sides of each triangle, -1 for none: first that of its facet."""
        if not len(self.mesh):
            return np.full((len(self.mesh.planar), 2), -1, dtype=np.int32)
        return np.stack([self.facet // 4, self.mesh.neighbors.reshape(-1)[self.facet]], axis=1)

    def simplices(self, what: str) -> NDArray[np.int32]:
        """Return the corners of the points, edges, triangles or tetrahedra; of points those without duplicates."""
        if what == "points":
            return np.flatnonzero(~self.mesh.is_duplicate).astype(np.int32)[:, None]
        return getattr(self, _checked(what))

    def ranks(self, what: str) -> NDArray[np.int32]:
        """Return the (k, 3) ranks of r_min, r_mid and r_max of all `simplices`; -1 for r_min of points, which is 0."""
        if _checked(what) == "tetrahedra":
            return np.repeat(self.tetrahedron_rank[:, None], 3, axis=1)
        if what == "edges":
            return np.stack([self.edge_min, self.edge_mid, self.edge_max], axis=1)
        if what == "triangles":
            here, there = np.append(self.tetrahedron_rank, np.int32(len(self.spectrum)))[self.sides.T]
            return np.stack([self.triangle_min, np.minimum(here, there), np.maximum(here, there)], axis=1)
        mid, last = self._least_ranks, len(self.spectrum)
        high = np.full(len(mid), -1, dtype=np.int32)
        np.maximum.at(high, self.edges, self.edge_max[:, None])
        high[high < 0] = last
        ranks = np.stack([np.full(len(mid), -1, dtype=np.int32), mid, high], axis=1)
        return ranks[~self.mesh.is_duplicate]

    def radii(self, what: str) -> Floats:
        """Return the (k, 3) radii r_min, r_mid and r_max of all `simplices`; infinite where there is none."""
        return np.concatenate([self.spectrum, [np.inf, 0.0]])[self.ranks(what)]

    def classes(self, what: str, r: Radius) -> NDArray[np.uint8]:
        """Return the indices in `CLASSES` of all `simplices` in the shape of r."""
        return classes_of_ranks(self.ranks(what), self.reached(checked_radius(r)))

    @cached_property
    def _least_ranks(self) -> NDArray[np.int32]:
        """(n,) the first rank at which each point is in a tetrahedron; as many as there are ranks if never."""
        least = np.full(len(self.points), len(self.spectrum), dtype=np.int32)
        for k in range(4):
            np.minimum.at(least, self.tetrahedra[:, k], self.tetrahedron_rank)
        return least

    @property
    def covered(self) -> int:
        """The first rank at which all points are in tetrahedra; as many as there are ranks if they never are."""
        return int(self._least_ranks[~self.mesh.is_duplicate].max(initial=0))

    def areas(self, triangles: NDArray[np.int32]) -> Floats:
        """Return the areas of triangles."""
        areas = np.empty(len(triangles))
        for begin in range(0, len(triangles), _BLOCK):
            a, b, c = np.moveaxis(self.points[triangles[begin : begin + _BLOCK]], 0, 2)
            with np.errstate(over="ignore"):
                areas[begin : begin + _BLOCK] = scaled_norms(cross(b - a, c - a).T) / 2
        return areas

    def squared_radius(self, rank: int) -> Fraction:
        """Return the exact square of a radius of the spectrum."""
        item, tetrahedra, triangles = int(self.witness[rank]), len(self), len(self.triangle_min)
        if item < tetrahedra:
            corners = self.tetrahedra[item]
        elif item < tetrahedra + triangles:
            corners = self.triangles[item - tetrahedra]
        else:
            corners = self.edges[item - tetrahedra - triangles]
        return squared_radius_of(self.points[corners].tolist())

    def _rows(self, what: str | None = None) -> Rows:
        if what == "spectrum":
            return Rows(Table({"r": self.spectrum}))
        tables = [
            self._family_table(name, corners)
            for name, corners in zip(SIMPLICES[1:], ["ab", "abc", "abcd"], strict=True)
        ]
        joined: Any = np.ma.concatenate
        return Rows(Table({name: joined([table[name] for table in tables]) for name in tables[-1]}))

    def _family_table(self, what: str, letters: str) -> dict[str, Any]:
        corners, labels = self.simplices(what), self.mesh.label_array
        columns: dict[str, Any] = {"corners": np.full(len(corners), len(letters))}
        for k, letter in enumerate("abcd"):
            is_there = k < len(letters)
            values = labels[corners[:, k]] if is_there else np.zeros(len(corners), np.int64)
            columns[f"label_{letter}"] = np.ma.array(values, mask=np.full(len(corners), not is_there))
        names = "r_min", "r_mid", "r_max"
        return {**columns, **dict(zip(names, self.radii(what).T, strict=True))}

    def _matrix(self, _what: str) -> Floats:
        return self.spectrum

    def _summary(self) -> str:
        radii = counted(len(self.spectrum), "critical radius", "critical radii")
        return f"{counted(len(self.points), 'point')}, {counted(len(self), 'tetrahedron', 'tetrahedra')}, {radii}"


def cross(p: Floats, q: Floats) -> Floats:
    """Cross products of (3, n) vectors."""
    return np.stack([p[i - 2] * q[i - 1] - p[i - 1] * q[i - 2] for i in range(3)])


def _checked(what: str) -> str:
    if what not in SIMPLICES:
        raise UsageError(f"invalid what {shown_number(what)}: expected {', '.join(SIMPLICES)}")
    return what


def classes_of_ranks(ranks: NDArray[np.int32], reached: int) -> NDArray[np.uint8]:
    """(k,) classes of simplices with these ranks where those below `reached` have come."""
    return (ranks < reached).sum(axis=1, dtype=np.uint8)


# ---- one shape -----------------------------------------------------------------------------------
@record
class SpaceAlphaShape(Value, OfFamily, Tabular):
    """Alpha shape of points in space for one radius r (the paper's α is -1/r).

    Its tetrahedra are those whose circumradius is at most r. The triangles that bound them are its surface: closed, and
    counter-clockwise as seen from outside; an edge has an even number of them, and a surface may touch itself at edges
    and points. Triangles and edges of the shape that bound no tetrahedron of it are singular.

    Parameters
    ----------
    family : SpaceAlphaComplex
        The shapes of all radii.
    r : float or Fraction
        The radius.
    region : (t,) int32 array
        Region of each tetrahedron, from 0: tetrahedra joined through triangles; -1 for those outside the shape.

    Examples
    --------
    >>> from vorotool import alpha_shape
    >>> shape = alpha_shape([[0, 0, 0], [4, 0, 0], [0, 3, 0], [0, 0, 2], [9, 9, 9]], r=3)
    >>> shape.surface.tolist(), shape.volume, round(shape.area, 3), shape.isolated.tolist()
    ([[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]], 4.0, 20.81, [4])
    """

    maker = "alpha_shape"

    family: SpaceAlphaComplex = f.nested()
    r: Radius = f.length()
    region: NDArray[np.int32] = f.index("tetrahedra")

    @property
    def label_array(self) -> NDArray[np.int64]:
        """(n,) labels: the input's own, else 1 to n."""
        return self.family.mesh.label_array

    @cached_property
    def reached(self) -> int:
        """Return how many radii of the spectrum are at most r."""
        return self.family.reached(self.r)

    # ---- parts
    @property
    def tetrahedra(self) -> NDArray[np.int32]:
        """(k, 4) tetrahedra of the shape."""
        return self.family.tetrahedra[self.inside]

    @cached_property
    def surface_index(self) -> Indices:
        """Return the triangles of the family that bound one tetrahedron of the shape."""
        return np.flatnonzero(self._sides_inside.sum(axis=1) == 1)

    @cached_property
    def _sides_inside(self) -> Booleans:
        return np.append(self.inside, False)[self.family.sides]

    @cached_property
    def surface(self) -> NDArray[np.int32]:
        """Return the (k, 3) triangles that bound the tetrahedra, counter-clockwise as seen from outside."""
        triangles = self.family.triangles[self.surface_index]
        is_outward = self._sides_inside[self.surface_index, 0]
        return np.where(is_outward[:, None], triangles, triangles[:, ::-1])

    @property
    def surface_region(self) -> NDArray[np.int32]:
        """(k,) region that each triangle of the surface bounds."""
        region = np.append(self.region, np.int32(-1))[self.family.sides[self.surface_index]]
        return region.max(axis=1)

    @cached_property
    def triangle_classes(self) -> NDArray[np.uint8]:
        """Return the (m,) indices in `CLASSES` of all triangles of the family."""
        return classes_of_ranks(self.family.ranks("triangles"), self.reached)

    @cached_property
    def edge_classes(self) -> NDArray[np.uint8]:
        """Return the (e,) indices in `CLASSES` of all edges of the family."""
        return classes_of_ranks(self.family.ranks("edges"), self.reached)

    @property
    def triangles(self) -> NDArray[np.int32]:
        """(k, 3) all triangles of the shape."""
        return self.family.triangles[self.triangle_classes > 0]

    @property
    def edges(self) -> NDArray[np.int32]:
        """(k, 2) all edges of the shape."""
        return self.family.edges[self.edge_classes > 0]

    @property
    def singular(self) -> NDArray[np.int32]:
        """(k, 3) triangles of the shape that bound no tetrahedron of it."""
        return self.family.triangles[self.triangle_classes == CLASSES.index("singular")]

    @property
    def singular_edges(self) -> NDArray[np.int32]:
        """(k, 2) edges of the shape that are on no triangle of it."""
        singular = self.family.edges[self.edge_classes == CLASSES.index("singular")]
        on = np.sort(self.singular[:, EDGES[[0, 1, 3]]].reshape(-1, 2), axis=1)
        keys, held = ((pairs[:, 0].astype(np.int64) << 32) | pairs[:, 1] for pairs in (singular, on))
        return singular[~np.isin(keys, held)]

    @property
    def isolated(self) -> NDArray[np.int32]:
        """(k,) 0-based points on no edge of the shape, without duplicates."""
        alone = ~self.family.mesh.is_duplicate
        alone[self.edges.reshape(-1)] = False
        return np.flatnonzero(alone).astype(np.int32)

    # ---- measures
    @property
    def volume(self) -> float:
        """Volume of the tetrahedra."""
        return float(self.family.mesh.volumes[self.inside].sum())

    @property
    def area(self) -> float:
        """Area of the surface."""
        return float(self.family.areas(self.surface).sum())

    @property
    def region_count(self) -> int:
        """Number of regions: tetrahedra joined through triangles."""
        return int(self.region.max(initial=-1)) + 1

    @cached_property
    def part_count(self) -> int:
        """Number of parts: all that is joined through edges, single points too."""
        root = _core.graphs.connected_components(np.ascontiguousarray(self.edges), len(self.points))
        return int(((root == np.arange(len(root))) & ~self.family.mesh.is_duplicate).sum())

    @cached_property
    def cavity_count(self) -> int:
        """Number of cavities: bounded components of what the shape leaves of space."""
        is_open = self.triangle_classes == 0
        sides = np.ascontiguousarray(self.family.sides[is_open] + np.int32(1))  # 0 is all outside
        root = _core.graphs.connected_components(sides, len(self.region) + 1)
        return int((root[1:] == np.arange(1, len(root)))[~self.inside].sum())

    @property
    def tunnel_count(self) -> int:
        """Number of tunnels: parts + cavities - Euler characteristic."""
        return self.part_count + self.cavity_count - self.euler

    @property
    def euler(self) -> int:
        """Euler characteristic: points - edges + triangles - tetrahedra."""
        points = len(self.points) - self.family.mesh.duplicates
        edges, triangles = (int((classes > 0).sum()) for classes in (self.edge_classes, self.triangle_classes))
        return points - edges + triangles - int(self.inside.sum())

    # ---- tables
    def _rows(self, what: str | None = None) -> Rows:
        return Rows(self._region_table() if what in (None, "table") else self._part_table(what))

    def _part_table(self, what: str) -> Table:
        corners: NDArray[np.int32] = self._matrix(what)
        labels = self.label_array
        columns: dict[str, Any] = {
            f"label_{letter}": Lookup(labels, corner) for letter, corner in zip("abcd", corners.T, strict=False)
        }
        if what == "edges":
            a, b = self.points[corners.T]
            columns["length"] = Computed(lambda rows: scaled_norms(b[rows] - a[rows]), len(corners))
            columns["class"] = _named(self.edge_classes[self.edge_classes > 0])
        elif what == "triangles":
            columns["class"] = _named(self.triangle_classes[self.triangle_classes > 0])
        elif what == "surface":
            columns["region"] = self.surface_region + 1
        elif what == "tetrahedra":
            columns["region"] = self.region[self.inside] + 1
        return Table(columns)

    def _region_table(self) -> Table:
        inside, count = self.inside, self.region_count
        of, volumes = self.region[inside], self.family.mesh.volumes[inside]
        corners = self.tetrahedra
        pairs = np.unique(of.astype(np.int64).repeat(4) << 32 | corners.reshape(-1))
        places = self.points[corners]
        low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
        np.minimum.at(low, of, places.min(axis=1))
        np.maximum.at(high, of, places.max(axis=1))
        surface = self.surface_region
        return Table(
            {
                "region": np.arange(1, count + 1),
                "volume": np.bincount(of, volumes, count),
                "area": np.bincount(surface, self.family.areas(self.surface), count),
                "points": np.bincount(pairs >> 32, minlength=count),
                "tetrahedra": np.bincount(of, minlength=count),
                **{f"{axis}_min": low[:, k] for k, axis in enumerate("xyz")},
                **{f"{axis}_max": high[:, k] for k, axis in enumerate("xyz")},
            }
        )

    def _matrix(self, what: str | None) -> NDArray[np.int32]:
        return getattr(self, what or "surface")

    def _summary(self) -> str:
        sizes = counted(len(self.points), "point"), counted(self.region_count, "region")
        return f"r = {nearest_double(self.r):.6g}, {', '.join(sizes)}, {counted(len(self.surface), 'triangle')}"


def _named(classes: NDArray[np.uint8]) -> NDArray[np.str_]:
    return np.array(CLASSES)[classes]
