"""Parameters of which `make test` runs a few, and `make test-all` all."""

from collections.abc import Iterable
from typing import Any

import pytest


def few(values: Iterable[Any], count: int = 6) -> list[Any]:
    """Return the values for `parametrize`, those after the first `count` marked as more of the same."""
    listed = list(values)
    return listed[:count] + [_marked(value, pytest.mark.more) for value in listed[count:]]


def slow(*values: Any) -> Any:
    """Return one set of parameters, marked slow."""
    return _marked(values, pytest.mark.slow)


def _marked(value: Any, mark: pytest.MarkDecorator) -> Any:
    if isinstance(value, type(pytest.param())):
        return pytest.param(*value.values, marks=(*value.marks, mark), id=value.id)
    return pytest.param(*(value if isinstance(value, tuple) else (value,)), marks=mark)
