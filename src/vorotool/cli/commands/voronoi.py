"""``vorotool voronoi``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.options.groups import result_options
from vorotool.cli.options.help_page import GroupedCommand
from vorotool.cli.options.lengths import Length
from vorotool.cli.options.pixel_size import spacing_option
from vorotool.cli.options.shapes import frame_option, shape_options
from vorotool.cli.options.shared import inputs_argument, output_options, what_option
from vorotool.cli.options.suggestions import files
from vorotool.cli.run import run_command
from vorotool.jobs.inputs import JobInput
from vorotool.jobs.job import Recipe
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.voronoi_checks import check_options
from vorotool.products.inputs import NAMES_WITH, names_of
from vorotool.products.registry import all_layers, formats_of

if TYPE_CHECKING:
    from vorotool.jobs.voronoi import VoronoiProducts

FORMATS = formats_of("voronoi")


@click.command("voronoi", cls=GroupedCommand)
@inputs_argument(NAMES_WITH["sites"])
@output_options(FORMATS)
@what_option(tuple(FORMATS))
@click.option("--by", metavar="COLUMN", help="Join features with the same value in this column into one site.")
@frame_option("Cut cells")
@click.option(
    "--clip",
    metavar="POLYGONS",
    help="File of polygons that cells are cut by, too; the frame is then around these.",
    shell_complete=files(names_of("polygons")),
)
@click.option(
    "--max-distance",
    type=Length(zero=False),
    metavar="D",
    help="Leave what is farther than this from all sites to nobody.",
)
@click.option(
    "--enclosures",
    metavar="LINES",
    help="File of lines or polygons that cut the plane: each face is shared out among the sites that meet it.",
    shell_complete=files(names_of("polygons")),
)
@click.option(
    "--count",
    type=click.IntRange(min=1),
    metavar="N",
    help="How many --what discs: the largest, then the largest that is disjoint from those before (default 1).",
)
@shape_options("columns")
@spacing_option()
@result_options(all_layers("voronoi"))
def command(**options: Any) -> None:
    """Share out the plane among points, lines and polygons of any shape: to each all places that are nearest to it.

    \b
    Example:
      vorotool sample two-shapes.json -o two-shapes.json
      vorotool voronoi two-shapes.json -o cells.geojson

    INPUT holds points, lines and polygons, mixed as they come (GeoJSON, WKT, CSV, JSON, Triangle .poly, SVG, DXF and
    files of maps), or is a mask or a label image (PNG, TIFF, PGM, JPEG, NPY), whose objects have outlines; - is
    standard input. Each feature is a site, each input a diagram of its own. Polygons are filled. Where several sites
    are equally near to a whole region, the first has it. Borders are straight lines and parabolas; as GeoJSON, WKT and
    in files of maps they are lines, the same in both cells.

    --what edges lists the borders, neighbors the pairs of cells that share one, table a row for each cell, discs the
    largest empty disc between the sites, with its center in the frame or the clip.
    """
    run_command(RECIPE, Options("voronoi", **options))


def _products(run: Run, o: Options, given: JobInput) -> VoronoiProducts:
    from vorotool.jobs.voronoi import VoronoiProducts

    return VoronoiProducts(run, o, given)


RECIPE = Recipe("voronoi", FORMATS, check_options, _products, "sites")
