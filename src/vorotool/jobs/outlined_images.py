"""What skeletons are made of: polygons, or the outlines of an image."""

from __future__ import annotations

from dataclasses import replace
from math import ceil
from typing import TYPE_CHECKING, Any, NamedTuple

from vorotool.formats.opening import opened
from vorotool.jobs.inputs import JobInput, read_opened, report_no_geometry
from vorotool.jobs.options import OF_IMAGES, Options, changed
from vorotool.jobs.pixel_sizes import placed_polygons, with_pixel_size
from vorotool.jobs.refusals import refuse
from vorotool.jobs.run_log import Run
from vorotool.jobs.units import lengths_in_steps, sides_of
from vorotool.products.formats import resolved
from vorotool.products.registry import is_of

if TYPE_CHECKING:
    from vorotool.engines.tessellation.cleaned_masks import Cleaning
    from vorotool.types.images import Raster
    from vorotool.types.pixels import Frame, PixelGrid
    from vorotool.types.polygons.polygon_set import PolygonSet

UNPRUNED = {"diagram", "discs", "elements", "necks", "offset", "parts", "thickness"}
"""Results that pruning does not change."""

SIMPLIFY = "engines.label_images.outlines:simplified_polygons"
PRUNE_CURVES = ", whose corners each have a branch: --prune angle=20 removes these branches"


class ReadPolygons(NamedTuple):
    """What skeletons are made of."""

    polygons: PolygonSet  # those of the input, or outlines
    is_mask: bool  # whether they are the outlines of an image
    options: Options  # with the size of pixels, and places, as the image has them
    frame: Frame | None = None  # the pixels of the image
    grid: PixelGrid | None = None  # what the image says of its pixels


def read_polygons(run: Run, o: Options, given: JobInput) -> ReadPolygons:
    """Read polygons, or the outlines of an image."""
    advice = "" if o.prune is not None or set(o.what) <= UNPRUNED else PRUNE_CURVES
    with opened(given.path, geometry="polygons", **o.opening) as source:
        o, value = read_opened(run, o, given, source, curves_advice=advice)
    if is_of(value, "Raster"):
        return outlined(run, o, given, value)
    refuse(o, ("spacing", *OF_IMAGES), "applies to images, but the input is polygons or lines")
    if not len(value):
        report_no_geometry(run, o)
    return ReadPolygons(
        value if o.simplify is None else _simplified(run, o, value, o.simplify), is_mask=False, options=o
    )


def outlined(run: Run, o: Options, given: JobInput, image: Raster) -> ReadPolygons:
    """Give the outlines of an image."""
    from vorotool.types.pixels import Frame

    o = with_pixel_size(run, o, given, image.grid)
    sides_of(o)
    o = lengths_in_steps(o)
    height, width = image.values.shape[:2]
    frame = Frame(0, 0, width, height)
    if o.simplify is None or o.spacing is None:
        polygons = placed_polygons(o.pixel_size, _outlines(run, o, image))
    else:
        whole = placed_polygons(o.pixel_size, _outlines(run, changed(o, simplify=None), image))
        polygons = resolved(SIMPLIFY)(whole, o.simplify)
    return ReadPolygons(polygons, is_mask=True, options=o, frame=frame, grid=image.grid)


def _outlines(run: Run, o: Options, image: Raster) -> PolygonSet:
    image, threshold, invert, cleaning = settled_foreground(run, o, image)
    how = {
        "outline": o.outline or "crack",
        "border": "open" if o.border == "open" else "closed",
        **{"mode": o.seeds, "connectivity": int(o.connectivity or 8), "threshold": threshold, "invert": invert},
        "min_area": None if cleaning is None else cleaning.min_area or None,
        "fill_holes": cleaning is not None and cleaning.fill_holes,
        "simplify": o.simplify,
    }
    return run.call(o, "engines.label_images.outlines:outlines", image, phase="outline", **how)


def _simplified(run: Run, o: Options, polygons: PolygonSet, tolerance: float) -> PolygonSet:
    """Simplify polygons once they are cut where they meet."""
    with run.phase("simplify"):
        how: dict[str, Any] = {"strict": o.strict, "threads": o.threads}
        graph = resolved("engines.arrangement.planar_graph:graph_for_skeletons")(polygons, **how)
        shapes = resolved("engines.arrangement.repaired_polygons:placed_shapes")(graph)
        return resolved(SIMPLIFY)(shapes.polygons, tolerance)


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
