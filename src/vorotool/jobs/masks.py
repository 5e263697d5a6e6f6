"""Which pixels of an image are foreground, as the options say: by a threshold, without holes and small objects."""

from __future__ import annotations

from dataclasses import replace
from math import ceil
from typing import TYPE_CHECKING, NamedTuple

from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run

if TYPE_CHECKING:
    from vorotool.engines.tessellation.cleaned_masks import Cleaning
    from vorotool.types.images import Raster


class Foreground(NamedTuple):
    """What of an image is foreground: what is larger than the threshold, or else what is not."""

    image: Raster  # with its values, or a mask that was cleaned
    threshold: float | None  # none where values tell
    invert: bool  # exchange foreground and background
    cleaning: Cleaning | None = None  # what is yet to be filled and left out


def settled_foreground(run: Run, o: Options, image: Raster) -> Foreground:
    """Find the threshold, which is in the statistics, and clean the mask if that is asked for."""
    found = _by_threshold(run, o, image)
    return found if not o.cleans_masks else _cleaned(run, o, found)


def _by_threshold(run: Run, o: Options, image: Raster) -> Foreground:
    """Find the threshold of Otsu's method if it is asked for: as a number it is said."""
    if o.threshold != "otsu":
        if o.threshold is not None:
            run.stats["threshold"] = o.threshold
        return Foreground(image, o.threshold, o.invert)
    from vorotool.engines.tessellation.raster_objects import (
        MOSTLY,
        counted_values,
        is_flat,
        settled_threshold,
        whole_threshold,
    )

    gray = counted_values(image)
    found = Foreground(image, *settled_threshold(image, "otsu", invert=o.invert))
    if is_flat(gray):
        run.note(f"all pixels have the value {found.threshold:.17g}: Otsu's method finds no foreground")
        run.stats["threshold"] = None
        return found
    run.note(f"threshold {found.threshold:.17g}, by Otsu's method")
    run.stats["threshold"] = found.threshold
    assert found.threshold is not None  # Otsu's method gives a number
    bright = float((gray > whole_threshold(gray, found.threshold)).mean())
    if not o.invert and bright > MOSTLY:
        share = f"{bright:.0%} of the image"
        run.note(f"{share} is brighter and becomes foreground: for dark objects, such as ink on paper, use --invert")
    return found


def _cleaned(run: Run, o: Options, found: Foreground) -> Foreground:
    """Fill holes and leave out small objects, as the options say."""
    import numpy as np

    from vorotool.engines.tessellation.cleaned_masks import Cleaning, cleaned_values
    from vorotool.engines.tessellation.raster_objects import foreground_values

    cleaning = Cleaning.of(o.min_area, o.fill_holes)
    values = foreground_values(found.image, found.threshold, invert=found.invert)
    cleaned = cleaned_values(values, cleaning, o.seeds, connectivity=int(o.connectivity or 8), missing=found.image.mask)
    report_cleaning(run, o, cleaned.filled, (cleaned.removed, cleaned.objects), "pixels")
    if o.outline == "contour" and found.threshold is not None:
        return found._replace(cleaning=cleaning)  # contours follow the gray values
    mask = cleaned.mask.view(np.uint8)
    return Foreground(replace(found.image, values=mask, mask=None, is_lossy=False), None, invert=False)


def report_cleaning(run: Run, o: Options, filled: int, removed: tuple[int, int], what: str) -> None:
    """Put what was filled and left out into the statistics, and into a note."""
    from vorotool.numeric.numbers import shown_number

    if o.fill_holes:
        run.stats[f"filled_{what}"] = filled
    if o.min_area is not None:
        run.stats["small_objects"] = removed[0]
        if removed[0]:
            least = shown_number(ceil(o.min_area))
            run.note(f"{removed[0]} of {removed[1]} objects have fewer than {least} {what}: dropped")
