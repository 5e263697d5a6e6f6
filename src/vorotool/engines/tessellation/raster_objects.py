"""Objects of an image or a volume: foreground by a threshold, a mask of components, or labels."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from math import floor
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import OTSU, STRICT, InputError, Kind, Message, UsageError, VorotoolWarning, option, warn
from vorotool.frozen import frozen
from vorotool.numeric.checks import checked_flag, is_choice
from vorotool.numeric.numbers import finite_double, shown_number
from vorotool.types.images import Raster
from vorotool.types.volumes.volume import Volume

Objects = Literal["components", "labels"]
Threshold = float | Literal["otsu"] | None
Note = Callable[[str], None] | None
"""Called with what may surprise."""

LARGEST_LABEL = 0xFFFFFFFF

MOSTLY = 0.75
"""Of an image that is light, so that its objects are likelier dark."""

MASK_VALUES = (1, 255)
"""Of masks, beside the largest value of the type."""

_THRESHOLD = option("--threshold T", "threshold=T (of seeds_from_raster, seeds_from_volume and outlines)")
_SOME_THRESHOLD = option("--threshold", "threshold=T")
_INVERT = option("--invert", "invert=True")
_AS_COMPONENTS = option("--seeds components", 'mode="components"')
_AS_LABELS = option("--seeds labels", 'mode="labels"')

_AXES = ("slice", "row", "column")

_NARROW = 2
"""Bytes of integers that are counted by a table of all of them."""

_LUMINANCE = (0.2125, 0.7154, 0.0721)
"""Weights of red, green and blue (ITU-R BT.709, as scikit-image has them)."""


def check_objects(mode: Any, modes: tuple[str, ...], connectivity: Any, axes: int = 2) -> None:
    """Refuse what no object is by, and neighborhoods that an image, or a volume, has not."""
    known, others = ((4, 8), (26, 6)) if axes == 2 else ((26, 6), (8, 4))
    if not is_choice(connectivity, known):
        what, other = ("", "volumes") if axes == 2 else (" in a volume", "images")
        more = f"; {others[0]} and {others[1]} apply to {other}" if is_choice(connectivity, others) else ""
        raise UsageError(
            f"connectivity is {shown_number(connectivity)}: it must be {known[0]} or {known[1]}{what}{more}"
        )
    if not is_choice(mode, (None, *modes)):
        raise UsageError(f"mode is {shown_number(mode)}: it must be one of {', '.join(modes)}")


def foreground_values(raster: Raster, threshold: Threshold, *, invert: bool) -> NDArray[Any]:
    """Values of which the nonzero ones are foreground."""
    values, invert = raster.values, checked_flag(invert, "invert")
    if threshold is not None:
        number, invert = settled_threshold(raster, threshold, invert=invert)
        gray = gray_values(raster)
        values = gray > whole_threshold(gray, number)
    elif raster.is_color:
        made = mask_options(gray_values(raster))
        channels = f"({raster.values.shape[2]} channels)"
        raise InputError(f"a color image {channels} is neither a mask nor a label image: use {_THRESHOLD} or {made}")
    elif raster.is_lossy and not is_flat(values[values != values.min()]):
        raise InputError(
            f"the file has lossy compression, such as JPEG, so its values are not labels; use {_THRESHOLD} or "
            f"{mask_options(values)}, or a PNG"
        )
    _require_finite(values)
    values = values == 0 if invert else values
    return values if raster.mask is None else np.where(raster.mask, values.dtype.type(0), values)


def _require_finite(values: NDArray[Any], what: str = "image") -> None:
    if values.dtype.kind == "f" and not np.isfinite(values).all():
        raise InputError(f"the {what} holds NaN or infinite values: use {_THRESHOLD} with a number, or replace them")


def gray_values(raster: Raster) -> NDArray[Any]:
    """(H, W) the values, or the luminance of a color image; transparency does not count."""
    values = raster.values
    if not raster.is_color:
        return values
    if values.shape[2] <= 2:
        return values[:, :, 0]
    red, green, blue = (weight * values[:, :, k] for k, weight in enumerate(_LUMINANCE))
    return red + green + blue


def settled_threshold(raster: Raster, threshold: float | Literal["otsu"], *, invert: bool) -> tuple[float, bool]:
    """Give the threshold of an image as a number, and whether foreground is what is not larger."""
    if not (isinstance(threshold, str) and threshold == "otsu"):
        finite_double(threshold, "threshold")
        return threshold, invert  # as it is: a double would round integers beyond 2^53

    gray = counted_values(raster)
    _require_finite(gray)
    if is_flat(gray):
        return (gray.flat[0].item() if gray.size else 0), False
    return otsu_threshold(gray), invert


def counted_values(raster: Raster) -> NDArray[Any]:
    """Gray values of the pixels that are not masked."""
    gray = gray_values(raster)
    return gray if raster.mask is None else gray[~raster.mask]


def is_flat(gray: NDArray[Any]) -> bool:
    """Whether there are no two different values."""
    return not gray.size or bool(gray.min() == gray.max())


def whole_threshold(gray: NDArray[Any], threshold: float) -> float:
    """Give a threshold as an integer where values are: a float would round those beyond 2^53 when it is compared."""
    return floor(threshold) if gray.dtype.kind in "iu" else threshold


def default_objects(values: NDArray[Any], *, note: Note = None) -> Objects:
    """Tell whether the nonzero values are of a mask or labels: several are labels, of one `objects_of_value` tells."""
    if values.dtype == bool:
        return "components"
    is_zero = values == 0
    first = values.flat[int(is_zero.argmin())]  # nonzero, if any is
    if (is_zero | (values == first)).all():
        return objects_of_value(first, note=note)
    refuse_photograph(values)
    return "labels"


def objects_of_value(value: Any, *, note: Note = None) -> Objects:
    """Tell what an image holds that has no value but this one and 0: a mask or a label."""
    kind = value.dtype
    is_largest = kind == np.bool_ or (kind.kind in "iu" and value == np.iinfo(kind).max)
    if value == 0 or is_largest:
        return "components"
    is_mask = value in MASK_VALUES
    if note is not None and not is_mask:
        note(Message(f"{value} is the only value besides 0, and read as a label: for a mask use {_AS_COMPONENTS}"))
    if note is not None and is_mask and kind.itemsize > 1:
        note(Message(f"{value} is the only value besides 0, and read as a mask: for a label use {_AS_LABELS}"))
    return "components" if is_mask else "labels"


def numbered_components(values: NDArray[Any], connectivity: int = 8) -> NDArray[np.uint32]:
    """Number the components of what is not 0: libraries that do it take longer to load than most images to process."""
    components = np.empty(values.shape, np.uint32)
    foreground = np.ascontiguousarray(values != 0).view(np.uint8)
    if values.ndim == 2:
        _core.label_images.label_components(foreground, connectivity == 8, components, None)
        return components
    in_space = _core.volumes.VolumeComponents(values.shape[2], values.shape[1], connectivity == 26)
    in_space.add(foreground, components, None)
    number = np.empty(in_space.size + 1, np.uint32)
    in_space.settle(number)
    return number[components]


def objects_of_mask(labels: NDArray[Any]) -> NDArray[Any] | None:
    """Number the objects of what is a mask by the rule of `objects_of_value`; None of labels, and where nothing is."""
    value = labels.max(initial=0)
    is_mask = value > 0 and objects_of_value(value) == "components"
    return numbered_components(labels) if is_mask and ((labels == 0) | (labels == value)).all() else None


def only_value(pieces: Iterable[tuple[int, NDArray[Any]]]) -> tuple[Any, tuple[int, NDArray[Any]] | None]:
    """Look for a second value beside 0 in pieces of an image or a volume; none is read after the one that has it."""
    one: Any = np.uint8(0)
    for first, values in pieces:
        is_zero = values == 0
        one = one or values.flat[int(is_zero.argmin())]  # the first that is not 0, if any is
        if not (is_zero | (values == one)).all():
            return one, (first, values)
    return one, None


def report_no_foreground(*, strict: bool, what: str = "image") -> None:
    """Warn of an image or a volume in which there is nothing, or refuse it."""
    if strict:
        raise InputError(f"the {what} has no foreground: use {_INVERT} or {_SOME_THRESHOLD}, or leave out {STRICT}")
    message = Message(f"the {what} has no foreground: use {_INVERT} or {_SOME_THRESHOLD}", Kind.EMPTY_INPUT)
    warn(VorotoolWarning(message))


def refuse_distances(what: str = "image") -> None:
    """Refuse distances to nothing."""
    raise InputError(f"the {what} has no foreground to measure distances to: use {_INVERT} or {_SOME_THRESHOLD}")


def refuse_photograph(values: NDArray[Any]) -> None:
    """A label image has about as many fragments as labels; a photograph falls into far more."""
    looks, distinct, fragments = photograph_signs(values)
    if looks:
        if min(values.shape) <= 4 < max(values.shape):  # the sides of a list, which no photograph has
            raise InputError(
                f"the array has the shape {values.shape}, is it a list of points? save x and y with shape (n, 2); for "
                f"an image use {_AS_LABELS} or {_SOME_THRESHOLD}"
            )
        raise InputError(
            f"the image holds {distinct} different values in {fragments} connected pieces, like a photograph: use "
            f"{mask_options(values)}, or {_AS_LABELS} if these are labels"
        )


def photograph_signs(values: NDArray[Any]) -> tuple[bool, int, int]:
    """Tell whether values look like a photograph rather than labels, how many there are, and in how many pieces."""
    fractional = values.dtype.kind == "f" and bool((values != np.floor(values)).any())
    distinct, fragments = (len(np.unique(values)),) * 2 if fractional else _fragments(label_values(values))
    return fractional or (fragments > 4 * distinct and fragments > 256), distinct, fragments


def mask_options(gray: NDArray[Any]) -> str:
    """Give the options that make a mask of an image: of what is dark where most of it is light, as paper is."""
    finite = gray[np.isfinite(gray)]
    middle = (float(finite.min()) + float(finite.max())) / 2 if finite.size else 0.0
    is_light = np.count_nonzero(finite > middle) > MOSTLY * finite.size
    if is_light:
        made = option("--threshold otsu --invert", 'threshold="otsu", invert=True')
        return f"{made} (most of it is light)"
    return OTSU


def _fragments(labels: NDArray[Any]) -> tuple[int, int]:
    """Count the values of an image, and the 4-connected pieces of those that are not 0."""
    steps = sum(int(np.count_nonzero(row[1:] != row[:-1])) for row in labels)
    if 8 * steps < labels.size:  # the borders between the regions of noise would take more memory than labels do
        found = _core.label_images.measure_regions(np.ascontiguousarray(labels), 0, None)
        return len(found["labels"]) + bool((labels == 0).any()), int(found["components"].sum())
    from skimage.measure import label

    return len(np.unique(labels)), int(label(labels.astype(np.int64), connectivity=1).max())


def label_values(values: NDArray[Any], *, first: int = 0) -> NDArray[Any]:
    """Give labels in an unsigned type; the first value that is none is named with its place."""
    if values.dtype in (np.bool_, np.uint8, np.uint16, np.uint32):
        return values
    if values.dtype.kind == "f":  # the limit is a double, as shorter ones do not hold it
        bad = (values < 0) | (values > np.float64(LARGEST_LABEL)) | (values != np.floor(values))
    else:
        bad = (values < 0) | (values > LARGEST_LABEL)
    if bad.any():
        at = [int(each) for each in np.unravel_index(int(bad.argmax()), bad.shape)]
        value, at[0] = values[tuple(at)], at[0] + first
        place = ", ".join(f"{axis} {each}" for axis, each in zip(_AXES[-len(at) :], at, strict=True))
        raise InputError(
            f"the {'image' if values.ndim < len(_AXES) else 'volume'} holds the value {value} in {place}: labels must "
            f"be integers from 0 to {LARGEST_LABEL}; use {_THRESHOLD} or {_AS_COMPONENTS} for a mask"
        )
    return values.astype(np.uint32)


# ---- objects of what is read part by part


@frozen
class PartwiseObjects:
    """The rows of an image, or the slices of a volume, of which the objects are seeds."""

    source: Any  # with a shape; an image is read by its ``rows``, a volume by its ``slices`` unless it is in memory
    # what shares a label; by default as in `seeds_from_raster`, but a photograph is looked for only in the first part
    # that has two values
    mode: str | None = None
    connectivity: int = 8
    threshold: float | None = None  # foreground is what is larger
    invert: bool = False  # exchange foreground and background
    step: int = 512  # rows or slices that are read at a time: best those that are asked for

    @property
    def corners(self) -> bool:
        """Whether components hang together by corners."""
        return self.connectivity in (8, 26)

    def limits(self) -> Iterator[tuple[int, int]]:
        """First row or slice, and number of them, of the parts in which it is read."""
        whole = self.source.shape[0]
        return ((first, min(self.step, whole - first)) for first in range(0, whole, self.step))

    def read(self, first: int, count: int) -> NDArray[Any]:
        """Read some rows or slices."""
        if isinstance(self.source, Volume):
            return self.source.values[first : first + count]
        is_flat = len(self.source.shape) == 2
        return (self.source.rows if is_flat else self.source.slices)(first, count)

    def values(self, first: int, count: int) -> NDArray[Any]:
        """Read some rows or slices, of which the nonzero values are foreground."""
        values = self.read(first, count)
        if values.ndim == 2:
            return foreground_values(Raster(values), self.threshold, invert=self.invert)  # parts may be masked
        if self.threshold is not None:
            values = values > whole_threshold(values, self.threshold)
        _require_finite(values, "volume")
        return values == 0 if self.invert else values

    def labels(self, first: int, count: int) -> NDArray[Any]:
        """Read the values of some rows or slices as labels, in an unsigned type."""
        return label_values(self.values(first, count), first=first)

    def mask(self, first: int, count: int) -> NDArray[np.uint8]:
        """Read the foreground of some rows or slices, as zeros and ones."""
        return np.ascontiguousarray(self.values(first, count) != 0).view(np.uint8)

    def kind(self, *, note: Note = None) -> Objects:
        """Tell whether the nonzero values are of a mask or labels, as `default_objects` does of an image."""
        if self.threshold is not None or checked_flag(self.invert, "invert"):
            return "components"
        one, found = only_value((first, self.values(first, count)) for first, count in self.limits())
        if found is None:
            return objects_of_value(one, note=note)
        first, values = found
        if values.ndim == 2:
            refuse_photograph(values)
        else:
            _refuse_gray(values, first)
        return "labels"

    def with_otsu(self) -> PartwiseObjects:
        """Settle the threshold by Otsu's method, for which the volume is read."""
        number, is_flat = _otsu(replace(self, threshold=None))
        return replace(self, threshold=number, invert=self.invert and not is_flat)


def _refuse_gray(values: NDArray[Any], first: int) -> None:
    """Refuse what looks like gray values, in the first slice that has two values beside 0."""
    several = (
        number for number, plane in enumerate(values) if plane.any() and (plane[plane != 0] != plane.max()).any()
    )
    at = next(several, None)
    if at is None:
        return
    plane, number = values[at], first + at
    if plane.dtype.kind != "f" or (plane == np.floor(plane)).all():
        plane = label_values(plane[None], first=number)[0]
    looks, distinct, fragments = photograph_signs(plane)
    if looks:
        raise InputError(
            f"slice {number} of the volume holds {distinct} different values in {fragments} connected pieces, like "
            f"gray values: use {mask_options(plane)}, {_THRESHOLD}, or {_AS_LABELS} if these are labels"
        )


def _otsu(objects: PartwiseObjects) -> tuple[float, bool]:
    """Otsu's threshold of a volume, and whether all voxels have that value; all floats are held."""
    slabs = (objects.read(first, count) for first, count in objects.limits())
    first = next(slabs)
    if first.dtype.kind == "f":
        values = np.concatenate([first, *slabs])
        _require_finite(values, "volume")
        low, high = values.min().item(), values.max().item()
        return (low, True) if low == high else (otsu_threshold(values), False)
    distinct, counts = _counted(first)
    for slab in slabs:
        more, times = _counted(slab)
        both = np.concatenate([distinct, more])
        distinct, index = np.unique(both, return_inverse=True)
        total = np.zeros(len(distinct), np.int64)
        np.add.at(total, index, np.concatenate([counts, times]))
        counts = total
    if len(distinct) == 1:
        return int(distinct[0]), True
    offsets = distinct.astype(np.uint64) - distinct[0].astype(np.uint64)  # modulo 2^64, so right where it is signed
    return int(distinct[best_split(offsets, counts)]), False


def _counted(slab: NDArray[Any]) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Give the distinct integers of a slab, and how often each occurs."""
    slab = slab.view(np.uint8) if slab.dtype == bool else slab
    if slab.dtype.itemsize > _NARROW:
        distinct, counts = np.unique(slab, return_counts=True)
        return distinct, counts.astype(np.int64)
    least, kinds = int(np.iinfo(slab.dtype).min), 1 << 8 * slab.itemsize
    counts = np.zeros(kinds, np.int64)
    for plane in slab:
        counts += np.bincount(plane.reshape(-1).astype(np.int32) - least, minlength=kinds)
    present = np.flatnonzero(counts)
    return (present + least).astype(slab.dtype), counts[present]


NARROW = 2
"""Bytes of integers of which scikit-image makes a histogram with a bin for each value from the least to the largest."""

BINS = 256
"""Of floating-point numbers, in scikit-image."""

LIMB = 22
"""Bits of a part of an integer: sums of 2^42 parts fit in 64 bits."""

MARGIN = 16 * 2.0**-53
"""Bounds the error of a mean, a quotient of sums that are exact but for the rounding of five operations, and of the
difference of two, as a part of the larger one."""


def otsu_threshold(gray: NDArray[Any]) -> float:
    """Give the largest value of the lower class; of floating-point numbers, the middle of a bin."""
    if gray.dtype.kind == "f":
        return _of_floats(gray)
    if gray.dtype.itemsize <= NARROW:
        from skimage.filters import threshold_otsu

        return int(threshold_otsu(gray))
    values, counts = np.unique(gray, return_counts=True)
    offsets = values.astype(np.uint64) - values[0].astype(np.uint64)  # modulo 2^64, so right where the type is signed
    return int(values[best_split(offsets, counts)])


def _of_floats(gray: NDArray[Any]) -> float:
    """Otsu's threshold in a histogram, of values whose squares are numbers: scaled by a power of two where needed."""
    from skimage.filters import threshold_otsu

    low, high = float(gray.min()), float(gray.max())
    exponent = int(np.frexp(max(-low, high))[1])
    if abs(exponent) <= np.finfo(gray.dtype).maxexp // 8:
        exponent = 0
    else:
        gray = np.ldexp(gray.astype(np.float64), -exponent)
        low, high = float(np.ldexp(low, -exponent)), float(np.ldexp(high, -exponent))
    if high - low <= 2 * BINS * float(np.spacing(gray.dtype.type(max(-low, high)))):  # there are not so many bins
        values, counts = np.unique(gray.astype(np.float64), return_counts=True)
        steps = (values - values[0]) / np.spacing(np.abs(values).min())  # exact: the values are so near each other
        return float(np.ldexp(values[best_split(steps.astype(np.uint64), counts)], exponent))
    return float(np.ldexp(float(threshold_otsu(gray)), exponent))


def best_split(values: NDArray[np.uint64], counts: NDArray[np.int64]) -> int:
    """Give the index of the last value of the lower class, exactly."""
    below = np.cumsum(counts)[:-1]
    total = int(counts.sum())
    parts = [(values >> np.uint64(bits)) & np.uint64((1 << LIMB) - 1) for bits in range(0, 64, LIMB)]
    limbs = [np.cumsum(part.astype(np.int64) * counts) for part in parts]
    sums = [int(limb[-1]) for limb in limbs]
    lower = sum(np.ldexp(limb[:-1].astype(np.float64), LIMB * k) for k, limb in enumerate(limbs)) / below
    upper = sum(np.ldexp((all_ - limb[:-1]).astype(np.float64), LIMB * k)
                for k, (limb, all_) in enumerate(zip(limbs, sums, strict=True))) / (total - below)  # fmt: skip
    weight = below * (total - below.astype(np.float64))
    error = MARGIN * upper
    least = weight * np.square(np.maximum(upper - lower - error, 0)) * (1 - MARGIN)
    most = weight * np.square(upper - lower + error) * (1 + MARGIN)
    return _largest(np.flatnonzero(most >= least.max()), below, limbs, total)


def _largest(candidates: NDArray[np.intp], below: NDArray[np.int64], limbs: list[NDArray[np.int64]], total: int) -> int:
    """Compare variances as fractions: (N s - n S)² / (n (N - n)), where n of N values are below, with sums s and S."""

    def sum_to(index: int) -> int:
        return sum(int(limb[index]) << (LIMB * k) for k, limb in enumerate(limbs))

    best, above, under = -1, -1, 1
    everything = sum_to(-1)
    for index in candidates.tolist():
        n = int(below[index])
        numerator, denominator = (total * sum_to(index) - n * everything) ** 2, n * (total - n)
        if numerator * under > above * denominator:
            best, above, under = index, numerator, denominator
    return best
