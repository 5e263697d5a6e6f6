"""Which options of ``voronoi`` go together, and with which results."""

from __future__ import annotations

from vorotool.errors import UsageError
from vorotool.jobs.options import Options
from vorotool.jobs.skeleton_checks import check_frame, check_join_tolerance, check_layers, may_be_drawn
from vorotool.jobs.targets import Target, check_picture_options, check_precision
from vorotool.products.formats import FORMATS, PICTURES
from vorotool.products.registry import PRODUCTS, formats_of, layers_of


def check_options(o: Options, targets: list[Target]) -> None:
    """Refuse what does not go together, or what no output would show."""
    formats = {target.fmt for target in targets}
    check_precision(o, formats_of("voronoi"), targets)
    if o.flatten is not None and not any(map(_flattens, targets)) and not may_be_drawn(o):
        raise UsageError(
            "--flatten is for drawings that are read, and for what has no curves: use -f geojson, wkt or csv, or leave "
            "it out"
        )
    check_join_tolerance(o)
    if o.by is not None and o.no_properties:
        raise UsageError("--by joins features by a column: leave out --no-properties")
    if o.count is not None and "discs" not in o.what:
        raise UsageError("--count is for discs: use --what discs, or leave it out")
    for name, value in (("--max-distance", o.max_distance), ("--enclosures", o.enclosures), ("--by", o.by)):
        if value is not None and set(o.what) == {"discs"}:
            raise UsageError(f"{name} is for cells, but discs are between all that there is: leave it out")
    if o.frame is not None:
        check_frame(o.frame)
    pictures = sorted(formats & set(PICTURES))
    if o.layers is not None and not pictures:
        raise UsageError("--layers is for pictures: use -f svg or -f png, or leave it out")
    check_layers(o, PRODUCTS["voronoi"], targets)
    check_picture_options(o, pictures, layers_of("voronoi"), png_has_width=True)


def _flattens(target: Target) -> bool:
    """Whether curves become lines in an output: in columns of WKT, too."""
    has_column = target.what == "cells" and target.fmt in ("csv", "tsv")
    return PRODUCTS["voronoi"][target.what].is_curved and (FORMATS[target.fmt].flattens or has_column)
