"""``vorotool skeleton-exact``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.options.help_page import GroupedCommand
from vorotool.cli.options.lengths import Length
from vorotool.cli.options.skeleton import skeleton_options
from vorotool.cli.run import run_command
from vorotool.errors import UsageError
from vorotool.jobs.animations import animated
from vorotool.jobs.inputs import JobInput
from vorotool.jobs.job import Recipe
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.skeleton_checks import check_options
from vorotool.products.registry import formats_of

if TYPE_CHECKING:
    from vorotool.jobs.skeletons.exact import ExactProducts


@click.command("skeleton-exact", cls=GroupedCommand, instead={"--offset": "give -d D with --what offset"})
@skeleton_options(
    click.option(
        "--gap",
        type=Length(zero=True),
        metavar="STEP",
        default=0.0,
        help="Shorten each edge by STEP at both ends, as the paper does; by default 0, which is exact.",
    ),
    click.option(
        "--border",
        type=click.Choice(["closed", "open"], case_sensitive=False),
        help="What objects do at the border of an image: they end there (closed, default), or go on, so that the "
        "skeleton runs to the border and does not fork.",
    ),
    click.option(
        "--complete/--no-complete",
        default=None,
        help="With a gap, add the straight portions that lead to the corners (default) or leave them out.",
    ),
    click.option(
        "--neck",
        type=click.FloatRange(0, 1),
        metavar="RATIO",
        help="Necks of --what necks, and cuts of --what parts: where half the width is at most RATIO times the largest "
        "clearance on either side (default 0.95 for necks, 0.5 for parts).",
    ),
)
def command(**options: Any) -> None:
    """Compute the exact skeleton (medial axis) of polygons: straight lines and parabolas, each with its radius.

    \b
    Example:
      vorotool sample two-shapes.json -o two-shapes.json
      vorotool skeleton-exact two-shapes.json -o skeleton.svg

    INPUT holds polygons or open lines (JSON, GeoJSON, WKT, Triangle .poly, SVG, DXF), or is a mask or a label image
    (PNG, TIFF, PGM, JPEG, NPY), whose objects have outlines; - is standard input. Polygons are placed on a lattice
    of 31 bits over their extent; where one crosses, touches or overlaps itself it is cut, with a warning. Of the
    Voronoi diagram of vertices and open edges, the edges between an edge and its own end are left out. What is
    drawn inside polygons comes first, polygon by polygon; arcs of a branch follow each other.
    """
    o = Options("skeleton-exact", **animated(options))
    if o.complete is not None and not o.gap:
        raise UsageError("nothing is missing without a gap: use --gap STEP, or leave --complete out")
    run_command(RECIPE, o)


def _products(run: Run, o: Options, given: JobInput) -> ExactProducts:
    from vorotool.jobs.skeletons.exact import ExactProducts

    return ExactProducts(run, o, given)


RECIPE = Recipe("skeleton-exact", formats_of("skeleton-exact"), check_options, _products, "polygons")
