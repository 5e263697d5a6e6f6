"""Tessellations of images that are never held: their objects are the seeds, and both pass by in bands of rows."""

from __future__ import annotations

import warnings
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.tessellation.frames import label_dtype
from vorotool.engines.tessellation.raster_objects import (
    LARGEST_LABEL,
    Note,
    PartwiseObjects,
    report_no_foreground,
)
from vorotool.engines.tessellation.tessellator import Quantity, Tessellator, surrounded
from vorotool.errors import LimitError, option
from vorotool.frozen import frozen
from vorotool.numeric.parallel import Progress, report
from vorotool.types.pixels import SQUARE, Frame, PixelSides
from vorotool.types.points.seed_set import SeedSet

BAND_PIXELS = 2**25
"""Most pixels of a band that is read at a time; for each two lists as wide as the image are kept, in a short form."""

SWEEP_PIXELS = 2**22
"""Pixels that are labeled at a time: each may be a seed, which takes some 60 bytes."""


@frozen
class ColumnEnvelope:
    """At most one seed a column."""

    row: NDArray[np.int32]  # (W,) int32 array: its row
    label: NDArray[np.uint32]  # (W,) uint32 array: its label; 0 where there is none

    @classmethod
    def empty(cls, width: int) -> ColumnEnvelope:
        """No seed in any column."""
        return cls(np.zeros(width, np.int32), np.zeros(width, np.uint32))

    def or_else(self, farther: ColumnEnvelope) -> ColumnEnvelope:
        """These seeds, and in the columns that have none those of another list."""
        has = self.label != 0
        return ColumnEnvelope(np.where(has, self.row, farther.row), np.where(has, self.label, farther.label))

    def numbered(self, number: NDArray[np.uint32]) -> ColumnEnvelope:
        """The list with other labels, from a table."""
        return ColumnEnvelope(self.row, number[self.label])

    def seeds(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.uint32]]:
        """Columns, rows and labels of the seeds."""
        x = np.flatnonzero(self.label)
        return x, self.row[x].astype(np.int64), self.label[x]

    def packed(self) -> bytes:
        """Give a short form: neighboring columns are much alike."""
        change = np.diff(self.row, prepend=np.int32(0))
        return zlib.compress(change.tobytes() + self.label.tobytes(), 1)

    @classmethod
    def unpacked(cls, data: bytes) -> ColumnEnvelope:
        """Give the list back."""
        row, label = np.frombuffer(zlib.decompress(data), np.uint32).reshape(2, -1)
        return cls(np.cumsum(row.view(np.int32), dtype=np.int32), label)


def last_seeds(objects: NDArray[np.uint32], first: int) -> ColumnEnvelope:
    """The lowest seed of each column, of rows from ``first`` on, which have labels and 0."""
    found = ColumnEnvelope.empty(objects.shape[1])
    for row, line in enumerate(objects, start=first):
        _put(found, row, line)
    return found


def first_seeds(objects: NDArray[np.uint32], first: int) -> ColumnEnvelope:
    """The uppermost seed of each column."""
    found = ColumnEnvelope.empty(objects.shape[1])
    for row in range(len(objects) - 1, -1, -1):
        _put(found, first + row, objects[row])
    return found


def _put(found: ColumnEnvelope, row: int, line: NDArray[np.uint32]) -> None:
    has = line != 0
    np.copyto(found.row, row, where=has)
    np.copyto(found.label, line, where=has)


@frozen
class ObjectBand:
    """Some rows of objects, and all that their tessellation needs of the other rows."""

    source: PartwiseObjects  # where they are read
    first: int
    count: int
    above: bytes  # the nearest seed of each column above and below them: `ColumnEnvelope.packed`
    below: bytes  # the nearest seed of each column above and below them: `ColumnEnvelope.packed`
    row_above: bytes  # of components: the numbers of the row above them, compressed
    start: int  # seeds, or provisional components, before the first row and after the last one
    end: int  # seeds, or provisional components, before the first row and after the last one
    fresh: NDArray[np.uint32]  # (end - start,) uint32 array: of components: their numbers

    def objects(self) -> NDArray[np.uint32]:
        """Read the rows: labels of objects, and 0."""
        source, rows = self.source, (self.first, self.count)
        if source.mode == "labels":
            return source.labels(*rows).astype(np.uint32, copy=False)
        mask = source.mask(*rows)
        if source.mode == "pixels":
            return _numbered_pixels(mask, self.start)
        numbers = np.empty(mask.shape, np.uint32)
        row_above = np.frombuffer(zlib.decompress(self.row_above), np.uint32)
        _core.label_images.number_band(mask, source.corners, row_above, self.fresh, numbers, None)
        return numbers


@frozen
class ImageBand:
    """Some rows of the tessellation of an image, computed where they are asked for: it can be pickled."""

    parts: tuple[ObjectBand, ...]  # those that have these rows
    first: int
    count: int
    what: Quantity  # as of `SeedBand`
    dtype: np.dtype[Any]  # as of `SeedBand`
    max_distance: float | Fraction | None = None  # as of `SeedBand`
    sides: PixelSides = SQUARE  # as of `SeedBand`

    def rows(self, *, threads: int = 0, progress: Progress = None) -> NDArray[Any]:
        """Compute the rows."""
        return self.quantities({self.what: self.dtype}, threads, progress)[0]

    def quantities(
        self, dtypes: Mapping[Quantity, np.dtype[Any]], threads: int, progress: Progress = None
    ) -> list[NDArray[Any]]:
        """Compute several quantities of the rows, for which they are read once."""
        shape = (self.count, self.parts[0].source.source.shape[1])
        outs = {what: np.empty(shape, dtype) for what, dtype in dtypes.items()}
        for part in self.parts:
            for first, pixels in self._pieces(part, outs, threads):
                report(progress, (first + pixels - self.first) / self.count)
        return list(outs.values())

    def _pieces(
        self, part: ObjectBand, outs: Mapping[Quantity, NDArray[Any]], threads: int
    ) -> Iterator[tuple[int, int]]:
        """Label the rows of a part piece by piece; gives the first row and the number of rows of each."""
        objects = part.objects()
        begin, end = max(self.first, part.first), min(self.first + self.count, part.first + part.count)
        step = max(1, SWEEP_PIXELS // objects.shape[1])
        limits = [(row, min(row + step, end)) for row in range(begin, end, step)]

        def rows(start: int, stop: int) -> NDArray[np.uint32]:
            return objects[start - part.first : stop - part.first]

        below = first_seeds(rows(end, part.first + part.count), end).or_else(ColumnEnvelope.unpacked(part.below))
        lists_below = []
        for start, stop in reversed(limits):
            lists_below.append(below)
            below = first_seeds(rows(start, stop), start).or_else(below)
        above = last_seeds(rows(part.first, begin), part.first).or_else(ColumnEnvelope.unpacked(part.above))
        for (start, stop), below in zip(limits, reversed(lists_below), strict=True):
            places = {what: out[start - self.first : stop - self.first] for what, out in outs.items()}
            self._label(rows(start, stop), start, above, below, places, threads)
            above = last_seeds(rows(start, stop), start).or_else(above)
            yield start, stop - start

    def _label(
        self,
        objects: NDArray[np.uint32],
        first: int,
        above: ColumnEnvelope,
        below: ColumnEnvelope,
        outs: Mapping[Quantity, NDArray[Any]],
        threads: int,
    ) -> None:
        is_object, limit = objects != 0, self.max_distance
        if not is_object.all():
            frame = Frame(0, first, objects.shape[1], len(objects))
            seeds = _seeds_near(objects, frame, above, below)
            sweep = Tessellator(seeds, frame, max_distance=limit, sides=self.sides, threads=threads)
            for what, out in outs.items():
                out[...] = sweep.computed(what, out.dtype)
        for what, out in outs.items():
            np.copyto(out, objects if what == "labels" else 0, where=is_object, casting="unsafe")


class StreamedImage(Tessellator):
    """The tessellation of an image that is read twice: for what bands need of each other, and for the bands.

    Its seeds are the first one alone, with the largest label and the sites of all: no other is kept.
    """

    def __init__(
        self,
        source: PartwiseObjects,
        *,
        max_sites: int = LARGEST_LABEL,
        max_distance: float | Fraction | None = None,
        sides: PixelSides = SQUARE,
        threads: int = 0,
        strict: bool = False,
        reading: Progress = None,
        progress: Progress = None,
        note: Note = None,
        has_sites: bool = False,
    ) -> None:
        height, width = source.source.shape
        source = replace(source, step=max(1, min(source.step, BAND_PIXELS // width)))
        self.source = replace(source, mode=source.mode or source.kind(note=note))
        self.pixels = self._largest_label = 0
        self._max_sites, self._max_distance = max_sites, max_distance
        self._corner: tuple[int, int] | None = None
        self._measurer = _core.volumes.VolumeMeasurer(width, 1) if has_sites else None
        self._bands: list[ObjectBand] = []
        self._components = _core.label_images.StreamingComponents(width, source.corners)
        x, y = np.array([0, width - 1]), np.array([0, height - 1])
        corners = SeedSet(x, y, np.array([1, 1]), sites=np.empty((0, 2)), site_labels=np.empty(0, np.uint32))
        with warnings.catch_warnings(action="ignore"):  # of an image of one pixel; seeds may be anywhere in the image
            super().__init__(corners, Frame(0, 0, width, height), sides=sides, threads=threads, progress=progress)
        self.duplicates = 0
        self._scan(reading)
        if not self.pixels:
            report_no_foreground(strict=strict)
        number = self._number()
        del self._components
        self.seeds = self._first_seed(number)
        del self._measurer

    def band(
        self,
        what: Quantity,
        dtype: np.dtype[Any],
        first: int,
        rows: int,
        max_distance: float | Fraction | None = None,
    ) -> ImageBand:
        """Give some rows as what computes them anywhere."""
        if what != "labels":
            self.check_distances()
        parts = tuple(band for band in self._bands if band.first < first + rows and band.first + band.count > first)
        return ImageBand(parts, first, rows, what, dtype, max_distance, self.sides)

    def labels(  # type: ignore[override]  # nothing is written to an array that is there
        self, first: int = 0, count: int | None = None, *, dtype: Any = None
    ) -> NDArray[Any]:
        """Labels of some rows."""
        kind = label_dtype(self.seeds.largest_label, dtype)
        return self._rows("labels", kind, first, count, self._max_distance)

    def squared_distances(  # type: ignore[override]
        self, first: int = 0, count: int | None = None, *, dtype: np.dtype[Any] | None = None
    ) -> NDArray[Any]:
        """Exact squared distances of some rows."""
        return self._rows("distance2", np.dtype(dtype or self.square_dtype), first, count)

    def distances(self, first: int = 0, count: int | None = None) -> NDArray[np.float32]:
        """Distances of some rows."""
        return self._rows("distance", np.dtype(np.float32), first, count)

    def measured(self, first: int, count: int, dtype: np.dtype[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """Labels and squared distances of some rows."""
        band = self.band("labels", dtype, first, count, self._max_distance)
        labels, squares = band.quantities({"labels": dtype, "distance2": self.measured_dtype}, self._threads)
        report(self._progress, (first + count) / self.frame.height)
        return labels, squares

    def _rows(
        self, what: Quantity, dtype: np.dtype[Any], first: int, count: int | None, limit: Any = None
    ) -> NDArray[Any]:
        count = self.frame.height - first if count is None else count
        made = self.band(what, dtype, first, count, limit).rows(threads=self._threads)
        report(self._progress, (first + count) / self.frame.height)
        return made

    def _scan(self, progress: Progress) -> None:
        """Read the image from top to bottom; labels are provisional yet, and the list below is that of the band."""
        width = self.frame.width
        above, row_above = ColumnEnvelope.empty(width), np.zeros(width, np.uint32)
        end = 0
        for first, count in self.source.limits():
            start = end
            objects, end = self._provisional(first, count, start)
            self._count(objects, first)
            if self._measurer is not None:
                self._measurer.add(objects[:, None], 0, None)
            below = first_seeds(objects, first).packed()
            row = zlib.compress(row_above.tobytes(), 1)
            none = np.empty(0, np.uint32)
            self._bands.append(ObjectBand(self.source, first, count, above.packed(), below, row, start, end, none))
            above = last_seeds(objects, first).or_else(above)
            row_above = objects[-1].copy()
            report(progress, (first + count) / self.frame.height)

    def _provisional(self, first: int, count: int, start: int) -> tuple[NDArray[np.uint32], int]:
        """Label some rows, as far as the rows above them tell; gives how many labels need numbers so far, too."""
        if self.source.mode == "labels":
            objects = self.source.labels(first, count).astype(np.uint32, copy=False)
            self._largest_label = max(self._largest_label, int(objects.max()))
            return objects, 0
        mask = self.source.mask(first, count)
        if self.source.mode == "pixels":
            end = start + int(np.count_nonzero(mask))
            self._check(end, "foreground pixels")
            self._largest_label = end
            return _numbered_pixels(mask, start), end
        objects = np.empty(mask.shape, np.uint32)
        self._components.add(mask, objects, None)
        self._check(self._components.size, "beginnings of components")
        return objects, self._components.size

    def _check(self, count: int, what: str) -> None:
        if count > min(self._max_sites, LARGEST_LABEL):
            limit = option(f"--max-sites {min(self._max_sites, LARGEST_LABEL)}")
            labels = option("--seeds labels", 'mode="labels"')
            raise LimitError(
                f"the image has at least {count} {what}, more than {limit}: use a larger limit, or {labels}"
            )

    def _count(self, objects: NDArray[np.uint32], first: int) -> None:
        count = int(np.count_nonzero(objects))
        if count and self._corner is None:
            y, x = divmod(int((objects != 0).argmax()), objects.shape[1])
            self._corner = x, first + y
        self.pixels += count

    def _first_seed(self, number: NDArray[np.uint32]) -> SeedSet:
        """Give the first seed, and the sites of all objects if they are wanted, as `seeds_from_raster` does."""
        x, y = np.array([] if self._corner is None else [self._corner], np.int64).reshape(-1, 2).T
        sites: dict[str, Any] = {"sites": np.empty((0, 2)), "site_labels": np.empty(0, np.uint32)}
        if self._measurer is not None:
            found = self._measurer.finish(None)
            label = found["labels"] if self.source.mode != "components" else number[found["labels"]]
            distinct, row = np.unique(label, return_inverse=True)
            area, total = np.zeros(len(distinct), np.int64), np.zeros((len(distinct), 2), np.int64)
            np.add.at(area, row, found["voxels"])
            np.add.at(total, row, found["sums"][:, ::2])  # along x and z: each row of the image is a slice
            sites = {"sites": total / area[:, None], "site_labels": distinct}
            sites["object_area"] = None if self.source.mode == "pixels" else area
        return SeedSet(x, y, np.full(len(x), self._largest_label, np.uint32), frame=self.frame, **sites)

    def _number(self) -> NDArray[np.uint32]:
        """Read the lists from bottom to top: each band gets the list of what is below it, and all get their numbers."""
        number = np.empty(self._components.size + 1, np.uint32)
        if self.source.mode == "components":
            self._largest_label = self._components.settle(number)
        below = ColumnEnvelope.empty(self.frame.width)
        for k in range(len(self._bands) - 1, -1, -1):
            band = self._bands[k]
            own = ColumnEnvelope.unpacked(band.below)
            band = replace(band, below=below.packed())
            if self.source.mode == "components":
                own = own.numbered(number)
                row_above = number[np.frombuffer(zlib.decompress(band.row_above), np.uint32)]
                band = replace(
                    band,
                    above=ColumnEnvelope.unpacked(band.above).numbered(number).packed(),
                    row_above=zlib.compress(row_above.tobytes(), 1),
                    fresh=number[band.start + 1 : band.end + 1],
                )
            self._bands[k] = band
            below = own.or_else(below)
        return number


def _numbered_pixels(mask: NDArray[np.uint8], start: int) -> NDArray[np.uint32]:
    """Number the ones in raster order, from ``start + 1``."""
    numbers = np.cumsum(mask, dtype=np.uint32).reshape(mask.shape)
    numbers += np.uint32(start)
    numbers *= mask
    return numbers


def _seeds_near(objects: NDArray[np.uint32], frame: Frame, above: ColumnEnvelope, below: ColumnEnvelope) -> SeedSet:
    """Give the seeds that are nearest to pixels of these rows: those that are not surrounded, and the lists."""
    y, x = np.nonzero((objects != 0) & ~surrounded(objects))
    (x_above, y_above, above_labels), (x_below, y_below, below_labels) = above.seeds(), below.seeds()
    return SeedSet(
        np.concatenate([x_above, x, x_below]),
        np.concatenate([y_above, y + frame.y, y_below]),
        np.concatenate([above_labels, objects[y, x], below_labels]),
        frame=frame,
        sites=np.empty((0, 2)),
        site_labels=np.empty(0, np.uint32),
    )
