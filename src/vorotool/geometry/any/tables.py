"""The table of any value, for a data frame."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError
from vorotool.geometry.mesh.tables import edge_table
from vorotool.geometry.mesh.triangulation import Triangulation
from vorotool.geometry.skeleton.centerline import Centerlines, centerline_table
from vorotool.geometry.skeleton.offsets import Offsets
from vorotool.geometry.skeleton.points_along import SkeletonPoints
from vorotool.geometry.skeleton.skeleton import Skeleton
from vorotool.geometry.skeleton.tables import arc_table
from vorotool.geometry.table import Table


def table(value: Any) -> dict[str, NDArray[Any]]:
    """Give the columns of a table as arrays: of the edges of a triangulation, arcs, points along these, or offsets.

    Parameters
    ----------
    value : Table, Triangulation, Skeleton, SkeletonPoints, Offsets or Centerlines
        What to tell about; fields that do not exist are masked, None, or NaN.

    Returns
    -------
    dict of arrays
        By the names of the columns; all have one length.

    Raises
    ------
    UsageError
        If there is no table of it.

    Examples
    --------
    >>> import vorotool
    >>> table(vorotool.skeleton_exact([[0, 0], [4, 0], [0, 3]]))["kind"].tolist()
    ['line', 'line', 'line']
    """
    if isinstance(value, Triangulation):
        value = edge_table(value)
    elif isinstance(value, Skeleton):
        value = arc_table(value)
    elif isinstance(value, Centerlines):
        value = centerline_table(value)
    elif isinstance(value, SkeletonPoints | Offsets):
        value = value.table()
    if not isinstance(value, Table):
        raise UsageError(
            f"there is no table of a {type(value).__name__}: give a Table, Triangulation, Skeleton, SkeletonPoints, "
            "Offsets or Centerlines"
        )
    return {name: column if isinstance(column, np.ndarray) else np.array(column) for name, column in value.items()}
