"""Otsu's threshold of numbers of any size: the one between whose two classes the variance is largest."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

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
