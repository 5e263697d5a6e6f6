"""Columns that options name, and sites that a result does not show."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from vorotool.errors import Kind, Message
from vorotool.jobs.options import Options
from vorotool.types.identity import check_plain, chosen_column

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.jobs.run_log import Run


def check_column(label_by: str | None, columns: Mapping[str, Any], option: str = "--label-by") -> None:
    """Refuse a column that the input does not have, or that holds objects."""
    if label_by is not None:
        check_plain(chosen_column(columns, label_by, option), option)


def check_columns(o: Options, columns: Mapping[str, Any]) -> None:
    """Refuse columns that options name and the input does not have."""
    check_column(o.label_by, columns)
    for name in o.with_columns or ():
        chosen_column(columns, name, "--with")


SHOWN = 10
"""Labels of sites that are named."""


def tell_empty_cells(run: Run, labels: NDArray[Any], is_empty: NDArray[np.bool_]) -> None:
    """Name the sites whose cells are empty."""
    if not is_empty.any():
        return
    run.stats["empty_sites"] = labels[is_empty][:SHOWN].tolist()
    if is_empty.all():
        many = f"all {len(labels)} cells are" if len(labels) > 1 else "the only cell is"
        run.warn(Message(f"{many} empty: no site has points in the frame or the clip", Kind.EMPTY_RESULT))
    else:
        run.note(_text(labels, is_empty, "cells", "empty: {} of"))


def tell_outside(run: Run, labels: NDArray[Any], is_outside: NDArray[np.bool_]) -> None:
    """Name the seeds outside the frame, whose regions may reach into it."""
    if is_outside.any():
        run.stats["outside"] = int(is_outside.sum())
        run.note(_text(labels, is_outside, "seeds", "outside the frame:"))


def _text(labels: NDArray[Any], chosen: NDArray[np.bool_], noun: str, what: str) -> str:
    named = labels[chosen]
    shown = ", ".join(map(str, named[:SHOWN].tolist())) + (", …" if len(named) > SHOWN else "")
    is_one = len(named) == 1
    said = what.format("that" if is_one else "those")
    return f"{len(named)} of {len(labels)} {noun} {'is' if is_one else 'are'} {said} site{'s' * (not is_one)} {shown}"
