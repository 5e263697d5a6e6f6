"""Discs that fit into shapes, or between them, with the places where they touch."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, dots, within
from vorotool.numeric.checks import index_of_rows
from vorotool.numeric.coordinates import on_grid
from vorotool.numeric.curves.flatten import chords_of, circle_tolerances
from vorotool.numeric.numbers import checked_flatten
from vorotool.types import fields as f
from vorotool.types.features import Rows, of_shapes
from vorotool.types.fields import record
from vorotool.types.identity import described_shapes, names_of, place_columns, with_columns_of
from vorotool.types.polygons.polygon_set import SHELL, PolygonSet
from vorotool.types.skeleton.segment_voronoi import SiteTable
from vorotool.types.table import Table
from vorotool.types.values import Curved, Pictured, Tabular, Value, counted

SHOWN_FEET = 3
"""Feet that a row of the table has: as many as it takes to hold a disc."""


@record
class Discs(Value, Tabular, Curved, Pictured):
    """Discs that no shape enters, by feature and from the largest to the smallest.

    Parameters
    ----------
    xy : (n, 2) float64 array
        Centers.
    radius : (n,) float64 array
        Radii: the distance from the nearest place on the boundary.
    polygon : (n,) int32 array
        The polygon that each is in, the first of several; -1 outside.
    rank : (n,) int32 array
        From 1 for the first of a feature.
    foot_starts : (n + 1,) int64 array
        The feet of disc i are ``feet[foot_starts[i]:foot_starts[i + 1]]``.
    feet : (k, 2) float64 array
        Where discs touch the boundary.
    foot_site : (k,) int32 array
        What each foot is on: a row of `site_table`; -1 on the border of a region.
    site_table : SiteTable
        Vertices and edges of `polygons`.
    polygons : PolygonSet
        The shapes as they were used.
    local : bool
        They are all that are larger than those around them, and may overlap; else those of a feature are disjoint.
    features : {"separate", "together"}
        Whether each feature was taken by itself.
    within : PolygonSet, optional
        Of empty discs: where their centers are.

    Raises
    ------
    InputError
        If an array has another shape.

    Examples
    --------
    >>> from vorotool import largest_discs
    >>> discs = largest_discs([[0, 0], [8, 0], [8, 2], [0, 2]], count=2)
    >>> discs.xy.tolist(), discs.radius.tolist()
    ([[4.0, 1.0], [1.0, 1.0]], [1.0, 1.0])
    >>> discs.feet_of(0).tolist()
    [[4.0, 0.0], [4.0, 2.0]]
    """

    maker = "largest_discs"

    xy: NDArray[np.float64] = f.position("discs", 2)
    radius: NDArray[np.float64] = f.length("discs")
    polygon: NDArray[np.int32] = f.index("discs")
    rank: NDArray[np.int32] = f.index("discs")
    foot_starts: NDArray[np.int64] = f.starts("discs", "feet")
    feet: NDArray[np.float64] = f.position("feet", 2)
    foot_site: NDArray[np.int32] = f.index("feet")
    site_table: SiteTable = f.nested()
    polygons: PolygonSet = f.nested()
    local: bool = False
    features: str = "separate"
    within: PolygonSet | None = f.nested(default=None)

    def __len__(self) -> int:
        return len(self.radius)

    def feet_of(self, disc: int) -> NDArray[np.float64]:
        """Return the points where a disc touches the boundary, by the numbers of their sites."""
        return self.feet[self.foot_starts[disc] : self.foot_starts[disc + 1]]

    @cached_property
    def held_by(self) -> NDArray[np.int64]:
        """(n, 3) feet that hold each disc, as rows of `feet`; -1 for those that there are not.

        The first foot, and of the others the nearest on each side of what is opposite: these hold a disc that cannot
        grow, and one of them does if it is opposite.
        """
        made = np.full((len(self), SHOWN_FEET), -1, dtype=np.int64)
        counts = np.diff(self.foot_starts)
        few = counts <= SHOWN_FEET
        disc = np.repeat(np.arange(len(self)), counts)
        place = within(counts)
        own = few[disc]
        made[disc[own], place[own]] = np.flatnonzero(own)
        for i in np.flatnonzero(~few).tolist():
            chosen = np.array(_holding(self.feet_of(i), self.xy[i]))
            made[i, : len(chosen)] = self.foot_starts[i] + chosen
        return made

    def table(self) -> Table:
        """Return a table with one row per disc.

        Returns
        -------
        Table
            ``label, id, rank, x, y, r, feet, x_1, y_1, x_2, y_2, x_3, y_3``. ``feet`` is how many places the disc
            touches, of which two or three are given: those that hold it, where they are more. Of empty discs instead of
            ``label, id`` there are ``label_1, label_2, label_3``: the features that the feet are on.
        """
        held = self.held_by
        is_missing = held < 0
        names = names_of(self.polygons, self.polygon)
        columns = {
            **names,
            "rank": self.rank,
            **place_columns(self.xy),
            "r": self.radius,
            "feet": np.diff(self.foot_starts),
        }
        for k in range(SHOWN_FEET):
            for axis, name in enumerate("xy"):
                values = np.append(self.feet[:, axis], np.nan)[held[:, k]]
                columns[f"{name}_{k + 1}"] = np.ma.array(values, mask=is_missing[:, k])
        if self.within is not None:
            columns = {name: column for name, column in columns.items() if name not in names}
            label = np.append(self.polygons.labels[self.site_table.polygon[self.foot_site]], 0)[held]
            columns |= {f"label_{k + 1}": np.ma.array(label[:, k], mask=is_missing[:, k]) for k in range(SHOWN_FEET)}
            return Table(columns)
        return with_columns_of(columns, self.polygons, self.polygon)

    def flattened(self, tolerance: float | None = None) -> PolygonSet:
        """Return the circles as polygons, with arcs replaced by chords.

        Parameters
        ----------
        tolerance : float, optional
            How far a chord may be from its circle, by default 1/2000 of its radius.

        Returns
        -------
        PolygonSet
            One polygon a disc, with the id and the properties of its polygon, and ``rank``, ``x``, ``y``, ``r`` and
            ``feet``.

        Raises
        ------
        UsageError
            If the tolerance is not a positive number.
        """
        count = len(self)
        across = self.radius[:, None] * (1, 0)
        start = np.stack([self.xy + across, self.xy - across], axis=1)
        ends = start[:, ::-1].reshape(-1, 2)
        is_left = np.ones(2 * count, dtype=bool)
        each = np.broadcast_to(circle_tolerances(self.xy, self.radius, checked_flatten(tolerance)), count)
        center = np.repeat(self.xy, 2, axis=0)
        xy, first = chords_of(start.reshape(-1, 2), ends, center, is_left, np.repeat(each, 2))
        polygons = self.polygons
        return PolygonSet(
            xy,
            first[::2],
            np.full(count, SHELL),
            np.arange(count, dtype=np.int32),
            **self._described(),
            y_axis=polygons.y_axis,
            unit=polygons.unit,
            crs=polygons.crs,
            index=index_of_rows(polygons.index, self.polygon),
        )

    def _described(self) -> dict[str, Any]:
        """Ids and properties of the discs."""
        x, y = on_grid(self.xy).T
        own: dict[str, NDArray[Any]] = {"rank": self.rank, "x": x, "y": y, "r": self.radius}
        own["feet"] = np.diff(self.foot_starts)
        return described_shapes(own, self.polygons, self.polygon)

    def _rows(self, _what: str | None = None) -> Rows:
        return Rows(self.table(), source=self.polygons, item=self.polygon)

    def _features(self, _what: str | None = None, flatten: float | None = None) -> Rows:
        return of_shapes(self.flattened(flatten), self.polygons, self.polygon)

    def _shown_places(self) -> list[Floats]:
        across = self.radius[:, None]
        return [self.polygons.xy, self.xy - across, self.xy + across]

    def _summary(self) -> str:
        return counted(len(self), "disc")


def _holding(feet: NDArray[np.float64], center: NDArray[np.float64]) -> list[int]:
    """The first foot, and on each side the nearest to what is opposite."""
    ways = feet - center
    ways /= np.sqrt((ways * ways).sum(axis=1, keepdims=True))
    turn = ways[0, 0] * ways[:, 1] - ways[0, 1] * ways[:, 0]
    forward = dots(ways, ways[0])
    left, right = (np.flatnonzero(side) for side in (turn >= 0, turn < 0))
    chosen = [0, *(int(side[np.argmin(forward[side])]) for side in (left, right) if len(side))]
    return list(dict.fromkeys(chosen))
