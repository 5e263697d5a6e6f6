"""The one registry of options that commands share."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from math import isfinite, nan
from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.options.columns import TABLE_OPTIONS, accumulated
from vorotool.cli.options.parameter_types import ParameterType
from vorotool.cli.options.suggestions import any_file, files, folders, formats_of, listed, outputs_of, words
from vorotool.products.inputs import IMAGE_NAMES, NAMES_WITH

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

SPELLINGS = (("colour", "color"), ("centre", "center"), ("neighbour", "neighbor"))
"""British spellings of what users type, and ours."""


def in_our_spelling(name: str) -> str:
    """Return a name as we spell it."""
    for british, american in SPELLINGS:
        name = name.replace(british, american)
    return name


LARGEST_EXPONENT = 400
"""Of decimal numbers: an exact power of ten beyond any float's takes time and memory, and means nothing."""


class Size(ParameterType[tuple[int, int]]):
    """``WxH`` in pixels."""

    name = "WxH"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[int, int]:
        """Parse width and height."""
        if isinstance(value, tuple):
            return value
        parts = value.lower().replace("×", "x").split("x")
        if len(parts) != 2 or not all(re.fullmatch("0*[1-9][0-9]{0,17}", part) for part in parts):
            self.fail(f"{value!r}: expected width and height in pixels, such as 640x480", param, ctx)
        return (int(parts[0]), int(parts[1]))


class Window(ParameterType[tuple[Any, ...]]):
    """``X,Y,W,H``: integers in pixels, or decimal numbers in the units of a map, which are kept exactly."""

    name = "X,Y,W,H"
    expected = "four integers X,Y,W,H, such as -10,-10,640,480"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[Any, ...]:
        """Parse four numbers of which the last two are positive."""
        if isinstance(value, tuple):
            return value
        try:
            x, y, w, h = (_number(part) for part in value.split(","))
        except (ValueError, ZeroDivisionError):
            self.fail(f"{value!r}: expected {self.expected}", param, ctx)
        if w <= 0 or h <= 0:
            self.fail(f"{value!r} is an empty window: W and H must be at least 1", param, ctx)
        return (x, y, w, h)


def _number(text: str) -> int | Fraction:
    """An integer, or a decimal number that is no larger than a float's."""
    try:
        return int(text)
    except ValueError:
        number = Decimal().convert(text, None, None) if isfinite(float(text)) else nan
        return Fraction(number)


class Rectangle(ParameterType[tuple[float, float, float, float]]):
    """``X,Y,W,H`` in the units of the input."""

    name = "X,Y,W,H"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, float, float, float]:
        """Parse four numbers of which the last two are positive."""
        if isinstance(value, tuple):
            return value
        try:
            x, y, w, h = (float(part) for part in value.split(","))
        except ValueError:
            self.fail(f"{value!r}: expected four numbers X,Y,W,H, such as 0,0,12.5,8", param, ctx)
        if not (all(map(isfinite, (x, y, w, h))) and w > 0 and h > 0):
            self.fail(f"{value!r}: expected finite numbers, W and H more than 0", param, ctx)
        return (x, y, w, h)


class Threshold(ParameterType[float | str]):
    """A number, or ``otsu``."""

    name = "T|otsu"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float | str:
        """Parse the number."""
        if value == "otsu":
            return "otsu"
        try:
            number = float(value)
        except ValueError:
            number = nan
        if not isfinite(number):
            self.fail(f"{value!r}: expected a number or otsu", param, ctx)
        return number


class Decimal(ParameterType[Fraction]):
    """A decimal number, kept exactly."""

    name = "D"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Fraction:
        """Parse the number."""
        if isinstance(value, Fraction):
            return value
        try:
            if abs(int(value.lower().partition("e")[2] or 0)) > LARGEST_EXPONENT:
                raise ValueError
            return Fraction(value)
        except (ValueError, ZeroDivisionError):
            self.fail(f"{value!r}: expected a decimal such as 12.5", param, ctx)


class CrsName(ParameterType[str]):
    """The name of a coordinate reference system."""

    name = "CRS"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Check the name."""
        from vorotool.numeric.crs import crs_member

        if crs_member(value) is None:
            self.fail(f"{value!r} is none: write authority and code, such as EPSG:3857 or OGC:CRS84", param, ctx)
        return str(value)


class Shard(ParameterType[tuple[int, int]]):
    """``I/N``, the I-th of N parts."""

    name = "I/N"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[int, int]:
        """Parse both numbers."""
        if isinstance(value, tuple):
            return value
        match = re.fullmatch("([0-9]{1,9})/([0-9]{1,9})", value)
        if match is None or not 1 <= int(match[1]) <= int(match[2]):
            self.fail(f"{value!r}: expected I/N with I from 1 to N, such as 2/8", param, ctx)
        return (int(match[1]), int(match[2]))


class Page(ParameterType[int]):
    """The number of a page, or ``all``."""

    name = "N|all"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:
        """Parse the number."""
        from vorotool.jobs.options import ALL_PAGES

        if isinstance(value, int):
            return value
        if value == "all":
            return ALL_PAGES
        if not re.fullmatch("[0-9]{1,9}", value):
            self.fail(f"{value!r}: expected the number of a page, from 0, or all", param, ctx)
        return int(value)


class Names(ParameterType[tuple[str, ...]]):
    """Names from a list, separated by commas."""

    name = "A[,B...]"

    def __init__(self, choices: tuple[str, ...]) -> None:
        self.choices = choices

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[str, ...]:
        """Split, accept both spellings, refuse what is not in the list."""
        if isinstance(value, tuple):
            return value
        given = (name.strip().lower() for name in value.split(","))
        names = tuple(map(in_our_spelling, given))
        for name in names:
            if name not in self.choices:
                self.fail(f"{name!r} is not one of {', '.join(self.choices)}", param, ctx)
        return tuple(dict.fromkeys(names))

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem[str]]:
        """Offer what is not in the list yet."""
        return listed(self.choices, incomplete)


def _named_folder(ctx: click.Context, param: click.Parameter, value: str | None) -> str | None:
    """Refuse an empty name, such as a variable of a shell that is not set leaves: it would stand for this folder."""
    if value == "":
        raise click.BadParameter("'' is no name: name a folder, or . for this one", ctx, param)
    return value


def named_image(ctx: click.Context, param: click.Parameter, value: str | None) -> str | None:
    """Refuse what is an option more likely: whoever forgot the image would be told of its value, which is left over."""
    if value is not None and value.startswith("-") and value != "-":
        raise click.BadParameter(f"{value!r} is no image: name one, or write ./{value}", ctx, param)
    return value


def _from_environment(name: str) -> dict[str, Any]:
    """Let an option that changes no result be set for all runs."""
    return {"envvar": f"VOROTOOL_{name}", "show_envvar": True}


OPTIONS: dict[str, Decorator] = {
    "input-format": click.option(
        "--input-format",
        metavar="FORMAT",
        help="Format of the input, where it is unclear.",
        shell_complete=words(NAMES_WITH[None]),
    ),
    "input-crs": click.option(
        "--input-crs",
        type=CrsName(),
        help="Coordinate reference system of an input that names none, such as EPSG:3857; nothing is reprojected.",
    ),
    "input-layer": click.option(
        "--input-layer",
        metavar="NAME",
        help="Layer of an input that has several; FILE:LAYER, such as map.gpkg:roads, names that of any file.",
    ),
    "crs": click.option(
        "--crs",
        type=CrsName(),
        help="Coordinate reference system to work and write in: inputs in another one are reprojected.",
    ),
    "out-dir": click.option(
        "--out-dir",
        metavar="DIR",
        callback=_named_folder,
        help="Folder for outputs named after the inputs.",
        shell_complete=folders,
    ),
    "jobs": click.option(
        "-j",
        "--jobs",
        type=click.IntRange(0, 1024),
        metavar="N",
        **_from_environment("JOBS"),
        help="Worker processes; 0 uses all cores.",
    ),
    **TABLE_OPTIONS,
    "files-from": click.option(
        "--files-from",
        metavar="FILE|-",
        help="Read the names of further inputs, one a line.",
        shell_complete=any_file,
    ),
    "null": click.option("-0", "--null", is_flag=True, help="Names of --files-from end with NUL bytes."),
    "keep-going": click.option("--keep-going", is_flag=True, help="Go on with the others when an input fails."),
    "dry-run": click.option("--dry-run", is_flag=True, help="Print the plan as JSON lines, and write nothing."),
    "resume": click.option("--resume", is_flag=True, help="Leave out inputs that were done before."),
    "shard": click.option("--shard", type=Shard(), help="Take every N-th input in the order of names, from the I-th."),
    "follow": click.option("--follow", is_flag=True, help="Follow links to folders that are found in folders."),
    "cluster": click.option(
        "--cluster",
        metavar="ADDRESS|local",
        **_from_environment("CLUSTER"),
        help="Work on a Dask cluster.",
        shell_complete=words(("local",)),
    ),
    "threads": click.option(
        "--threads",
        type=click.IntRange(0, 1024),
        metavar="N",
        default=0,
        show_default=True,
        **_from_environment("THREADS"),
        help="Threads; 0 uses all.",
    ),
    "quiet": click.option(
        "-q",
        "--quiet",
        is_flag=True,
        **_from_environment("QUIET"),
        help="Print no notes, warnings or progress.",
    ),
    "verbose": click.option("-v", "--verbose", is_flag=True, help="Report the time of each phase."),
    "stats": click.option(
        "--stats",
        metavar="FILE|-",
        help="Write counts, sizes, seconds and warnings as JSON.",
        shell_complete=files(("json",)),
    ),
    "verify": click.option("--verify", is_flag=True, help="Check the result independently; exit 1 if it is wrong."),
    "strict": click.option("--strict", is_flag=True, help="Refuse what would be repaired or snapped."),
    "decimals": click.option(
        "--decimals",
        type=click.IntRange(0, 17),
        metavar="N",
        help="Decimals of coordinates; polygons stay valid. Default: all that round-trip.",
    ),
    "precision": click.option(
        "--precision",
        type=click.IntRange(1, 17),
        metavar="N",
        help="Significant digits of other numbers; by default the shortest that round-trips.",
    ),
    "max-pixels": click.option(
        "--max-pixels",
        type=click.IntRange(min=1),
        metavar="N",
        default=2**31,
        show_default=True,
        **_from_environment("MAX_PIXELS"),
        help="Maximum number of pixels held in memory.",
    ),
    "max-sites": click.option(
        "--max-sites",
        type=click.IntRange(min=1),
        metavar="N",
        default=2**31 - 1,
        show_default=True,
        **_from_environment("MAX_SITES"),
        help="Maximum number of seeds, samples or vertices.",
    ),
    "no-clobber": click.option("--no-clobber", is_flag=True, help="Refuse to replace an existing file."),
    "overwrite": click.option(
        "--overwrite", is_flag=True, help="Replace a GeoPackage that holds other layers, which are lost."
    ),
    "safe-csv": click.option(
        "--safe-csv",
        is_flag=True,
        help="Put ' before texts in CSV and TSV that a spreadsheet would take for formulas; numbers stay.",
    ),
    "no-properties": click.option(
        "--no-properties",
        is_flag=True,
        help="Do not copy the input's further columns or properties, wherever they would be.",
    ),
    "columns": click.option(
        "--columns", metavar="X,Y[,LABEL]", help="Columns of a point list, by name or number (from 1)."
    ),
    "page": click.option(
        "--page", type=Page(), help="Page of an image stack, from 0; all makes each page an input of a batch."
    ),
    "seeds": click.option(
        "--seeds",
        type=click.Choice(["pixels", "components", "labels", "centroids"], case_sensitive=False),
        help="What an image's seeds are; by default components of a mask (0, and 1 or 255 or all bits), else labels.",
    ),
    "connectivity": click.option(
        "--connectivity",
        type=click.Choice(["8", "4"], case_sensitive=False),
        help="Connectivity of the components of an image; by default 8.",
    ),
    "threshold": click.option("--threshold", type=Threshold(), help="Foreground is what is brighter than this."),
    "invert": click.option("--invert", is_flag=True, help="Exchange foreground and background."),
    "size": click.option("--size", type=Size(), help="Frame of W x H pixels from pixel (0, 0)."),
    "window": click.option("--window", type=Window(), help="Frame whose first pixel is (X, Y)."),
    "width": click.option(
        "--width",
        type=click.IntRange(16, 2**31 - 1),
        metavar="PIXELS",
        help="Pixels across a picture that is not the size of an image; by default 1000.",
    ),
    "overlay": click.option(
        "--overlay",
        metavar="IMAGE",
        callback=named_image,
        help="Draw pictures over this image, at its size: coordinates are its pixels.",
        shell_complete=files(IMAGE_NAMES),
    ),
    "y-up": click.option(
        "--y-up/--y-down",
        default=None,
        help="Direction of y in the input; by default up on maps and in DXF, down in images and SVG.",
    ),
}


_OF_TABLES = ("table", "table_inputs", "fields")
BATCH_OPTIONS = (
    *("files_from", "null", "jobs", "keep_going", "dry_run", "resume", "shard", "follow"),
    *_OF_TABLES,
    "cluster",
)
"""Options of many inputs."""


def together(*options: Decorator) -> Decorator:
    """Add options to a command, in this order."""

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        for option in reversed(options):
            function = option(function)
        return function

    return decorate


def shared(*names: str) -> Decorator:
    """Add options of the registry to a command, in this order."""
    return together(*(OPTIONS[name] for name in names))


def inputs_argument(extensions: Iterable[str]) -> Decorator:
    """Add the inputs, which usually have these extensions."""
    return click.argument("inputs", metavar="INPUT...", nargs=-1, shell_complete=files(extensions))


def output_options(formats: Mapping[str, Sequence[str]]) -> Decorator:
    """Add ``--output`` and ``--format`` of a command that writes these formats."""
    all_formats = dict.fromkeys(fmt for possible in formats.values() for fmt in possible)
    return together(
        click.option(
            "-o",
            "--output",
            metavar="FILE",
            help="Where to write; - is standard output.",
            shell_complete=outputs_of(formats),
        ),
        click.option(
            "-f",
            "--format",
            metavar="FORMAT",
            help=f"Format of the output: {', '.join(all_formats)}; by default its extension. With several results "
            "a list, such as tiff,csv: each has the one that is usual for it.",
            shell_complete=formats_of(formats),
        ),
    )


def batch_options(*, table: bool = True) -> Decorator:
    """Add the options of many inputs."""
    return shared(*(name.replace("_", "-") for name in BATCH_OPTIONS if table or name not in _OF_TABLES))


SEVERAL = (
    "several separated by commas: -o x.gpkg writes them as layers of one file, any other name a file for each, such as "
    "x.labels.tif and x.table.csv for -o x.tif"
)
"""How several results are written, as help says it."""


def what_option(choices: tuple[str, ...]) -> Decorator:
    """Add ``--what``; the first choice is the default."""
    return click.option(
        "--what",
        type=Names(choices),
        multiple=True,
        callback=accumulated,
        default=(choices[0],),
        show_default=True,
        help=f"What to write: {', '.join(choices)}; {SEVERAL}.",
    )


def layers_option(choices: tuple[str, ...]) -> Decorator:
    """Add ``--layers`` of pictures."""
    return click.option(
        "--layers",
        type=Names(choices),
        multiple=True,
        callback=accumulated,
        help=f"Layers of pictures: {', '.join(choices)}.",
    )
