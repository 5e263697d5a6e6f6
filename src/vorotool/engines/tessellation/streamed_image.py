"""Tessellations of images that are never held: their objects are the seeds, and both pass by in bands of rows."""

from __future__ import annotations

import warnings
import zlib
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.tessellation.bands import Quantity, SeedBand
from vorotool.engines.tessellation.column_envelope import ColumnEnvelope, first_seeds, last_seeds
from vorotool.engines.tessellation.frames import square_dtype
from vorotool.engines.tessellation.interior_seeds import surrounded_pixels
from vorotool.engines.tessellation.raster_objects import (
    LARGEST_LABEL,
    Note,
    foreground_values,
    label_values,
    objects_of_value,
    only_value,
    refuse_distances,
    refuse_photograph,
    report_no_foreground,
)
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import LimitError, option
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.types.pixel_frame import Frame
from vorotool.types.points.raster import Raster
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.spacing import SQUARE, PixelSides

StreamedMode = Literal["pixels", "components", "labels"]

BAND_PIXELS = 2**25
"""Most pixels of a band that is read at a time; for each two lists as wide as the image are kept, in a short form."""

SWEEP_PIXELS = 2**22
"""Pixels that are labeled at a time: each may be a seed, which takes some 60 bytes."""


class ImageRows(Protocol):
    """An image that is read band by band; it can be pickled."""

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""

    def rows(self, first: int, count: int) -> NDArray[Any]:
        """Read some rows."""


@plain
class ObjectRows:
    """The rows of an image, of which the objects are seeds."""

    image: ImageRows
    # what shares a label; by default as in `seeds_from_raster`, but a photograph is looked for only in the first band
    # that has two values
    mode: StreamedMode | None = None
    connectivity: int = 8
    threshold: float | None = None  # foreground is what is larger
    invert: bool = False  # exchange foreground and background
    # rows of a band that is read at a time, if that is not too much: best those of the bands that are asked for
    height: int = 512

    def values(self, first: int, count: int) -> NDArray[Any]:
        """Read some rows, of which the nonzero values are foreground."""
        return foreground_values(Raster(self.image.rows(first, count)), self.threshold, invert=self.invert)

    def mask(self, first: int, count: int) -> NDArray[np.uint8]:
        """Read the foreground of some rows, as zeros and ones."""
        return np.ascontiguousarray(self.values(first, count) != 0).view(np.uint8)

    def labels(self, first: int, count: int) -> NDArray[np.uint32]:
        """Read the values of some rows as labels."""
        return label_values(self.values(first, count), first=first).astype(np.uint32, copy=False)

    def limits(self) -> Iterator[tuple[int, int]]:
        """First row and number of rows of the bands in which it is read."""
        height, width = self.image.shape
        step = max(1, min(self.height, BAND_PIXELS // width))
        return ((first, min(step, height - first)) for first in range(0, height, step))

    def with_mode(self, *, note: Note = None) -> ObjectRows:
        """Find out what shares a label, where it is not said; see `objects_of_value`."""
        if self.mode is not None:
            return self
        if self.threshold is not None or self.invert:
            return replace(self, mode="components")
        one, found = only_value((first, self.values(first, count)) for first, count in self.limits())
        if found is None:
            return replace(self, mode=objects_of_value(one, note=note))
        refuse_photograph(found[1])
        return replace(self, mode="labels")


@plain
class ObjectBand:
    """Some rows of objects, and all that their tessellation needs of the other rows."""

    source: ObjectRows  # where they are read
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
            return source.labels(*rows)
        mask = source.mask(*rows)
        if source.mode == "pixels":
            return _numbered_pixels(mask, self.start)
        numbers = np.empty(mask.shape, np.uint32)
        row_above = np.frombuffer(zlib.decompress(self.row_above), np.uint32)
        _core.label_images.number_band(mask, source.connectivity == 8, row_above, self.fresh, numbers, None)
        return numbers


@plain
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
        out = np.empty((self.count, self.parts[0].source.image.shape[1]), self.dtype)
        for part in self.parts:
            for first, pixels in self._pieces(part, out, threads):
                if progress is not None:
                    progress((first + pixels - self.first) / self.count)
        return out

    def _pieces(self, part: ObjectBand, out: NDArray[Any], threads: int) -> Iterator[tuple[int, int]]:
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
            place = out[start - self.first : stop - self.first]
            self._label(rows(start, stop), start, above, below, place, threads)
            above = last_seeds(rows(start, stop), start).or_else(above)
            yield start, stop - start

    def _label(
        self,
        objects: NDArray[np.uint32],
        first: int,
        above: ColumnEnvelope,
        below: ColumnEnvelope,
        out: NDArray[Any],
        threads: int,
    ) -> None:
        is_object = objects != 0
        if not is_object.all():
            frame = Frame(0, first, objects.shape[1], len(objects))
            seeds = _seeds_near(objects, frame, above, below)
            band = SeedBand(seeds, frame, self.what, self.dtype, self.max_distance, self.sides)
            out[...] = band.rows(threads=threads)
        np.copyto(out, objects if self.what == "labels" else 0, where=is_object, casting="unsafe")


class StreamedImage:
    """The tessellation of an image that is read twice: for what bands need of each other, and for the bands."""

    def __init__(
        self,
        source: ObjectRows,
        *,
        max_sites: int = LARGEST_LABEL,
        strict: bool = False,
        progress: Progress = None,
        note: Note = None,
        sides: PixelSides = SQUARE,
    ) -> None:
        self.source, self.sides = source.with_mode(note=note), sides
        height, width = source.image.shape
        self.frame = Frame(0, 0, width, height)
        self.pixels = self.largest_label = 0
        self._max_sites = max_sites
        self._corner: tuple[int, int] | None = None
        self._bands: list[ObjectBand] = []
        self._components = _core.label_images.StreamingComponents(width, source.connectivity == 8)
        self._scan(progress)
        if not self.pixels:
            report_no_foreground(strict=strict)
        self._number()
        del self._components

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

    def check_distances(self) -> None:
        """Refuse distances where there is no foreground."""
        if not self.pixels:
            refuse_distances()

    @property
    def square_dtype(self) -> np.dtype[Any]:
        """The type of squared distances, as `Tessellator.square_dtype`: none is larger than from the first seed."""
        self.check_distances()
        x, y = self._corner or (0, 0)
        dx, dy = max(x, self.frame.width - 1 - x), max(y, self.frame.height - 1 - y)
        dx, dy = dx * self.sides.x, dy * self.sides.y
        return square_dtype(dx * dx + dy * dy)

    @property
    def arithmetic(self) -> str:
        """The narrowest arithmetic that is exact wherever in the image seeds are."""
        x, y = np.array([0, self.frame.width - 1]), np.array([0, self.frame.height - 1])
        corners = SeedSet(x, y, np.array([1, 1]), sites=np.empty((0, 2)), site_labels=np.empty(0, np.uint32))
        with warnings.catch_warnings(action="ignore"):  # of an image of one pixel
            return Tessellator(corners, self.frame, sides=self.sides).arithmetic

    def _scan(self, progress: Progress) -> None:
        """Read the image from top to bottom; labels are provisional yet, and the list below is that of the band."""
        width = self.frame.width
        above, row_above = ColumnEnvelope.empty(width), np.zeros(width, np.uint32)
        end = 0
        for first, count in self.source.limits():
            start = end
            objects, end = self._provisional(first, count, start)
            self._count(objects, first)
            below = first_seeds(objects, first).packed()
            row = zlib.compress(row_above.tobytes(), 1)
            none = np.empty(0, np.uint32)
            self._bands.append(ObjectBand(self.source, first, count, above.packed(), below, row, start, end, none))
            above = last_seeds(objects, first).or_else(above)
            row_above = objects[-1].copy()
            if progress is not None:
                progress((first + count) / self.frame.height)

    def _provisional(self, first: int, count: int, start: int) -> tuple[NDArray[np.uint32], int]:
        """Label some rows, as far as the rows above them tell; gives how many labels need numbers so far, too."""
        if self.source.mode == "labels":
            objects = self.source.labels(first, count)
            self.largest_label = max(self.largest_label, int(objects.max()))
            return objects, 0
        mask = self.source.mask(first, count)
        if self.source.mode == "pixels":
            end = start + int(np.count_nonzero(mask))
            self._check(end, "foreground pixels")
            self.largest_label = end
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

    def _number(self) -> None:
        """Read the lists from bottom to top: each band gets the list of what is below it, and all get their numbers."""
        number = np.empty(self._components.size + 1, np.uint32)
        if self.source.mode == "components":
            self.largest_label = self._components.settle(number)
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


def _numbered_pixels(mask: NDArray[np.uint8], start: int) -> NDArray[np.uint32]:
    """Number the ones in raster order, from ``start + 1``."""
    numbers = np.cumsum(mask, dtype=np.uint32).reshape(mask.shape)
    numbers += np.uint32(start)
    numbers *= mask
    return numbers


def _seeds_near(objects: NDArray[np.uint32], frame: Frame, above: ColumnEnvelope, below: ColumnEnvelope) -> SeedSet:
    """Give the seeds that are nearest to pixels of these rows: those that are not surrounded, and the lists."""
    y, x = np.nonzero((objects != 0) & ~surrounded_pixels(objects))
    (x_above, y_above, above_labels), (x_below, y_below, below_labels) = above.seeds(), below.seeds()
    return SeedSet(
        np.concatenate([x_above, x, x_below]),
        np.concatenate([y_above, y + frame.y, y_below]),
        np.concatenate([above_labels, objects[y, x], below_labels]),
        frame=frame,
        sites=np.empty((0, 2)),
        site_labels=np.empty(0, np.uint32),
    )
