"""Curves at a distance from polygons and lines: rings of straight lines and circular arcs."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, crosses, norms, owners
from vorotool.numeric.checks import index_of_rows
from vorotool.numeric.curves.flatten import chords_of, circle_tolerances
from vorotool.numeric.curves.inverse_functions import inverse_sine
from vorotool.numeric.numbers import checked_flatten
from vorotool.types import fields as f
from vorotool.types.features import Rows, of_shapes
from vorotool.types.fields import record
from vorotool.types.identity import described_shapes, names_of, part_table, place_columns
from vorotool.types.polygons.polygon_set import HOLE, SHELL, PolygonSet
from vorotool.types.skeleton.segment_voronoi import SiteTable
from vorotool.types.table import Lookup, Table
from vorotool.types.values import Curved, Pictured, Tabular, Value, counted

PIECE_KINDS = ("line", "arc")
RING_KINDS = ("shell", "hole")
_FINE = 2.0**-10
"""Of the extent: chords of arcs whose bounds are shown."""


@record
class Offsets(Value, Tabular, Curved, Pictured):
    """Shapes bounded by offset curves, distance by distance, each a shell and holes.

    At a distance d > 0 a shape is what is no farther than d from the polygons and lines; at d < 0 what lies in a
    polygon, farther than -d from all of them. The pieces of a ring follow one another, each from the end of the one
    before, with the shape on their left: shells go counter-clockwise (y upwards), holes clockwise; all arcs turn
    counter-clockwise where d > 0, else clockwise.

    Parameters
    ----------
    start, end : (k, 2) float64 array
        Ends of the pieces, in input units.
    center : (k, 2) float64 array
        Of the circle of each arc, which is at most half of it; NaN on straight lines.
    site : (k,) int32 array
        The site that each piece is at the distance from, a row of `site_table`: an edge of a line, a vertex of an arc.
    ring_starts : (q + 1,) int64 array
        The first piece of each ring, and k.
    shape_starts : (s + 1,) int64 array
        The first ring of each shape, its shell, and q.
    distance : (s,) float64 array
        Of each shape.
    polygon : (s,) int32 array
        The polygon that each is around or in, the first one of several that share it, or of several parts of a feature
        that it is around; -1 around several features.
    site_table : SiteTable
        Vertices and edges of `polygons`.
    polygons : PolygonSet
        As they were used: placed, and cut where they meet, each feature by itself or all together.
    features : {"separate", "together"}
        Whether what is inside a feature is what it would be if there were no others; see `vorotool.Skeleton`.
    origin : (float, float)
        Of the lattice that they were computed on.

    Raises
    ------
    InputError
        If an array has another shape.

    Examples
    --------
    >>> from vorotool import offset
    >>> made = offset([[0, 0], [4, 0], [4, 2], [0, 2]], [-0.5, 1])
    >>> made.distance.tolist(), np.diff(made.ring_starts).tolist(), made.area.round(6).tolist()
    ([-0.5, 1.0], [4, 8], [3.0, 23.141593])
    """

    maker = "offset"

    start: NDArray[np.float64] = f.position("pieces", 2)
    end: NDArray[np.float64] = f.position("pieces", 2)
    center: NDArray[np.float64] = f.position("pieces", 2)
    site: NDArray[np.int32] = f.index("pieces")
    ring_starts: NDArray[np.int64] = f.starts("rings", "pieces", least=1)
    shape_starts: NDArray[np.int64] = f.starts("shapes", "rings", least=1)
    distance: NDArray[np.float64] = f.length("shapes")
    polygon: NDArray[np.int32] = f.index("shapes")
    site_table: SiteTable = f.nested()
    polygons: PolygonSet = f.nested()
    features: str = "separate"
    origin: tuple[float, float] = (0.0, 0.0)

    def __len__(self) -> int:
        """Return the number of shapes."""
        return len(self.distance)

    @cached_property
    def is_arc(self) -> NDArray[np.bool_]:
        """(k,) whether each piece is a circular arc."""
        return ~np.isnan(self.center[:, 0])

    @cached_property
    def shape_of_ring(self) -> NDArray[np.int64]:
        """(q,) the shape of each ring."""
        return owners(np.diff(self.shape_starts))

    @cached_property
    def ring_of_piece(self) -> NDArray[np.int64]:
        """(k,) the ring of each piece."""
        return owners(np.diff(self.ring_starts))

    @cached_property
    def ring_kind(self) -> NDArray[np.int8]:
        """(q,) `SHELL` or `HOLE`."""
        kind = np.full(len(self.shape_of_ring), HOLE, dtype=np.int8)
        kind[self.shape_starts[:-1]] = SHELL
        return kind

    @cached_property
    def piece_distance(self) -> NDArray[np.float64]:
        """(k,) the distance of the shape of each piece; its magnitude is the radius of arcs."""
        return self.distance[self.shape_of_ring][self.ring_of_piece]

    @cached_property
    def angle(self) -> NDArray[np.float64]:
        """(k,) how far each arc turns, in radians, at most π; 0 for straight lines."""
        chord = self.end - self.start
        sine = norms(chord) / (2 * np.abs(self.piece_distance))
        return np.where(self.is_arc, 2 * inverse_sine(sine), 0.0)

    @cached_property
    def length(self) -> NDArray[np.float64]:
        """(k,) true lengths."""
        chord = self.end - self.start
        straight = norms(chord)
        return np.where(self.is_arc, self.angle * np.abs(self.piece_distance), straight)

    @cached_property
    def area(self) -> NDArray[np.float64]:
        """(s,) areas: of the chords' polygons, and of the segments of circles outside, or inside them."""
        first = self.start[self.ring_starts[:-1]][self.ring_of_piece]
        a, b = self.start - first, self.end - first
        # sin x near 0 and π: by the chord and the height of its triangle
        x, y = np.where(self.is_arc[:, None], self.start - self.center, 0).T
        u, v = np.where(self.is_arc[:, None], self.end - self.center, 0).T
        sector = self.piece_distance * np.abs(self.piece_distance) * self.angle - (x * v - y * u)
        pieces = (crosses(a, b) + np.where(self.is_arc, sector, 0)) / 2
        if not len(self):
            return np.zeros(0)
        return np.add.reduceat(np.add.reduceat(pieces, self.ring_starts[:-1]), self.shape_starts[:-1])

    def flattened(self, tolerance: float | None = None) -> PolygonSet:
        """Return the shapes as polygons, with arcs replaced by chords.

        Parameters
        ----------
        tolerance : float, optional
            How far a chord may be from its arc, by default 1/2000 of its radius; none takes more than a quarter of a
            circle.

        Returns
        -------
        PolygonSet
            One polygon a shape, with the id and the properties of its polygon, its ``distance`` and its ``area``: that
            within the curves.

        Raises
        ------
        UsageError
            If the tolerance is not a positive number.
        """
        is_left = self.piece_distance > 0
        each = circle_tolerances(self.start, np.abs(self.piece_distance), checked_flatten(tolerance))
        xy, first = chords_of(self.start, self.end, self.center, is_left, each)
        return PolygonSet(
            xy,
            first[self.ring_starts],
            self.ring_kind,
            self.shape_of_ring,  # type: ignore[arg-type]
            **self._described(),
            y_axis=self.polygons.y_axis,
            unit=self.polygons.unit,
            crs=self.polygons.crs,
            index=index_of_rows(self.polygons.index, self.polygon),
        )

    def _described(self) -> dict[str, Any]:
        """Ids and properties of the shapes: what is around several features has none."""
        return described_shapes({"distance": self.distance, "area": self.area}, self.polygons, self.polygon)

    def table(self) -> Table:
        """Return a table with one row per piece.

        Returns
        -------
        Table
            ``label, id, shape, distance, ring, ring_kind, piece, kind, x0, y0, x1, y1, cx, cy, r, ccw, site_index,
            length``. Rings are counted in their shape, 0 is the shell. A straight line has no center, no radius, and
            does not turn.
        """
        ring = self.ring_of_piece
        shape = self.shape_of_ring[ring]
        line = ~self.is_arc
        return part_table(
            {
                **names_of(self.polygons, self.polygon[shape]),
                "shape": shape,
                "distance": self.piece_distance,
                "ring": ring - self.shape_starts[shape],
                "ring_kind": Lookup(list(RING_KINDS), self.ring_kind[ring].astype(np.int32)),
                "piece": np.arange(len(self.site)),
                "kind": Lookup(list(PIECE_KINDS), self.is_arc.astype(np.int32)),
                **place_columns(self.start, "0"),
                **place_columns(self.end, "1"),
                "cx": np.ma.array(self.center[:, 0], mask=line),
                "cy": np.ma.array(self.center[:, 1], mask=line),
                "r": np.ma.array(np.abs(self.piece_distance), mask=line),
                "ccw": np.ma.array((self.piece_distance > 0).astype(np.int8), mask=line),
                "site_index": self.site,
                "length": self.length,
            },
            self.polygons,
            self.polygon[shape],
        )

    def _rows(self, _what: str | None = None) -> Rows:
        shape = self.shape_of_ring[self.ring_of_piece]
        return Rows(self.table(), source=self.polygons, item=self.polygon[shape])

    def _features(self, _what: str | None = None, flatten: float | None = None) -> Rows:
        return of_shapes(self.flattened(flatten), self.polygons, self.polygon)

    def _shown_places(self) -> list[Floats]:
        corners = np.concatenate([self.polygons.xy, self.start])
        tolerance = _FINE * (float(np.ptp(corners, axis=0).max()) or 1.0) if len(corners) else 1.0
        return [self.polygons.xy, self.flattened(tolerance).xy]

    def _summary(self) -> str:
        return f"{counted(len(self), 'shape')}, {counted(len(self.site), 'piece')}"
