"""Names of objects in pictures: their ids, or what a column says."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from vorotool.render.canvas.layers import Texts
from vorotool.types.identity import column_of


def column_texts(properties: Mapping[str, Sequence[Any]], column: str | None, ids: Iterable[Any]) -> list[str]:
    """Give what is written on objects."""
    return [text_of(value) for value in (ids if column is None else column_of(properties, column) or ())]


def text_of(value: Any) -> str:
    """Give a value as what is written, shortest; nothing for what is missing."""
    if value is None or value is np.ma.masked:
        return ""
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return "" if value != value else repr(value).removesuffix(".0")  # noqa: PLR0124  # NaN is not itself
    return str(value).strip()


def without_empty(texts: Texts) -> Texts:
    """Leave out the places where nothing is written."""
    kept = [k for k, text in enumerate(texts.texts) if text]
    if len(kept) == len(texts.texts):
        return texts
    return replace(texts, points=texts.points[kept], texts=[texts.texts[k] for k in kept])
