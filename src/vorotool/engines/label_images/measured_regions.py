"""Regions of an image or a volume with their sites, measured part by part, and the tables of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction
from functools import cached_property
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.common import label_array, refuse_negative
from vorotool.errors import InputError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import dots, norms
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.parallel import Progress
from vorotool.types.pixels import CELL, Frame, PixelSides
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.table import Table
from vorotool.types.volumes.volume import VolumeSeeds, VoxelFrame

_MEASURES = {2: ("area", "perimeter", "border_length"), 3: ("volume", "surface", "border_area")}
"""Columns: the size of a region and of its border, and of the border that two share."""


@frozen
class RegionMeasures:
    """Measures of the regions of a label image or volume; what `measure_regions` gives.

    All are counts, along x and y, and z of a volume. Columns, rows and slices count from the corner.
    """

    labels: NDArray[np.uint32]  # (k,) uint32 array: the labels that occur, increasing, without 0
    cells: NDArray[np.int64]  # (k,) int64 array: pixels or voxels of each region
    components: NDArray[np.int64]  # (k,) int64 array: its parts that share sides of pixels, or faces of voxels
    # (k, axes) int64 array: sides or faces across each axis, between the region and anything else, the outside included
    faces: NDArray[np.int64]
    sums: NDArray[np.int64]  # (k, axes) int64 array: of columns, rows and slices
    low: NDArray[np.int64]  # (k, axes) int64 array: first and last column, row and slice
    high: NDArray[np.int64]  # (k, axes) int64 array: first and last column, row and slice
    # (b, 2) uint32 array: indices of two regions that share a side or a face, the smaller first, in lexicographic order
    borders: NDArray[np.uint32]
    border_faces: NDArray[np.int64]  # (b, axes) int64 array: what the two share, across each axis


def measure_parts(parts: Iterable[NDArray[Any]], *, threads: int = 0, progress: Progress = None) -> RegionMeasures:
    """Measure all regions of labels that come band by band, or slab by slab: they need not be in memory."""
    threads = checked_threads(threads)
    measurer: _core.volumes.VolumeMeasurer | None = None
    across: tuple[int, ...] = ()
    types: list[np.dtype[Any]] = []
    for part in parts:
        if measurer is None:
            across = part.shape[1:]
            measurer = _core.volumes.VolumeMeasurer(across[-1], 1 if len(across) == 1 else across[0])
        if part.shape[1:] != across:
            raise InputError(
                f"slabs must have one height and width, but a slab of {part.shape[1:]} follows those of {across}"
            )
        types.append(part.dtype)
        array = label_array(part, CELL[part.ndim])
        measurer.add(array if part.ndim == 3 else array[:, None], threads, progress)  # each row is a slice
    if measurer is None:
        raise InputError("the sequence of slabs is empty: give at least one")
    found = measurer.finish(progress)
    cell = CELL[len(across) + 1]
    for dtype in set(types):
        refuse_negative(dtype, int(found["labels"].max(initial=0)), cell)
    if len(across) == 1:
        for name in ("faces", "sums", "low", "high", "border_faces"):
            found[name] = np.ascontiguousarray(found[name][:, ::2])
    borders = np.stack([found.pop("border_a"), found.pop("border_b")], axis=1)
    return RegionMeasures(borders=borders, cells=found.pop("voxels"), **found)


@frozen(eq=False)
class Regions:
    """Measures of regions, and their sites."""

    measures: RegionMeasures
    frame: Frame | VoxelFrame  # where they lie
    sides: PixelSides
    # whose sites are those of the regions; without them the centroids of the regions are
    seeds: SeedSet | VolumeSeeds | None = None
    # (n,) array: the largest squared distance in the region of each site, in steps of the sides over the scale
    largest_squares: NDArray[Any] | None = None
    scale: int = 1

    @property
    def labels(self) -> NDArray[np.uint32]:
        """Of the sites, increasing."""
        if self.seeds is None:
            return self.measures.labels
        return self.seeds.site_labels

    @cached_property
    def sites(self) -> NDArray[np.float64]:
        """(n, axes) positions, in steps of the sides."""
        if self.seeds is not None:
            return self.seeds.sites * self.steps
        measures = self.measures
        centroids = measures.sums / measures.cells[:, None] + np.array(self.frame.origin, np.int64)
        return centroids * self.steps

    @property
    def steps(self) -> NDArray[np.int64]:
        """Sides of a pixel or voxel along x, y and z, in steps."""
        return np.array(self.sides.units[::-1], dtype=np.int64)

    @cached_property
    def rows(self) -> NDArray[np.intp]:
        """The site of each label that occurs."""
        return np.searchsorted(self.labels, self.measures.labels)

    @property
    def stranger(self) -> int | None:
        """The first label that occurs and is of no site."""
        found = self.measures.labels
        known = self.rows < len(self.labels)
        known[known] = self.labels[self.rows[known]] == found[known]
        return None if known.all() else int(found[~known][0])

    # ---- tables
    def table(self, *, properties: bool = True, threads: int = 0, progress: Progress = None) -> Table:
        """Tabulate the regions: see `region_table`."""
        measures, labels = self.measures, self.labels
        size, border, _ = _MEASURES[len(self.steps)]
        nearest_label, nearest_distance = self._nearest_sites(threads, progress)
        degree = np.bincount(measures.borders.ravel(), minlength=len(measures.labels)).astype(np.int64)
        cells = self._spread(measures.cells)
        absent = cells == 0
        touches = ((measures.low == 0) | (measures.high == np.array(self.frame.shape[::-1]) - 1)).any(axis=1)
        columns: dict[str, Any] = {
            "label": labels.astype(np.int64),
            **{name: self._lengths(self.sites[:, k].copy()) for k, name in enumerate("xyz"[: len(self.steps)])},
            size: self._sizes(cells),
            border: self._borders(self._spread(measures.faces)),
            "neighbors": self._spread(degree),
            "nearest_label": nearest_label,
            "nearest_distance": self._lengths(nearest_distance),
            "touches_frame": np.ma.array(self._spread(touches.astype(np.int64)), mask=absent),
            "max_distance": np.ma.array(self._largest(), mask=absent | (self.largest_squares is None)),
            "components": self._spread(measures.components),
        }
        low, high = ((ends + np.array(self.frame.origin)) * self.steps for ends in (measures.low, measures.high + 1))
        for names, values in (("xyz", low), ("whd", high - low)):
            for name, column in zip(names, values.T, strict=False):
                columns[f"bbox_{name}"] = np.ma.array(self._lengths(self._spread(column)), mask=absent)
        own = getattr(self.seeds, f"object_{size}", None)
        if own is not None:
            columns[f"object_{size}"] = self._sizes(np.asarray(own, dtype=np.int64))
        table = Table(columns)
        has_more = self.seeds is not None and properties and self.seeds.properties
        return table.with_properties(self.seeds.properties) if has_more and self.seeds is not None else table

    def neighbors(self) -> Table:
        """Tabulate the neighboring regions: see `neighbor_table`."""
        measures, position = self.measures, self.sites[self.rows]
        a, b = measures.borders.T
        return Table(
            {
                "label_a": measures.labels[a].astype(np.int64),
                "label_b": measures.labels[b].astype(np.int64),
                _MEASURES[len(self.steps)][2]: self._borders(measures.border_faces),
                "centroid_distance": self._lengths(norms(position[a] - position[b])),
            }
        )

    def _spread(self, values: NDArray[Any]) -> NDArray[Any]:
        """Values of the regions at the rows of their sites, 0 in the others."""
        made = np.zeros((len(self.labels), *values.shape[1:]), dtype=values.dtype)
        made[self.rows] = values
        return made

    def _nearest_sites(self, threads: int, progress: Progress) -> tuple[Any, Any]:
        """Label and distance of the site nearest to each; masked where there is no other."""
        nearest: Any = _core.spatial.nearest_other_sites  # of two axes or three
        labels = np.ascontiguousarray(self.labels)
        index, distance = nearest(*map(np.ascontiguousarray, self.sites.T), labels, threads, progress)
        alone = index < 0
        label = labels.astype(np.int64)[index] if len(labels) else index
        masked = (np.where(alone, 0, label), np.where(alone, 0.0, distance))
        return np.ma.array(masked[0], mask=alone), np.ma.array(masked[1], mask=alone)

    def _largest(self) -> Any:
        if self.largest_squares is None:
            return self._lengths(np.zeros(len(self.labels)))
        return self._lengths(np.sqrt(self.largest_squares.astype(np.float64)) / self.scale)

    # ---- units of the sides
    def _lengths(self, values: Any, power: int = 1) -> Any:
        """Lengths in steps, or products of them, in the unit of the sides; integers where that changes nothing."""
        factor = self.sides.step**power
        if len(self.steps) == 3:
            return values if factor == 1 else values * float(factor)
        if set(self.sides.units) == {1} and factor == 1:
            return values
        return values * float(factor.numerator) / float(factor.denominator)

    def _sizes(self, cells: NDArray[np.int64]) -> Any:
        """Areas or volumes of so many pixels or voxels."""
        of_one = prod(self.sides.units)
        if len(self.steps) == 2:
            return self._lengths(cells if of_one == 1 else cells * float(of_one), 2)
        volume: Fraction = of_one * self.sides.step**3
        return cells if volume == 1 else cells * float(volume)

    def _borders(self, faces: NDArray[np.int64]) -> Any:
        """Lengths or areas of so many sides or faces across each axis."""
        of_one = prod(self.sides.units)
        across = [of_one // side for side in self.sides.units[::-1]]
        fits = int(faces.max(initial=0)) * sum(across) < 2**63
        kind = np.int64 if fits else object
        exact = dots(faces.astype(kind), np.array(across, kind))
        return self._lengths(exact if fits else exact.astype(np.float64), len(across) - 1)


def regions_of_parts(
    parts: Iterable[tuple[NDArray[Any], NDArray[Any] | None]],
    frame: Frame | VoxelFrame,
    sides: PixelSides,
    seeds: SeedSet | VolumeSeeds,
    *,
    threads: int = 0,
) -> Regions:
    """Measure the regions of a tessellation from its labels, and squared distances, which come part by part."""
    wanted = seeds.site_labels
    assert wanted is not None  # the seeds have filled them in
    largest: list[NDArray[Any]] = []

    def passing() -> Iterator[NDArray[Any]]:
        for labels, squares in parts:
            if squares is not None:
                found = largest_by_label(label_array(labels), squares, wanted, threads, None)
                largest[:] = [np.maximum(found, *largest) if largest else found]
            yield labels

    measures = measure_parts(passing(), threads=threads)
    return Regions(measures, frame, sides, seeds, largest[0] if largest else None, seeds.scale)


def largest_by_label(
    labels: NDArray[Any], values: NDArray[Any], wanted: NDArray[np.uint32], threads: int, progress: Progress
) -> NDArray[Any]:
    """Return the largest value in each region, 0 for labels that do not occur."""
    is_double = values.dtype == np.float64
    if is_double:  # the bits of positive doubles are in the order of their values
        values = np.ascontiguousarray(values).view(np.uint64)
    wide = np.uint64 if values.dtype.itemsize == 8 else np.uint32
    rows = np.ascontiguousarray(values).astype(wide, copy=False).reshape(-1, values.shape[-1])
    by_label: Any = _core.label_images.max_by_label  # of several types
    found: NDArray[np.uint64] = by_label(labels.reshape(rows.shape), rows, wanted, threads, progress)
    return found.view(np.float64) if is_double else found
