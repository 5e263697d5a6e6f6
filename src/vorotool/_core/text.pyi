"""
Numbers, fields and polygons as text, read and written: a delimiter is one of , ; tab and blank.
"""

from collections.abc import Sequence
import enum
from typing import Any

import numpy
import numpy.typing


class TextError(ValueError):
    pass

def parse_numbers(text: bytes, delimiter: str, columns: Sequence[int], header_records: int = 0, fields: int = 0, threads: int = 0) -> numpy.typing.NDArray[numpy.float64]: ...

def parse_fields(text: bytes, delimiter: str, columns: Sequence[int], header_records: int = 0, fields: int = 0, threads: int = 0) -> list[list[str]]: ...

def count_rows(text: bytes, delimiter: str, header_records: int = 0, threads: int = 0) -> int: ...

def line_of_row(text: bytes, delimiter: str, header_records: int, row: int) -> int: ...

def first_record(text: bytes, delimiter: str) -> tuple[int, str, list[str]] | None:
    """Its line, its text and its fields."""

def find_too_deep(text: bytes, limit: int) -> int | None: ...

def format_rows(values: list[Any], missing: Sequence[numpy.typing.NDArray[numpy.bool] | None], digits: Sequence[int] = [], threads: int = 0, shape: tuple[tuple[str, ...], str, str] | None = None, by_tabs: bool = False) -> list[bytes]: ...

class NumberTexts:
    def __init__(self, values: numpy.typing.NDArray[numpy.float64], precision: int = 0, threads: int = 0) -> None: ...

    def __len__(self) -> int: ...

class PolygonStyle(enum.Enum):
    wkt = 0

    geojson = 1

    json = 2

    wkt_lines = 3

    geojson_lines = 4

class PolygonTexts:
    """
    A column of polygons: each row from its first polygon to that of the next.
    """

    def __init__(self, vertices: numpy.typing.NDArray[numpy.float64], rings: numpy.typing.NDArray[numpy.int64], polygons: numpy.typing.NDArray[numpy.int64], rows: numpy.typing.NDArray[numpy.int64], style: PolygonStyle) -> None: ...

    def __len__(self) -> int: ...
