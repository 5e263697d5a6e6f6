"""Columns of the input that options name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from vorotool.jobs.options import Options
from vorotool.types.named_columns import check_plain, chosen_column

if TYPE_CHECKING:
    from vorotool.jobs.options import Options


def check_column(label_by: str | None, columns: Mapping[str, Any], option: str = "--label-by") -> None:
    """Refuse a column that the input does not have, or that holds objects."""
    if label_by is not None:
        check_plain(chosen_column(columns, label_by, option), option)


def check_columns(o: Options, columns: Mapping[str, Any]) -> None:
    """Refuse columns that options name and the input does not have."""
    check_column(o.label_by, columns)
    for name in o.with_columns or ():
        chosen_column(columns, name, "--with")
