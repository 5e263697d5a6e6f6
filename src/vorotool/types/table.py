"""Tables: named columns of one length, one row an object."""

from __future__ import annotations

from collections.abc import Callable, ItemsView, Iterator, Mapping, ValuesView
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import objects
from vorotool.numeric.checks import is_equal
from vorotool.products.formats import resolved
from vorotool.types.values import Tabular, counted


@frozen(eq=False)
class Lookup:
    """A column that shows the values of other objects: row i holds ``values[index[i]]``."""

    # (m,) int64 or float64 array, or list: contiguous; finite. Of a list, None shows that there is no value
    values: NDArray[Any] | list[Any]
    index: NDArray[np.int32]  # (n,) int32 array: 0-based; it may be a column of a matrix

    def __len__(self) -> int:
        return len(self.index)

    def __getitem__(self, rows: slice) -> NDArray[Any]:
        values = self.values if isinstance(self.values, np.ndarray) else objects(self.values)
        return values.take(self.index[rows])


@frozen(eq=False)
class Computed:
    """A column of numbers that are computed when its rows are asked for."""

    # `function(rows)` gives the float64 values of a slice; called in several threads at once. What is not finite is
    # written empty in text, and as it is in NPZ
    function: Callable[[slice], NDArray[np.float64]]
    size: int  # number of rows

    def __len__(self) -> int:
        return self.size

    def __getitem__(self, rows: slice) -> NDArray[np.float64]:
        return self.function(rows)


class Table(dict[str, Any], Tabular):
    """Columns by name, in order; a masked array or None marks fields that do not exist.

    It is a dictionary, so that ``pandas.DataFrame(table)`` has its columns; integers of which some do not exist are
    floats there, and stay integers in ``table.to_pandas()``. Columns are not exchanged, added or removed.

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
    >>> table
    Table: 2 rows of label, area
    """

    def __init__(self, columns: Mapping[str, Any]) -> None:
        stored = columns.stored() if isinstance(columns, Table) else dict(columns)
        lengths: dict[str, int] = {}
        for name, column in stored.items():
            try:
                lengths[name] = len(column)
            except TypeError:
                text = f"column {name} is not a list or array of values: give one value per row"
                raise InputError(text) from None
        if len(set(lengths.values())) > 1:
            raise InputError(f"columns must have one length, but have {lengths}")
        super().__init__(stored)
        self.rows = next(iter(lengths.values()), 0)

    def __getitem__(self, name: str) -> Any:
        column = super().__getitem__(name)
        return column[:] if isinstance(column, Lookup | Computed) else column

    def __iter__(self) -> Iterator[str]:  # that there is one of its own has dict(table) ask for the columns, too
        return super().__iter__()

    def get(self, name: str, default: Any = None) -> Any:
        """Return a column, or a default if there is none."""
        return self[name] if name in self.keys() else default

    def values(self) -> ValuesView[Any]:  # type: ignore[override]  # dict's shows what is stored
        """Return the columns."""
        return ValuesView(self)

    def items(self) -> ItemsView[str, Any]:  # type: ignore[override]
        """Return the columns with their names."""
        return ItemsView(self)

    def copy(self) -> Table:
        """Return a table of the same columns."""
        return Table(self)

    def __or__(self, other: Mapping[str, Any]) -> dict[str, Any]:  # type: ignore[override]  # dict's has what is stored
        return {**self, **other}

    def __ror__(self, other: Mapping[str, Any]) -> dict[str, Any]:  # type: ignore[override]
        return {**other, **self}

    def _refused(self, *_: Any, **__: Any) -> Any:
        """Refuse a change."""
        raise TypeError("a Table is read-only: create another one, as Table({**table, name: column})")

    __setitem__ = __delitem__ = __ior__ = clear = pop = popitem = setdefault = update = _refused

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Table):
            return False  # an index of pandas would be asked next, and compare all of its entries
        return self is other or (list(self) == list(other) and is_equal(dict(self), dict(other)))

    def __ne__(self, other: object) -> bool:  # dict has one of its own
        return not self == other

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> Any:
        return Table, (self.stored(),)

    def _rows(self, _what: str | None = None) -> Any:
        return resolved("types.features:Rows")(self)

    def __repr__(self) -> str:
        return f"Table: {counted(self.rows, 'row')} of {', '.join(self) or 'no columns'}"

    def _repr_html_(self) -> str:
        """The first rows, as notebooks show them."""
        return resolved("render.showing:table_html")(self)

    def stored(self) -> dict[str, Any]:
        """Columns as they were stored, before any are looked up or computed."""
        return dict(super().items())

    def with_properties(self, properties: Mapping[str, Any]) -> Table:
        """Add the input's own columns; on a clash of names ours take the prefix ``voro_``."""
        columns = {(f"voro_{name}" if name in properties else name): c for name, c in self.stored().items()}
        own = {name: c if isinstance(c, Lookup) else np.asarray(c, dtype=object) for name, c in properties.items()}
        return Table({**columns, **own})
