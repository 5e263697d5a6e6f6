"""``vorotool delaunay``."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.candidates import files
from vorotool.cli.commands import run_command
from vorotool.cli.inputs import naming, read_clip, read_seed_input, refuse
from vorotool.cli.options import (
    Rectangle,
    batch_options,
    inputs_argument,
    layers_option,
    output_options,
    shared,
    what_option,
)
from vorotool.cli.recipes import Recipe
from vorotool.cli.results import MESH_LAYERS
from vorotool.cli.run import Run
from vorotool.cli.targets import Target, check_picture_options
from vorotool.cli.units import pixel_size_option
from vorotool.formats.input_formats import NAMES_WITH, POLYGON_NAMES

if TYPE_CHECKING:
    from vorotool.cli.meshes import MeshProducts
    from vorotool.geometry.points import PointSet
    from vorotool.geometry.seeds import SeedSet

METHODS = ("exact", "digital", "digital-valid")
_TABLES = ("csv", "json", "npz")
_PICTURES = ("svg", "png")
FORMATS = {
    "edges": ("csv", "json", "geojson", "npz", "edge", "obj", *_PICTURES),
    "triangles": ("csv", "json", "geojson", "npz", "ele", "obj", *_PICTURES),
    "cells": ("geojson", "csv", "json", "npz", "wkt", *_PICTURES),
    "table": (*_TABLES, "node"),
    "compare": _TABLES,
}
OF_TRIANGULATIONS = frozenset(
    {("edges", "edge"), ("triangles", "ele")} | {(what, fmt) for what in ("cells", "table") for fmt in FORMATS[what]}
)
"""Results and formats that what the digital rule finds has no place in."""
PICTURE_LAYERS = {"svg": MESH_LAYERS, "png": tuple(layer for layer in MESH_LAYERS if layer != "labels")}

_WITHOUT_DIGITS = frozenset({"npz", "edge", "ele", *_PICTURES})


@click.command("delaunay")
@inputs_argument(NAMES_WITH["points"])
@output_options(FORMATS)
@what_option(tuple(FORMATS))
@click.option(
    "--method",
    type=click.Choice(METHODS),
    default="exact",
    show_default=True,
    help="digital: the paper's rule, to the letter, on the digital tessellation of a frame; digital-valid: its "
    "certified repair, which gives the exact triangulation.",
)
@click.option(
    "--frame",
    type=Rectangle(),
    help="Rectangle that cells are clipped to; by default the bounds of the points and a tenth more.",
)
@click.option(
    "--clip",
    metavar="POLYGONS",
    help="File of polygons that cells are clipped to as well.",
    shell_complete=files(POLYGON_NAMES),
)
@shared("size", "window", "columns", "input-format", "page", "seeds", "connectivity", "threshold", "invert")
@layers_option(MESH_LAYERS)
@shared("overlay", "width", "y-up", "out-dir", "threads", "stats", "verify", "strict", "precision", "max-pixels")
@shared("max-sites")
@pixel_size_option()
@batch_options()
@shared("no-clobber", "no-properties", "quiet", "verbose")
def command(**options: Any) -> None:
    """Triangulate points exactly: no circle through a triangle's vertices holds another point.

    \b
    Example:
      vorotool delaunay data/dots.csv -o edges.csv

    INPUT is a list of points (CSV, TSV, Triangle .node, NPY, GeoJSON, WKT, JSON) or an image (PNG, TIFF, PGM, PBM,
    NPY), whose components or labels count as points at their centroids; - is standard input. Label i is the i-th
    point; labels of the input are kept. OBJ and files for Triangle (.edge, .ele, .node) number the points instead.

    --what compare lists where the digital rule differs from the exact triangulation, each with its cause.
    """
    run_command(RECIPE, SimpleNamespace(**options))


def _products(run: Run, o: SimpleNamespace, source: str) -> MeshProducts:
    with naming(source), run.phase("read"):
        points = _read_points(run, o, source)
    if o.clip is not None:
        with run.phase("read polygons"):
            o.clip = read_clip(run, o, o.clip)
    with naming(source):
        return _kind(o)(points, o, run)


def _kind(o: SimpleNamespace) -> type[MeshProducts]:
    """Give the maker of the results that are wanted."""
    if not _is_digital(o):
        from vorotool.cli.meshes import MeshProducts

        return MeshProducts
    from vorotool.cli.digital_meshes import DigitalProducts, RepairedProducts

    return RepairedProducts if o.method == "digital-valid" else DigitalProducts


def _is_digital(o: SimpleNamespace) -> bool:
    return o.method != "exact" or "compare" in o.what


def _check_options(o: SimpleNamespace, targets: list[Target]) -> None:
    _check_method(o, targets)
    if o.connectivity is not None and o.seeds in ("pixels", "labels"):
        raise click.UsageError(f"--connectivity is for components: leave it out with --seeds {o.seeds}")
    formats = {target.fmt for target in targets}
    with_cells = {"cells", "diagram"} & set(o.layers or ()) or {"cells", "table"} & set(o.what)
    for name in ("frame", "clip"):
        if getattr(o, name) is not None and not with_cells:
            raise click.UsageError(f"--{name} is for cells: use --what cells or table, or leave it out")
    if o.precision is not None and formats <= _WITHOUT_DIGITS:
        raise click.UsageError("--precision is for numbers in text: use -f csv, json, geojson or obj, or leave it out")
    pictures = sorted(formats & set(_PICTURES))
    if o.layers is not None and not pictures:
        raise click.UsageError("--layers is for pictures: use -f svg or -f png, or leave it out")
    check_picture_options(o, pictures, PICTURE_LAYERS, png_has_width=True)


def _check_method(o: SimpleNamespace, targets: list[Target]) -> None:
    """Refuse what the way of triangulating cannot give, or would not look at."""
    if o.size is not None and o.window is not None:
        raise click.UsageError("give --size or --window, not both")
    for name in ("size", "window"):
        if getattr(o, name) is not None and not _is_digital(o):
            raise click.UsageError(f"--{name} is the frame of a tessellation: use --method digital or digital-valid")
    if "compare" in o.what:
        if o.method == "digital-valid" or (o.method == "exact" and len(o.what) > 1):
            raise click.UsageError("--what compare is about the digital rule: use --method digital")
        o.method = "digital"
    if o.method == "digital" and {"cells", "diagram"} & set(o.layers or ()):
        raise click.UsageError("--layers cells and diagram are of the exact cells: use --method exact or digital-valid")
    for target in targets:
        if o.method == "digital" and (target.what, target.fmt) in OF_TRIANGULATIONS:
            raise click.UsageError(
                f"--method digital finds edges and triangles that need be no triangulation: {target.what} as "
                f"{target.fmt} needs --method exact or digital-valid"
            )


def _read_points(run: Run, o: SimpleNamespace, source: str) -> PointSet | SeedSet:
    from vorotool.engines.seeding import seeds_from_raster
    from vorotool.geometry.points import PointSet

    value = read_seed_input(run, o, source, properties=bool({"table", "cells"} & set(o.what)))
    if isinstance(value, PointSet):
        return value
    refuse(o, ("columns",), "is for lists of points, but the input is an image")
    refuse(o, ("size", "window"), "is for lists of points, but the input is an image, which brings its own frame")
    # The sites of objects are their centroids, but their regions are not those of the centroids.
    mode = None if o.seeds == "centroids" and not _is_digital(o) else o.seeds
    return seeds_from_raster(
        value,
        mode=mode,
        connectivity=int(o.connectivity or 8),
        threshold=o.threshold,
        invert=o.invert,
        max_sites=o.max_sites,
        allow_empty=True,
    )


RECIPE = Recipe("delaunay", FORMATS, _check_options, _products, "points")
