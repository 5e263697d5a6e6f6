"""Values of the library as arguments: what is none is refused by name, with what makes one."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from vorotool.errors import InputError
from vorotool.numeric.checks import described
from vorotool.products.registry import is_of


def check_value(value: Any, name: str, *types: str) -> None:
    """Refuse what is not of a public type."""
    if is_of(value, *types):
        return
    makers = {each: getattr(import_module("vorotool"), each).maker for each in types}
    expected = " or ".join(
        f"{'an' if each[0] in 'AO' else 'a'} {each} of vorotool.{maker}" for each, maker in makers.items()
    )
    raise InputError(f"invalid {name}: expected {expected}, but got {described(value)}")
