"""``--prune``, ``--from`` and ``--to`` of the commands that make skeletons."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

import click

from vorotool.cli.options.lengths import measured
from vorotool.cli.options.parameter_types import ParameterType
from vorotool.cli.options.suggestions import words
from vorotool.jobs.pruning_choice import CRITERIA, LENGTHS, Pruning

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

FORMS = "angle=DEG, chord=D, scale=S, length=D, ratio=Q, mask or none"


class PruningType(ParameterType[Pruning]):
    """``CRITERION=THRESHOLD``, ``mask`` or ``none``."""

    name = "CRITERION=X"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Pruning:
        """Parse it, and refuse a threshold that is none."""
        if isinstance(value, Pruning):
            return value
        if value in ("mask", "none"):
            return Pruning(value)
        criterion, equals, text = value.partition("=")
        if criterion not in CRITERIA or not equals:
            self.fail(f"{value!r}: expected {FORMS}", param, ctx)
        if ctx is not None and ctx.resilient_parsing:  # a shell completes what follows, and should not wait for numpy
            return Pruning(criterion, criterion)
        length = measured(text) if criterion in LENGTHS else None
        if length is not None:
            if length.number < 0:
                self.fail(f"{value!r}: expected a length from 0", param, ctx)
            return Pruning(criterion, criterion, length)
        from vorotool.engines.pruning.pruning import check_threshold
        from vorotool.errors import UsageError

        try:
            threshold = float(text)
        except ValueError:
            self.fail(f"{value!r}: {text!r} is no number; give {FORMS}", param, ctx)
        try:
            check_threshold(criterion, threshold)
        except UsageError as error:
            self.fail(error.typed, param, ctx)
        return Pruning(criterion, criterion, threshold)

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem[str]]:
        """Offer criteria, to which a number is added."""
        return words((*(f"{name}=" for name in CRITERIA), "mask", "none"))(ctx, param, incomplete)


class Place(ParameterType[tuple[float, float]]):
    """``X,Y`` in the units of the input."""

    name = "X,Y"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, float]:
        """Parse two finite numbers."""
        if isinstance(value, tuple):
            return value
        try:
            x, y = (float(part) for part in value.split(","))
        except ValueError:
            self.fail(f"{value!r}: expected two numbers X,Y, such as 12.5,8", param, ctx)
        if not (isfinite(x) and isfinite(y)):
            self.fail(f"{value!r}: expected finite numbers", param, ctx)
        return (x, y)
