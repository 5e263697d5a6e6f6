"""``vorotool draw``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.options.help_page import GroupedCommand
from vorotool.cli.options.picture_style import page_option, picture_style_options
from vorotool.cli.options.pixel_size import drawn_pixel_size_option
from vorotool.cli.options.shared import batch_options, inputs_argument, layers_option, output_options, shared
from vorotool.cli.run import run_command
from vorotool.jobs.inputs import JobInput
from vorotool.jobs.job import Recipe
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.products.inputs import DRAWN_NAMES
from vorotool.products.registry import all_layers, formats_of

if TYPE_CHECKING:
    from vorotool.jobs.drawing import Picture

FORMATS = formats_of("draw")


@click.command("draw", cls=GroupedCommand)
@inputs_argument(DRAWN_NAMES)
@output_options(FORMATS)
@shared("input-format", "input-layer", "page")
@layers_option(all_layers("draw"))
@shared("overlay", "width", "y-up")
@picture_style_options()
@page_option()
@drawn_pixel_size_option()
@shared("out-dir", "threads", "stats", "max-pixels")
@batch_options(table=False)
@shared("no-clobber", "overwrite", "quiet", "verbose")
def command(**options: Any) -> None:
    """Draw a label image, in which neighboring regions never share a color, a skeleton, a Voronoi map, or shapes.

    \b
    Example:
      vorotool sample cells.png -o cells.png
      vorotool draw cells.png -o cells.svg

    INPUT is a label image (PNG, TIFF, PGM, NPY, Zarr), such as tessellate writes, a skeleton or a Voronoi map
    (JSON, NPZ), the JSON of offset curves, or shapes: polygons and lines (GeoJSON, WKT, JSON, Triangle .poly, SVG,
    DXF), such as centerlines and alpha shapes; - is standard input.
    """
    run_command(RECIPE, Options("draw", what=("picture",), **options))


def _products(run: Run, o: Options, given: JobInput) -> Picture:
    from vorotool.jobs.drawing import Picture

    return Picture(run, o, given)


def _check_options(o: Options, targets: list[Target]) -> None:
    """What there can be in a picture depends on the input."""


RECIPE = Recipe("draw", FORMATS, _check_options, _products)
