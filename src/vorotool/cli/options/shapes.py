"""What the commands have in common that take shapes, or the outlines of an image: their options."""

from __future__ import annotations

import click

from vorotool.cli.options.areas import cleaning_options
from vorotool.cli.options.lengths import FlatteningTolerance, Length
from vorotool.cli.options.shared import Decorator, Rectangle, shared, together
from vorotool.products.formats import FORMATS

_FLATTENED = ", ".join(each.title for each in FORMATS.values() if each.flattens)


def frame_option(what: str) -> Decorator:
    """Add ``--frame``, by which this is clipped."""
    return click.option(
        "--frame",
        type=Rectangle(),
        help=f"{what} to this rectangle; by default the image, or the bounds and a tenth around them.",
    )


def shape_options(*between: str, flattened: str = "") -> Decorator:
    """Add the options of reading shapes and outlines."""
    return together(
        click.option(
            "--flatten",
            type=FlatteningTolerance(),
            help=f"How far lines may be from curves where a format ({_FLATTENED}){flattened} has none, and from those "
            "that are read. Default: auto, which is for arcs 1/2000 of their radius, for others 1/2000 of their extent "
            "or 1/100 of their clearance.",
        ),
        click.option(
            "--join-tolerance",
            type=Length(zero=True),
            metavar="D",
            help="How far ends of lines of a DXF input may be apart that are joined; by default 0.005 mm, or 1/100000 "
            "of the extent where the unit is not known.",
        ),
        click.option(
            "--simplify",
            type=Length(zero=False),
            metavar="TOLERANCE",
            help="Leave out vertices first, where outlines move by no more than this; what touches still does.",
        ),
        shared(*between, "input-format", "input-layer", "input-crs", "crs", "page"),
        click.option(
            "--outline",
            type=click.Choice(["crack", "contour"], case_sensitive=False),
            help="Of an image: around pixels (default), or half-way between the centers of pixels.",
        ),
        click.option(
            "--seeds",
            type=click.Choice(["components", "labels"], case_sensitive=False),
            help="What an image's objects are; by default components of a mask (0, and 1 or 255 or all bits), else "
            "labels.",
        ),
        shared("connectivity", "threshold", "invert"),
        cleaning_options(),
    )
