"""``vorotool alphashape``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.options.areas import Area
from vorotool.cli.options.columns import accumulated
from vorotool.cli.options.groups import site_options
from vorotool.cli.options.help_page import GroupedCommand
from vorotool.cli.options.lengths import Radius
from vorotool.cli.options.picture_style import animation_options, page_option
from vorotool.cli.options.shared import (
    SEVERAL,
    Decimal,
    Names,
    inputs_argument,
    output_options,
)
from vorotool.cli.run import run_command
from vorotool.errors import UsageError
from vorotool.jobs.animations import animated, check_animation
from vorotool.jobs.inputs import JobInput, check_components, check_frame_options
from vorotool.jobs.job import Recipe
from vorotool.jobs.names import METHODS, OF_ONE_SHAPE, PLOTS
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target, check_picture_options, check_precision
from vorotool.products.formats import ANIMATIONS, PICTURES, format_named, picture_format
from vorotool.products.inputs import NAMES_WITH
from vorotool.products.registry import PRODUCTS, all_layers, formats_of, layers_of

if TYPE_CHECKING:
    from vorotool.jobs.alpha_shape import ShapeProducts

FORMATS = formats_of("alphashape")
_OF_POLYGONS = ", ".join(PRODUCTS["alphashape"]["polygons"].usual_for)
_OF_SPACING = "give it what vorotool tessellate --spacing SX,SY --what table writes, whose x and y are in that unit"
OF_DIGITAL_RULE = frozenset({"edges", "complex", "family", "spectrum"})
"""Results that need no more than edges and the triangles beside them."""


@click.command("alphashape", cls=GroupedCommand, instead={"--spacing": _OF_SPACING})
@inputs_argument(NAMES_WITH["points"])
@click.option("-r", "r", type=Radius(), help="Radius, in units of the input; inf gives the convex hull.")
@click.option("--alpha", type=Decimal(), metavar="A", help="The paper's alpha = -1/r, negative.")
@click.option("--auto", is_flag=True, help="The smallest r whose shape is one region with every point: the default.")
@click.option("--regions", type=click.IntRange(min=1), metavar="K", help="Regions that --auto allows; by default 1.")
@output_options(FORMATS)
@click.option(
    "--what",
    type=Names(tuple(FORMATS)),
    multiple=True,
    callback=accumulated,
    help=f"What to write: {', '.join(FORMATS)}; by default edges, polygons for {_OF_POLYGONS}; {SEVERAL}.",
)
@click.option(
    "--rule",
    type=click.Choice(["corrected", "printed"], case_sensitive=False),
    default="corrected",
    show_default=True,
    help="printed: r_min and open intervals to the letter of the paper.",
)
@click.option("--hole-threshold", type=Area(zero=True), help="Fill holes (cavities) of at most this area.")
@click.option("--region-threshold", type=Area(zero=True), help="Then leave out regions of at most this area.")
@click.option(
    "--method",
    type=click.Choice(METHODS, case_sensitive=False),
    default="exact",
    show_default=True,
    help="How points are triangulated, as in delaunay.",
)
@site_options(all_layers("alphashape"))
@page_option()
@animation_options("shapes whose r grows to that of the shape")
def command(**options: Any) -> None:
    """Find the alpha shape of points: edges that an empty disc of radius r touches at both ends, and what they bound.

    \b
    Example:
      vorotool sample dots.csv -o dots.csv
      vorotool alphashape dots.csv -r 60 -o shape.csv

    INPUT is a list of points (CSV, TSV, Triangle .node, NPY, GeoJSON, WKT, JSON) or an image (PNG, TIFF, PGM, JPEG,
    NPY), whose components or labels count as points at their centroids; - is standard input. Label i is the i-th
    point; labels of the input are kept.

    --what family, spectrum, curves and persistence are about the shapes of all radii. -f html makes a page with a
    slider over r.
    """
    if options["what"] is None:
        options["what"] = (_default_what(options["format"], options["output"]),)
    run_command(RECIPE, Options("alphashape", **animated(options)))


def _products(run: Run, o: Options, given: JobInput) -> ShapeProducts:
    from vorotool.jobs.alpha_shape import products

    return products(run, o, given)


def _default_what(fmt: str | None, output: str | None) -> str:
    name = format_named(fmt or Path(output or "").suffix)
    return next((what for what, each in PRODUCTS["alphashape"].items() if name in each.usual_for), next(iter(FORMATS)))


def _check_options(o: Options, targets: list[Target]) -> None:
    check_components(o)
    if o.regions is not None and (o.r is not None or o.alpha is not None):
        raise UsageError("--regions is for the automatic choice of r: leave out -r and --alpha")
    _check_method(o, {target.fmt for target in targets})
    if "hull" in o.what and (o.hole_threshold is not None or o.region_threshold is not None):
        raise UsageError("the hull has no thresholds: leave out --hole-threshold and --region-threshold")
    formats = {target.fmt for target in targets}
    check_precision(o, FORMATS, targets)
    check_animation(o, targets)
    if o.method == "digital" and formats & set(ANIMATIONS):
        raise UsageError("--method digital has no animation: use --method exact or digital-valid")
    products = PRODUCTS["alphashape"]
    pictures = sorted(
        {picture_format(target.fmt) for target in targets if products[target.what].usual_layers} & set(PICTURES)
    )
    if o.layers is not None and not pictures:
        raise UsageError("--layers is for pictures of a shape: use -f svg or -f png, or leave it out")
    if o.overlay is not None and not pictures:
        raise UsageError("--overlay is for pictures of a shape: use -f svg or -f png, or leave it out")
    if o.frame is not None and (o.overlay is not None or not pictures):
        raise UsageError("--frame is what pictures of a shape show: use -f svg or -f png, or leave it out")
    plots = ["svg"] if any(target.what in PLOTS and target.fmt == "svg" for target in targets) else []
    check_picture_options(o, pictures or plots, layers_of("alphashape"), png_has_width=True)


def _check_method(o: Options, formats: set[str]) -> None:
    """Refuse what the way of triangulating or the rule cannot give, or would not look at."""
    check_frame_options(o, is_digital=o.method != "exact")
    is_automatic = o.r is None and o.alpha is None
    needs_corrected = (is_automatic and set(o.what) & OF_ONE_SHAPE) or set(PLOTS) & set(o.what) or "html" in formats
    if o.rule == "printed" and needs_corrected:
        raise UsageError(
            "persistence, curves, pages and the automatic r need --rule corrected: give -r, or leave out --rule"
        )
    if o.rule == "printed" and o.verify:
        raise UsageError("the printed rule fails the check, as it should: leave out --verify or --rule")
    if o.method == "digital":
        _check_digital_rule(o, formats)


def _check_digital_rule(o: Options, formats: set[str]) -> None:
    if "html" in formats:
        raise UsageError("--method digital has no curves for a page: use --method exact or digital-valid")
    for name in o.what:
        if name not in OF_DIGITAL_RULE:
            raise UsageError(
                "--method digital finds edges and triangles that need be no triangulation: "
                f"{name} needs --method exact or digital-valid"
            )
    if set(o.what) & OF_ONE_SHAPE and o.r is None and o.alpha is None:
        raise UsageError("--method digital has no regions to choose r by: give -r or --alpha")
    if o.hole_threshold is not None or o.region_threshold is not None or o.verify:
        raise UsageError("--method digital has no regions: leave out thresholds and --verify")


RECIPE = Recipe("alphashape", FORMATS, _check_options, _products, "points")
