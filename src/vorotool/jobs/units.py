"""Tables and vectors in units of the world."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from vorotool.errors import UsageError
from vorotool.products.formats import FORMATS

if TYPE_CHECKING:
    from vorotool.geometry.table import Table
    from vorotool.jobs.targets import Target

Value = TypeVar("Value")


class PixelSize(NamedTuple):
    """The side of a pixel: a number, and the name of its unit."""

    factor: Fraction
    unit: str | None


def check_units(size: PixelSize | None, targets: Sequence[Target]) -> None:
    """Refuse a size of pixels that nothing shows.

    Raises
    ------
    UsageError
        If all outputs are images or pictures; only the plot of curves has units.
    """
    if size is not None and all(FORMATS[target.fmt].is_image and target.what != "curves" for target in targets):
        raise UsageError("--pixel-size is for tables and vectors: use --what table, or leave it out")


def in_units(size: PixelSize | None, value: Value) -> Value:
    """Give a result in the units of the pixel size, if there is one."""
    if size is None:
        return value
    from vorotool.geometry.any.scaling import scaled

    with _within_doubles():
        result: Value = scaled(value, size.factor, unit=size.unit)
    return result


def table_in_units(size: PixelSize | None, table: Table, *, properties: Collection[str] = ()) -> Table:
    """Give a table in the units of the pixel size, if there is one; the input's own columns stay as they are."""
    if size is None:
        return table
    from vorotool.geometry.any.scaling import scaled_table

    with _within_doubles():
        return scaled_table(table, size.factor, properties=properties)


@contextmanager
def _within_doubles() -> Iterator[None]:
    """Refuse a size that makes numbers infinite."""
    import numpy as np

    try:
        with np.errstate(over="raise"):
            yield
    except FloatingPointError:
        raise UsageError("--pixel-size makes coordinates or areas too large for numbers: use a smaller one") from None


def length_in_units(size: PixelSize | None, length: Any) -> Any:
    """Give a number of pixels, or None, in the units of the pixel size, if there is one."""
    if size is None or length is None:
        return length
    return length * (size.factor if isinstance(length, Fraction) else float(size.factor))


def unit_stats(size: PixelSize | None) -> dict[str, Any]:
    """What statistics say of the size."""
    return {} if size is None else {"pixel_size": float(size.factor), "unit": size.unit}
