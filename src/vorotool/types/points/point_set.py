"""Points as they were read: coordinates and what the file said of each."""

from __future__ import annotations

from dataclasses import field, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import InputError, element
from vorotool.numeric.checks import check_index, whole_numbers
from vorotool.numeric.coordinates import coordinate_rows
from vorotool.types import fields as f
from vorotool.types.box import Box
from vorotool.types.fields import UNSTATED, YAxis, record
from vorotool.types.values import Geometric, Pictured, Tabular, Value, counted

if TYPE_CHECKING:
    from vorotool.types.features import Rows

LABEL = "label"
"""The column whose integers from 1 are the labels of points."""


class OfPoints(Value):
    """A value about each of some points, which may have labels and names of their own."""

    _places: ClassVar[str]
    """The field with the coordinates."""

    labels: NDArray[np.int64] | None
    index: Any

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.index is not None:
            check_index(self.index, len(getattr(self, self._places)), "point")

    @property
    def label_array(self) -> NDArray[np.int64]:
        """(n,) labels: the input's own, else 1 to n."""
        count = len(getattr(self, self._places))
        return np.arange(1, count + 1, dtype=np.int64) if self.labels is None else self.labels


class Points(OfPoints):
    """A list of points."""

    _places = "xy"
    """One letter an axis."""

    def __post_init__(self) -> None:
        rows = coordinate_rows(getattr(self, self._places), "point", len(self._places))  # a copy
        finite = np.isfinite(rows)
        if not finite.all():
            bad = np.flatnonzero(~finite.all(axis=1))
            row = int(bad[0])
            raise InputError(
                f"{element('point', row)} is ({', '.join(map(str, rows[row].tolist()))}): coordinates must be finite; "
                f"remove or repair it ({counted(bad.size, 'such point')})"
            )
        object.__setattr__(self, self._places, rows)
        if self.labels is not None:
            object.__setattr__(self, "labels", checked_labels(self.labels, len(self)))
        super().__post_init__()

    def __len__(self) -> int:
        return len(getattr(self, self._places))

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(getattr(self, self._places), dtype=dtype, copy=copy)


@record
class PointSet(Points, Tabular, Geometric, Pictured):
    """A list of points in the order of the input.

    Parameters
    ----------
    xy : (n, 2) float64 array
        Coordinates in the units of the input; finite. They are copied.
    labels : (n,) int64 array, optional
        The input's own labels (each at least 1). Without them point i has label i + 1.
    properties : dict of str to sequence, optional
        Other columns of the input, each of length n, copied to outputs that have one row or feature a point.
    y_axis : {"none", "up", "down"}
        Direction of y where the coordinates come from; "none" where nothing states it.
    crs : object, optional
        The ``crs`` member of a GeoJSON input, copied to GeoJSON outputs.
    first_number : {1, 0}
        Number of the first point in the input's own file: a ``.node`` file may count from 0.
    index : pandas Index, array or sequence, optional
        Names of the points in the input, such as the row index of a data frame: one entry per point.
    frame : Box, optional
        The rectangle covered by the pixels of the image that the points come from: the default frame of what is made
        of them.
    unit : str, optional
        The unit of length of the coordinates, such as ``mm``, where the input says it.

    Raises
    ------
    InputError
        If the shape is not (n, 2), a coordinate is not finite, masked or an integer beyond 2^53, or a label is below 1;
        the row is named.

    Examples
    --------
    >>> PointSet([[2, 1], [7, 5]]).label_array
    array([1, 2])
    """

    xy: NDArray[np.float64] = f.position("points", 2)
    labels: NDArray[np.int64] | None = f.numbers(np.int64, "points", default=None)
    properties: dict[str, Any] = field(default_factory=dict)
    y_axis: YAxis = f.y_axis(default=UNSTATED)
    crs: Any = None
    first_number: int = 1
    index: Any = None
    frame: Box | None = f.input_box()
    unit: str | None = None

    def _rows(self, _what: str | None = None) -> Rows:
        x, y = np.ascontiguousarray(self.xy.T)
        return replace(self._features(), columns={"label": self.label_array, "x": x, "y": y})

    def _features(self, _what: str | None = None, _flatten: float | None = None) -> Rows:
        from vorotool.types.features import point_rows  # it imports this module

        return point_rows({"label": self.label_array}, self, self.xy)

    def _summary(self) -> str:
        return counted(len(self), "point")


def known_of_points(points: Any) -> dict[str, Any]:
    """Return what is known of points beside their places, as results have it, too.

    Labels that repeat name groups of points, not points: they become a property.
    """
    known = {name: getattr(points, name) for name in ("labels", "properties", "y_axis", "crs", "index")}
    labels = known["labels"]
    if labels is not None and not (labels[1:] > labels[:-1]).all() and len(np.unique(labels)) < len(labels):
        name = LABEL if LABEL not in known["properties"] else f"voro_{LABEL}"
        known |= {"labels": None, "properties": {name: labels.tolist(), **known["properties"]}}
    return known


def labels_of(values: Any) -> NDArray[np.int64] | None:
    """Return the values of a column as labels; None if one of them is not an integer from 1."""
    try:
        is_flag = np.asarray(values).dtype.kind == "b"
        return None if is_flag else checked_labels(values, len(values))
    except (InputError, ValueError):
        return None


def checked_labels(labels: Any, count: int) -> NDArray[np.int64]:
    """Return the labels of so many points, each from 1 to 4294967295."""
    array = whole_numbers(labels, "label of point", np.uint32, 1)
    if array.shape != (count,):
        raise InputError(f"labels must have shape ({count},), but have shape {array.shape}")
    return array.astype(np.int64)


@record
class VolumePoints(Points):
    """A list of points in space in the order of the input.

    Parameters
    ----------
    xyz : (n, 3) float64 array
        Coordinates in voxels, x, y and z; finite. They are copied.
    labels : (n,) int64 array, optional
        The input's own labels (each at least 1). Without them point i has label i + 1.
    properties : dict of str to sequence, optional
        Other columns of the input, each of length n.
    index : pandas Index, array or sequence, optional
        Names of the points in the input, such as the row index of a data frame: one entry per point.

    Raises
    ------
    InputError
        If the shape is not (n, 3), a coordinate is not finite, masked or an integer beyond 2^53, or a label is below 1;
        the row is named.

    Examples
    --------
    >>> VolumePoints([[2, 1, 0], [7, 5, 3]]).label_array
    array([1, 2])
    """

    _places = "xyz"

    xyz: NDArray[np.float64] = f.position("points", 3)
    labels: NDArray[np.int64] | None = f.numbers(np.int64, "points", default=None)
    properties: dict[str, Any] = field(default_factory=dict)
    index: Any = None

    def _summary(self) -> str:
        return f"{counted(len(self), 'point')} in space"
