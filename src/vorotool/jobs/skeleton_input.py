"""What skeletons are made of: polygons, or the outlines of an image."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from vorotool.jobs.inputs import JobInput, opened_input, read_opened, report_no_geometry
from vorotool.jobs.masks import settled_foreground
from vorotool.jobs.options import Options, changed
from vorotool.jobs.pixel_sizes import placed_polygons, with_pixel_size
from vorotool.jobs.refusals import refuse
from vorotool.jobs.run_log import Run
from vorotool.jobs.units import lengths_in_steps, sides_of

if TYPE_CHECKING:
    from vorotool.types.images import Raster
    from vorotool.types.pixels import Frame, PixelGrid
    from vorotool.types.polygons.polygon_set import PolygonSet

UNPRUNED = {"diagram", "discs", "elements", "necks", "offset", "parts", "thickness"}
"""Results that pruning does not change."""

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
    from vorotool.types.images import Raster
    from vorotool.types.polygons.polygon_set import PolygonSet

    advice = "" if o.prune is not None or set(o.what) <= UNPRUNED else PRUNE_CURVES
    with opened_input(o, given, "polygons") as source:
        o, value = read_opened(run, o, given, source, curves_advice=advice)
    if isinstance(value, Raster):
        return outlined(run, o, given, value)
    assert isinstance(value, PolygonSet)  # what is asked for is polygons, or an image
    refuse(o.for_images, "applies to images, but the input is polygons or lines")
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
        from vorotool.engines.label_images.outlines import simplified_polygons

        whole = placed_polygons(o.pixel_size, _outlines(run, changed(o, simplify=None), image))
        polygons = simplified_polygons(whole, o.simplify)
    return ReadPolygons(polygons, is_mask=True, options=o, frame=frame, grid=image.grid)


def _outlines(run: Run, o: Options, image: Raster) -> PolygonSet:
    from vorotool.engines.label_images.outlines import outlines

    image, threshold, invert, cleaning = settled_foreground(run, o, image)
    with run.phase("outline") as progress:
        return outlines(
            image,
            outline=o.outline or "crack",
            border="open" if o.has_open_border else "closed",
            mode=o.seeds,
            connectivity=int(o.connectivity or 8),
            threshold=threshold,
            invert=invert,
            min_area=None if cleaning is None else cleaning.min_area or None,
            fill_holes=cleaning is not None and cleaning.fill_holes,
            simplify=o.simplify,
            strict=o.strict,
            max_sites=o.max_sites,
            threads=o.threads,
            progress=progress,
            note=run.note,
        )


def _simplified(run: Run, o: Options, polygons: PolygonSet, tolerance: float) -> PolygonSet:
    """Simplify polygons once they are cut where they meet."""
    from vorotool.engines.arrangement.planar_graph import graph_for_skeletons
    from vorotool.engines.arrangement.repaired_polygons import placed_shapes
    from vorotool.engines.label_images.outlines import simplified_polygons

    with run.phase("simplify"):
        graph = graph_for_skeletons(polygons, strict=o.strict, threads=o.threads)
        return simplified_polygons(placed_shapes(graph, threads=o.threads).polygons, tolerance)
