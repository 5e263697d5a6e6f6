"""Options of volumes: those that images have with one more axis, and their own."""

from __future__ import annotations

import re
from typing import Any

import click

from vorotool.cli.options.parameter_types import ParameterType
from vorotool.cli.options.shared import Decorator, Window, shared, together

MOST_LEVELS = 30
"""A side has at most 2^30 voxels."""


class VolumeSize(ParameterType[tuple[int, ...]]):
    """``WxH`` in pixels, or ``WxHxD`` in voxels."""

    name = "WxH[xD]"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[int, ...]:
        """Parse width, height and, of a volume, depth."""
        if isinstance(value, tuple):
            return value
        parts = value.lower().replace("×", "x").split("x")
        if len(parts) not in (2, 3) or not all(re.fullmatch("0*[1-9][0-9]{0,17}", part) for part in parts):
            expected = "expected width and height in pixels, such as 640x480, and of a volume the depth: 640x480x20"
            self.fail(f"{value!r}: {expected}", param, ctx)
        return tuple(map(int, parts))


class VolumeWindow(Window):
    """``X,Y,W,H`` as of images, or six integers in voxels."""

    name = "X,Y[,Z],W,H[,D]"
    expected = f"{Window.expected}, or of a volume six, X,Y,Z,W,H,D"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[Any, ...]:
        """Parse four numbers, or six of which the last three are positive."""
        if isinstance(value, tuple) or value.count(",") != 5:
            return super().convert(value, param, ctx)
        try:
            window = tuple(map(int, value.split(",")))
        except ValueError:
            self.fail(f"{value!r}: expected six integers X,Y,Z,W,H,D, such as -10,-10,0,640,480,20", param, ctx)
        if min(window[3:]) <= 0:
            self.fail(f"{value!r} is an empty window: W, H and D must be at least 1", param, ctx)
        return window


class Levels(ParameterType[int]):
    """A number of copies, or ``auto``."""

    name = "N|auto"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:
        """Parse the number."""
        from vorotool.jobs.options import AUTO_LEVELS

        if isinstance(value, int):
            return value
        if value == "auto":
            return AUTO_LEVELS
        if not re.fullmatch("[0-9]{1,2}", value) or int(value) > MOST_LEVELS:
            self.fail(f"{value!r}: expected a number of coarser copies up to {MOST_LEVELS}, or auto", param, ctx)
        return int(value)


_CONNECTIVITY = click.option(
    "--connectivity",
    type=click.Choice(["8", "4", "26", "6"], case_sensitive=False),
    help="Connectivity of the components of an image, by default 8, or of a volume, by default 26.",
)


def volume_options() -> Decorator:
    """Add the options of volumes alone."""
    return together(
        click.option(
            "--volume",
            is_flag=True,
            help="Read all pages of a stack, or an array with three axes, as one volume (z, y, x), and points with "
            "their z.",
        ),
        click.option(
            "--slice",
            type=int,
            metavar="Z",
            help="Draw this slice of a volume; by default the three through its middle.",
        ),
        click.option(
            "--levels",
            type=Levels(),
            help="Coarser copies of a volume in OME-Zarr, each of every second voxel; auto: until 256 across.",
        ),
    )


def frame_options(*, has_volumes: bool) -> Decorator:
    """Add the frame of lists of points, which may be that of a volume."""
    if not has_volumes:
        return shared("size", "window")
    return together(
        click.option(
            "--size", type=VolumeSize(), help="Frame of W x H pixels from pixel (0, 0), or of W x H x D voxels."
        ),
        click.option("--window", type=VolumeWindow(), help="Frame whose first pixel is (X, Y), or voxel (X, Y, Z)."),
    )


def connectivity_option(*, has_volumes: bool) -> Decorator:
    """Add ``--connectivity``."""
    return _CONNECTIVITY if has_volumes else shared("connectivity")
