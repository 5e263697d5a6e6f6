"""Places along skeletons and centerlines, and the segments between their feet."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.types import fields as f
from vorotool.types.features import Corners, Rows, chosen, of_points, of_polygons, of_segments, without_places
from vorotool.types.fields import record
from vorotool.types.identity import names_of, part_table, place_columns
from vorotool.types.polygons.planar_graph import moved_feet
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.table import Table
from vorotool.types.values import Pictured, Tabular, Value, WithParts, counted


@record
class SkeletonPoints(Value, Tabular, WithParts, Pictured):
    """Points along the branches of a skeleton, or along centerlines, in their order.

    Parameters
    ----------
    skeleton : Skeleton
        What they are on; of centerlines the arcs.
    arc : (n,) int64 array
        Its arc that each is on; of what leads on from a centerline the arc at that end.
    along : (n,) float64 array
        How far each is from the beginning of its branch, along the branch; of a centerline with what leads on.
    xy : (n, 2) float64 array
        Places.
    radius : (n,) float64 array
        Their clearance.
    feet : (n, 2, 2) float64 array
        The nearest place on the site left of the arc, and on that to its right; of centerlines where the straight line
        across meets the outline first.
    rings : (n, 2) int32 array, optional
        Of centerlines alone: the ring of the polygon that each foot is on, 0 for the shell, else the hole; -1 where the
        place is on the outline itself.

    Raises
    ------
    InputError
        If an array has another shape.

    Examples
    --------
    >>> from vorotool import points_along, skeleton_exact
    >>> points = points_along(skeleton_exact([[0, 0], [8, 0], [8, 2], [0, 2]]), every=2)
    >>> points.feet[points.radius == 1].tolist()
    [[[1.0, 2.0], [1.0, 0.0]], [[3.0, 2.0], [3.0, 0.0]], [[5.0, 2.0], [5.0, 0.0]], [[7.0, 2.0], [7.0, 0.0]]]
    """

    skeleton: Skeleton = f.nested()
    arc: NDArray[np.int64] = f.numbers(np.int64, "points")
    along: NDArray[np.float64] = f.length("points")
    xy: NDArray[np.float64] = f.position("points", 2)
    radius: NDArray[np.float64] = f.length("points")
    feet: NDArray[np.float64] = f.position("points", 2, 2)
    rings: NDArray[np.int32] | None = f.index("points", 2, default=None)

    def __len__(self) -> int:
        return len(self.arc)

    @cached_property
    def polygon(self) -> NDArray[np.int32]:
        """(n,) the polygon that each is in; -1 outside."""
        return self.skeleton.polygon[self.arc]

    @cached_property
    def spans(self) -> NDArray[np.bool_]:
        """(n,) whether there is a segment between both feet: not in a corner."""
        return np.asarray((self.feet[:, 0] != self.feet[:, 1]).any(axis=1))

    @cached_property
    def width(self) -> NDArray[np.float64]:
        """(n,) twice the radius; of centerlines the length of the section."""
        return 2 * self.radius if self.rings is None else hypotenuse(*(self.feet[:, 1] - self.feet[:, 0]).T)

    @cached_property
    def as_given(self) -> SkeletonPoints:
        """The same with corners and feet on the polygons of the input: those of `skeleton` are on a lattice."""
        skeleton = self.skeleton.as_given
        if skeleton is self.skeleton:
            return self
        if self.rings is not None:
            return replace(self, skeleton=skeleton)  # sections are those of the input from the beginning
        feet = moved_feet(self.skeleton, self.skeleton.sites[self.arc], self.feet)
        xy = np.where(self.radius[:, None] == 0, feet[:, 0], self.xy)
        return replace(self, skeleton=skeleton, xy=xy, feet=feet)

    def table(self) -> Table:
        """Return a table with one row per point.

        Returns
        -------
        Table
            ``label, id, branch, arc, side, along, x, y, r, width, x_a, y_a, x_b, y_b``: foot a is on the left of the
            arc. The width is from foot to foot along centerlines, else twice the radius. Outside there is no polygon.
            Centerlines have ``ring_a, ring_b``, too: numbers of holes, 0 for the shell.
        """
        return part_table(self.columns(), self.skeleton.polygons, self.polygon)

    def columns(self) -> dict[str, Any]:
        """Return the columns of the table that are not of the input."""
        skeleton, arc, given = self.skeleton, self.arc, self.as_given
        return {
            **names_of(skeleton.polygons, self.polygon),
            "branch": skeleton.branch[arc],
            "arc": arc,
            "side": skeleton.side_names(arc),
            "along": self.along,
            **place_columns(given.xy),
            "r": self.radius,
            "width": self.width,
            **place_columns(given.feet[:, 0], "_a"),
            **place_columns(given.feet[:, 1], "_b"),
            **self._ring_columns(),
        }

    def _ring_columns(self) -> dict[str, Any]:
        if self.rings is None:
            return {}
        sides = zip(("ring_a", "ring_b"), self.rings.T, strict=True)
        return {name: np.ma.array(ring, mask=ring < 0) for name, ring in sides}

    def transects(self) -> SkeletonPoints:
        """Return the points with a segment from foot to foot."""
        kept = self.spans
        rings = None if self.rings is None else self.rings[kept]
        places = self.along[kept], self.xy[kept], self.radius[kept], self.feet[kept]
        return SkeletonPoints(self.skeleton, self.arc[kept], *places, rings)

    def _rows(self, what: str | None = None) -> Rows:
        points = self.transects() if what == "transects" else self
        return Rows(points.table(), source=self.skeleton.polygons, item=points.polygon)

    def _features(self, what: str | None = None, _flatten: float | None = None) -> Rows:
        return chosen(self, what, {"points": self._points, "transects": self.transects()._segments})

    def _points(self) -> Rows:
        return self._located(of_points(self.as_given.xy), "x", "y")

    def _segments(self) -> Rows:
        return self._located(of_segments(self.as_given.feet), "x_a", "y_a", "x_b", "y_b")

    def _located(self, geometry: Corners, *places: str) -> Rows:
        columns = without_places(Table(self.columns()), *places)
        return of_polygons(columns, self.skeleton.polygons, self.polygon, geometry=geometry, is_part=True)

    def _matrix(self, what: str) -> NDArray[np.float64]:
        return (self.transects() if what == "transects" else self).as_given.xy

    def _summary(self) -> str:
        return counted(len(self), "point")
