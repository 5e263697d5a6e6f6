"""Whether the arrays of a Voronoi map that was read go together."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.numeric.ragged import owners
from vorotool.types.voronoi.voronoi_map import OUTSIDE, VoronoiMap


def check_map(name: str, cells: VoronoiMap) -> None:
    """Check that arcs lead from lower to higher vertices, and that rings are closed and pass each side once."""
    low, high = cells.arcs.T
    _refuse(name, "arcs", low >= high, lambda at: f"it is from vertex {low[at]} to {high[at]}; write the smaller first")
    signed = cells.ring_arcs.astype(np.int64)
    arc, is_back = np.abs(signed) - 1, signed < 0
    ring = owners(np.diff(cells.ring_starts))
    cell = cells.cell_of_polygon[owners(np.diff(cells.polygon_starts))][ring]
    count = len(cells.arcs)
    wrong = (signed == 0) | (arc >= count)
    _refuse(name, "cells", wrong, lambda at: f"a ring has arc {signed[at]}, but there are {count}", cell)
    own = cells.sites[arc, is_back.astype(int)]
    _refuse(
        name,
        "cells",
        own != cell,
        lambda at: f"a ring has arc {signed[at]}, whose side is {_side(int(own[at]))}; correct its sites",
        cell,
    )
    begin, end = np.where(is_back, high[arc], low[arc]), np.where(is_back, low[arc], high[arc])
    after = np.arange(1, len(arc) + 1)
    after[cells.ring_starts[1:] - 1] = cells.ring_starts[:-1]
    _refuse(
        name,
        "cells",
        end != begin[after],
        lambda at: f"a ring continues at vertex {begin[after[at]]}, but arc {signed[at]} ends at {end[at]}; close it",
        cell,
    )
    passed = np.bincount(2 * arc + is_back, minlength=2 * count)
    due = (cells.sites != OUTSIDE).ravel()
    sides = np.repeat(np.arange(count), 2)
    _refuse(
        name,
        "arcs",
        passed != due,
        lambda at: f"rings have its {('left', 'right')[at % 2]} side {passed[at]} times; expected {int(due[at])}",
        sides,
    )


def _side(site: int) -> str:
    return "null" if site == OUTSIDE else f"of site {site}"


def _refuse(name: str, member: str, wrong: NDArray[np.bool_], words: Any, item: NDArray[Any] | None = None) -> None:
    """Refuse what is wrong first, with the number of its item."""
    if wrong.any():
        at = int(wrong.argmax())
        raise InputError(f"{name}, {member} {at if item is None else item[at]}: {words(at)}")
