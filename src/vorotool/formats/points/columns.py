"""Which columns of a table are the coordinates of its points, and which is the label."""

from __future__ import annotations

import re
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.tables import coordinate_columns, plain_name
from vorotool.errors import InputError, UsageError, option
from vorotool.formats.parsing.reader_options import ReadOptions, shortened

COLUMNS, _X_Y = option("--columns"), option("--columns X,Y", 'columns="X,Y"')
_BEGINNINGS = (("x", "y"), ("longitude", "latitude"), ("lon", "lat"), ("lng", "lat"), ("east", "north"), ("col", "row"))
"""Of names that may be a pair of coordinates, such as x0 and y0."""

_NUMBER = r"(?i)[+-]?(\d++(?:\.\d*+)?|\.\d++)(e[+-]?\d+)?|[+-]?(nan|inf|infinity)"
DECIMAL_COMMA = r"(?i)[+-]?\d*+,\d++(e[+-]?\d+)?"
_X_Y_Z = option("--columns X,Y,z=Z", 'columns="X,Y,z=Z"')
_MOST_LISTED = 12


class Chosen(NamedTuple):
    """Which columns are what, from 0."""

    used: list[int]  # those of x, y, z if there is one, and of the label if there is one
    label: int | None = None
    is_named: bool = False  # by the user: then the label is no other column

    @property
    def coordinates(self) -> list[int]:
        """Those of x, y and z."""
        return self.used if self.label is None else self.used[:-1]


class Wanted(NamedTuple):
    """Columns as the user names them: x, y and perhaps the label, and z."""

    plane: list[str]
    z: str | None = None

    @property
    def all(self) -> list[str]:
        """With that of z last."""
        return self.plane if self.z is None else [*self.plane, self.z]


def parse_columns(columns: str, *, axes: int = 2) -> Wanted:
    """Take the names apart; that of z has ``z=`` before it."""
    parts = [part.strip() for part in columns.split(",")]
    of_z = [part for part in parts if axes == 3 and part.lower().startswith("z=")]
    wanted = Wanted([part for part in parts if part not in of_z], of_z[0][2:].strip() if of_z else None)
    is_zero = [_is_number(part) and not part.strip("0") for part in wanted.all]
    is_unclear = not all(wanted.all) or any(is_zero) or len(set(wanted.all)) < len(wanted.all)
    if len(wanted.plane) not in (2, 3) or len(of_z) > 1 or is_unclear:
        form = "two or three different columns as X,Y or X,Y,LABEL"
        raise UsageError(
            f"{COLUMNS} is {shortened(columns)}: name {'X,Y,z=Z or X,Y,z=Z,LABEL' if axes == 3 else form}, by name or "
            "by number from 1"
        )
    return wanted


def choose(name: str, fields: list[str], wanted: Wanted | None, options: ReadOptions) -> tuple[bool, Chosen]:
    """Tell whether the first record is a header, and which columns are x, y and, if one is, the label."""
    if wanted is not None:
        return _look_up(name, fields, wanted, options)
    chosen = coordinate_columns(fields, axes=options.axes)
    if chosen is not None:
        used = [fields[column] for column in chosen]
        plain = ["x", "y", "z"][: options.axes]
        meanings = [*plain, "label"][: len(chosen)]
        if [plain_name(each) for each in used] != meanings:  # plain x, y need no word
            options.note(f"{name}: columns {', '.join(used)} are read as {', '.join(meanings)}")
        label = chosen[options.axes] if len(chosen) > options.axes else None
        return True, Chosen(chosen, label)
    header = not any(_looks_numeric(field) for field in fields) and any(fields)
    if not header and len(fields) == options.axes:  # without names they are x, y, in space x, y, z
        return False, Chosen(list(range(options.axes)))
    raise _no_z(name, fields) if options.axes == 3 else _unknown_columns(name, fields, header)


def chosen_columns(name: str, fields: list[str], options: ReadOptions) -> Chosen:
    """Choose the columns of a table that are x, y and, if one is, the label: as in delimited text."""
    wanted = None if options.columns is None else parse_columns(options.columns, axes=options.axes)
    return choose(name, fields, wanted, options)[1]


def note_no_label(name: str, options: ReadOptions) -> None:
    """Say that a column that is called label holds something else."""
    options.note(f"{name}: the column label holds other values than integers from 1: points are numbered from 1")


def _look_up(name: str, fields: list[str], wanted: Wanted, options: ReadOptions) -> tuple[bool, Chosen]:
    """Find the columns that the user named; a name makes the first record a header."""
    plane = [_find_column(name, fields, column) for column in wanted.plane]
    z = None
    if options.axes == 3:
        names = [plain_name(field) for field in fields]
        if wanted.z is None and names.count("z") != 1:
            raise _no_z(name, fields)
        z = names.index("z") if wanted.z is None else _find_column(name, fields, wanted.z)
    used = [*plane[:2], *([] if z is None else [z]), *plane[2:]]
    chosen = Chosen(used, plane[2] if len(plane) > 2 else None, is_named=True)
    if len(set(chosen.used)) < len(chosen.used):
        shown = _cut(",".join(wanted.all))
        raise InputError(f"{name}: {COLUMNS} {shown} names one column twice; {_listing(fields)}")
    named = not all(map(_is_number, wanted.all)) or (options.axes == 3 and wanted.z is None)
    values = [fields[i] for i in chosen.used]
    return named or (any(values) and not any(_looks_numeric(value) for value in values)), chosen


def _no_z(name: str, fields: list[str]) -> InputError:
    return InputError(f"{name}: no columns recognized as x, y and z; name them with {_X_Y_Z} ({_listing(fields)})")


def _is_number(column: str) -> bool:
    """Whether a column is named by its number; digits of other scripts may be a name."""
    return column.isascii() and column.isdecimal()


def _find_column(name: str, fields: list[str], wanted: str) -> int:
    if _is_number(wanted):
        digits = wanted.lstrip("0")
        if len(digits) > len(str(len(fields))) or int(digits) > len(fields):
            raise InputError(
                f"{name}: {COLUMNS} names column {_cut(wanted)}, but there are {len(fields)}; {_listing(fields)}"
            )
        return int(digits) - 1
    for names, key in ((fields, wanted), ([plain_name(field) for field in fields], plain_name(wanted))):
        if names.count(key) == 1:
            return names.index(key)
        if names.count(key) > 1:
            raise InputError(f"{name}: several columns are called {shortened(wanted)}; give {COLUMNS} by number")
    raise InputError(f"{name}: there is no column {shortened(wanted)}; {_listing(fields)}; correct {COLUMNS}")


def _unknown_columns(name: str, fields: list[str], header: bool) -> InputError:
    if len(fields) == 1:
        return InputError(
            f"{name}: the first line has one column, {fields[0][:40]!r}; give x and y, separated by "
            "a comma, a semicolon, a tab or blanks"
        )
    what = "no coordinate columns recognized in the header" if header else f"{len(fields)} columns without a header"
    example = _example(fields) if header else _numeric_example(fields)
    if example is None:
        return InputError(
            f"{name}: {what}; give the points that the table was computed from, or name the columns of x and y with "
            f"{_X_Y} ({_listing(fields)})"
        )
    from shlex import quote

    chosen = option(f"--columns {quote(example)}", f'columns="{example}"')
    return InputError(f"{name}: {what}; name the columns of x and y, for example {chosen} ({_listing(fields)})")


def _example(fields: list[str]) -> str | None:
    """Two columns that may be x and y, as their names begin alike and go on the same; None where no two do."""
    names = [plain_name(field) for field in fields]
    for first, second in _BEGINNINGS:
        for key in dict.fromkeys(names):
            other = second + key.removeprefix(first)
            if key.startswith(first) and other in names:
                x, y = names.index(key), names.index(other)
                is_clear = names.count(key) == names.count(other) == 1 and "," not in fields[x] + fields[y]
                return f"{fields[x]},{fields[y]}" if is_clear else f"{x + 1},{y + 1}"
    return None


def _numeric_example(fields: list[str]) -> str | None:
    """The numbers of the first two columns that hold numbers; None where no two do."""
    numeric = [str(i) for i, field in enumerate(fields, 1) if _looks_numeric(field)]
    return ",".join(numeric[:2]) if len(numeric) > 1 else None


def _listing(fields: list[str]) -> str:
    shown = ", ".join(f"{i} = {field[:24] or 'empty'}" for i, field in enumerate(fields[:_MOST_LISTED], 1))
    more = f", … {len(fields)} in all" if len(fields) > _MOST_LISTED else ""
    return f"its columns are {shown}{more}"


def _cut(text: str) -> str:
    return text if len(text) <= 40 else f"{text[:39]}…"


def _looks_numeric(text: str) -> bool:
    return bool(re.fullmatch(_NUMBER, text) or re.fullmatch(DECIMAL_COMMA, text))


# ---- points as readers find them -----------------------------------------------------------------
class PointRows(NamedTuple):
    """A list of points."""

    coordinates: NDArray[np.float64]  # (n, 2) or (n, 3) float64 array: x, y, and z where it is asked for
    labels: NDArray[np.int64] | None  # (n,) int64 array: the input's own
    properties: dict[str, Any]  # further columns
    placed: dict[str, Any]  # direction of y and coordinate reference system, as `PointSet` takes them
