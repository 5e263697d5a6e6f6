"""Points of space as they were read: coordinates and what the file said of each."""

from __future__ import annotations

from dataclasses import field
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.numeric.checks import check_index
from vorotool.types import fields as f
from vorotool.types.fields import record
from vorotool.types.points.point_set import checked_labels, finite_rows
from vorotool.types.values import Value, counted


@record
class VolumePoints(Value):
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

    xyz: NDArray[np.float64] = f.position("points", 3)
    labels: NDArray[np.int64] | None = f.numbers(np.int64, "points", default=None)
    properties: dict[str, Any] = field(default_factory=dict)
    index: Any = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "xyz", finite_rows(self.xyz, 3))
        if self.labels is not None:
            object.__setattr__(self, "labels", checked_labels(self.labels, len(self.xyz)))
        super().__post_init__()
        check_index(self.index, len(self.xyz), "point")

    def __len__(self) -> int:
        return len(self.xyz)

    @property
    def label_array(self) -> NDArray[np.int64]:
        """(n,) labels: the input's own, else 1 to n."""
        if self.labels is not None:
            return self.labels
        return np.arange(1, len(self.xyz) + 1, dtype=np.int64)

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self.xyz, dtype=dtype, copy=copy)

    def _summary(self) -> str:
        return f"{counted(len(self), 'point')} in space"
