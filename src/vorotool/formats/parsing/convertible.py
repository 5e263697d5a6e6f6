"""Files that are known and not read: what they are, and the command that makes something of them that is."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source

_MAPS = (".dxf", ".gml", ".gdb", ".tab", ".mif")
_DRAWINGS = (".svg", ".svgz", ".pdf", ".eps", ".ps", ".ai")
_OTHERS = (".dwg", ".zip")
_HEADS = ((b"%PDF-", ".pdf"), (b"%!PS", ".ps"), (b"\xc5\xd0\xd3\xc6", ".eps"))
_DWG = re.compile(rb"AC10\d\d\0")
_SVG = re.compile(
    rb"(\xef\xbb\xbf)?\s*(<\?xml[^>]*>|<!--.*?-->|<!DOCTYPE[^>\[]*(\[.*?\]\s*)?>|\s)*<svg[\s>]", re.DOTALL
)


def refuse_convertible(source: Source) -> None:
    """Refuse the formats of maps and drawings that are not read, by extension or content.

    Raises
    ------
    InputError
        With the command that converts the file.

    Examples
    --------
    >>> refuse_convertible(Source("seeds.csv", b"1,2"))
    >>> refuse_convertible(Source("towns.zip", b""))
    Traceback (most recent call last):
        ...
    vorotool.errors.InputError: towns.zip: .zip files are not read; unpack it, and give a file that is in it: \
unzip towns.zip
    >>> refuse_convertible(Source("logo.svg", b"<svg></svg>"))
    Traceback (most recent call last):
        ...
    vorotool.errors.InputError: logo.svg: .svg files are not read; make an image of it and give --threshold otsu, for \
example: inkscape logo.svg --export-filename=logo.png --export-background=white
    """
    heads = (suffix for head, suffix in _HEADS if source.data.startswith(head))
    found = source.suffix if source.suffix in _MAPS + _DRAWINGS + _OTHERS else next(heads, None)
    if found is None and _DWG.match(source.data):
        found = ".dwg"
    if found is None and _SVG.match(source.data[:4096]):
        found = ".svg"
    if found is not None:
        file = source.name if source.suffix == found else f"FILE{found}"
        raise InputError(f"{source.name}: {found} files are not read; {_CONVERSIONS.get(found, _as_map)(file)}")


def _as_map(file: str) -> str:
    return f"convert it: ogr2ogr -f GeoJSON {Path(file).with_suffix('.geojson')} {file}"


def _as_image(command: str) -> Callable[[str], str]:
    def advice(file: str) -> str:
        made = command.format(file=file, stem=Path(file).with_suffix(""))
        return f"make an image of it and give --threshold otsu, for example: {made}"

    return advice


def _as_dxf(file: str) -> str:
    made = Path(file).with_suffix(".dxf")
    return f"save it as DXF in the program that made it, and convert that: {_as_map(str(made)).partition(': ')[2]}"


def _unpacked(file: str) -> str:
    return f"unpack it, and give a file that is in it: unzip {file}"


def _unpacked_drawing(file: str) -> str:
    made = Path(file).with_suffix(".svg")
    return f"unpack it: gzip -dc {file} > {made}; then {_CONVERSIONS['.svg'](str(made))}"


_POSTSCRIPT = _as_image("gs -o {stem}.png -sDEVICE=pnggray -r300 -dEPSCrop {file}")
_CONVERSIONS: dict[str, Callable[[str], str]] = {
    ".eps": _POSTSCRIPT,
    ".ps": _POSTSCRIPT,
    ".ai": _POSTSCRIPT,
    ".dwg": _as_dxf,
    ".zip": _unpacked,
    ".svgz": _unpacked_drawing,
    ".svg": _as_image("inkscape {file} --export-filename={stem}.png --export-background=white"),
    ".pdf": _as_image("pdftoppm -r 300 -gray -singlefile {file} {stem}"),
}
