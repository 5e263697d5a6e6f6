"""The alpha complex of points, all alpha shapes at once, and how long its regions last."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.products.formats import resolved
from vorotool.types import fields as f
from vorotool.types.alpha.radii import Radius, RankedRadii, checked_radius, squared_radius_of
from vorotool.types.features import Corners, Rows
from vorotool.types.fields import record
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.table import Table
from vorotool.types.values import Geometric, Pictured, Tabular, Value, counted

CLASSES = ("outside", "singular", "boundary", "interior")
"""Classes of edges by number: outside of a shape, alone in it, on one triangle of it, between two."""


@record
class AlphaComplex(Value, RankedRadii, Tabular, Geometric, Pictured):
    """Family of alpha shapes: the radii at which each Delaunay edge enters, bounds and leaves the shape.

    The paper's α is -1/r. An edge is in the shape for r_min ≤ r < r_max. r_min is half its length, if it is a Gabriel
    edge, else r_mid, the smaller circumradius of its triangles, from which on it bounds a triangle of the shape; r_max
    is the larger one. Radii of missing triangles are infinite. A triangle is in the shape if its circumradius is at
    most r. The paper has open intervals; the shapes differ only at radii of the spectrum.

    Radii are correctly rounded. Comparisons use ranks, exact indices in the spectrum.

    Parameters
    ----------
    mesh : Triangulation
        Triangulation of the points.
    edges : (e, 2) int32 array
        Ends of each edge, the smaller index first, in the order of the triangles.
    sides : (e, 2) int32 array
        The triangles with this edge, or -1.
    r_min, r_mid, r_max : (e,) float64 array
        Radii in input units; infinite where there is none.
    rank_min, rank_mid, rank_max : (e,) int32 array
        Indices of these radii in the spectrum; its length for infinite radii.
    triangle_rank : (t,) int32 array
        Indices of the circumradii in the spectrum.
    spectrum : (m,) float64 array
        Radii at which the shape changes, each exact value once, increasing; two of them may round to one double.
    witness : (m,) int32 array
        A triangle with this circumradius, or the number of triangles plus an edge of twice this length.
    rule : {"corrected", "printed"}
        ``printed``: r_min is half the length of every edge with two triangles, and intervals are open, as in the text.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 2.3; Edelsbrunner, Kirkpatrick and Seidel 1983.

    Examples
    --------
    >>> from vorotool import alpha_complex
    >>> family = alpha_complex([[0, 0], [4, 0], [0, 3]])
    >>> family.edges.tolist(), family.r_min.tolist(), family.spectrum.tolist()
    ([[1, 2], [0, 2], [0, 1]], [2.5, 1.5, 2.0], [1.5, 2.0, 2.5])
    >>> family.reached(2), family.reached(Fraction(5, 2))
    (2, 3)
    """

    maker = "alpha_complex"

    mesh: Triangulation = f.nested()
    edges: NDArray[np.int32] = f.index("edges", 2)
    sides: NDArray[np.int32] = f.index("edges", 2)
    r_min: NDArray[np.float64] = f.length("edges")
    r_mid: NDArray[np.float64] = f.length("edges")
    r_max: NDArray[np.float64] = f.length("edges")
    rank_min: NDArray[np.int32] = f.index("edges")
    rank_mid: NDArray[np.int32] = f.index("edges")
    rank_max: NDArray[np.int32] = f.index("edges")
    triangle_rank: NDArray[np.int32] = f.index("triangles")
    spectrum: NDArray[np.float64] = f.length("radii")
    witness: NDArray[np.int32] = f.index("radii")
    rule: str = "corrected"

    def __len__(self) -> int:
        return len(self.edges)

    @property
    def points(self) -> NDArray[np.float64]:
        """(n, 2) coordinates, in the order of the input."""
        return self.mesh.points

    def entered(self, r: Radius) -> int:
        """Return the number of critical radii reached at r; with open intervals, of those below r."""
        return self._count(r, or_equal=self.rule != "printed")

    def squared_radius(self, rank: int) -> Fraction:
        """Return the exact square of a radius of the spectrum."""
        item = int(self.witness[rank])
        triangles = len(self.triangle_rank)
        corners = self.mesh.triangles[item] if item < triangles else self.edges[item - triangles]
        return squared_radius_of(self.points[corners].tolist())

    @property
    def covered(self) -> int:
        """The first rank at which all points are in triangles; as many as there are ranks if they never are."""
        least = np.full(len(self.points), len(self.spectrum), dtype=np.int32)
        np.minimum.at(least, self.mesh.triangles, self.triangle_rank[:, None])
        return int(least[self.mesh.first].max(initial=0))

    def classes(self, r: Radius) -> NDArray[np.uint8]:
        """Return the (e,) indices of the classes of the edges in `CLASSES` for the shape of r.

        Raises
        ------
        UsageError
            If r is not positive.
        """
        reached, entered = self.reached(checked_radius(r)), self.entered(r)
        return classes_of(self, reached, entered)

    @cached_property
    def lengths(self) -> NDArray[np.float64]:
        """Return the (e,) lengths of the edges, to a relative error of 1e-15; infinite beyond the largest double."""
        a, b = self.points[self.edges[:, 0]], self.points[self.edges[:, 1]]
        with np.errstate(over="ignore"):
            lengths: NDArray[np.float64] = hypotenuse(*(b - a).T)
        return lengths

    def _rows(self, what: str | None = None) -> Rows:
        if what == "spectrum":
            return Rows(Table({"r": self.spectrum}))
        return Rows(resolved("types.alpha.tables:family_table")(self))

    def _features(self, _what: str | None = None, _flatten: float | None = None) -> Rows:
        return replace(self._rows(), source=self.mesh, geometry=Corners(self.points, self.edges))

    def _matrix(self, _what: str) -> NDArray[np.float64]:
        return self.spectrum

    def _summary(self) -> str:
        radii = counted(len(self.spectrum), "critical radius", "critical radii")
        sizes = (counted(len(self.points), "point"), counted(len(self), "edge"), radii)
        return ", ".join(sizes)


def classes_of(family: AlphaComplex, reached: int, entered: int) -> NDArray[np.uint8]:
    """(e,) classes of the edges where ranks below ``reached`` have come, and edges entered below ``entered``."""
    classes = np.where(family.rank_mid < reached, np.uint8(2), np.uint8(1))
    classes[family.rank_min >= entered] = 0
    classes[family.rank_max < reached] = 3
    return classes


@record
class RegionPersistence(Value, Tabular):
    """Persistence of the regions of all alpha shapes: the radii at which each is born and dies.

    A region consists of triangles joined through edges. It is born with its first triangle, and dies when it merges
    with one born earlier (the elder rule); of several born at one radius the one with the most points survives, then
    the one whose first triangle comes first. Regions are ordered by birth, then by these triangles. Regions that would
    merge at the radius of their birth are one.

    Parameters
    ----------
    birth : (k,) float64 array
        Radii at which the regions are born.
    death : (k,) float64 array
        Radii at which the regions merge into older ones; infinite if they never do.
    into : (k,) int32 array
        The older region, or -1.
    points, triangles : (k,) int32 arrays
        Numbers of vertices and triangles just before the death, or for the largest shape.
    area : (k,) float64 array
        Area of these triangles.
    joined : float
        Smallest radius at which one region holds every point, or the largest radius if there is none; it replaces
        infinite deaths when persistences are compared.

    Examples
    --------
    >>> from vorotool import persistence
    >>> found = persistence([[0, 0], [2, 0], [0, 2], [9, 0], [12, 0], [9, 3]])
    >>> found.birth.round(3).tolist(), found.death.round(3).tolist(), found.points.tolist()
    ([1.414, 2.121], [inf, 4.876], [6, 4])
    >>> found.suggested
    2
    """

    birth: NDArray[np.float64] = f.length("regions")
    death: NDArray[np.float64] = f.length("regions")
    into: NDArray[np.int32] = f.index("regions")
    points: NDArray[np.int32] = f.index("regions")
    triangles: NDArray[np.int32] = f.index("regions")
    area: NDArray[np.float64] = f.area("regions")
    joined: float = f.length()

    def __len__(self) -> int:
        return len(self.birth)

    @property
    def persistence(self) -> NDArray[np.float64]:
        """(k,) death minus birth; for regions that never die `joined` minus birth."""
        death = np.where(np.isinf(self.death), np.maximum(self.joined, self.birth), self.death)
        there = np.isfinite(self.birth)  # of circles beyond the largest double nothing can be told
        return np.subtract(death, self.birth, out=np.zeros(len(self)), where=there)

    @property
    def suggested(self) -> int:
        """Number of regions that stand out: those above the largest gap between successive persistences.

        The last gap is between the least persistence and 0; of equal gaps the one with fewer regions counts. One
        distant point makes the first gap large: look at the table in that case.
        """
        ordered = np.append(np.sort(self.persistence)[::-1], 0.0)
        gaps = ordered[:-1] - ordered[1:]
        return int(np.argmax(gaps)) + 1 if len(gaps) else 0

    @property
    def apart_until(self) -> float:
        """Smallest radius at which one of the regions that stand out dies: below it they are separate."""
        standing = np.argsort(-self.persistence, kind="stable")[: self.suggested]
        return float(self.death[standing].min(initial=np.inf))

    def table(self) -> Table:
        """Return a table of the regions: ``region, birth, death, persistence, into, points, triangles, area``.

        Regions count from 1. Regions that never die have no ``death`` and no ``into``.
        """
        return Table(
            {
                "region": np.arange(1, len(self) + 1),
                "birth": self.birth,
                "death": np.ma.masked_invalid(self.death),
                "persistence": self.persistence,
                "into": np.ma.array(self.into.astype(np.int64) + 1, mask=self.into < 0),
                "points": self.points,
                "triangles": self.triangles,
                "area": self.area,
            }
        )

    def _rows(self, _what: str | None = None) -> Rows:
        return Rows(self.table())

    def _summary(self) -> str:
        stands = "stands" if self.suggested == 1 else "stand"
        return f"{counted(len(self), 'region')}, {self.suggested} of which {stands} out"
