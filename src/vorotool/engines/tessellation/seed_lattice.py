"""Points on the lattice of seeds, whose step is a pixel or voxel, or a part of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import reduce
from math import ceil, floor
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import STRICT, InputError, warn
from vorotool.numeric.checks import index_of_rows
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.types.pixels import CELL, SQUARE, Frame, PixelSides
from vorotool.types.points.seed_set import SCALES
from vorotool.types.values import counted
from vorotool.types.volumes.volume import FINEST_SCALE

if TYPE_CHECKING:
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.volumes.volume_points import VolumePoints

LARGEST_COORDINATE = float(2**44)
"""Coordinates up to here, times 256, are exact in a double."""

_MOST_STEPS = 2**40
"""The bound of the exact arithmetic: see `src/core/tessellation/sweep_arithmetic.hpp`."""

_MOST_COUNTED = 2**61
"""Coordinates in steps, seen from the origin, stay below: sums of them fit 64 bits."""

_LARGE_MOVE = 2.0**-20
"""Seeds of decimals move by less, in pixels or voxels, where the lattice is not coarse for the frame."""


class SnappedPlaces(NamedTuple):
    """Places on the coarsest lattice that holds them."""

    steps: NDArray[np.int64]  # (n, axes) int64 array: in steps of 1 / `scale`
    scale: int  # a power of two, at most `finest`
    moved: NDArray[np.bool_]  # (n,) bool array: which of them lay on none of these lattices
    largest_move: float  # the largest of their moves, in pixels or voxels
    finest: int  # the steps a pixel or voxel of the finest of these lattices

    @property
    def moves(self) -> int:
        """How many were moved."""
        return int(self.moved.sum())


def finest_scale(places: NDArray[np.float64], frame: Frame, sides: PixelSides = SQUARE) -> int:
    """Give the steps a pixel of the finest lattice on which a tessellation is computed exactly."""
    low, high = (frame.x, frame.y), (frame.x + frame.width, frame.y + frame.height)
    of_frame = _scale_within(low, high, sides)
    if len(places):
        low = (min(low[0], floor(places[:, 0].min())), min(low[1], floor(places[:, 1].min())))
        high = (max(high[0], ceil(places[:, 0].max())), max(high[1], ceil(places[:, 1].max())))
    return max(_scale_within(low, high, sides), min(of_frame, FINEST_SCALE))


def _scale_within(low: tuple[int, int], high: tuple[int, int], sides: PixelSides) -> int:
    """Give the largest power of two of steps a pixel for a box of pixels."""
    extent = max((b - a) * side for a, b, side in zip(low, high, (sides.x, sides.y), strict=True))
    most: int = min(_MOST_STEPS // extent, _MOST_COUNTED // max(map(abs, low + high)))
    return SCALES[max(most.bit_length() - 1, 0)]


def least_frame(places: NDArray[np.float64]) -> Frame:
    """Give the frame that is likely to be asked for later: the least at the origin that holds the points."""
    low = [min(floor(column.min(initial=0)), 0) for column in places.T]
    high = [floor(column.max(initial=0) + 0.5) + 1 for column in places.T]
    return Frame(low[0], low[1], high[0] - low[0], high[1] - low[1])


def on_coarser_lattice(seeds: Any, frame: Any, sides: PixelSides, *, strict: bool) -> Any:
    """Give seeds of a lattice that is too fine for a frame on the finest one that is not."""
    if seeds.scale <= FINEST_SCALE or not len(seeds):
        return seeds
    places = np.stack([seeds.x, seeds.y], axis=1) / seeds.scale
    finest = finest_scale(places, frame, sides)
    if seeds.scale <= finest:
        return seeds
    snapped = snapped_places(places, finest)
    report_snapped(places, snapped, strict=strict)
    return replace(
        seeds,
        x=snapped.steps[:, 0],
        y=snapped.steps[:, 1],
        scale=snapped.scale,
        snapped=max(seeds.snapped, snapped.moves),
        largest_move=seeds.largest_move + snapped.largest_move,
    )


def snapped_places(places: NDArray[np.float64], finest: int = FINEST_SCALE) -> SnappedPlaces:
    """Put places on the lattice; what is finer than its steps moves to the nearest multiple."""
    far = np.flatnonzero((np.abs(places) > LARGEST_COORDINATE).any(axis=1))
    if far.size:
        raise InputError(
            f"point {far[0] + 1} is ({', '.join(f'{each:.17g}' for each in places[far[0]].tolist())}): "
            f"coordinates of seeds must be at most 2^44 {CELL[places.shape[1]]}s; scale the points"
        )
    fine = places * finest
    steps = np.rint(fine)
    moved = (steps != fine).any(axis=1)
    largest_move = 0.0
    if moved.any():
        moves = fine - steps
        largest = moves[int(np.argmax(sum(column * column for column in moves.T)))]
        largest_move = float(reduce(hypotenuse, largest)) / finest
    lattice = steps.astype(np.int64)
    scale = _coarsest_scale(lattice, finest)
    lattice //= finest // scale
    return SnappedPlaces(lattice, scale, moved, largest_move, finest)


def sites_of_points(
    places: NDArray[np.float64], labels: NDArray[np.uint32], points: PointSet | VolumePoints, *, strict: bool
) -> dict[str, Any]:
    """Give the sites in increasing label order; points that share a label leave the choice to the type of the seeds."""
    if points.labels is None:
        return {"sites": places, "site_labels": labels, "properties": points.properties, "index": points.index}
    order = np.argsort(labels, kind="stable")
    if len(labels) and (np.diff(labels[order].astype(np.int64)) == 0).any():
        return {"properties": _columns_of_regions(points.properties, labels, order, strict=strict)}
    properties = {name: [column[i] for i in order] for name, column in points.properties.items()}
    index = index_of_rows(points.index, order)
    return {"sites": places[order], "site_labels": labels[order], "properties": properties, "index": index}


def _columns_of_regions(
    columns: Mapping[str, Sequence[Any]], labels: NDArray[np.uint32], order: NDArray[np.integer], *, strict: bool
) -> dict[str, list[Any]]:
    """Return columns with one value a label, in the order of labels: those in which points of a label agree."""
    ordered = labels[order]
    first = order[np.searchsorted(ordered, ordered)]
    chosen = order[np.flatnonzero(np.diff(ordered, prepend=0))]
    kept = {
        name: [column[i] for i in chosen.tolist()]
        for name, column in columns.items()
        if all(column[a] == column[b] for a, b in zip(order.tolist(), first.tolist(), strict=True))
    }
    if len(kept) < len(columns):
        dropped = ", ".join(name for name in columns if name not in kept)
        what = f"points of one label differ in {dropped}"
        if strict:
            raise InputError(f"{what}: remove these columns, or leave out {STRICT}")
        warn(f"{what}: these columns are dropped from the results")
    return kept


def report_snapped(places: NDArray[np.float64], snapped: SnappedPlaces, *, strict: bool) -> None:
    """Refuse places that moved to the lattice, or warn if one moved far; the seeds have the count in any case."""
    count, cell = snapped.moves, CELL[places.shape[1]]
    step = f"1/{snapped.finest}" if snapped.finest <= FINEST_SCALE else f"2^-{snapped.finest.bit_length() - 1}"
    if not count:
        return
    if strict:
        row = int(np.flatnonzero(snapped.moved)[0])
        raise InputError(
            f"point {row + 1} is ({', '.join(map(str, places[row].tolist()))}): seeds lie on multiples of {step} "
            f"{cell} ({counted(count, 'such point')}); round them or leave out {STRICT}"
        )
    if snapped.largest_move >= _LARGE_MOVE:
        warn(
            f"{count} of {len(places)} seeds moved to the nearest {step} {cell}, by at most "
            f"{snapped.largest_move:.2g} {cell}s"
        )


def _coarsest_scale(lattice: NDArray[np.int64], finest: int) -> int:
    """Give the smallest power of two of steps a pixel for coordinates in the finest ones."""
    used = int(np.bitwise_or.reduce(lattice, axis=None)) & (finest - 1)
    return finest // (used & -used) if used else 1
