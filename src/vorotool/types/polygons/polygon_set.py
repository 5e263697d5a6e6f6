"""Polygons and open lines as they were given: rings in flat arrays, and what the input said of each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vorotool.errors import InputError
from vorotool.numeric.arrays import Floats, divides, following, mask_of, starts_of, within
from vorotool.numeric.checks import check_index
from vorotool.numeric.coordinates import coordinate_rows
from vorotool.types import fields as f
from vorotool.types.box import Box
from vorotool.types.fields import UNSTATED, YAxis, record, with_fitting
from vorotool.types.identity import feature_labels, names_of, other_columns
from vorotool.types.values import Geometric, Pictured, Tabular, Value, counted

if TYPE_CHECKING:
    from vorotool.types.features import Rows

SHELL, HOLE, LINE = 0, 1, 2
"""Kinds of rings: the outer boundary of a polygon, a hole in it, an open line."""

_KIND_NAMES = ("shell", "hole", "line")


@record
class PolygonSet(Value, Tabular, Geometric, Pictured):
    """Polygons and open lines in the order of the input, each vertex once: rings do not repeat their first one.

    A polygon is a shell followed by its holes; an open line counts as a polygon of one ring. What lies in a polygon is
    inside its shell and in none of its holes, each ring by the even-odd rule; nothing else is asked of the rings here.

    Parameters
    ----------
    xy : (n, 2) float64 array
        Vertices of all rings, one ring after the other, in the units of the input; finite. All arrays are copied.
    ring_starts : (r + 1,) int64 array
        Ring k has the vertices ``ring_starts[k]`` to ``ring_starts[k + 1] - 1``, at least one.
    ring_kind : (r,) int8 array
        `SHELL`, `HOLE` or `LINE`. A line that ends where it begins repeats its first vertex.
    ring_polygon : (r,) int32 array
        The polygon of each ring: from 0, not decreasing, without gaps.
    ids : sequence, optional
        The input's own name of each polygon; None for one without.
    feature : (p,) int32 array, optional
        The object of the input that each polygon is a part of, from 0, not decreasing. By default each is its own.
    properties : dict of str to sequence, optional
        Other columns of the input, one value per polygon.
    y_axis : {"none", "up", "down"}
        Direction of y where the coordinates come from; "none" where nothing states it.
    crs : object, optional
        The ``crs`` member of a GeoJSON input, copied to GeoJSON outputs.
    connectivity : {8, 4}, optional
        Of the pixels that these are the crack outlines of. 8: pieces of a polygon that meet at a vertex only hang
        together there; rings run along both, and no two cross. 4: what is outside does. By default neither.
    unit : str, optional
        The unit of length of the coordinates, such as ``mm``, where the input says it.
    index : pandas Index, array or sequence, optional
        Names of the polygons in the input, such as the row index of a data frame: one entry per polygon.
    frame : Box, optional
        The rectangle covered by the pixels of the image that the outlines come from: the default frame of what is made
        of them.
    page : Box, optional
        The page of the drawing that the polygons come from, in its coordinates.
    is_drawing : bool
        Whether they come from a drawing, whose pictures are 1:1 by default.

    Raises
    ------
    InputError
        If an array has another shape or order, or a coordinate is not finite; polygon, ring and vertex are named.

    Examples
    --------
    >>> shapes = PolygonSet([[0, 0], [4, 0], [0, 3], [1, 1], [2, 1], [1, 2], [5, 0], [6, 1]],
    ...                     [0, 3, 6, 8], [SHELL, HOLE, LINE], [0, 0, 1])
    >>> len(shapes), shapes.ring(1).tolist(), shapes.part.tolist()
    (2, [[1.0, 1.0], [2.0, 1.0], [1.0, 2.0]], [1, 1])
    """

    xy: NDArray[np.float64] = f.position("vertices", 2)
    ring_starts: NDArray[np.int64] = f.numbers(np.int64, "starts")
    ring_kind: NDArray[np.int8] = f.numbers(np.int8, "rings")
    ring_polygon: NDArray[np.int32] = f.index("rings")
    ids: Sequence[Any] | None = None
    feature: NDArray[np.int32] = f.index("polygons", default=None)  # filled in where it is not given
    properties: dict[str, Any] = field(default_factory=dict)
    y_axis: YAxis = f.y_axis(default=UNSTATED)
    crs: Any = None
    connectivity: int | None = None
    unit: str | None = None
    index: Any = None
    frame: Box | None = f.input_box()
    page: Box | None = f.input_box()
    is_drawing: bool = field(default=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "xy", coordinate_rows(self.xy, "vertex"))
        for name, dtype in (("ring_starts", np.int64), ("ring_kind", np.int8), ("ring_polygon", np.int32)):
            object.__setattr__(self, name, _integers(getattr(self, name), dtype, name))
        _check_rings(self.ring_starts, self.ring_kind, self.ring_polygon, len(self.xy))
        count = len(self)
        feature = np.arange(count) if self.feature is None else self.feature
        object.__setattr__(self, "feature", _checked_features(feature, count))
        super().__post_init__()
        for name, values in [*self.properties.items(), ("ids", self.ids)]:
            if values is not None and len(values) != count:
                raise InputError(f"{name} must hold one value per polygon, {count}, but holds {len(values)}")
        check_index(self.index, count, "polygon")
        if self.connectivity not in (None, 4, 8):
            raise InputError(f"connectivity is {self.connectivity}: it must be 4 or 8, or left out")
        self._check_finite()

    def _check_finite(self) -> None:
        finite = np.isfinite(self.xy)
        if not finite.all():
            bad = np.flatnonzero(~finite.all(axis=1))
            at = int(bad[0])
            raise InputError(
                f"{self.place(at)} is ({self.xy[at, 0]}, {self.xy[at, 1]}): coordinates must be finite; "
                f"remove or repair it ({counted(bad.size, 'such vertex', 'such vertices')})"
            )

    def __len__(self) -> int:
        return int(self.ring_polygon[-1]) + 1 if len(self.ring_polygon) else 0

    @cached_property
    def part(self) -> NDArray[np.int32]:
        """(p,) number of each polygon within its feature, from 1."""
        first = np.flatnonzero(np.diff(self.feature, prepend=-1))
        return (within(np.diff(first, append=len(self.feature))) + 1).astype(np.int32)

    @cached_property
    def labels(self) -> NDArray[np.int64]:
        """(p,) label of the feature of each polygon: what its column ``label`` holds, else its number from 1."""
        return feature_labels(self.feature, self.properties)

    @cached_property
    def other_columns(self) -> dict[str, Any]:
        """The properties without the columns that hold the labels and the ids."""
        found = other_columns(self.properties, self.labels)
        return found if self.ids is not None else {name: column for name, column in found.items() if name != "id"}

    @property
    def feature_ids(self) -> Sequence[Any] | None:
        """The ids of the input, or its column ``id``."""
        return self.properties.get("id") if self.ids is None else self.ids

    @property
    def as_given(self) -> PolygonSet:
        """These polygons with the coordinates of the input, where an engine has moved vertices to a lattice."""
        return self.__dict__.get("_as_given", self)

    def moved(self, xy: NDArray[np.float64]) -> PolygonSet:
        """Move the vertices: `as_given` of what is returned has those of these polygons.

        Examples
        --------
        >>> moved = set_of_rings([[0, 0], [4.1, 0], [0, 3]], [3], [SHELL], [0]).moved([[0, 0], [4, 0], [0, 3]])
        >>> moved.xy[1].tolist(), moved.as_given.xy[1].tolist()
        ([4.0, 0.0], [4.1, 0.0])
        """
        places = coordinate_rows(xy, "vertex")
        made = with_fitting(self, xy=places) if len(places) == len(self.xy) else replace(self, xy=places)
        made._check_finite()
        made.__dict__["_as_given"] = self.as_given
        return made

    @cached_property
    def polygon_starts(self) -> NDArray[np.int64]:
        """(p + 1,) first ring of each polygon, and the number of rings."""
        return np.searchsorted(self.ring_polygon, np.arange(len(self) + 1)).astype(np.int64)

    @cached_property
    def is_line(self) -> NDArray[np.bool_]:
        """(p,) whether each is an open line."""
        return np.equal(self.ring_kind[self.polygon_starts[:-1]], LINE)

    @cached_property
    def following(self) -> NDArray[np.int64]:
        """(n,) the vertex after each one around its ring."""
        return following(self.ring_starts)

    @cached_property
    def ends_line(self) -> NDArray[np.bool_]:
        """(n,) whether each vertex is the last of a line: no edge leads on from it."""
        return mask_of((self.ring_starts[1:] - 1)[self.ring_kind == LINE], len(self.xy))

    @property
    def edge_starts(self) -> NDArray[np.int64]:
        """(k,) vertices that edges begin at; a lone vertex is one that ends there, too."""
        return np.flatnonzero(~self.ends_line | (self.following == np.arange(len(self.xy))))

    def ring(self, index: int) -> NDArray[np.float64]:
        """(k, 2) vertices of a ring: a view."""
        return self.xy[self.ring_starts[index] : self.ring_starts[index + 1]]

    def rings_of(self, polygon: int) -> Iterator[NDArray[np.float64]]:
        """Vertices of the shell of a polygon, then of its holes; of a line, its own."""
        for index in range(*self.polygon_starts[polygon : polygon + 2].tolist()):
            yield self.ring(index)

    def place(self, vertex: int) -> str:
        """Words for the place of a vertex, all counted from 1: ``polygon 2, hole 1, vertex 5``."""
        ring = int(np.searchsorted(self.ring_starts, vertex, side="right")) - 1
        return f"{self.ring_place(ring)}, vertex {vertex - int(self.ring_starts[ring]) + 1}"

    def ring_place(self, ring: int) -> str:
        """Words for a ring, all counted from 1: ``polygon 2, hole 1``."""
        polygon = int(self.ring_polygon[ring])
        kind = int(self.ring_kind[ring])
        nth = f" {ring - int(self.polygon_starts[polygon])}" if kind == HOLE else ""
        return f"polygon {polygon + 1}, {_KIND_NAMES[kind]}{nth}"

    def _features(self, _what: str | None = None, _flatten: float | None = None) -> Rows:
        from vorotool.types.features import Rows  # it imports this module

        every = np.arange(len(self))
        names = names_of(self, every)
        if self.feature_ids is None:
            del names["id"]
        return Rows(names, self.other_columns, self, every, self)

    def _shown_places(self) -> list[Floats]:
        return [self.xy]

    def _summary(self) -> str:
        lines = int(np.count_nonzero(self.ring_kind == LINE))
        kinds = [counted(len(self) - lines, "polygon"), *([counted(lines, "line")] if lines else [])]
        return ", ".join([*kinds, counted(len(self.xy), "vertex", "vertices")])


def set_of_rings(
    xy: ArrayLike, sizes: ArrayLike, kinds: ArrayLike, polygons: ArrayLike, **described: Any
) -> PolygonSet:
    """Make a `PolygonSet` of rings that may repeat their first vertex at their end, once or more."""
    vertices = coordinate_rows(xy, "vertex")
    lengths = np.array(sizes, dtype=np.int64).reshape(-1)
    starts = starts_of(lengths)
    kept = np.ones(len(vertices), dtype=bool)
    ring = np.flatnonzero((lengths > 1) & (np.asarray(kinds) != LINE))
    while ring.size:
        last = starts[ring] + lengths[ring] - 1
        repeated = (vertices[starts[ring]] == vertices[last]).all(axis=1)
        kept[last[repeated]] = False
        ring = ring[repeated]
        lengths[ring] -= 1
        ring = ring[lengths[ring] > 1]
    return PolygonSet(vertices[kept], starts_of(lengths), kinds, polygons, **described)  # type: ignore[arg-type]


def _integers(values: Any, dtype: Any, name: str) -> NDArray[Any]:
    array = np.array(values, dtype=dtype, order="C")
    if array.ndim != 1:
        raise InputError(f"{name} must have one dimension, but has shape {array.shape}")
    return array


def _check_rings(
    starts: NDArray[np.int64], kinds: NDArray[np.int8], polygons: NDArray[np.int32], vertices: int
) -> None:
    if len(starts) != len(kinds) + 1 or len(kinds) != len(polygons):
        raise InputError(
            f"ring_starts, ring_kind and ring_polygon have {len(starts)}, {len(kinds)} and {len(polygons)} values; "
            "for r rings give r + 1, r and r"
        )
    if not divides(starts, vertices, least=1):
        raise InputError(f"ring_starts must increase from 0 to the number of vertices, {vertices}, without empty rings")
    begins = polygons[1:] != polygons[:-1]  # of each ring but the first: whether it is that of another polygon
    if len(polygons) and (polygons[0] != 0 or (polygons[1:] - polygons[:-1] != begins).any()):
        raise InputError("ring_polygon must increase from 0 without gaps: number the polygons in order")
    if (kinds[:1] == HOLE).any() or ((kinds[1:] == HOLE) == begins).any() or (kinds[:-1][~begins] == LINE).any():
        raise InputError("the rings of a polygon must be a shell and then holes, or one line")
    if ((kinds < SHELL) | (kinds > LINE)).any():
        raise InputError("ring_kind must be 0 (shell), 1 (hole) or 2 (line)")


def _checked_features(values: Any, count: int) -> NDArray[np.int32]:
    feature = _integers(values, np.int32, "feature")
    if len(feature) != count:
        raise InputError(f"feature must hold one value per polygon, {count}, but holds {len(feature)}")
    if count and (feature[0] < 0 or (feature[1:] < feature[:-1]).any()):
        raise InputError("feature must not decrease: the parts of a feature are consecutive")
    return feature
