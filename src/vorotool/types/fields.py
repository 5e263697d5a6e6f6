"""Fields of values, each declared once: its shape, its type, and whether it is a length, a position, an index.

A declaration is what a field is assigned in the body of its class. From it follow the checks of what is given, arrays
that nobody changes, and what becomes of the field in another unit of length.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, field, fields, replace
from enum import Enum
from functools import partial
from typing import Any, ClassVar, Literal, NamedTuple, TypeVar, dataclass_transform

import numpy as np
from numpy.typing import DTypeLike, NDArray

from vorotool.errors import InputError
from vorotool.frozen import frozen, unchecked
from vorotool.numeric.numbers import shown_number

_KEY = "declared"
T = TypeVar("T")
Axis = int | str
"""Length of an axis: a number, or a name that stands for one number in all fields of a value."""


class Meaning(Enum):
    """What the numbers of a field are."""

    LENGTH = "length"
    AREA = "area"
    POSITION = "position"
    STEPS = "steps"
    NUMBER = "number"
    AXIS = "axis"
    VALUE = "value"


class Declared(NamedTuple):
    """What a field holds."""

    meaning: Meaning
    shape: tuple[Axis, ...] = ()  # of an array; () for a single number, or a value
    dtype: DTypeLike | None = None
    along: int = 0  # of steps of a grid: the axis
    rows_of: Axis | None = None  # of starts of rows: how many items the rows have together
    least: int = 0  # items of each row
    is_optional: bool = False

    def settle(self, given: Any, name: str, sizes: dict[Axis, int]) -> Any:
        """Check a field and return it as it is kept; lengths that its axes name are noted in `sizes`."""
        if given is None and self.is_optional:
            return None
        if self.shape and self.dtype is not None:
            array: NDArray[Any] = np.ascontiguousarray(given, dtype=self.dtype)
            if self.rows_of is not None:
                self._check_starts(array, name, sizes)
            else:
                if array.size == 0 and all(isinstance(width, int) for width in self.shape[1:]):
                    array = array.reshape((0, *self.shape[1:]))  # type: ignore[arg-type]
                self._measure(self.shape, array.shape, name, sizes)
            if array.flags.writeable:
                array = array.view()  # the caller's own array stays as it is
                array.flags.writeable = False
            return array
        if self.meaning is Meaning.AXIS:
            return given if isinstance(given, str) and given in AXES else checked_y_axis(given, name)
        if self.shape:
            self._measure(self.shape, (len(given),), name, sizes)
        return given

    def _measure(self, shape: tuple[Axis, ...], found: tuple[int, ...], name: str, sizes: dict[Axis, int]) -> None:
        """Compare a shape with the declared one; the first field that has a named axis says how long it is."""
        fits = len(shape) == len(found)
        for axis, size in zip(shape, found, strict=False):
            fits = fits and size == (axis if axis.__class__ is int else sizes.get(axis, size))
        if not fits:
            wanted = tuple(axis if isinstance(axis, int) else sizes.get(axis, axis) for axis in shape)
            raise InputError(f"{name} must have shape {_text(wanted)}, but has shape {_text(found)}")
        sizes.update(zip(shape, found, strict=True))

    def _check_starts(self, starts: NDArray[Any], name: str, sizes: dict[Axis, int]) -> None:
        """Check starts of rows: 0 first, the number of items last."""
        (rows,) = self.shape
        if starts.ndim != 1 or not len(starts):
            raise InputError(f"{name} must have one dimension and a first entry, but has shape {_text(starts.shape)}")
        self._measure((rows,), (len(starts) - 1,), name, sizes)
        last = self.rows_of if isinstance(self.rows_of, int) else sizes.setdefault(str(self.rows_of), int(starts[-1]))
        if starts[0] != 0 or starts[-1] != last or (np.diff(starts) < self.least).any():
            empty = ", without empty rows" if self.least else ""
            raise InputError(f"{name} must increase from 0 to {last}{empty}")


def _text(shape: tuple[Axis, ...]) -> str:
    return f"({', '.join(map(str, shape))}{',' if len(shape) == 1 else ''})"


def _declare(
    meaning: Meaning,
    dtype: DTypeLike | None,
    *shape: Axis,
    default: Any = MISSING,
    kw_only: bool = False,
    compare: bool = True,
    **more: Any,
) -> Any:
    metadata = {_KEY: Declared(meaning, shape, dtype, is_optional=default is None, **more)}
    return field(default=default, metadata=metadata, kw_only=kw_only, compare=compare)


position = partial(_declare, Meaning.POSITION, np.float64)
"""Declare coordinates: an array whose last axis is x, y; without a shape a box, or a tuple x, y, width, height."""
input_box = partial(_declare, Meaning.POSITION, None, default=None, compare=False)
"""Declare the box of the image or the page that a value comes from, which `==` does not look at; or None."""
steps = partial(_declare, Meaning.STEPS, np.int64)
"""Declare places on a grid `along` an axis, 0 for x, as whole numbers of its steps."""
length = partial(_declare, Meaning.LENGTH, np.float64)
"""Declare lengths: an array, or one number without a shape."""
area = partial(_declare, Meaning.AREA, np.float64)
"""Declare areas."""
numbers = partial(_declare, Meaning.NUMBER)
"""Declare an array of a type of numbers that no unit changes: ratios, labels, counts, flags, indices."""
index = partial(_declare, Meaning.NUMBER, np.int32)
"""Declare an int32 array of indices from 0."""
nested = partial(_declare, Meaning.VALUE, None)
"""Declare another value that has lengths or positions, and its length where other fields have to be as long."""
y_axis = partial(_declare, Meaning.AXIS, None, compare=False)
"""Declare which way y goes; values that differ in nothing else are equal."""
filled_in = partial(field, default=None)
"""Declare a value that follows from the others where it is not given."""


def starts(rows: Axis, items: Axis, *, least: int = 0) -> Any:
    """Declare an int64 array of where each row begins among the items of all, and at its end their number."""
    return _declare(Meaning.NUMBER, np.int64, rows, rows_of=items, least=least)


def with_y_axis(value: T, axis: YAxis) -> T:
    """Return a value whose y, and that of all values in it, goes another way."""
    changes: dict[str, Any] = {}
    for each in fields(value):  # type: ignore[arg-type]
        held = getattr(value, each.name)
        own: Declared | None = each.metadata.get(_KEY)
        if own is not None and own.meaning is Meaning.AXIS:
            changes[each.name] = axis
        elif isinstance(held, Record):
            changes[each.name] = with_y_axis(held, axis)
        elif isinstance(held, tuple) and held and all(isinstance(item, Record) for item in held):
            changes[each.name] = tuple(with_y_axis(item, axis) for item in held)
    if not changes:
        return value
    made = replace(value, **changes)  # type: ignore[type-var]
    if "_as_given" in value.__dict__:  # the polygons that these were before an engine moved them
        made.__dict__["_as_given"] = with_y_axis(value.__dict__["_as_given"], axis)
    return made


def fitting(kind: type[T], **named: Any) -> T:
    """Make a value of what an engine has made: fields are settled as declared, but not compared with each other."""
    return unchecked(kind, **_settled(kind, named))


def with_fitting(value: T, **changes: Any) -> T:
    """Replace fields by what an engine has made, see `fitting`."""
    held = {each.name: getattr(value, each.name) for each in fields(value)}  # type: ignore[arg-type]
    return unchecked(type(value), **(held | _settled(type(value), changes)))


def _settled(kind: type[Any], named: dict[str, Any]) -> dict[str, Any]:
    known: dict[str, Declared] = kind._declared
    return {name: known[name].settle(given, name, {}) if name in known else given for name, given in named.items()}


@dataclass_transform(
    eq_default=False,
    frozen_default=True,
    field_specifiers=(field, position, steps, length, area, numbers, index, starts, nested, y_axis),
)
def record(kind: type[T]) -> type[T]:
    """Make a frozen data class of one with declared fields."""
    made: Any = frozen(eq=False, repr=False)(kind)
    made._declared = {each.name: each.metadata[_KEY] for each in fields(made) if _KEY in each.metadata}
    return made


class Record:
    """A frozen data class whose declared fields are checked when it is made."""

    _declared: ClassVar[dict[str, Declared]] = {}

    def __post_init__(self) -> None:
        held, sizes = self.__dict__, dict[Axis, int]()
        for name, own in self._declared.items():
            held[name] = own.settle(held[name], name, sizes)


YAxis = Literal["up", "down", "none"]
UP: YAxis = "up"
"""Maps, drawings of CAD, well-known text: whatever has a coordinate reference system, and what is written as such."""
DOWN: YAxis = "down"
"""Images and SVG, and what is made of them."""
UNSTATED: YAxis = "none"
"""Bare numbers, which are drawn downwards, as in the paper."""

AXES = (UP, DOWN, UNSTATED)
MEMBER = "y_axis"
"""The member of our JSON, GeoJSON and NPZ that says it."""


def y_axis_of(y_up: bool) -> YAxis:
    """Return the axis that a caller states by a flag."""
    return UP if y_up else DOWN


def checked_y_axis(given: Any, name: str = MEMBER) -> YAxis:
    """Return what a file or a caller says of the axis."""
    if not isinstance(given, str) or given not in AXES:
        raise InputError(f"{name} is {shown_number(given)}: write {', '.join(map(repr, AXES[:2]))} or {AXES[2]!r}")
    return given


def y_axis_member(document: Mapping[str, Any], usual: YAxis) -> YAxis:
    """Return what a document says of the axis, else the usual one of its form."""
    return checked_y_axis(document[MEMBER]) if MEMBER in document else usual


def is_up(value: Any) -> bool:
    """Return whether y of a value goes upwards."""
    return bool(getattr(value, "y_axis", UNSTATED) == UP)
