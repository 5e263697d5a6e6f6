"""What skeletons are made of: polygons, or the outlines of an image."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

from vorotool.jobs.inputs import IMAGE_OPTIONS, note_other_size, refuse, settle_threshold
from vorotool.jobs.run_log import Run

if TYPE_CHECKING:
    from vorotool.geometry.points.raster import Raster
    from vorotool.geometry.polygons.polygon_set import PolygonSet


def read_polygons(run: Run, o: SimpleNamespace, source: str) -> PolygonSet:
    """Read polygons, or the outlines of an image; ``o.is_mask`` tells which it was."""
    from vorotool.formats import read
    from vorotool.geometry.points.raster import Raster
    from vorotool.geometry.polygons.polygon_set import PolygonSet

    value = read(
        source,
        geometry="polygons",
        input_format=o.input_format,
        page=o.page,
        max_pixels=o.max_pixels,
        max_sites=o.max_sites,
        properties=not o.no_properties,
        threads=o.threads,
        note=run.note,
        crs=o.input_crs,
    )
    o.is_mask = isinstance(value, Raster)
    if isinstance(value, Raster):
        return _outlines(run, o, value)
    assert isinstance(value, PolygonSet)  # what is asked for is polygons, or an image
    refuse(o, (*IMAGE_OPTIONS, "outline"), "is for images, but the input is polygons or lines")
    return value if o.simplify is None else _simplified(run, o, value)


def _outlines(run: Run, o: SimpleNamespace, image: Raster) -> PolygonSet:
    from vorotool.engines.label_images.outlines import outlines

    note_other_size(run, o, image.values.shape)
    settle_threshold(run, o, image)
    with run.phase("outline"):
        return outlines(
            image,
            outline=o.outline or "crack",
            mode=o.seeds,
            connectivity=int(o.connectivity or 8),
            threshold=o.threshold,
            invert=o.invert,
            simplify=o.simplify,
            strict=o.strict,
            max_sites=o.max_sites,
            threads=o.threads,
            progress=run.progress("outlines"),
            note=run.note,
        )


def _simplified(run: Run, o: SimpleNamespace, polygons: PolygonSet) -> PolygonSet:
    """Simplify polygons once they are cut where they meet."""
    from vorotool.engines.arrangement.lattice_rings import placed_shapes
    from vorotool.engines.arrangement.planar_graph import graph_for_skeletons
    from vorotool.engines.label_images.simplification import simplified_polygons

    with run.phase("simplify"):
        graph = graph_for_skeletons(polygons, strict=o.strict, threads=o.threads)
        return simplified_polygons(placed_shapes(graph, threads=o.threads).polygons, o.simplify)
