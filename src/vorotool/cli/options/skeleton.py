"""What the commands that make skeletons have in common: their options."""

from __future__ import annotations

import click

from vorotool.cli.options.columns import accumulated
from vorotool.cli.options.groups import result_options
from vorotool.cli.options.lengths import Distances, Length
from vorotool.cli.options.picture_style import animation_options
from vorotool.cli.options.pixel_size import spacing_option
from vorotool.cli.options.pruning import FORMS, Place, PruningType
from vorotool.cli.options.shapes import frame_option, shape_options
from vorotool.cli.options.shared import (
    Decorator,
    inputs_argument,
    output_options,
    together,
    what_option,
)
from vorotool.products.inputs import NAMES_WITH
from vorotool.products.registry import all_layers, formats_of

ENDS = ("middle", "corner", "none")
"""As `vorotool.engines.centerlines.centerline` has them, which ``--help`` does not import."""


_BEFORE: tuple[Decorator, ...] = (
    click.option(
        "--side",
        type=click.Choice(["interior", "exterior", "both"], case_sensitive=False),
        default="interior",
        show_default=True,
        help="Inside polygons, outside all of them, or both.",
    ),
    frame_option("Clip"),
    click.option(
        "--prune",
        type=PruningType(),
        help=f"Remove side branches whose significance is below a threshold: {FORMS}. "
        "By default mask for images, none for polygons.",
    ),
    click.option(
        "--join-junctions",
        is_flag=True,
        help="Make junctions one that are joined by branches shorter than the radius at the largest: >-< becomes ><.",
    ),
    click.option(
        "--from", "start", type=Place(), help="Begin the centerline at the place on the skeleton nearest to this."
    ),
    click.option("--to", "end", type=Place(), help="End it at the nearest place."),
    click.option(
        "--ends",
        type=click.Choice(ENDS, case_sensitive=False),
        help="Where centerlines end: in the middle of the piece of outline between both sides (default), in a "
        "corner, or where that piece begins. With middle, skeletons are led on to the ends of strokes, too; "
        "else they are as pruning leaves them.",
    ),
    click.option(
        "--smooth",
        type=Length(zero=False),
        metavar="TOLERANCE",
        help="Fit cubic Bezier curves to skeletons and centerlines that are nowhere farther from them than this.",
    ),
    click.option(
        "--features",
        type=click.Choice(["separate", "together"], case_sensitive=False),
        default="separate",
        help="Take each feature as if there were no others, whatever lies in it or over it (default), or all as one "
        "drawing.",
    ),
)
_READING: tuple[Decorator, ...] = (
    click.option(
        "--every",
        type=Length(zero=False),
        metavar="D",
        help="Step along branches or the centerline, of --what points and transects.",
    ),
    click.option(
        "--along",
        type=click.Choice(["branches", "centerline"], case_sensitive=False),
        help="What these are along: each branch of the skeleton (default), so that distances begin anew at junctions, "
        "or the centerline of each polygon from end to end, with transects straight across it up to the outline.",
    ),
    shape_options(flattened=" or --what shape"),
)
"""Options before a command's own, and after them."""
_OF_EXACT: tuple[Decorator, ...] = (
    click.option(
        "-d",
        "--distance",
        type=Distances(),
        multiple=True,
        callback=accumulated,
        help="Distances of --what offset, separated by commas: positive outwards, negative inwards; START:STOP:STEP is "
        "a range of them, such as 1:5:0.5 or -10:-1:1mm.",
    ),
    click.option(
        "--count",
        type=click.IntRange(min=1),
        metavar="N",
        help="How many --what discs of each feature: the largest, then the largest that is disjoint from those before "
        "(default 1); with --local the largest so many.",
    ),
    click.option("--local", is_flag=True, help="Of --what discs all that are larger than those around them."),
    animation_options("offset curves whose distances grow to those of -d"),
)
"""Options of results that only skeleton-exact has."""


def skeleton_options(*own: Decorator, command: str = "skeleton-exact") -> Decorator:
    """Add the options that skeletons have in common, and a command's own among them."""
    formats = formats_of(command)
    written = inputs_argument(NAMES_WITH["polygons"]), output_options(formats), what_option(tuple(formats))
    also = _OF_EXACT if command == "skeleton-exact" else ()
    return together(*written, *_BEFORE, *own, *also, *_READING, spacing_option(), result_options(all_layers(command)))
