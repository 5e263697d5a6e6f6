"""``vorotool tessellate``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.options.groups import site_options
from vorotool.cli.options.help_page import GroupedCommand
from vorotool.cli.options.lengths import ExactLength
from vorotool.cli.options.picture_style import animation_options
from vorotool.cli.options.pixel_size import spacing_option
from vorotool.cli.options.shared import (
    inputs_argument,
    named_image,
    output_options,
    what_option,
)
from vorotool.cli.options.suggestions import files
from vorotool.cli.options.volumes import VolumeSize, volume_options
from vorotool.cli.run import run_command
from vorotool.errors import UsageError
from vorotool.jobs.animations import animated, check_animation
from vorotool.jobs.inputs import JobInput, check_components, check_frame_options, refuse
from vorotool.jobs.job import Recipe
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target, check_picture_options, check_precision
from vorotool.jobs.units import known_length
from vorotool.jobs.volumes.checks import check_image_options, check_volume_options, check_volume_units
from vorotool.products.formats import ANIMATIONS, picture_format
from vorotool.products.inputs import IMAGE_NAMES, NAMES_WITH
from vorotool.products.registry import PRODUCTS, VOLUME_PRODUCTS, all_layers, formats_of, layers_of

if TYPE_CHECKING:
    from vorotool.jobs.streamed_tessellation import StreamedProducts
    from vorotool.jobs.tessellation import Products
    from vorotool.jobs.volumes.products import VolumeProducts

FORMATS = formats_of("tessellate")
_PICTURES = {(what, fmt) for what, each in PRODUCTS["tessellate"].items() for fmt in each.layers}


@click.command("tessellate", cls=GroupedCommand)
@inputs_argument(NAMES_WITH["points"])
@output_options(FORMATS)
@what_option(tuple(FORMATS))
@click.option(
    "--method",
    type=click.Choice(["exact", "propagation"], case_sensitive=False),
    default="exact",
    show_default=True,
    help="propagation: the paper's two passes to the letter, nearly exact.",
)
@click.option("--passes", type=click.IntRange(1, 2), metavar="N", help="Passes of the propagation; by default 2.")
@click.option(
    "--max-distance",
    type=ExactLength(),
    help="Label only pixels within this distance of a seed: others get 0; distances are not cut.",
)
@click.option(
    "--dtype",
    type=click.Choice(["uint8", "uint16", "uint32", "int32"], case_sensitive=False),
    help="Type of labels in TIFF, NPY, Zarr.",
)
@click.option(
    "--chunk",
    type=VolumeSize(),
    help="Columns x rows (x slices) of the chunks of a Zarr store; by default 2048x512, fewer rows if wide.",
)
@click.option("--tiled", is_flag=True, help="Tiles of 512 x 512 pixels in TIFFs, instead of strips of whole rows.")
@click.option(
    "--cell-size",
    type=ExactLength(),
    metavar="SIDE",
    help="Side of a pixel in the units of points, lines or polygons on a map, or with a unit; --window, "
    "--max-distance and distances are in the units of the map, too.",
)
@click.option(
    "--like",
    metavar="RASTER",
    callback=named_image,
    help="Frame and pixels of this image, of which only the header is read: results overlay it pixel by "
    "pixel, on its map, if it has one.",
    shell_complete=files(IMAGE_NAMES),
)
@spacing_option()
@volume_options()
@site_options(all_layers("tessellate"), has_scale=False, has_volumes=True)
@animation_options("cells that grow from their seeds, up to --max-distance")
def command(**options: Any) -> None:
    """Label every pixel with its nearest seed, exactly; ties go to the smallest label.

    \b
    Example:
      vorotool sample dots.csv -o dots.csv
      vorotool tessellate dots.csv --size 512x512 -o labels.png

    INPUT is a list of points (CSV, TSV, Triangle .node, NPY, GeoJSON, WKT, JSON) or an image (PNG, TIFF, PGM, JPEG,
    NPY, Zarr); - is standard input. Label i is the i-th point; an image's own labels are kept. With --volume it is a
    volume: a stack (TIFF, NPY, Zarr), or points with a z.
    """
    o = Options("tessellate", **animated(options))
    if o.is_of_volumes:
        check_volume_units(o)
    run_command(VOLUME_RECIPE if o.is_of_volumes else RECIPE, o)


def _check_options(o: Options, targets: list[Target]) -> None:
    check_image_options(o)
    check_frame_options(o, is_digital=True)
    if o.method == "propagation" and o.max_distance is not None:
        raise UsageError("--max-distance needs --method exact")
    if o.method == "propagation" and o.spacing is not None:
        raise UsageError("--spacing needs --method exact: the paper's propagation is for square pixels")
    if o.method == "exact" and o.passes is not None:
        raise UsageError("--passes needs --method propagation")
    if o.method == "propagation" and {"distance", "distance2"} & {target.what for target in targets}:
        raise UsageError("distances are those of the exact tessellation: leave out --method propagation")
    check_components(o)
    _check_cells(o)
    if o.method == "propagation" and o.cluster is not None and o.out_dir is None:
        raise UsageError("a cluster computes bands of the exact tessellation: leave out --method propagation")
    check_precision(o, FORMATS, targets)
    check_animation(o, targets)
    if o.method == "propagation" and any(target.fmt in ANIMATIONS for target in targets):
        raise UsageError("animations are of the exact tessellation: leave out --method propagation")
    _check_output_options(o, {(target.what, picture_format(target.fmt)) for target in targets})


def _check_cells(o: Options) -> None:
    if o.like is not None:
        others = {"size": o.size, "window": o.window, "cell-size": o.cell_size, "spacing": o.spacing}
        refuse(others, "contradicts --like, which takes the frame and its pixels from a raster: leave one of them out")
    if o.cell_size is None:
        return
    side = known_length(o.cell_size)
    if side is not None and not 1e-100 < side < 1e100:
        raise UsageError("--cell-size must be more than 0, and at most 1e100")
    if o.spacing is not None:
        raise UsageError("--cell-size makes cells that are squares, in the units of the map: leave out --spacing")
    if o.size is not None:
        raise UsageError("--size is in pixels: with --cell-size give --window X,Y,W,H in the units of the map")


def _check_output_options(o: Options, outputs: set[tuple[str, str]]) -> None:
    """Refuse options that no output would show."""
    if o.dtype is not None and not outputs & {("labels", fmt) for fmt in ("tiff", "npy", "zarr")}:
        raise UsageError("--dtype is for labels in TIFF, NPY and Zarr: use -f tiff or -f npy, or leave it out")
    if o.chunk is not None and "zarr" not in {fmt for _, fmt in outputs}:
        raise UsageError("--chunk is for Zarr stores: use -f zarr, or leave it out")
    if o.tiled and "tiff" not in {fmt for _, fmt in outputs}:
        raise UsageError("--tiled is for TIFF: use -f tiff, or leave it out")
    if o.layers is not None and not outputs & _PICTURES:
        raise UsageError("--layers is for pictures: --what color, labels as SVG, or the diagram as PNG")
    pictures = sorted(outputs & _PICTURES - (set() if o.draws_diagram else {("diagram", "png")}))
    check_picture_options(o, [fmt for _, fmt in pictures], layers_of("tessellate"))


def _products(run: Run, o: Options, given: JobInput) -> Products | StreamedProducts:
    from vorotool.jobs.tessellation import products

    return products(run, o, given)


def _volume_products(run: Run, o: Options, given: JobInput) -> VolumeProducts:
    from vorotool.jobs.volumes.products import products

    return products(run, o, given)


RECIPE = Recipe("tessellate", FORMATS, _check_options, _products, "points")
_VOLUME_FORMATS = {what: each.formats for what, each in VOLUME_PRODUCTS.items()}
VOLUME_RECIPE = Recipe("tessellate", _VOLUME_FORMATS, check_volume_options, _volume_products, "points")
