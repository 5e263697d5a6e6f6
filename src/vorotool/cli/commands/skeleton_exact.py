"""``vorotool skeleton-exact``."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.commands.skeletons import run_skeletons
from vorotool.cli.options.skeleton import Length, skeleton_options
from vorotool.errors import UsageError

if TYPE_CHECKING:
    from vorotool.geometry.polygons.polygon_set import PolygonSet
    from vorotool.jobs.exact_skeleton import ExactProducts
    from vorotool.jobs.run_log import Run


@click.command("skeleton-exact")
@skeleton_options(
    click.option(
        "--features",
        type=click.Choice(["separate", "together"]),
        default="separate",
        help="Take each feature as if there were no others, whatever lies in it or over it (default), or all as one "
        "drawing.",
    ),
    click.option(
        "--gap",
        type=Length(zero=True),
        metavar="STEP",
        default=0.0,
        help="Shorten each edge by STEP at both ends, as the paper does; by default 0, which is exact.",
    ),
    click.option(
        "--complete/--no-complete",
        default=None,
        help="With a gap, add the straight portions that lead to the corners (default) or leave them out.",
    ),
)
def command(**options: Any) -> None:
    """Compute the exact skeleton (medial axis) of polygons: straight lines and parabolas, each with its radius.

    \b
    Example:
      vorotool skeleton-exact data/two-shapes.json -o skeleton.svg

    INPUT holds polygons or open lines (JSON, GeoJSON, WKT, Triangle .poly), or is a mask or a label image (PNG, TIFF,
    PGM, JPEG, NPY), whose objects have outlines; - is standard input. Polygons are placed on a lattice of 31 bits over
    their extent; where one crosses, touches or overlaps itself it is cut, with a warning. Of the
    Voronoi diagram of vertices and open edges, the edges between an edge and its own end are left out. What is drawn
    inside polygons comes first, polygon by polygon; arcs of a branch follow each other.
    """
    o = SimpleNamespace(**options)
    if o.complete is not None and not o.gap:
        raise UsageError("nothing is missing without a gap: use --gap STEP, or leave --complete out")
    run_skeletons("skeleton-exact", o, _products)


def _products(polygons: PolygonSet, o: SimpleNamespace, run: Run) -> ExactProducts:
    from vorotool.jobs.exact_skeleton import ExactProducts

    return ExactProducts(polygons, o, run)
