"""What options were given: values by name, which nobody changes.

This is what a frozen data class would be, but that one compiles methods for each of a hundred fields, at the start of
every run.
"""

from __future__ import annotations

from typing import Any, NoReturn, TypeVar, dataclass_transform


@dataclass_transform(kw_only_default=True, frozen_default=True)
class Options:
    """Options of one kind: what its class, and those before it, annotate; a value there is the default."""

    def __init__(self, **given: Any) -> None:
        names = names_of(type(self))
        unknown = given.keys() - names
        missing = [name for name in names if name not in given and not hasattr(type(self), name)]
        if unknown or missing:
            raise TypeError(f"{type(self).__name__}: unknown {sorted(unknown)}, missing {missing}")
        self.__dict__.update({name: given[name] if name in given else getattr(type(self), name) for name in names})

    def __setattr__(self, name: str, value: Any) -> NoReturn:
        raise AttributeError(f"options are not changed: {name}")

    __delattr__ = __setattr__  # type: ignore[assignment]


T = TypeVar("T", bound=Options)


def names_of(kind: type[Options]) -> list[str]:
    """Return the names of all options of a kind."""
    classes = [vars(each).get("__annotations__", {}) for each in reversed(kind.__mro__)]
    return list(dict.fromkeys(name for annotated in classes for name in annotated))


def changed(o: T, **values: Any) -> T:
    """Return options with some of them changed."""
    return type(o)(**{**vars(o), **values})
