"""Delimited text with a column of geometry: well-known text, or well-known binary in hexadecimal digits."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.gis.feature_table import Features
from vorotool.formats.io.sources import Source, check_nesting
from vorotool.formats.parsing.reader_options import shortened
from vorotool.formats.parsing.reference_systems import crs_of_numbers
from vorotool.formats.points.delimited import GEOMETRY_COLUMNS, DelimitedText, delimited_text, geometry_column
from vorotool.numeric.crs import without_number
from vorotool.numeric.curves.well_known import geometry_of_binary, geometry_of_texts

_COMMENT = re.compile(rb"^\s*#.*$", re.MULTILINE)
_SHAPE = re.compile(rb"POLYGON|LINESTRING|LINEARRING|CIRCULARSTRING|CURVE|SURFACE|TIN|TRIANGLE", re.IGNORECASE)
_BINARY = re.compile(r"(00|01)([0-9A-Fa-f]{2}){8,}")


def features_of_texts(source: Source) -> Features:
    """Read geometries of well-known text: each begins a line, and ends when its brackets close."""
    check_nesting(source.data, name=source.name)
    texts: list[str] = []
    lines: list[int] = []
    srids: list[int] = []
    depth = 0
    for number, line in enumerate(source.data.decode("utf-8", "replace").splitlines(), 1):
        text = line.strip()
        if not text or (depth == 0 and text.startswith("#")):
            continue
        if depth > 0 or (texts and text.startswith("(")):
            texts[-1] += " " + text
        else:
            text, srid = without_number(text)
            texts.append(text)
            lines.append(number)
            srids.append(srid)
        depth = max(0, depth + text.count("(") - text.count(")"))
    crs = crs_of_numbers(source.name, srids, lines.__getitem__)
    geometry, curves = geometry_of_texts(texts, source.flatten)
    bad = next((row for row, each in enumerate(geometry) if each is None), None)
    if bad is not None:
        raise InputError(
            f"{source.name}, line {lines[bad]}: {shortened(texts[bad])} is not WKT; write for example POINT (3 4) or "
            "POLYGON ((0 0, 4 0, 0 3, 0 0)), each ring closed"
        )

    def place(feature: int) -> str:
        return f"{source.name}, line {lines[feature]}"

    return Features(source.name, geometry, {}, None, crs, place, texts=texts, curves=curves)


def names_shapes(data: bytes) -> bool:
    """Return whether a well-known text names a polygon or a line."""
    return _SHAPE.search(_COMMENT.sub(b"", data)) is not None


def features_of_rows(source: Source) -> Features:
    """Read all rows; an empty field is no geometry."""
    text = delimited_text(source)
    column = geometry_column(text.fields)
    if column is None:
        raise InputError(
            f"{source.name}: no column has the name of a geometry column ({', '.join(GEOMETRY_COLUMNS)}); rename the "
            "column of geometry"
        )
    columns = text.columns()
    written = columns.pop(list(columns)[column])
    check_nesting("\n".join(written), name=source.name)
    geometry, crs, curves = _parsed(text, written, source.flatten)

    def place(feature: int) -> str:
        return f"{source.name}, line {text.line_of(feature)}"

    return Features(source.name, geometry, columns, None, crs, place, curves=curves)


def _parsed(text: DelimitedText, written: Sequence[str], flatten: float | None) -> tuple[NDArray[np.object_], Any, int]:
    """The geometry, its reference system, and how many curves were flattened."""
    fields = [field.strip() for field in written]
    kept = [row for row, field in enumerate(fields) if field]
    geometry = np.full(len(fields), None, dtype=object)
    if all(_BINARY.fullmatch(fields[row]) for row in kept) and kept:
        geometry[kept], curves = geometry_of_binary([fields[row] for row in kept], flatten)
        crs = crs_of_geometry(text.name, geometry[kept], lambda index: text.line_of(kept[index]))
    else:
        cut = [without_number(fields[row]) for row in kept]
        geometry[kept], curves = geometry_of_texts([wkt for wkt, _ in cut], flatten)
        crs = crs_of_numbers(text.name, [number for _, number in cut], lambda index: text.line_of(kept[index]))
    bad = next((row for row in kept if geometry[row] is None), None)
    if bad is not None:
        raise InputError(
            f"{text.name}, line {text.line_of(bad)}: {shortened(fields[bad])} is neither WKT nor WKB; write for "
            "example POINT (3 4)"
        )
    return geometry, crs, curves


# ---- well-known binary ---------------------------------------------------------------------------
_HEXADECIMAL = re.compile(rb"[0-9A-Fa-f\s]*")


def features_of_binary(source: Source) -> Features:
    """Read one geometry, or one a line."""
    import shapely

    if not source.data.strip():
        raise InputError(
            f"{source.name} is empty, but well-known binary (WKB) is expected; check the program that wrote it"
        )
    is_digits = _HEXADECIMAL.fullmatch(source.data) is not None
    written = source.data.split() if is_digits else [source.data]
    geometry, curves = geometry_of_binary([item.decode() for item in written] if is_digits else written, source.flatten)
    bad = np.flatnonzero(shapely.is_missing(geometry))
    if bad.size:
        raise InputError(f"{source.name}: geometry {bad[0] + 1} is not WKB; is the file damaged or cut off?")
    crs = crs_of_geometry(source.name, geometry, lambda row: row + 1)
    return Features(source.name, geometry, {}, None, crs, curves=curves)


def crs_of_geometry(name: str, geometry: NDArray[Any], line_of: Callable[[int], int]) -> Any:
    """Give the ``crs`` member for the numbers (SRID) that geometry of extended well-known binary carries."""
    import shapely

    numbers = [0 if each is None else int(shapely.get_srid(each)) for each in geometry]
    return crs_of_numbers(name, numbers, line_of)
