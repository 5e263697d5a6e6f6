"""Files that are known and not read: what they are, and the command that makes something of them that is."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from vorotool.errors import OTSU, InputError
from vorotool.formats.io.sources import Source

_MAPS = (".gml", ".gdb", ".tab", ".mif")
_SHAPEFILE_PARTS = (".shx", ".dbf", ".prj", ".cpg")
_DRAWINGS = (".pdf", ".eps", ".ps", ".ai")
_FONTS = (".ttf", ".otf", ".ttc", ".woff", ".woff2")
_OTHERS = (".dwg", ".zip", ".qgz", ".qgs", ".roi", *_FONTS, *_SHAPEFILE_PARTS)
_HEADS = (
    *((b"%PDF-", ".pdf"), (b"%!PS", ".ps"), (b"\xc5\xd0\xd3\xc6", ".eps"), (b"OTTO\0", ".otf")),
    *((b"\0\1\0\0\0", ".ttf"), (b"wOFF", ".woff"), (b"wOF2", ".woff2"), (b"ttcf", ".ttc")),
)
_DWG = re.compile(rb"AC10\d\d\0")


def refuse_convertible(source: Source) -> None:
    """Refuse the formats of maps and drawings that are not read, by extension or content."""
    heads = (suffix for head, suffix in _HEADS if source.data.startswith(head))
    found = source.suffix if source.suffix in _MAPS + _DRAWINGS + _OTHERS else next(heads, None)
    if found is None and _DWG.match(source.data):
        found = ".dwg"
    if found == ".zip" and b".roi" in source.data:
        found = ".roi"
    if found is not None:
        file = source.name if source.suffix == found else f"FILE{found}"
        raise InputError(f"{source.name}: {found} files are not supported; {_CONVERSIONS.get(found, _as_map)(file)}")


def refuse_geodatabase(folder: str) -> None:
    """Refuse a file geodatabase, which is a folder."""
    if Path(folder).suffix.lower() == ".gdb":
        target = Path(folder).with_suffix(".gpkg")
        raise InputError(f"{folder}: file geodatabases are not supported; convert it: ogr2ogr {target} {folder}")


def _as_map(file: str) -> str:
    return f"convert it: ogr2ogr -f GeoJSON {Path(file).with_suffix('.geojson')} {file}"


def _as_drawing(command: str) -> Callable[[str], str]:
    def advice(file: str) -> str:
        stem = Path(file).with_suffix("")
        return (
            f"convert it to an image and use {OTSU}, for example: {command.format(file=file, stem=stem)}; or, for its "
            f"outlines, an SVG: inkscape {file} --export-text-to-path --export-plain-svg --export-filename={stem}.svg"
        )

    return advice


def _as_dxf(file: str) -> str:
    made = Path(file).with_suffix(".dxf")
    return f"save it as DXF in the program that made it, or convert it: dwg2dxf -o {made} {file}"


def _unpacked(file: str) -> str:
    return f"unpack it, and name a file from it: unzip {file}"


def _written(file: str) -> str:
    return "it is a font: write the text in a drawing program, convert it to paths, and save these as SVG"


def _as_part(file: str) -> str:
    return f"it is part of a Shapefile: name {Path(file).with_suffix('.shp')}"


_POSTSCRIPT = _as_drawing("gs -o {stem}.png -sDEVICE=pnggray -r300 -dEPSCrop {file}")
_CONVERSIONS: dict[str, Callable[[str], str]] = {
    **dict.fromkeys((".eps", ".ps", ".ai"), _POSTSCRIPT),
    ".pdf": _as_drawing("pdftoppm -r 300 -gray -singlefile {file} {stem}"),
    **dict.fromkeys(_FONTS, _written),
    **dict.fromkeys(_SHAPEFILE_PARTS, _as_part),
    ".dwg": _as_dxf,
    ".zip": _unpacked,
    **dict.fromkeys((".qgz", ".qgs"), lambda _: "it is a project of QGIS: name the files of its layers"),
    ".roi": lambda _: "make a mask of the regions in ImageJ (Edit, Selection, Create Mask), and use that image",
}
