"""``vorotool delaunay``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.options.groups import site_options
from vorotool.cli.options.help_page import GroupedCommand
from vorotool.cli.options.pixel_size import spacing_option
from vorotool.cli.options.shared import (
    Rectangle,
    inputs_argument,
    output_options,
    what_option,
)
from vorotool.cli.options.suggestions import files
from vorotool.cli.run import run_command
from vorotool.errors import UsageError
from vorotool.jobs.inputs import JobInput, check_components, check_frame_options
from vorotool.jobs.job import Recipe
from vorotool.jobs.names import GRAPHS, METHODS
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target, check_picture_options, check_precision
from vorotool.products.formats import PICTURES
from vorotool.products.inputs import NAMES_WITH, names_of
from vorotool.products.registry import all_layers, formats_of, layers_of

if TYPE_CHECKING:
    from vorotool.jobs.triangulation import MeshProducts

FORMATS = formats_of("delaunay")
OF_CELLS = ("cells", "table", "statistics", "measures")
OF_TRIANGULATIONS = frozenset(
    {("edges", "edge"), ("triangles", "ele")} | {(what, fmt) for what in OF_CELLS for fmt in FORMATS[what]}
)
"""Results and formats that what the digital rule finds has no place in."""


@click.command("delaunay", cls=GroupedCommand)
@inputs_argument(NAMES_WITH["points"])
@output_options(FORMATS)
@what_option(tuple(FORMATS))
@click.option(
    "--method",
    type=click.Choice(METHODS, case_sensitive=False),
    default="exact",
    show_default=True,
    help="digital: the paper's rule, to the letter, on the digital tessellation of a frame; digital-valid: its "
    "certified repair, which gives the exact triangulation.",
)
@click.option(
    "--graph",
    type=click.Choice(GRAPHS, case_sensitive=False),
    default="delaunay",
    show_default=True,
    help="Which edges: all; those of the Gabriel graph, of relative neighbors, or of the minimum spanning tree.",
)
@click.option(
    "--frame",
    type=Rectangle(),
    help="Rectangle that cells are clipped to; by default the image, or the bounds and a tenth around them.",
)
@click.option(
    "--clip",
    metavar="POLYGONS",
    help="File of polygons that cells are clipped to as well.",
    shell_complete=files(names_of("polygons")),
)
@spacing_option()
@site_options(all_layers("delaunay"))
def command(**options: Any) -> None:
    """Triangulate points exactly: no circle through a triangle's vertices holds another point.

    \b
    Example:
      vorotool sample dots.csv -o dots.csv
      vorotool delaunay dots.csv -o edges.csv

    INPUT is a list of points (CSV, TSV, Triangle .node, NPY, GeoJSON, WKT, JSON) or an image (PNG, TIFF, PGM, JPEG,
    NPY), whose components or labels count as points at their centroids; - is standard input. Label i is the i-th
    point; labels of the input are kept. OBJ and files for Triangle (.edge, .ele, .node) number the points instead.

    --what statistics summarises area, perimeter, roundness, neighbors and distances of whole cells.

    --what compare lists where the digital rule differs from the exact triangulation, each with its cause.
    """
    run_command(RECIPE, Options("delaunay", **options))


def _products(run: Run, o: Options, given: JobInput) -> MeshProducts:
    from vorotool.jobs.triangulation import products

    return products(run, o, given)


def _check_options(o: Options, targets: list[Target]) -> None:
    _check_method(o, targets)
    _check_graph(o)
    check_components(o)
    formats = {target.fmt for target in targets}
    with_cells = {"cells", "diagram"} & set(o.layers or ()) or set(OF_CELLS) & set(o.what)
    for name, given in (("frame", o.frame), ("clip", o.clip)):
        is_page = name == "frame" and o.overlay is None and formats & set(PICTURES)
        if given is not None and not with_cells and not is_page:
            raise UsageError(f"--{name} is for cells: use --what cells or table, or leave it out")
    check_precision(o, FORMATS, targets)
    pictures = sorted(formats & set(PICTURES))
    if o.layers is not None and not pictures:
        raise UsageError("--layers is for pictures: use -f svg or -f png, or leave it out")
    check_picture_options(o, pictures, layers_of("delaunay"), png_has_width=True)


def _check_method(o: Options, targets: list[Target]) -> None:
    """Refuse what the way of triangulating cannot give, or would not look at."""
    check_frame_options(o, is_digital=o.triangulated_by != "exact")
    if "compare" in o.what and (o.method == "digital-valid" or (o.method == "exact" and len(o.what) > 1)):
        raise UsageError("--what compare is about the digital rule: use --method digital")
    if "compare" in o.what and o.spacing is not None:
        raise UsageError("--what compare explains differences by the sides of square pixels: leave out --spacing")
    if o.triangulated_by == "digital" and {"cells", "diagram"} & set(o.layers or ()):
        raise UsageError("--layers cells and diagram are of the exact cells: use --method exact or digital-valid")
    for target in targets:
        if o.triangulated_by == "digital" and (target.what, target.fmt) in OF_TRIANGULATIONS:
            raise UsageError(
                f"--method digital finds edges and triangles that need be no triangulation: {target.what} as "
                f"{target.fmt} needs --method exact or digital-valid"
            )


def _check_graph(o: Options) -> None:
    """Refuse a graph that no result shows, or that the way of triangulating does not hold."""
    if o.graph == "delaunay":
        return
    if "edges" not in {*o.what, *(o.layers or ())}:
        raise UsageError(f"--graph {o.graph} is for edges: use --what edges or --layers edges, or leave it out")
    if o.triangulated_by == "digital":
        raise UsageError(f"--graph {o.graph} is a part of the exact triangulation: use --method exact or digital-valid")


RECIPE = Recipe("delaunay", FORMATS, _check_options, _products, "points")
