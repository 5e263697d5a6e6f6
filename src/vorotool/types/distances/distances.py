"""Distances between two shapes, and the places where they are reached."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats
from vorotool.types.features import Rows, of_segments, without_places
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.table import Lookup, Table
from vorotool.types.values import Geometric, Pictured, Tabular, Value

HAUSDORFF, FROM_A, FROM_B, SMALLEST = "hausdorff", "a to b", "b to a", "smallest"
"""Names of distances in tables: the larger of both directions, each of them, and the smallest one."""


@frozen
class PlacePair:
    """Point of a shape, the nearest point of another shape, and their distance.

    Parameters
    ----------
    distance : float
        In the units of the input.
    on_a, on_b : tuple of float
        The x and y of the place on a, and of that on b.
    """

    distance: float
    on_a: tuple[float, float]
    on_b: tuple[float, float]

    def __float__(self) -> float:
        return self.distance


@frozen(eq=False, repr=False)
class Distances(Value, Tabular, Geometric, Pictured):
    """Distances between two shapes a and b: the Hausdorff distance, the smallest distance, or both.

    Parameters
    ----------
    from_a : PlacePair, optional
        The place of a that is farthest from b, and the place of b that is nearest to it: the directed Hausdorff
        distance from a to b.
    from_b : PlacePair, optional
        The place of b that is farthest from a, and the place of a that is nearest to it.
    smallest : PlacePair, optional
        The closest pair of points.
    shapes : tuple of PolygonSet
        The shapes a and b.
    is_boundary : bool
        Whether polygons stand for their outlines; else they are filled.

    Examples
    --------
    >>> from vorotool import hausdorff
    >>> found = hausdorff(["LINESTRING (0 0, 8 0)"], ["LINESTRING (0 1, 2 1)"])
    >>> found.distance == found.from_a.distance, found.from_a.on_a, found.from_a.on_b, float(found.from_b)
    (True, (8.0, 0.0), (2.0, 1.0), 1.0)
    """

    maker = "hausdorff"

    from_a: PlacePair | None
    from_b: PlacePair | None
    smallest: PlacePair | None
    shapes: tuple[PolygonSet, PolygonSet]
    is_boundary: bool = False

    @property
    def distance(self) -> float:
        """Hausdorff distance, the larger of the directed ones computed; without them the smallest distance."""
        rows = self.rows
        return (rows.get(HAUSDORFF) or rows.get(FROM_A) or rows.get(FROM_B) or rows[SMALLEST]).distance

    def __float__(self) -> float:
        return self.distance

    @property
    def rows(self) -> dict[str, PlacePair]:
        """Distances by name: those of ``hausdorff``, ``a to b``, ``b to a`` and ``smallest`` that exist."""
        found: dict[str, PlacePair] = {}
        if self.from_a is not None and self.from_b is not None:
            found[HAUSDORFF] = self.from_a if self.from_a.distance >= self.from_b.distance else self.from_b
        one_by_one = {FROM_A: self.from_a, FROM_B: self.from_b, SMALLEST: self.smallest}
        return found | {name: each for name, each in one_by_one.items() if each is not None}

    @property
    def crs(self) -> Any:
        """The ``crs`` member of the shapes."""
        a, b = self.shapes
        return b.crs if a.crs is None else a.crs

    @property
    def _made_of(self) -> PolygonSet:
        return self.shapes[0]

    @property
    def places(self) -> NDArray[np.float64]:
        """(n, 2, 2) the point on a and the point on b of each row."""
        return np.array([(each.on_a, each.on_b) for each in self.rows.values()]).reshape(-1, 2, 2)

    def table(self) -> Table:
        """Return a table with one row per distance.

        Returns
        -------
        Table
            ``what, distance, x_a, y_a, x_b, y_b``.
        """
        rows = self.rows
        places = self.places.reshape(-1, 4)
        return Table(
            {
                "what": Lookup(list(rows), np.arange(len(rows), dtype=np.int32)),
                "distance": np.array([each.distance for each in rows.values()]),
                **{name: places[:, k].copy() for k, name in enumerate(("x_a", "y_a", "x_b", "y_b"))},
            }
        )

    def _rows(self, what: str | None = None) -> Rows:
        return Rows(self._only(what).table())

    def _features(self, what: str | None = None, _flatten: float | None = None) -> Rows:
        found = self._only(what)
        return Rows(without_places(found.table()), {}, found, None, of_segments(found.places))

    def _only(self, what: str | None) -> Distances:
        """Leave the others out."""
        if what == "hausdorff":
            return replace(self, smallest=None)
        return replace(self, from_a=None, from_b=None) if what == "smallest" else self

    def _shown_places(self) -> list[Floats]:
        return [polygons.xy for polygons in self.shapes]

    def _summary(self) -> str:
        return ", ".join(f"{name} {each.distance:.6g}" for name, each in self.rows.items())
