"""What the commands that make skeletons have in common: options, formats, layers, and how they read and write."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import chain
from math import isfinite
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.batch.dispatch import run_command
from vorotool.cli.options.groups import result_options
from vorotool.cli.options.parameter_types import ParameterType
from vorotool.cli.options.pruning import FORMS, Place, PruningType
from vorotool.cli.options.shared import (
    Decorator,
    Rectangle,
    inputs_argument,
    output_options,
    shared,
    together,
    what_option,
)
from vorotool.formats.parsing.format_names import NAMES_WITH
from vorotool.jobs.inputs import IMAGE_OPTIONS, naming, note_other_size, refuse, settle_threshold
from vorotool.jobs.job import Recipe
from vorotool.jobs.names import DERIVED, PICTURES, SKELETON_LAYERS, TABLES
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target, check_picture_options

if TYPE_CHECKING:
    from vorotool.geometry.points.raster import Raster
    from vorotool.geometry.polygons.polygon_set import PolygonSet
    from vorotool.jobs.skeleton import SkeletonProducts

FORMATS = {
    "skeleton": ("json", "csv", "geojson", "npz", "wkt", "graphml", *PICTURES, "html"),
    "diagram": ("json", "csv", "geojson", "npz", "wkt", *PICTURES),
    "elements": (*TABLES, *PICTURES),
    "centerline": ("geojson", *TABLES, "wkt", *PICTURES),
    "offset": ("json", "csv", "geojson", "npz", "wkt", *PICTURES),
    "shape": ("json", "geojson", "wkt", "poly", *PICTURES),
    "points": ("csv", "json", "npz", "geojson", "wkt", *PICTURES),
    "transects": ("geojson", "wkt", *TABLES, *PICTURES),
    "branches": TABLES,
    "table": TABLES,
}
LAYERS = tuple(dict.fromkeys([*SKELETON_LAYERS, *chain.from_iterable(DERIVED.values())]))
"""Layers of all pictures."""

APPROXIMATE_LAYERS = (*LAYERS, "exact")
"""Beside approximate skeletons pictures can show exact ones."""

PICTURE_LAYERS = {
    "svg": APPROXIMATE_LAYERS,
    "png": APPROXIMATE_LAYERS,
}

_WITHOUT_DIGITS = frozenset({"npz", "html", *PICTURES})
_WITHOUT_CURVES = frozenset({"geojson", "wkt", "graphml"})
_CURVED = frozenset({"skeleton", "diagram", "centerline", "offset"})


ENDS = ("middle", "corner", "none")
"""As `vorotool.engines.centerlines.centerline` has them, which ``--help`` does not import."""


class Length(ParameterType[float]):
    """A finite length, 0 only where that is allowed."""

    name = "LENGTH"

    def __init__(self, *, zero: bool) -> None:
        self._zero = zero

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Parse the number."""
        try:
            number = float(value)
        except ValueError:
            self.fail(f"{value!r} is no length: give a number such as 0.5", param, ctx)
        if not isfinite(number) or number < 0 or (number == 0 and not self._zero):
            self.fail(f"{value!r} is no length: it must be {'0 or more' if self._zero else 'above 0'}", param, ctx)
        return number


class Distances(ParameterType[tuple[float, ...]]):
    """Different finite numbers other than 0, separated by commas."""

    name = "D[,D...]"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...]:
        """Parse the numbers."""
        if isinstance(value, tuple):
            return value
        try:
            numbers = tuple(float(part) for part in value.split(","))
        except ValueError:
            self.fail(f"{value!r} is no list of distances: give numbers such as -2,5", param, ctx)
        from vorotool.engines.offsets.offsets import checked_distances
        from vorotool.errors import UsageError

        try:
            wanted = tuple(checked_distances(numbers))
        except UsageError as error:
            self.fail(str(error), param, ctx)
        return wanted


_BEFORE: tuple[Decorator, ...] = (
    inputs_argument(NAMES_WITH["polygons"]),
    output_options(FORMATS),
    what_option(tuple(FORMATS)),
    click.option(
        "--side",
        type=click.Choice(["interior", "exterior", "both"]),
        default="interior",
        show_default=True,
        help="Inside polygons, outside all of them, or both.",
    ),
    click.option(
        "--frame", type=Rectangle(), help="Cuts what is outside; by default the bounds and a tenth around them."
    ),
    click.option(
        "--prune",
        type=PruningType(),
        help=f"Remove pieces that hang on the rest and matter less than a threshold: {FORMS}. "
        "By default mask for images, none for polygons.",
    ),
    click.option(
        "--from", "start", type=Place(), help="Begin the centerline at the place on the skeleton nearest to this."
    ),
    click.option("--to", "end", type=Place(), help="End it at the nearest place."),
    click.option(
        "--ends",
        type=click.Choice(ENDS),
        help="Where centerlines end: in the middle of the edge that the skeleton forks to (default), in a corner, or "
        "where it forks.",
    ),
)
_READING: tuple[Decorator, ...] = (
    click.option(
        "-d",
        "--distance",
        type=Distances(),
        help="Of --what offset: above 0 outwards, below 0 inwards; several separated by commas.",
    ),
    click.option(
        "--every",
        type=Length(zero=False),
        metavar="D",
        help="Of --what points and transects: the step along branches.",
    ),
    click.option(
        "--flatten",
        type=Length(zero=False),
        metavar="TOLERANCE",
        help="How far lines may be from curves where a format (GeoJSON, WKT, GraphML) or --what shape has none; by "
        "default 1/4096 of the extent.",
    ),
    click.option(
        "--simplify",
        type=Length(zero=False),
        metavar="TOLERANCE",
        help="Leave out vertices first, where outlines move by no more than this; what touches still does.",
    ),
    shared("input-format", "input-crs", "page"),
    click.option(
        "--outline",
        type=click.Choice(["crack", "contour"]),
        help="Of an image: around pixels (default), or half-way between the centres of pixels.",
    ),
    click.option(
        "--seeds",
        type=click.Choice(["components", "labels"]),
        help="What an image's objects are; by default components of a mask (0, and 1 or 255 or all bits), else labels.",
    ),
    shared("connectivity", "threshold", "invert"),
)
"""Options before a command's own, and after them."""


def skeleton_options(*own: Decorator, layers: tuple[str, ...] = LAYERS) -> Decorator:
    """Add the options that skeletons have in common, and a command's own among them."""
    return together(*_BEFORE, *own, *_READING, result_options(layers))


def run_skeletons(
    name: str, o: SimpleNamespace, make: Callable[[PolygonSet, SimpleNamespace, Run], SkeletonProducts]
) -> None:
    """Read polygons, make what a command makes of them, check it, and write it."""
    run_command(Recipe(name, FORMATS, _check_options, partial(_products, make), "polygons"), o)


def _products(
    make: Callable[[PolygonSet, SimpleNamespace, Run], SkeletonProducts], run: Run, o: SimpleNamespace, source: str
) -> SkeletonProducts:
    with naming(source), run.phase("read"):
        polygons = _read_polygons(run, o, source)
    with naming(source):
        return make(polygons, o, run)


def _check_options(o: SimpleNamespace, targets: list[Target]) -> None:
    formats = {target.fmt for target in targets}
    if o.precision is not None and formats <= _WITHOUT_DIGITS:
        raise click.UsageError("--precision is for numbers in text: use -f json, csv, geojson or wkt, or leave it out")
    curved = any(target.what in _CURVED and target.fmt in _WITHOUT_CURVES for target in targets)
    if o.flatten is not None and not curved and "shape" not in o.what:
        raise click.UsageError(
            "--flatten is for what has no curves: use -f geojson, -f wkt or --what shape, or leave it out"
        )
    _check_measures(o)
    _check_shapes(o)
    if o.frame is not None and o.side == "interior" and "diagram" not in o.what:
        raise click.UsageError("--frame cuts what is outside: use --side exterior or both, or leave it out")
    if o.frame is not None:
        _check_frame(o.frame)
    _check_centerline(o)
    pictures = sorted(formats & set(PICTURES))
    if o.layers is not None and not pictures:
        raise click.UsageError("--layers is for pictures: use -f svg or -f png, or leave it out")
    _check_layers(o, targets)
    check_picture_options(o, pictures, PICTURE_LAYERS, png_has_width=True, has_page="html" in formats)


def _check_frame(frame: tuple[float, ...]) -> None:
    from vorotool.geometry.magnitude import LARGEST

    if max(map(abs, frame)) > LARGEST:
        raise click.UsageError(f"--frame goes too far to compute with: use numbers of at most {LARGEST:g}")


def _check_layers(o: SimpleNamespace, targets: list[Target]) -> None:
    """Each picture has each of the layers."""
    usual = (*SKELETON_LAYERS, "exact") if hasattr(o, "compare") else SKELETON_LAYERS
    for target in (target for target in targets if target.fmt in PICTURES):
        own = DERIVED.get(target.what, usual)
        for layer in (layer for layer in o.layers or () if layer not in own):
            raise click.UsageError(
                f"--layers {layer}: a picture of {target.what} in {target.fmt.upper()} has {', '.join(own)}; "
                "choose of these"
            )


def _check_centerline(o: SimpleNamespace) -> None:
    if "centerline" in o.what and o.side == "exterior":
        raise click.UsageError("centerlines are inside polygons: use --side interior or both")
    if o.ends is not None and not {"centerline", "table"} & set(o.what):
        raise click.UsageError(
            "--ends is for centerlines, skeletons lead into corners: use --what centerline or table, or leave it out"
        )
    if (o.start is not None or o.end is not None) and "centerline" not in o.what:
        raise click.UsageError("--from and --to are ends of centerlines: use --what centerline, or leave them out")


def _check_measures(o: SimpleNamespace) -> None:
    """Distances and steps are there where they are needed, and only there."""
    for name, value, users in (("-d", o.distance, {"offset"}), ("--every", o.every, {"points", "transects"})):
        wanted = users & set(o.what)
        if wanted and value is None:
            raise click.UsageError(f"--what {','.join(sorted(wanted))} needs a length: use {name} D")
        if not wanted and value is not None:
            what = " or ".join(f"--what {user}" for user in sorted(users))
            raise click.UsageError(f"{name} is for other results: use {what}, or leave it out")


def _check_shapes(o: SimpleNamespace) -> None:
    """Shapes are rebuilt from what is inside them; offset curves are of the shapes, whatever the skeleton is."""
    if "shape" in o.what and o.side == "exterior":
        raise click.UsageError("shapes are rebuilt from inside: use --side interior or both")
    has_gap = bool(getattr(o, "gap", None))
    if "shape" in o.what and has_gap:
        raise click.UsageError("a skeleton with a gap leaves the corners out: use --what shape without --gap")
    given = {"--side": o.side != "interior", "--prune": o.prune is not None, "--gap": has_gap}
    for name in (name for name, is_given in given.items() if is_given and set(o.what) == {"offset"}):
        raise click.UsageError(f"{name} is for skeletons, but offset curves are of the shapes: leave it out")


def _read_polygons(run: Run, o: SimpleNamespace, source: str) -> PolygonSet:
    """Read polygons, or the outlines of an image; ``o.is_mask`` tells which it was."""
    from vorotool.formats import read
    from vorotool.geometry.points.raster import Raster
    from vorotool.geometry.polygons.polygon_set import PolygonSet

    value = read(
        source,
        geometry="polygons",
        input_format=o.input_format,
        page=o.page,
        max_pixels=o.max_pixels,
        max_sites=o.max_sites,
        properties=not o.no_properties,
        threads=o.threads,
        note=run.note,
        crs=o.input_crs,
    )
    o.is_mask = isinstance(value, Raster)
    if isinstance(value, Raster):
        return _outlines(run, o, value)
    assert isinstance(value, PolygonSet)  # what is asked for is polygons, or an image
    refuse(o, (*IMAGE_OPTIONS, "outline"), "is for images, but the input is polygons or lines")
    return value if o.simplify is None else _simplified(run, o, value)


def _outlines(run: Run, o: SimpleNamespace, image: Raster) -> PolygonSet:
    from vorotool.engines.label_images.outlines import outlines

    note_other_size(run, o, image.values.shape)
    settle_threshold(run, o, image)
    with run.phase("outline"):
        return outlines(
            image,
            outline=o.outline or "crack",
            mode=o.seeds,
            connectivity=int(o.connectivity or 8),
            threshold=o.threshold,
            invert=o.invert,
            simplify=o.simplify,
            strict=o.strict,
            max_sites=o.max_sites,
            threads=o.threads,
            progress=run.progress("outlines"),
            note=run.note,
        )


def _simplified(run: Run, o: SimpleNamespace, polygons: PolygonSet) -> PolygonSet:
    """Simplify polygons once they are cut where they meet."""
    from vorotool.engines.arrangement.lattice_rings import placed_shapes
    from vorotool.engines.arrangement.planar_graph import graph_for_skeletons
    from vorotool.engines.label_images.simplification import simplified_polygons

    with run.phase("simplify"):
        graph = graph_for_skeletons(polygons, strict=o.strict, threads=o.threads)
        return simplified_polygons(placed_shapes(graph, threads=o.threads).polygons, o.simplify)
