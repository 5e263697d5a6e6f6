"""Parameters of which `make test` runs a few, and `make test-all` all."""

from collections.abc import Iterable
from typing import Any

import pytest


def few(values: Iterable[Any], count: int = 6) -> list[Any]:
    """Return the values for `parametrize`, those after the first `count` marked slow."""
    listed = list(values)
    return listed[:count] + [slow(*value) if isinstance(value, tuple) else slow(value) for value in listed[count:]]


def slow(*values: Any) -> Any:
    """Return one set of parameters, marked slow."""
    return pytest.param(*values, marks=pytest.mark.slow)
