"""Alpha shapes of too few points: what is refused, and what is empty."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import STRICT, InputError, VorotoolWarning, option, warn
from vorotool.products.registry import is_of
from vorotool.types.alpha.complex import AlphaComplex

GIVE_R = f": give r itself{option(' (-r)', '')}"
"""Advice where no radius can be chosen."""


def allows_empty(points: Any, allow_empty: bool | None) -> bool:
    """Tell whether too few points are no error: as the caller says, else those of an image, one of many perhaps."""
    is_image = is_of(points, "SeedSet") and points.frame is not None
    return is_image if allow_empty is None else allow_empty


def report_too_few(count: int, *, allow_empty: bool, strict: bool) -> None:
    """Refuse points that no edge can join, or warn of them; of an image without any it has been told."""
    if not count and allow_empty:
        return
    held = "1 point" if count == 1 else f"{count} points"
    where = ", all at one position" if count > 1 else ""
    reason = f"an alpha shape needs at least two distinct points, but got {held}{where}"
    refuse_or_warn(reason, "", allow_empty=allow_empty, strict=strict)


def refuse_or_warn(reason: str, advice: str, *, allow_empty: bool, strict: bool) -> None:
    """Raise or warn for a reason why there is no shape."""
    if not allow_empty:
        raise InputError(f"{reason}{advice}")
    if strict:
        raise InputError(f"{reason}{f'{advice}, or' if advice else ':'} leave out {STRICT} for an empty shape")
    warn(VorotoolWarning(f"{reason}{advice}; the shape is empty"))


def radius_below_all(family: AlphaComplex) -> float:
    """A radius whose shape has isolated points only; any has where no edge is."""
    return float(np.nextafter(family.spectrum[0], 0)) if len(family.spectrum) else 1.0


def unjoined(family: AlphaComplex) -> str | None:
    """Say why no radius gives a region that holds every point; None where one does."""
    mesh = family.mesh
    if len(mesh.points) and least_ranks(family).max() < len(family.spectrum):
        return None
    count = len(mesh.points) - mesh.duplicates
    if len(mesh.triangles):
        reason = "a point is on"
    elif count < 2:
        reason = "one point spans" if count else "no points span"
    else:
        reason = "two points span" if count == 2 else f"{count} points on a line span"
    return f"{reason} no triangle, so no radius gives a region that holds all points"


def least_ranks(family: AlphaComplex) -> NDArray[np.int32]:
    """(n,) the first rank at which each point is in a triangle; as many as there are ranks where it never is."""
    mesh = family.mesh
    least = np.full(len(mesh.points), len(family.spectrum), dtype=np.int32)
    np.minimum.at(least, mesh.triangles, family.triangle_rank[:, None])
    return least[mesh.first]
