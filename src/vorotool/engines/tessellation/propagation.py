"""The paper's own tessellation (section 2.2): two passes that propagate labels, to the letter."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.tessellation.frames import (
    band_limits,
    check_out,
    default_frame,
    label_dtype,
    report_duplicates,
    require_memory,
    require_seeds,
)
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import InputError, UsageError, option
from vorotool.numeric.checks import is_choice
from vorotool.numeric.numbers import shown_number
from vorotool.numeric.parallel import Progress
from vorotool.types.images import LabelImage
from vorotool.types.pixels import MAX_PIXELS, Frame
from vorotool.types.points.seed_set import SeedSet

_EXACT = option("--method exact", 'method="exact"')


def propagate(
    seeds: SeedSet,
    frame: Frame | None = None,
    *,
    passes: int = 2,
    progress: Progress = None,
) -> LabelImage:
    """Run the paper's two passes to the letter (section 2.2), with an implicit frame of zero labels."""
    if not is_choice(passes, (1, 2)):
        raise UsageError(f"passes is {shown_number(passes)}: it must be 1 or 2")
    require_seeds(seeds)
    frame = frame or default_frame(seeds)
    if seeds.scale != 1:
        raise InputError(f"the paper's propagation starts from pixels: round the seeds, or use {_EXACT}")
    x, y = seeds.x - frame.x, seeds.y - frame.y
    outside = np.flatnonzero((x < 0) | (y < 0) | (x >= frame.width) | (y >= frame.height))
    if outside.size:
        i = int(outside[0])
        raise InputError(
            f"seed {i + 1} at ({seeds.x[i]}, {seeds.y[i]}) is outside the frame, and the paper's propagation starts "
            f"from its pixels: use a larger {option('--size', 'shape')} or {option('--window')}, or {_EXACT}"
        )
    labels = np.empty(frame.shape, np.uint32)
    _core.tessellation.propagate(x, y, seeds.labels, passes, labels, progress)
    return LabelImage(labels.astype(label_dtype(seeds.largest_label), copy=False), frame, seeds)


class PropagatedRows:
    """The paper's tessellation, held in memory, with the interface of `Tessellator` for its rows."""

    def __init__(
        self,
        seeds: SeedSet,
        frame: Frame | None = None,
        *,
        passes: int = 2,
        strict: bool = False,
        max_pixels: int = MAX_PIXELS,
        progress: Progress = None,
    ) -> None:
        require_seeds(seeds)
        self.seeds = seeds
        self.frame = frame or default_frame(seeds)
        require_memory(self.frame, max_pixels)
        self._labels = propagate(seeds, self.frame, passes=passes, progress=progress).labels
        with warnings.catch_warnings(action="ignore"):
            self._exact = Tessellator(seeds, self.frame)
        self.duplicates = self._exact.duplicates
        report_duplicates(self.duplicates, len(seeds), strict=strict)

    def labels(
        self, first: int = 0, rows: int | None = None, *, dtype: Any = None, out: NDArray[Any] | None = None
    ) -> NDArray[Any]:
        """Labels of some rows, as `Tessellator.labels` gives them."""
        found = self._labels[first : self.frame.height if rows is None else first + rows]
        if out is None:
            return found.astype(label_dtype(self.seeds.largest_label, dtype), copy=False)
        check_out(out, found.shape)
        label_dtype(self.seeds.largest_label, out.dtype)
        out[...] = found
        return out

    def compare_with_exact(self) -> dict[str, Any]:
        """Count the pixels that differ from the exact tessellation, and name the first in raster order."""
        count, first = 0, None
        for start, rows in band_limits(self.frame):
            found, exact = self.labels(start, rows), self._exact.labels(start, rows)
            wrong = found != exact
            count += int(wrong.sum())
            if first is None and wrong.any():
                row, column = (int(v) for v in np.unravel_index(int(wrong.argmax()), wrong.shape))
                first = {
                    "x": self.frame.x + column,
                    "y": self.frame.y + start + row,
                    "label": int(found[row, column]),
                    "exact_label": int(exact[row, column]),
                }
        return {"wrong_pixels": count, "first_wrong": first}
