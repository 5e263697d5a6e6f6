"""Files beside the input, in its coordinates: what states another unit is converted, what states none is as it is."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from vorotool.errors import InputError
from vorotool.jobs.input_lengths import side_of_pixel, unit_of_grid

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.jobs.options import Options
    from vorotool.jobs.run_log import Run
    from vorotool.numeric.input_unit import InputUnit
    from vorotool.types.pixel_grid import PixelGrid
    from vorotool.types.polygons.polygon_set import PolygonSet


def unit_of_vectors(o: Options, value: Any) -> InputUnit | None:
    """Return the unit of the coordinates of an input: of ``--pixel-size``, else as it states."""
    from vorotool.numeric.input_unit import InputUnit, unit_of

    size = o.pixel_size
    if size is not None and size.unit is not None:
        return InputUnit(size.unit, size.factor)
    return unit_of(value)


def coordinates_of(o: Options, value: Any) -> InputUnit | None:
    """Return the same, but where only a coordinate reference system states it."""
    has_system = getattr(value, "polygons", value).crs is not None
    states = not has_system or (o.pixel_size is not None and o.pixel_size.unit is not None)
    return unit_of_vectors(o, value) if states else None


def side_of_backdrop(run: Run, o: Options, grid: PixelGrid | None) -> float:
    """Return the side of a pixel of ``--overlay`` in the coordinates of points, lines and polygons drawn over it."""
    from vorotool.numeric.length_units import ratio

    unit = run.coordinates
    if unit is None:
        return 1.0
    pixel = side_of_pixel(grid)
    found = None if pixel is None or (grid is not None and grid.transform is not None) else ratio(pixel.unit, unit.unit)
    if pixel is None or found is None:
        run.note(f"{o.overlay} states no size of its pixels: they are taken to be the coordinates")
        return 1.0
    return float(pixel.side * found / unit.side)


def unit_of_image(o: Options, grid: PixelGrid | None) -> InputUnit | None:
    """Return what 1 is in the coordinates that files beside an image are in: those of its map, else pixels."""
    from vorotool.numeric.input_unit import InputUnit

    size = o.pixel_size
    is_of_map = size is not None and (size.origin is not None or size.sides is not None)
    if size is not None and size.unit is not None:
        return InputUnit(size.unit, Fraction(1) if is_of_map else size.factor)
    if is_of_map:
        return None if grid is None else unit_of_grid(grid)
    return side_of_pixel(grid)


def in_first_unit(
    run: Run,
    o: Options,
    second: tuple[str, PolygonSet],
    first: tuple[str, InputUnit | None],
    *,
    pixels: bool = False,
    crs: Any = None,
) -> PolygonSet:
    """Return polygons in the coordinates of the input, which may have a system, by the units that both state."""
    (path, value), (source, unit) = second, first
    if value.crs is not None:
        return value
    from vorotool.numeric.input_unit import unit_of
    from vorotool.numeric.length_units import ratio

    own = unit_of(value)
    if own is None:
        if pixels or (unit is not None and crs is None):  # of systems `in_one_crs` speaks
            what = "pixels" if pixels else "those"
            run.note(f"{path} states no unit: its coordinates are taken to be {what} of {source}")
        return value
    found = None if unit is None else ratio(own.unit, unit.unit)
    if unit is None or found is None:
        text = f"{path} is in {own.text}, but the unit of {source} is not known: its numbers are taken as they are"
        if o.strict:
            raise InputError(f"{text}; state it with --pixel-size, or leave out --strict")
        run.warn(text)
        return value
    factor = found * own.side / unit.side
    return value if factor == 1 else replace(value, xy=times(value.xy, factor), unit=None)


def times(xy: NDArray[np.float64], factor: Fraction) -> NDArray[np.float64]:
    """Multiply by a ratio, with one rounding where it is a whole number or one over such."""
    if factor.denominator == 1 or factor.numerator == 1:
        return xy * float(factor.numerator) / float(factor.denominator)
    return xy * float(factor)
