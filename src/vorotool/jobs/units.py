"""Units of the world, which ``--pixel-size`` scales tables and vectors to, or ``--spacing``; and what is pruned."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from functools import partial
from math import isfinite, prod
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, TypeVar

from vorotool.errors import UsageError
from vorotool.jobs.options import Measured, Options, changed
from vorotool.numeric.numbers import nearest_double
from vorotool.products.formats import FORMATS
from vorotool.products.options import flag, options_of
from vorotool.products.registry import PLOTS

if TYPE_CHECKING:
    from vorotool.jobs.targets import Target
    from vorotool.types.pixels import PixelSides
    from vorotool.types.table import Table
    from vorotool.typing import Criterion

CRITERIA: tuple[Criterion, ...] = ("angle", "chord", "scale", "length", "ratio")
"""As `vorotool.types.skeleton.skeleton` has them, which ``--help`` does not import."""
LENGTHS = ("chord", "length")
"""Criteria whose thresholds are lengths."""


class Pruning(NamedTuple):
    """What is removed: a criterion and a threshold, or nothing; ``name`` is what was asked for."""

    name: str
    criterion: str | None = None
    threshold: Any = 0.0  # a float, once lengths with a unit are in pixels

    def stats(self) -> dict[str, Any]:
        """What statistics say of it."""
        return {"name": self.name} | ({} if self.criterion is None else {self.criterion: self.threshold})


def chosen_pruning(asked: Pruning | None, *, is_mask: bool) -> Pruning:
    """What to remove: masks are pruned by default, polygons are not."""
    if asked is not None and asked.name != "mask":
        return asked
    if asked is None and not is_mask:
        return Pruning("none")
    from vorotool.engines.pruning.pruning import default_pruning_for_masks

    return Pruning("mask", *default_pruning_for_masks())


Value = TypeVar("Value")
Number = TypeVar("Number", bound="float | Fraction")


class PixelSize(NamedTuple):
    """The side of a pixel, and where pixels are on a map; or its sides, where distances are in their unit."""

    factor: Fraction  # the side; with `sides` 1, as results are in their unit already
    unit: str | None
    is_auto: bool = False  # it is yet to be read from the file
    origin: tuple[float, float] | None = None  # (float, float): where on the map the center of the first pixel is
    y_up: bool = False  # rows go down on the map: what is made of the image is made with y upwards
    crs: Any = None  # the coordinate reference system of the map
    is_spacing: bool = False  # it is that of `--spacing`
    sides: PixelSides | None = None  # of `--spacing`: what it says, or the file

    @property
    def option(self) -> str:
        """Where it is given."""
        return "--spacing" if self.is_spacing else "--pixel-size"


AUTO = PixelSize(Fraction(1), None, is_auto=True)
"""What the file says."""

AUTO_SPACING = AUTO._replace(is_spacing=True)
"""What the file says of both sides."""

_IN_STEPS = frozenset(
    f"lengths.{name}"
    for name in ["length", "length_or_zero", "tolerance_or_auto", "distances", "place", "rectangle", "rectangle_or_box"]
)
"""Types of options that are lengths or positions in the coordinates of shapes and meshes."""

_NUMBERS = {2: "two numbers, SX,SY", 3: "three numbers, SX,SY,SZ"}


def with_spacing(o: Options) -> Options:
    """Give options in which ``--spacing`` is the size of pixels."""
    if o.unit is not None:
        raise UsageError(
            "--spacing changes distances, --pixel-size only scales what is written: give only one, --spacing if "
            "pixels are not squares"
        )
    return changed(o, pixel_size=o.spacing)


def sides_of(o: Options, axes: int = 2) -> PixelSides:
    """Give the sides of a pixel, or of a voxel, in whose unit distances are: 1 without ``--spacing``."""
    from vorotool.types.pixels import pixel_sides

    sides = None if o.pixel_size is None else o.pixel_size.sides
    if sides is None:
        return pixel_sides(None, axes)
    if len(sides.units) != axes:
        what = "an image or points in a plane" if axes == 2 else "a volume"
        raise UsageError(f"--spacing has {len(sides.units)} sides, but the input is {what}: give {_NUMBERS[axes]}")
    return sides


def lengths_in_steps(o: Options) -> Options:
    """Give options for shapes whose coordinates are counted in steps of ``--spacing``: lengths are in steps as well."""
    size = o.pixel_size
    if size is None or size.sides is None:
        return o
    step = size.sides.step
    names = (name for name, row in options_of(o.command).items() if row.type in _IN_STEPS)
    others: dict[str, Any] = {name: _in_steps(getattr(o, name), step) for name in names}
    prune: Pruning | None = o.prune
    if prune is not None and prune.criterion in LENGTHS:
        others["prune"] = prune._replace(threshold=_in_steps(prune.threshold, step))
    return changed(o, **others, pixel_size=size._replace(factor=step))


def _in_steps(value: Any, step: Fraction) -> Any:
    """A number, or several, in steps: as the decimal number that it is written as."""
    from vorotool.types.pixels import as_decimal

    if value is None:
        return None
    if isinstance(value, tuple):
        return tuple(_in_steps(each, step) for each in value)
    return float(as_decimal(value) / step)


def shows_units(targets: Sequence[Target]) -> bool:
    """Tell whether an output has lengths."""
    return any(  # images have lengths in thickness and plots, and in arrays of places and radii
        target.what in ("thickness", *PLOTS)
        or (target.fmt == "npy" and target.what in ("points", "spectrum"))
        or not FORMATS[target.fmt].is_image
        for target in targets
    )


def known_length(length: Number | None) -> Number | None:
    """Give a length of an option; None while only an image that is yet to be read can say what its unit is."""
    return None if isinstance(length, Measured) else length


class Sides(NamedTuple):
    """How long 1 is in the coordinates along each axis of pixels or voxels, as arrays are ordered."""

    unit: str
    lengths: tuple[Fraction, ...]
    step: Fraction | None = None  # what lengths are counted in, where sides differ
    whose: str = "the input"

    @property
    def side(self) -> Fraction | None:
        """What a length is divided by; None where pixels are no squares, and distances are in pixels."""
        return self.lengths[0] if self.step is None and len(set(self.lengths)) == 1 else self.step


def lengths_in_pixels(o: Options, size: PixelSize | None) -> Options:
    """Give options whose lengths are numbers in the coordinates of the input, as far as a size of pixels tells."""
    if size is None or size.is_auto or size.unit is None:
        return o  # the input may tell
    lengths = (size.factor,) * 2 if size.sides is None else size.sides.lengths
    return in_coordinates(o, Sides(size.unit, lengths, None if size.sides is None else size.factor, size.option))


def in_coordinates(o: Options, sides: Sides) -> Options:
    """Give options whose lengths are numbers in coordinates of which 1 is so long."""
    lengths = _converted(o, partial(_number, sides))
    if "frame" in lengths:
        check_frame(lengths["frame"])
    return changed(o, **lengths) if lengths else o


def check_frame(frame: Sequence[float]) -> None:
    """Refuse a frame too far away to compute with."""
    from vorotool.types.box import LARGEST

    if max(map(abs, frame)) > LARGEST:
        raise UsageError(f"--frame is too large to compute with: use numbers of at most {LARGEST:g}")


def refuse_lengths(o: Options, reason: str) -> None:
    """Refuse the first length that has a unit, if there is one."""

    def refuse(option: str, length: Measured) -> NoReturn:
        raise UsageError(f"{option} {length.text} has a unit, but {reason}")

    _converted(o, refuse)


def _converted(o: Options, convert: Callable[[str, Measured], Any]) -> dict[str, Any]:
    """Convert the values of all options that have a unit."""
    return {name: _in_pixels(flag(o.command, name), getattr(o, name), convert) for name in o.measured}


def _in_pixels(option: str, value: Any, converted: Callable[[str, Measured], Any]) -> Any:
    """Convert what has a unit in the value of an option, which messages name as users do."""
    if isinstance(value, Measured):
        return converted(option, value)
    if isinstance(value, Pruning):
        length = replace(value.threshold, text=f"{value.criterion}={value.threshold.text}")
        return value._replace(threshold=converted(option, length))
    if isinstance(value, tuple):
        return tuple(_in_pixels(option, each, converted) for each in value)
    return value


def _number(sides: Sides, option: str, length: Measured) -> Fraction | float:
    """A length, an area or a volume in pixels: exact, or correctly rounded."""
    from vorotool.numeric.length_units import METERS, ratio

    found = ratio(length.unit, sides.unit)
    if found is None:
        its = f"is in {sides.unit}, an unknown unit"
        known = ", ".join(METERS)
        raise UsageError(f"{option} {length.text} has a unit, but {sides.whose} {its}: give it one of {known}")
    if length.power not in (1, len(sides.lengths)):
        what = "pixels have areas, such as 5um2" if len(sides.lengths) == 2 else "voxels have volumes, such as 5um3"
        raise UsageError(f"invalid {option} {length.text!r}: {what}")
    pixel = sides.side if length.power == 1 else prod(sides.lengths)
    if pixel is None:
        what, text = ("pixels that are not squares", "SX,SY") if len(sides.lengths) == 2 else _VOXELS
        raise UsageError(
            f"{option} {length.text} has a unit, but the input has {what}: use --spacing auto, or --spacing {text}, "
            "to measure with their sides"
        )
    exact = length.number * prod([found] * length.power) / pixel
    rounded = nearest_double(exact)
    if not isfinite(rounded) or (exact and not rounded):
        raise UsageError(f"invalid {option} {length.text!r}: expected a number of pixels that a float can hold")
    return exact if length.is_exact else rounded


_VOXELS = ("voxels that are not cubes", "SX,SY,SZ")


def check_units(o: Options, targets: Sequence[Target]) -> None:
    """Refuse a size of pixels that nothing shows, and no length is measured by."""
    if o.unit is None or o.unit.is_spacing or o.measured:
        return
    is_distance = any(each.what.startswith("distance") for each in targets)
    if not shows_units(targets) and not o.scale_bar and not (is_distance and o.is_laid_out):
        instead = "--spacing, by which distances are measured" if is_distance else "--what table"
        raise UsageError(f"--pixel-size applies to tables and vectors: use {instead}, or leave it out")


def in_units(size: PixelSize | None, value: Value) -> Value:
    """Give a result in the units of the pixel size, if there is one."""
    if size is None:
        return value
    from vorotool.types.scaling import scaled

    with _within_doubles(size):
        return scaled(value, size.factor, size.origin, unit=size.unit)


def unit_columns(size: PixelSize | None, count: int) -> dict[str, list[str]]:
    """Give the column that names the unit of so many rows, where there is one."""
    return {} if size is None or size.unit is None else {"unit": [size.unit] * count}


def unit_text(size: PixelSize | None) -> str:
    """Words for the unit after a number, where there is one."""
    return "" if size is None or size.unit is None else f" {size.unit}"


def table_in_units(
    size: PixelSize | None, table: Table, *, properties: Collection[str] = (), has_rows: bool = False
) -> Table:
    """Give a table in the units of the pixel size, if there is one; the input's own columns stay as they are."""
    if size is None:
        return table
    from vorotool.types.scaling import scaled_table

    pixel = (1.0, 1.0) if size.sides is None else (float(size.sides.lengths[-1]), float(size.sides.lengths[-2]))
    with _within_doubles(size):
        y_up = has_rows and size.y_up
        return scaled_table(
            table,
            size.factor,
            properties=properties,
            origin=size.origin,
            y_up=y_up,
            pixel=pixel,
        )


@contextmanager
def _within_doubles(size: PixelSize) -> Iterator[None]:
    """Refuse a size that makes numbers infinite."""
    import numpy as np

    try:
        with np.errstate(over="raise"):
            yield
    except FloatingPointError:
        raise UsageError(f"{size.option} makes coordinates or areas too large for numbers: use a smaller one") from None


def length_in_units(size: PixelSize | None, length: Any) -> Any:
    """Give a number of pixels, or None, in the units of the pixel size, if there is one."""
    if size is None or length is None:
        return length
    return length * (size.factor if isinstance(length, Fraction) else float(size.factor))


class Amount(NamedTuple):
    """A length among statistics, in the coordinates of the input; an area by the power of 2, a place by its axis."""

    value: Any  # a number, or None
    power: int = 1
    axis: int | None = None


def lengths_among(found: Any, *names: str) -> Any:
    """Give statistics in which numbers of some names are lengths, and x and y a place."""
    if not isinstance(found, dict):
        return found
    axes = {"x": 0, "y": 1}
    return {
        name: Amount(value, axis=axes.get(name)) if name in names or name in axes else lengths_among(value, *names)
        for name, value in found.items()
    }


def box_amounts(frame: Sequence[float]) -> list[Amount]:
    """Give x, y, width and height as amounts."""
    return [Amount(side, axis=axis) for side, axis in zip(frame, (0, 1, None, None), strict=True)]


def in_stated_unit(size: PixelSize | None, found: Any) -> Any:
    """Give statistics with their amounts in the unit that they state, that of files."""
    if isinstance(found, Amount):
        value = found.value
        if size is None or size.is_auto or value is None or isinstance(value, str):
            return value
        made = float(value) * float(size.factor) ** found.power
        return made + size.origin[found.axis] if size.origin is not None and found.axis is not None else made
    if isinstance(found, dict):
        return {name: in_stated_unit(size, value) for name, value in found.items()}
    return [in_stated_unit(size, value) for value in found] if isinstance(found, list) else found


def unit_stats(size: PixelSize | None) -> dict[str, Any]:
    """What statistics say of the size."""
    if size is None or size.is_auto:
        return {}
    found: dict[str, Any] = {"pixel_size": float(size.factor), "unit": size.unit}
    if size.sides is not None and not size.is_spacing:
        found["pixel_size"] = float(size.sides.lengths[-1])
    elif size.sides is not None:
        sides = [float(side) for side in reversed(size.sides.lengths)]
        found = {"spacing": sides, "spacing_step": str(size.sides.step), "unit": size.unit}
    if size.crs is None:
        return found
    from vorotool.numeric.crs import crs_name

    return {**found, "crs": crs_name(size.crs)}
