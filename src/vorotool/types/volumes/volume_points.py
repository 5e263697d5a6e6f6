"""Points of space as they were read: coordinates and what the file said of each."""

from __future__ import annotations

from dataclasses import field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.types import fields as f
from vorotool.types.fields import record
from vorotool.types.points.point_set import Points
from vorotool.types.values import counted


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
