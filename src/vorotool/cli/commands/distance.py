"""``vorotool distance``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.options.help_page import GroupedCommand
from vorotool.cli.options.picture_style import page_option, picture_style_options
from vorotool.cli.options.shared import layers_option, output_options, shared, what_option
from vorotool.cli.options.suggestions import files
from vorotool.cli.run import run_command
from vorotool.jobs.inputs import JobInput, refuse_several
from vorotool.jobs.job import Recipe
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.products.inputs import NAMES_WITH
from vorotool.products.registry import all_layers, formats_of

if TYPE_CHECKING:
    from vorotool.jobs.distances import DistanceProducts

FORMATS = formats_of("distance")


@click.command("distance", cls=GroupedCommand)
@click.argument("a", metavar="A", shell_complete=files(NAMES_WITH["sites"]))
@click.argument("b", metavar="B", shell_complete=files(NAMES_WITH["sites"]))
@output_options(FORMATS)
@what_option(tuple(FORMATS))
@click.option("--boundary", is_flag=True, help="Polygons are their outlines; by default they are filled.")
@shared("columns", "input-format", "input-layer", "input-crs", "crs", "page")
@layers_option(all_layers("distance"))
@shared("width", "y-up")
@picture_style_options()
@page_option()
@shared(
    *("threads", "stats", "verify", "strict", "decimals", "precision", "max-pixels", "max-sites", "no-clobber"),
    *("overwrite", "quiet", "verbose"),
)
def command(a: str, b: str, **options: Any) -> None:
    """Measure how far two shapes are apart: the Hausdorff distance, both ways, and the smallest distance.

    \b
    Example:
      vorotool sample two-shapes.json -o two-shapes.json
      vorotool sample segments.wkt -o segments.wkt
      vorotool distance two-shapes.json segments.wkt

    A and B hold points, lines and polygons, mixed as they come (GeoJSON, WKT, CSV, JSON, Triangle .poly, SVG, DXF and
    files of maps), or are masks or label images (PNG, TIFF, PGM, JPEG, NPY), whose objects have outlines; - is standard
    input for one of them. All of each is one shape, polygons are filled. The Hausdorff distance is the largest distance
    from a place of one to the nearest place of the other; all places count, not vertices only. Each row has the places,
    which GeoJSON and WKT have lines between, and pictures show.
    """
    refuse_several({"A": a, "B": b})
    run_command(RECIPE, Options("distance", inputs=(a,), other=b, **options))


def _check_options(o: Options, targets: list[Target]) -> None:
    from vorotool.jobs.distances import check_options

    check_options(o, targets)


def _products(run: Run, o: Options, given: JobInput) -> DistanceProducts:
    from vorotool.jobs.distances import DistanceProducts

    return DistanceProducts(run, o, given)


RECIPE = Recipe("distance", FORMATS, _check_options, _products, "sites")
