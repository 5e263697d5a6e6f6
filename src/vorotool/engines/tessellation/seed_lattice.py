"""Points on the lattice of seeds, whose step is a pixel or voxel, or down to 1/256 of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import NO_PROPERTIES, STRICT, InputError, warn
from vorotool.geometry.curves.inverse_functions import hypotenuse
from vorotool.geometry.points.seed_set import FINEST_SCALE
from vorotool.geometry.row_index import index_of_rows

if TYPE_CHECKING:
    from vorotool.geometry.points.point_set import PointSet
    from vorotool.geometry.volumes.volume_points import VolumePoints

LARGEST_COORDINATE = float(2**44)
"""Coordinates up to here, times 256, are exact in a double."""

_CELL = {2: "pixel", 3: "voxel"}


class SnappedPlaces(NamedTuple):
    """Places on the coarsest lattice that holds them.

    Parameters
    ----------
    steps : (n, axes) int64 array
        In steps of 1 / ``scale``.
    scale : int
        A power of two from 1 to 256.
    moved : (n,) bool array
        Which of them lay on none of these lattices.
    largest_move : float
        The largest of their moves, in pixels or voxels.
    """

    steps: NDArray[np.int64]
    scale: int
    moved: NDArray[np.bool_]
    largest_move: float

    @property
    def moves(self) -> int:
        """How many were moved."""
        return int(self.moved.sum())


def snapped_places(places: NDArray[np.float64]) -> SnappedPlaces:
    """Put places on the lattice; what is finer than 1/256 moves to the nearest multiple.

    Parameters
    ----------
    places : (n, 2) or (n, 3) float64 array
        Finite.

    Raises
    ------
    InputError
        If a coordinate is beyond 2^44.

    Examples
    --------
    >>> snapped_places(np.array([[0.5, 2.0], [7.0, 5.0]])).steps.tolist()
    [[1, 4], [14, 10]]
    """
    far = np.flatnonzero((np.abs(places) > LARGEST_COORDINATE).any(axis=1))
    if far.size:
        raise InputError(
            f"point {far[0] + 1} is ({', '.join(f'{each:.17g}' for each in places[far[0]].tolist())}): "
            f"coordinates of seeds must be at most 2^44 {_CELL[places.shape[1]]}s; scale the points"
        )
    fine = places * FINEST_SCALE
    steps = np.rint(fine)
    moved = (steps != fine).any(axis=1)
    largest_move = 0.0
    if moved.any():
        first, *others = (fine - steps).T
        for other in others:
            first = hypotenuse(first, other)
        largest_move = float(first.max()) / FINEST_SCALE
    lattice = steps.astype(np.int64)
    scale = _coarsest_scale(lattice)
    lattice //= FINEST_SCALE // scale
    return SnappedPlaces(lattice, scale, moved, largest_move)


def sites_of_points(
    places: NDArray[np.float64], labels: NDArray[np.uint32], points: PointSet | VolumePoints
) -> dict[str, Any]:
    """Give the sites in increasing label order; points that share a label leave the choice to the type of the seeds.

    Parameters
    ----------
    places : (n, axes) float64 array
        Of the seeds.
    labels : (n,) uint32 array
        Of the points.
    points : PointSet or VolumePoints
        What else is known of them.

    Raises
    ------
    InputError
        If points share a label and bring further columns.
    """
    if points.labels is None:
        return {"sites": places, "site_labels": labels, "properties": points.properties, "index": points.index}
    order = np.argsort(labels, kind="stable")
    if len(labels) and (np.diff(labels[order].astype(np.int64)) == 0).any():
        if points.properties:
            raise InputError(f"points that share a label cannot bring further columns: use {NO_PROPERTIES}")
        return {}
    properties = {name: [column[i] for i in order] for name, column in points.properties.items()}
    index = index_of_rows(points.index, order)
    return {"sites": places[order], "site_labels": labels[order], "properties": properties, "index": index}


def report_snapped(places: NDArray[np.float64], snapped: SnappedPlaces, *, strict: bool) -> None:
    """Tell how many places moved to the lattice, if any did, or refuse them.

    Raises
    ------
    InputError
        If they are refused.

    Warns
    -----
    VorotoolWarning
        With their number and the largest move.
    """
    count, cell = snapped.moves, _CELL[places.shape[1]]
    if not count:
        return
    if strict:
        row = int(np.flatnonzero(snapped.moved)[0])
        raise InputError(
            f"point {row + 1} is ({', '.join(map(str, places[row].tolist()))}): seeds lie on multiples of 1/256 {cell} "
            f"({count} such points); round them or leave out {STRICT}"
        )
    warn(
        f"{count} of {len(places)} seeds moved to the nearest 1/256 {cell}, by at most {snapped.largest_move:.6f} "
        f"{cell}s"
    )


def _coarsest_scale(lattice: NDArray[np.int64]) -> int:
    """The smallest power of two of steps a pixel for coordinates given in 1/256 pixel."""
    used = int(np.bitwise_or.reduce(lattice, axis=None)) & (FINEST_SCALE - 1)
    return FINEST_SCALE // (used & -used) if used else 1
