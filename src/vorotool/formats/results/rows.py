"""Lists of objects in a JSON document, or in the arrays of an archive: their members are taken out as arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, option
from vorotool.formats.parsing.reader_options import shortened
from vorotool.formats.text.tables import json_text

Arrays = Mapping[str, NDArray[Any]]

PREFIXES = {
    "vertices": "vertex",
    "arcs": "arc",
    "sites": "site",
    "shapes": "shape",
    "rings": "offset_ring",
    "pieces": "piece",
}
"""How names of arrays begin, by the lists that they are of."""

_AS_JSON = option("-f json", 'fmt="json"')


def is_number(value: Any) -> bool:
    """Return whether a value of JSON is a number."""
    return type(value) in (int, float)


class JsonRows:
    """Lists of objects in a document."""

    def __init__(self, name: str, document: Mapping[str, Any]) -> None:
        self.name, self.document = name, document
        self._lists: dict[str, list[dict[str, Any]]] = {}

    def list_of(self, member: str) -> list[dict[str, Any]]:
        """Return a member of the document, which is a list of objects."""
        if member not in self._lists:
            value = self.document.get(member)
            if not isinstance(value, list):
                raise InputError(f"{self.name}: {member} are {shortened(value)}; write a list")
            for index, row in enumerate(value):
                if not isinstance(row, dict):
                    raise InputError(f"{self.name}, {member} {index}: {shortened(row)} is not an object")
            self._lists[member] = value
        return self._lists[member]

    def count(self, member: str) -> int:
        """Return the number of items of a list."""
        return len(self.list_of(member))

    def has(self, member: str, name: str) -> bool:
        """Return whether any item has a member that is not null."""
        return any(row.get(name) is not None for row in self.list_of(member))

    def values(self, member: str, name: str, is_right: Callable[[Any], bool], what: str) -> list[Any]:
        """Return the values of a member, all of which must be right."""
        values = [row.get(name) for row in self.list_of(member)]
        for at, value in enumerate(values):
            if not is_right(value):
                raise InputError(f"{self.name}, {member} {at}: {name} is {shortened(value)}; write {what}")
        return values

    def numbers(self, member: str, name: str, *, optional: bool = False) -> NDArray[np.float64]:
        """Return numbers; None becomes NaN where it is allowed."""
        values = self.values(member, name, lambda v: is_number(v) or (v is None and optional), "a number")
        return np.array([np.nan if value is None else value for value in values], dtype=np.float64)

    def indices(self, member: str, name: str, limit: int, *, optional: bool = False) -> NDArray[np.int32]:
        """Return integers from 0 to below a limit; None becomes -1 where it is allowed."""
        what = f"an integer from 0 to {limit - 1}"
        values = self.values(member, name, lambda v: _is_index(v, limit, optional=optional), what)
        return np.array([-1 if value is None else value for value in values], dtype=np.int32)

    def choices(self, member: str, name: str, names: tuple[str, ...], *, optional: bool = False) -> NDArray[np.int8]:
        """Return the number of each name in a list; None becomes -1 where it is allowed."""
        number: dict[Any, int] = {text: index for index, text in enumerate(names)} | ({None: -1} if optional else {})
        what = " or ".join(json_text(text) for text in number)
        values = self.values(member, name, lambda v: isinstance(v, str | None) and v in number, what)
        return np.array([number[value] for value in values], dtype=np.int8)

    def truths(self, member: str, name: str) -> NDArray[np.bool_]:
        """Return truth values."""
        values = self.values(member, name, lambda value: type(value) is bool, "true or false")
        return np.array(values, dtype=bool)

    def pairs(self, member: str, name: str, *, optional: bool) -> NDArray[np.float64]:
        """Return pairs of numbers; None becomes NaN where it is allowed."""

        def is_right(value: Any) -> bool:
            return (value is None and optional) or (_is_pair(value) and all(map(is_number, value)))

        values = self.values(member, name, is_right, "[number, number]")
        nothing = (np.nan, np.nan)
        return np.array([nothing if value is None else value for value in values], dtype=np.float64).reshape(-1, 2)

    def index_pairs(
        self, member: str, name: str, parts: tuple[str, str], limit: int, *, optional: bool = False
    ) -> NDArray[np.int32]:
        """Return pairs of integers; None, for one of them or both, becomes -1 where it is allowed."""

        def is_right(value: Any) -> bool:
            if value is None:
                return optional
            return _is_pair(value) and all(_is_index(each, limit, optional=optional) for each in value)

        null = ", or null" if optional else ""
        values = self.values(member, name, is_right, f"two integers from 0 to {limit - 1}{null}")
        pairs = [[-1 if each is None else each for each in value or (None, None)] for value in values]
        return np.array(pairs, dtype=np.int32).reshape(-1, 2)


def _is_pair(value: Any) -> bool:
    return type(value) is list and len(value) == 2


def _is_index(value: Any, limit: int, *, optional: bool) -> bool:
    return (type(value) is int and 0 <= value < limit) or (value is None and optional)


class ArrayRows:
    """Lists of objects as arrays, one for each member; what is no list is in a document."""

    def __init__(self, name: str, arrays: Arrays, document: Mapping[str, Any]) -> None:
        self.name, self.arrays, self.document = name, arrays, document

    def count(self, member: str) -> int:
        """Return the number of items of a list."""
        return len(self.together(f"{PREFIXES[member]}_"))

    def has(self, member: str, name: str) -> bool:
        """Return whether there are arrays of a member."""
        return any(each.startswith(f"{PREFIXES[member]}_{name}") for each in self.arrays)

    def together(self, prefix: str) -> range:
        """Return the indices of items whose arrays have names that begin so, all of one length."""
        lengths = {name: len(values) for name, values in self.arrays.items() if name.startswith(prefix)}
        if len(set(lengths.values())) > 1:
            sizes = ", ".join(f"{name} {length}" for name, length in lengths.items())
            raise InputError(
                f"{self.name}: arrays that belong together are of different lengths ({sizes}); write it again"
            )
        return range(next(iter(lengths.values()), 0))

    def array(self, name: str) -> NDArray[Any]:
        """Return an array that must be there."""
        if name not in self.arrays:
            raise InputError(f"{self.name} has no array {name}: write it again, or give the JSON ({_AS_JSON})")
        return self.arrays[name]

    def checked(self, name: str, kinds: str, is_right: Callable[[NDArray[Any]], Any], what: str) -> NDArray[Any]:
        """Return an array of some types, all of whose values are right."""
        array = self.array(name)
        if array.dtype.kind not in kinds:
            raise InputError(f"{self.name}: {name} is of type {array.dtype}; write {what}")
        wrong = np.flatnonzero(~is_right(array))
        if wrong.size:
            raise InputError(f"{self.name}: {name} {wrong[0]} is {array[wrong[0]]}; write {what}")
        return array

    def _own(self, member: str, name: str) -> str:
        self.count(member)
        return f"{PREFIXES[member]}_{name}"

    def reals(self, name: str, *, optional: bool = False) -> NDArray[np.float64]:
        """Return an array of finite numbers, or NaN where that is allowed."""
        found = self.checked(name, "iuf", lambda a: np.isfinite(a) | (optional & np.isnan(a)), "finite numbers")
        return found.astype(np.float64)

    def integers(self, name: str, low: int, high: int) -> NDArray[np.int64]:
        """Return an array of integers from one to below another."""
        what = f"integers from {low} to {high - 1}"
        return self.checked(name, "iub", lambda a: (a >= low) & (a < high), what).astype(np.int64)

    def numbers(self, member: str, name: str, *, optional: bool = False) -> NDArray[np.float64]:
        """Return numbers; NaN where that is allowed."""
        return self.reals(self._own(member, name), optional=optional)

    def indices(self, member: str, name: str, limit: int, *, optional: bool = False) -> NDArray[np.int32]:
        """Return integers from 0, or from -1, to below a limit."""
        return self.integers(self._own(member, name), -int(optional), limit).astype(np.int32)

    def choices(self, member: str, name: str, names: tuple[str, ...], *, optional: bool = False) -> NDArray[np.int8]:
        """Return the numbers of names."""
        return self.integers(self._own(member, name), -int(optional), len(names)).astype(np.int8)

    def truths(self, member: str, name: str) -> NDArray[np.bool_]:
        """Return truth values."""
        return self.integers(self._own(member, name), 0, 2).astype(np.bool_)

    def pairs(self, member: str, name: str, *, optional: bool) -> NDArray[np.float64]:
        """Return pairs of numbers: both NaN where that is allowed."""
        own = self._own(member, name)
        x, y = (self.reals(f"{own}_{axis}", optional=optional) for axis in "xy")
        half = np.flatnonzero(np.isnan(x) != np.isnan(y))
        if half.size:
            raise InputError(f"{self.name}: {own}_x or {own}_y {half[0]} is missing; write both, or NaN")
        return np.stack([x, y], axis=1)

    def index_pairs(
        self, member: str, name: str, parts: tuple[str, str], limit: int, *, optional: bool = False
    ) -> NDArray[np.int32]:
        """Return pairs of integers from 0, or from -1, to below a limit."""
        found = [self.indices(member, part, limit, optional=optional) for part in parts]
        return np.stack(found, axis=1)


Rows = JsonRows | ArrayRows
"""Lists of objects, by the names of the lists and of their members."""
