"""Tables and vectors in units of the world."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction
from types import SimpleNamespace
from typing import Any, NamedTuple, TypeVar

from vorotool.errors import UsageError
from vorotool.jobs.targets import Target
from vorotool.products.formats import FORMATS

Value = TypeVar("Value")


class PixelSize(NamedTuple):
    """The side of a pixel: a number, and the name of its unit."""

    factor: Fraction
    unit: str | None


def check_units(o: SimpleNamespace, targets: Sequence[Target]) -> None:
    """Refuse a size of pixels that nothing shows.

    Raises
    ------
    UsageError
        If all outputs are images or pictures; only the plot of curves has units.
    """
    if getattr(o, "pixel_size", None) is None:
        return
    if all(FORMATS[target.fmt].is_image and target.what != "curves" for target in targets):
        raise UsageError("--pixel-size is for tables and vectors: use --what table, or leave it out")


def in_units(o: SimpleNamespace, value: Value) -> Value:
    """Give a result in the units of the pixel size, if there is one."""
    if o.pixel_size is None:
        return value
    from vorotool.geometry.any.scaling import scaled

    with _within_doubles():
        result: Value = scaled(value, o.pixel_size.factor)
    return result


def table_in_units(o: SimpleNamespace, table: Any, *, properties: Collection[str] = ()) -> Any:
    """Give a table in the units of the pixel size, if there is one; the input's own columns stay as they are."""
    if o.pixel_size is None:
        return table
    from vorotool.geometry.any.scaling import scaled_table

    with _within_doubles():
        return scaled_table(table, o.pixel_size.factor, properties=properties)


@contextmanager
def _within_doubles() -> Iterator[None]:
    """Refuse a size that makes numbers infinite."""
    import numpy as np

    try:
        with np.errstate(over="raise"):
            yield
    except FloatingPointError:
        raise UsageError("--pixel-size makes coordinates or areas too large for numbers: use a smaller one") from None


def length_in_units(o: SimpleNamespace, length: Any) -> Any:
    """Give a number of pixels, or None, in the units of the pixel size, if there is one."""
    if o.pixel_size is None or length is None:
        return length
    return length * (o.pixel_size.factor if isinstance(length, Fraction) else float(o.pixel_size.factor))


def unit_stats(o: SimpleNamespace) -> dict[str, Any]:
    """What statistics say of the size."""
    size: PixelSize | None = getattr(o, "pixel_size", None)
    return {} if size is None else {"pixel_size": float(size.factor), "unit": size.unit}
