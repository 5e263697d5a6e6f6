"""How far some work is: the one way in which whatever takes long says so, and in which it is stopped."""

from __future__ import annotations

from typing import Protocol


class Report(Protocol):
    """Called now and then with the fraction done, from 0 to 1; what it raises stops the work."""

    def __call__(self, fraction: float, /) -> object:
        """Take notice."""


Progress = Report | None
"""None where nobody asks."""
