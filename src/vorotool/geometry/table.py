"""Tables: named columns of one length, one row an object."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError


@dataclass(frozen=True, eq=False)
class Lookup:
    """A column that shows the values of other objects: row i holds ``values[index[i]]``.

    Nothing is gathered until the rows are asked for, and a writer turns each value into text once.

    Parameters
    ----------
    values : (m,) int64 or float64 array
        Contiguous; finite.
    index : (n,) int32 array
        0-based; it may be a column of a matrix.

    Examples
    --------
    >>> Lookup(np.array([1.5, 2.5]), np.array([1, 0, 1], dtype=np.int32))[1:].tolist()
    [1.5, 2.5]
    """

    values: NDArray[Any]
    index: NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.index)

    def __getitem__(self, rows: slice) -> NDArray[Any]:
        found: NDArray[Any] = self.values.take(self.index[rows])
        return found


@dataclass(frozen=True, eq=False)
class Computed:
    """A column of numbers that are computed when its rows are asked for.

    Parameters
    ----------
    function : callable
        ``function(rows)`` gives the float64 values of a slice; called in several threads at once. What is not finite
        is written empty in text, and as it is in NPZ.
    size : int
        Number of rows.

    Examples
    --------
    >>> Computed(lambda rows: np.sqrt(np.arange(10.0)[rows]), 10)[4:5].tolist()
    [2.0]
    """

    function: Callable[[slice], NDArray[np.float64]]
    size: int

    def __len__(self) -> int:
        return self.size

    def __getitem__(self, rows: slice) -> NDArray[np.float64]:
        return self.function(rows)


class Table(Mapping[str, Any]):
    """Columns by name, in order; a masked array or None marks fields that do not exist.

    Parameters
    ----------
    columns : mapping of str to 1-D array, list, Lookup or Computed
        Columns of one length. Fields masked in a ``numpy.ma`` array, and None in a list, are written empty.

    Raises
    ------
    InputError
        If the lengths differ.

    Examples
    --------
    >>> table = Table({"label": np.array([1, 2]), "area": np.array([12, 9])})
    >>> len(table), table.rows
    (2, 2)
    """

    def __init__(self, columns: Mapping[str, Any]) -> None:
        self._columns = dict(columns)
        lengths = {name: len(column) for name, column in self._columns.items()}
        if len(set(lengths.values())) > 1:
            raise InputError(f"columns must have one length, but have {lengths}")
        self.rows = next(iter(lengths.values()), 0)

    def __getitem__(self, name: str) -> Any:
        column = self._columns[name]
        return column[:] if isinstance(column, Lookup | Computed) else column

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def stored(self) -> dict[str, Any]:
        """Columns as they were given: what is looked up or computed is not so yet."""
        return dict(self._columns)

    def with_properties(self, properties: Mapping[str, Any]) -> Table:
        """Add the input's own columns; on a clash of names ours take the prefix ``voro_``."""
        columns = {(f"voro_{name}" if name in properties else name): c for name, c in self._columns.items()}
        return Table({**columns, **{name: np.asarray(c, dtype=object) for name, c in properties.items()}})
