"""Types of the compiled core (private)."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

# ---- text (bind_text.cpp): a delimiter is one of "," ";" "\t" " " --------------------------------

class TextError(ValueError):
    """Args: kind (not_number, not_finite, field_count, open_quote), line, column, text, found, expected."""

    args: tuple[str, int, int, str, int, int]

def parse_numbers(
    text: bytes,
    delimiter: str,
    columns: list[int],
    header_records: int = 0,
    fields: int = 0,
    threads: int = 0,
) -> NDArray[np.float64]: ...
def parse_fields(
    text: bytes,
    delimiter: str,
    columns: list[int],
    header_records: int = 0,
    fields: int = 0,
    threads: int = 0,
) -> list[list[str]]: ...
def count_rows(text: bytes, delimiter: str, header_records: int = 0, threads: int = 0) -> int: ...
def line_of_row(text: bytes, delimiter: str, header_records: int, row: int) -> int: ...
def first_record(text: bytes, delimiter: str) -> tuple[int, str, list[str]] | None: ...
def find_too_deep(text: bytes, limit: int) -> int | None: ...
def format_columns(
    values: list[Any], missing: list[NDArray[np.bool_] | None], precision: int = 0, threads: int = 0
) -> list[bytes]: ...
