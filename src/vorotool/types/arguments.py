"""Values of the library as arguments: what is none is refused by name, with what makes one."""

from __future__ import annotations

from typing import Any, ClassVar, Protocol

from vorotool.errors import InputError
from vorotool.numeric.descriptions import described


class Made(Protocol):
    """A type of the library."""

    maker: ClassVar[str]
    """The function that makes a value of it."""


def check_value(value: Any, name: str, *types: type[Made]) -> None:
    """Refuse what is not of a type of the library."""
    if isinstance(value, types):
        return
    expected = " or ".join(f"{_article(each.__name__)} of vorotool.{each.maker}" for each in types)
    raise InputError(f"invalid {name}: expected {expected}, but got {described(value)}")


def _article(name: str) -> str:
    return f"{'an' if name[0] in 'AO' else 'a'} {name}"
