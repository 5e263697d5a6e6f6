"""Necks: where polygons are narrowest between wider places, and the cuts there."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, following, objects
from vorotool.types import fields as f
from vorotool.types.features import Rows, of_polygons, of_segments, of_shapes, without_places
from vorotool.types.fields import record
from vorotool.types.identity import described_shapes, names_of, part_table, place_columns, with_columns_of
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.table import Lookup, Table
from vorotool.types.values import Geometric, Pictured, Tabular, Value, counted

SITE_KINDS = ("vertex", "edge")


@record
class Necks(Value, Tabular, Geometric, Pictured):
    """Points of a skeleton where the clearance is least in both directions, polygon by polygon, by x and then by y.

    The boundary is touched at two opposite places there, the feet: the cut goes straight from one to the other.

    Parameters
    ----------
    skeleton : Skeleton
        What they are on.
    arc : (n,) int32 array
        Its arc that each is on, or one of the two where they meet.
    xy : (n, 2) float64 array
        Places: the middle of each cut.
    width : (n,) float64 array
        Lengths of the cuts: twice the clearance.
    feet : (n, 2, 2) float64 array
        Both ends of each cut, the one with less x first, or with less y.
    sites : (n, 2) int32 array
        The vertices or edges that these are on: rows of ``skeleton.site_table``.
    beside : (n, 2) float64 array
        The largest clearance that is reached from the neck on either side without passing a narrower one, the smaller
        first. Of necks that are equally narrow the one that comes first counts as narrower.

    Raises
    ------
    InputError
        If an array has another shape.

    Examples
    --------
    >>> from vorotool import necks
    >>> rooms = [[0, 0], [4, 0], [4, 1.5], [6, 1.5], [6, 0], [12, 0], [12, 6], [6, 6], [6, 2.5], [4, 2.5]]
    >>> rooms += [[4, 4], [0, 4]]
    >>> found = necks(rooms)
    >>> found.feet.tolist(), found.beside.tolist(), found.ratio.tolist()
    ([[[5.0, 1.5], [5.0, 2.5]]], [[2.0, 3.0]], [0.25])
    """

    maker = "necks"

    skeleton: Skeleton = f.nested()
    arc: NDArray[np.int32] = f.index("necks")
    xy: NDArray[np.float64] = f.position("necks", 2)
    width: NDArray[np.float64] = f.length("necks")
    feet: NDArray[np.float64] = f.position("necks", 2, 2)
    sites: NDArray[np.int32] = f.index("necks", 2)
    beside: NDArray[np.float64] = f.length("necks", 2)

    def __len__(self) -> int:
        return len(self.width)

    @cached_property
    def polygon(self) -> NDArray[np.int32]:
        """(n,) the polygon that each is in."""
        return self.skeleton.polygon[self.arc]

    @cached_property
    def ratio(self) -> NDArray[np.float64]:
        """(n,) half of the width over the smaller clearance beside: near 0 at a narrow door between large rooms."""
        return np.minimum(self.width / 2 / self.beside[:, 0], 1.0)

    def taken(self, chosen: NDArray[np.bool_] | NDArray[np.integer]) -> Necks:
        """Return a selection of the necks."""
        return Necks(
            self.skeleton,
            *(getattr(self, name)[chosen] for name in ("arc", "xy", "width", "feet", "sites", "beside")),
        )

    def table(self) -> Table:
        """Return a table with one row per neck.

        Returns
        -------
        Table
            ``label, id, x, y, width, ratio, r_smaller, r_larger``, and of both feet ``x_a, y_a, kind_a, ring_a,
            index_a`` and the same with b: the site that the foot is on, a vertex or the edge that begins there.
        """
        return part_table(self._columns(), self.skeleton.polygons, self.polygon)

    def _columns(self) -> dict[str, Any]:
        table = self.skeleton.site_table
        columns = {
            **names_of(self.skeleton.polygons, self.polygon),
            **place_columns(self.xy),
            "width": self.width,
            "ratio": self.ratio,
            "r_smaller": self.beside[:, 0].copy(),
            "r_larger": self.beside[:, 1].copy(),
        }
        for foot, name in enumerate("ab"):
            site = self.sites[:, foot]
            columns |= {
                **place_columns(self.feet[:, foot], f"_{name}"),
                f"kind_{name}": Lookup(list(SITE_KINDS), (table.kind[site] == EDGE).astype(np.int32)),
                f"ring_{name}": table.ring[site],
                f"index_{name}": table.index[site],
            }
        return columns

    def _rows(self, _what: str | None = None) -> Rows:
        return Rows(self.table(), source=self.skeleton.polygons, item=self.polygon)

    def _features(self, _what: str | None = None, _flatten: float | None = None) -> Rows:
        columns = without_places(Table(self._columns()))
        return of_polygons(columns, self.skeleton.polygons, self.polygon, geometry=of_segments(self.feet), is_part=True)

    def _summary(self) -> str:
        return f"{counted(len(self), 'neck')} of {counted(len(self.skeleton.polygons), 'polygon')}"


@record
class Parts(Value, Tabular, Geometric, Pictured):
    """Pieces of polygons, polygon by polygon, by the least x of each and then by y.

    Parameters
    ----------
    polygons : PolygonSet
        The pieces, each a feature, with the id and the properties of its polygon. Shells go counter-clockwise (y
        upwards), holes clockwise, both from their vertex with the least x, or of these with the least y.
    source : (p,) int32 array
        The polygon that each is a piece of: one of ``necks.skeleton.polygons``.
    radius : (p,) float64 array
        Of the largest disc in that polygon whose center is in the piece.
    center : (p, 2) float64 array
        Of this disc, of several the one with the least x, or y.
    necks : Necks
        Where the polygons are cut.
    between : (c, 2) int32 array
        The two pieces that each cut parts, ascending.

    Raises
    ------
    InputError
        If an array has another shape.

    Examples
    --------
    >>> from vorotool import parts
    >>> rooms = [[0, 0], [4, 0], [4, 1.5], [6, 1.5], [6, 0], [12, 0], [12, 6], [6, 6], [6, 2.5], [4, 2.5]]
    >>> rooms += [[4, 4], [0, 4]]
    >>> pieces = parts(rooms)
    >>> pieces.area.tolist(), pieces.radius.tolist(), pieces.between.tolist()
    ([17.0, 37.0], [2.0, 3.0], [[0, 1]])
    """

    maker = "parts"

    polygons: PolygonSet = f.nested("parts")
    source: NDArray[np.int32] = f.index("parts")
    radius: NDArray[np.float64] = f.length("parts")
    center: NDArray[np.float64] = f.position("parts", 2)
    necks: Necks = f.nested("cuts")
    between: NDArray[np.int32] = f.index("cuts", 2)

    def __len__(self) -> int:
        return len(self.polygons)

    @cached_property
    def width(self) -> NDArray[np.float64]:
        """(p,) diameters of the largest discs."""
        return 2 * self.radius

    @cached_property
    def area(self) -> NDArray[np.float64]:
        """(p,) areas; those of the pieces of a polygon sum to its own, but for rounding."""
        polygons = self.polygons
        start = polygons.ring_starts
        first = np.repeat(polygons.xy[start[:-1]], np.diff(start), axis=0)
        (x, y), (u, v) = (polygons.xy - first).T, (polygons.xy[following(start)] - first).T
        twice = np.add.reduceat(x * v - y * u, start[:-1]) if len(x) else np.zeros(0)
        return np.bincount(polygons.ring_polygon, twice, minlength=len(polygons)) / 2

    @cached_property
    def cuts(self) -> NDArray[np.int64]:
        """(p,) number of cuts around each."""
        return np.bincount(self.between.reshape(-1), minlength=len(self))

    @cached_property
    def neighbors(self) -> list[list[int]]:
        """Return the pieces beyond the cuts of each piece, ascending."""
        found: list[set[int]] = [set() for _ in range(len(self))]
        for a, b in self.between.tolist():
            found[a].add(b)
            found[b].add(a)
        return [sorted(each) for each in found]

    def table(self) -> Table:
        """Return a table with one row per piece.

        Returns
        -------
        Table
            ``piece, polygon, id, area, width, x, y, cuts``: the width is the diameter of the largest disc of the
            polygon with its center in the piece, x and y this center.
        """
        return with_columns_of(
            {
                "piece": np.arange(len(self)),
                **names_of(self.necks.skeleton.polygons, self.source),
                "area": self.area,
                "width": self.width,
                **place_columns(self.center),
                "cuts": self.cuts,
            },
            self.necks.skeleton.polygons,
            self.source,
        )

    def described(self) -> PolygonSet:
        """Return the pieces with their measures as properties, prefixed ``voro_`` on a clash with the input.

        Examples
        --------
        >>> from vorotool import parts
        >>> parts([[0, 0], [4, 0], [4, 2], [0, 2]]).described().properties["width"]
        [2.0]
        """
        own: dict[str, Any] = {
            "piece": np.arange(len(self)),
            "area": self.area,
            "width": self.width,
            "cuts": self.cuts,
            "neighbors": objects(self.neighbors),
        }
        return replace(self.polygons, **described_shapes(own, self.necks.skeleton.polygons, self.source))

    def _rows(self, _what: str | None = None) -> Rows:
        return Rows(self.table(), source=self.necks.skeleton.polygons, item=self.source)

    def _features(self, _what: str | None = None, _flatten: float | None = None) -> Rows:
        return of_shapes(self.described(), self.necks.skeleton.polygons, self.source)

    def _shown_places(self) -> list[Floats]:
        return [self.polygons.xy]

    def _summary(self) -> str:
        return f"{counted(len(self), 'piece')} of {counted(len(self.necks.skeleton.polygons), 'polygon')}"
