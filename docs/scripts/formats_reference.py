"""Print the reference of formats, made from the registries: `formats_reference.py > docs/reference/formats.md`."""

import sys
from collections.abc import Iterable

from vorotool.products.formats import FORMATS
from vorotool.products.inputs import SPACE_READERS, VOLUME_NAMES, names_of
from vorotool.products.registry import PRODUCTS


def reference() -> str:
    """Formats of inputs, of outputs, and of each result, as Markdown."""
    parts = [
        "# Formats",
        "",
        "Made by `python docs/scripts/formats_reference.py`; a test keeps it true. [What formats carry](abilities.md):",
        "reference systems, attributes, sizes of pixels. [Coordinates, curves and digits](coordinates.md): how",
        "they are rounded and flattened.",
        "",
        "## Inputs",
        "",
        "The content of a file tells its format; `--input-format NAME` does where it is unclear.",
        "",
        *table("holds", "`--input-format`", rows=((kind, coded(names)) for kind, names in inputs().items())),
        "",
        "## Outputs",
        "",
        "The extension of the output tells its format, or `-f NAME`; in the library `fmt`.",
        "Images have no units in them.",
        "Formats of lines have no curves: [lines](coordinates.md#curves) within `--flatten` stand for these.",
        "",
        *table("format", "`-f`", "extensions", "kind", rows=outputs()),
        "",
        "## Results",
        "",
        "What each command writes with `--what`, and in which formats, the default first.",
        "",
    ]
    for command, products in PRODUCTS.items():
        rows = ((f"`{what}`", coded(each.formats)) for what, each in products.items())
        parts += [f"### {command}", "", *table("`--what`", "`-f`", rows=rows), ""]
    return "\n".join(parts)


def inputs() -> dict[str, Iterable[str]]:
    """Names of formats that are read, by what they hold."""
    held: dict[str, Iterable[str]] = {
        "points": names_of("points"),
        "polygons and lines": names_of("polygons"),
        "images": names_of("image"),
    }
    space = [name for name, kind in names_of("points").items() if kind in SPACE_READERS or kind == "npy"]
    return {**held, "volumes, slice by slice": VOLUME_NAMES, "points with a z": space}


def outputs() -> Iterable[tuple[str, ...]]:
    """A row for each format that is written."""
    for name, each in FORMATS.items():
        kinds = (("image", each.is_image), ("lines", each.flattens), ("text" if each.is_text else "bytes", True))
        yield each.title, f"`{name}`", coded(each.endings), ", ".join(kind for kind, holds in kinds if holds)


def table(*titles: str, rows: Iterable[tuple[str, ...]]) -> list[str]:
    """A table of Markdown."""
    return [f"| {' | '.join(row)} |" for row in (titles, ["---"] * len(titles), *rows)]


def coded(names: Iterable[str]) -> str:
    """Names as code, separated by commas."""
    return ", ".join(f"`{name}`" for name in names)


if __name__ == "__main__":
    sys.stdout.write(reference())
