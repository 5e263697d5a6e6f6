"""Numbers in text: attributes of delimited text that are numbers stay so, digit by digit."""

from __future__ import annotations

import re
from typing import Any

_COLUMN = re.compile(r"(?:(?:-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][+-]?\d+)?)?\n)*", re.ASCII)


class NumberText(str):
    """A number as it is written, which is a number in JSON, too: no digit of it changes on its way."""

    __slots__ = ()

    @property
    def number(self) -> int | float:
        """Its value: an integer where it is written as one, of no more digits than are usual."""
        return int(self) if len(self) < 64 and not any(mark in self for mark in ".eE") else float(self)


def typed_texts(values: list[str]) -> list[Any]:
    """Give the texts of a column as numbers if all are, but for empty ones, which are None then."""
    text = "\n".join(values)
    if text.count("\n") + 1 != len(values) or not any(values) or not _COLUMN.fullmatch(text + "\n"):
        return values
    return [NumberText(value) if value else None for value in values]
