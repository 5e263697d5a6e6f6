"""The format of an input, and what it holds: told once, by what the caller says, the content and the extension."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from vorotool.errors import INPUT_FORMAT, InputError, UsageError, option
from vorotool.formats.io.arrays import MAGIC, npy_header
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.products.formats import resolved
from vorotool.products.inputs import IMAGE_NAMES, INPUTS, Holds
from vorotool.products.registry import is_of

_CRS, _TO_CRS = option("--input-crs", "crs"), option("--crs", "to_crs")
_LAYER = option("--input-layer or FILE:LAYER", "layer or FILE:LAYER")

_IMAGE_SUFFIXES = {f".{name}": kind for name, kind in IMAGE_NAMES.items() if kind != "zarr"}
_IMAGE_HEADS = (
    (b"\x89PNG", "png"),
    (b"II*\x00", "tiff"),
    (b"MM\x00*", "tiff"),
    (b"II+\x00", "tiff"),
    (b"MM\x00+", "tiff"),
    (MAGIC, "npy"),
)
_RESULTS: dict[bytes, Holds] = {
    b'"vorotool.skeleton"': "skeleton",
    b'"vorotool.offsets"': "offsets",
    b'"vorotool.voronoi"': "voronoi",
}


def recognized(
    source: Source, geometry: str | None = None, said: str | None = None, columns: str | None = None
) -> tuple[Holds, Source]:
    """Tell what a source holds, and give it with its format; what was parsed to tell comes with it."""
    result = _result(source.data) if geometry is None and said in (None, "json", "geojson") else None
    may_be_points = columns is not None and source.data.startswith(MAGIC)
    image = None if may_be_points or result else image_format(source, said)
    if image is not None:
        return "image", replace(source, format=image)
    from vorotool.formats.text_recognition import recognized_geometry, text_source

    if result is not None:
        return result, text_source(source, "json")
    return recognized_geometry(source, geometry, said, columns)


def read_recognized(holds: Holds, source: Source, options: ReadOptions) -> Any:
    """Read what a source was recognized as: points, polygons, an image, a skeleton or offset curves."""
    if holds == "image":
        refuse_for_images(options, source.layer)
    elif source.layer is not None and "layers" not in INPUTS[source.format].has:
        raise UsageError(f"{_LAYER} applies to files with layers, but {source.name} has none: leave it out")
    readers = INPUTS[source.format].readers
    name = readers["polygons"] if holds == "sites" and "sites" not in readers else readers[holds]
    reader: Callable[[Source, ReadOptions], Any] = resolved(name)
    value = reader(source, options)
    if is_of(value, "PointRows"):
        value = resolved("formats.points.columns:point_set")(value)
    if holds not in ("points", "polygons", "sites"):
        return value
    from vorotool.formats.parsing.reference_systems import with_crs

    if is_of(value, "Sites"):
        return replace(value, polygons=with_crs(value.polygons, source.name, options))
    return with_crs(value, source.name, options)


def refuse_for_images(options: ReadOptions, layer: str | None) -> None:
    """Refuse what is said of points, polygons and lines where the input is an image."""
    for name, given in ((_CRS, options.crs), (_TO_CRS, options.to_crs), (_LAYER, layer)):
        if given is not None:
            raise UsageError(f"{name} applies to points, polygons and lines, but the input is an image: leave it out")


def image_source(source: Source, said: str | None = None) -> Source:
    """Give a source, which must be an image, with its format; an NPY file of two columns is one, too."""
    said = "npy" if said is None and source.data.startswith(MAGIC) else said
    found = said if said == "npy" and source.data.startswith(MAGIC) else image_format(source, said)
    if found is None:
        raise InputError(
            f"{source.name} is not an image in a supported format (PNG, TIFF, PGM, PBM, NPY, "
            f"{', '.join(PICTURES.values())}): name its format with {INPUT_FORMAT}, or convert it to PNG"
        )
    refuse_for_images(ReadOptions(), source.layer)
    return replace(source, format=found)


def image_format(source: Source, said: str | None = None) -> str | None:
    """Give the format of an image: what is said, else the extension, else the content; None if it is no image."""
    if said is not None and "image" not in INPUTS[said].readers:
        return None
    found, by_name = _image_by_content(source.data), _IMAGE_SUFFIXES.get(source.suffix)
    kind = found or by_name
    if said in (None, "npy") and (kind is None or (kind == "npy" and not _is_npy_image(source))):
        return None
    chosen = said or by_name or found
    if chosen == "zarr":
        raise InputError(f"{source.name} is a file, but a Zarr store is a folder: leave out {INPUT_FORMAT}")
    if not source.data:
        raise InputError(f"{source.name} is empty, but an image is expected: check the program that wrote it")
    if found and found != chosen:
        said_so = option(f"--input-format {found}", f'input_format="{found}"')
        raise InputError(f"{source.name} is not a {chosen} file, it begins as {found}: use {said_so}")
    return chosen


def _is_npy_image(source: Source) -> bool:
    try:
        shape = npy_header(source).shape
    except InputError:
        return False
    return len(shape) in (2, 3) and shape[1] != 2


def _image_by_content(data: bytes) -> str | None:
    for head, name in _IMAGE_HEADS:
        if data.startswith(head):
            return name
    return "pnm" if looks_like_pnm(data) else picture_format(data)


def _result(data: bytes) -> Holds | None:
    """What of ours text looks like the JSON of, which is not parsed to tell."""
    found = next((holds for kind, holds in _RESULTS.items() if kind in data), None)
    return found if found and data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{") else None


# ---- how images begin ----------------------------------------------------------------------------
PICTURES = {"jpeg": "JPEG", "bmp": "BMP", "gif": "GIF", "webp": "WebP", "avif": "AVIF"}
"""Formats and what they are called."""
_BMP_HEADERS = (12, 16, 40, 52, 56, 64, 108, 124)

GAP = rb"(?:\s|#[^\n\r]*[\n\r])+"
"""Between the numbers of a header of PBM, PGM or PPM: space and comments."""
_START = re.compile(rb"P([1-6])" + GAP + rb"(?=[0-9])")


def picture_format(data: bytes) -> str | None:
    """Which of `PICTURES` data begins as."""
    if data.startswith(b"\xff\xd8\xff"):
        return "jpeg"
    if data.startswith((b"GIF87a", b"GIF89a")):
        return "gif"
    if data.startswith(b"RIFF") and data[8:12] == b"WEBP":
        return "webp"
    if data[4:12] in (b"ftypavif", b"ftypavis"):
        return "avif"
    if data.startswith(b"BM") and int.from_bytes(data[14:18], "little") in _BMP_HEADERS:
        return "bmp"
    return None


def looks_like_pnm(data: bytes) -> bool:
    """Tell whether data begins as a PBM, PGM or PPM file: P1 to P6, space or comments, a number."""
    return _START.match(data[:65_536]) is not None
