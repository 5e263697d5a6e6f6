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
    """The side of a pixel, and where pixels are on a map.

    Parameters
    ----------
    factor : Fraction
        The side.
    unit : str, optional
        Its unit.
    is_auto : bool
        It is yet to be read from the file.
    origin : (float, float), optional
        Where on the map the centre of the first pixel is.
    y_up : bool
        Rows go down on the map: what is made of the image is made with y upwards.
    crs : object, optional
        The coordinate reference system of the map.
    """

    factor: Fraction
    unit: str | None
    is_auto: bool = False
    origin: tuple[float, float] | None = None
    y_up: bool = False
    crs: Any = None


AUTO = PixelSize(Fraction(1), None, is_auto=True)
"""What the file says."""


def shows_units(targets: Sequence[Target]) -> bool:
    """Tell whether an output has lengths: images and pictures have none, but for the plot of curves."""
    return any(not FORMATS[target.fmt].is_image or target.what == "curves" for target in targets)


def check_units(size: PixelSize | None, targets: Sequence[Target]) -> None:
    """Refuse a size of pixels that nothing shows.

    Raises
    ------
    UsageError
        If all outputs are images or pictures; only the plot of curves has units.
    """
    if size is not None and not shows_units(targets):
        raise UsageError("--pixel-size is for tables and vectors: use --what table, or leave it out")


def in_units(size: PixelSize | None, value: Value) -> Value:
    """Give a result in the units of the pixel size, if there is one."""
    if size is None:
        return value
    from vorotool.geometry.any.scaling import scaled

    with _within_doubles():
        result: Value = scaled(value, size.factor, size.origin)
    return result


def table_in_units(
    size: PixelSize | None, table: Table, *, properties: Collection[str] = (), has_rows: bool = False
) -> Table:
    """Give a table in the units of the pixel size, if there is one; the input's own columns stay as they are.

    Parameters
    ----------
    size : PixelSize, optional
        The unit, and the map.
    table : Table
        In pixels.
    properties : collection of str
        The input's own columns.
    has_rows : bool
        Its y counts rows downwards, whatever the map.
    """
    if size is None:
        return table
    from vorotool.geometry.any.scaling import scaled_table

    with _within_doubles():
        y_up = has_rows and size.y_up
        return scaled_table(table, size.factor, properties=properties, origin=size.origin, y_up=y_up)


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
    if size is None or size.is_auto:
        return {}
    found = {"pixel_size": float(size.factor), "unit": size.unit}
    if size.crs is None:
        return found
    from vorotool.geometry.crs import crs_name

    return {**found, "crs": crs_name(size.crs)}
