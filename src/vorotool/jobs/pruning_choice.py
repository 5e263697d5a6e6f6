"""What is pruned: what the user asks for, or what the input calls for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from vorotool.typing import Criterion

CRITERIA: tuple[Criterion, ...] = ("angle", "chord", "scale", "length", "ratio")
"""As `vorotool.types.skeleton.critical_values` has them, which ``--help`` does not import."""
LENGTHS = ("chord", "length")
"""Criteria whose thresholds are lengths."""


class Pruning(NamedTuple):
    """What is removed: a criterion and a threshold, or nothing; ``name`` is what was asked for."""

    name: str
    criterion: str | None = None
    threshold: Any = 0.0  # a float, once lengths with a unit are in pixels

    def stats(self) -> dict[str, Any]:
        """What statistics say of it."""
        return {"name": self.name} | ({} if self.criterion is None else {self.criterion: self.threshold})


def chosen_pruning(asked: Pruning | None, *, is_mask: bool) -> Pruning:
    """What to remove: masks are pruned by default, polygons are not."""
    if asked is not None and asked.name != "mask":
        return asked
    if asked is None and not is_mask:
        return Pruning("none")
    from vorotool.engines.pruning.pruning import default_pruning_for_masks

    return Pruning("mask", *default_pruning_for_masks())
