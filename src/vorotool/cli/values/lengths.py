"""Lengths and areas: numbers of pixels, or numbers with a unit, which the input or ``--pixel-size`` converts."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction
from math import inf, isfinite
from typing import TYPE_CHECKING, Any

from vorotool.cli.values import UnexpectedError
from vorotool.cli.values.numbers import decimal
from vorotool.errors import UsageError
from vorotool.jobs.options import Measured
from vorotool.jobs.units import AUTO, AUTO_SPACING, CRITERIA, LENGTHS, PixelSize, Pruning
from vorotool.numeric.length_units import METERS, is_known

if TYPE_CHECKING:
    from vorotool.types.pixels import PixelSides

_NUMBER = r"[-+]?(?:[0-9]++(?:\.[0-9]*+)?|\.[0-9]++)(?:[eE][-+]?[0-9]+)?"
_NAME = r"[^\W\d_]{1,16}"
_UNIT = re.compile(rf"{_NAME}\Z")
_WITH_UNIT = re.compile(rf"({_NUMBER})\s*({_NAME})")
_AREA = re.compile(rf"({_NUMBER})(?:\s*({_NAME})\^?([23²³]))?")
_SIDE = re.compile(rf"([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*({_NAME})?")
_LIKE_AREA = re.compile(
    rf"-?(?:[0-9]++(?:\.[0-9]++)?|\.[0-9]++)(e[-+]?[0-9]+)?\s*({_NAME}\^?[0-9²³]|{'|'.join(METERS)}|px|pixels?|voxels?)?",
    re.IGNORECASE,
)
"""An argument that is an area, or was to be one; a file whose name has an extension is none."""
_POWERS = {"2": 2, "²": 2, "3": 3, "³": 3}
MOST_OF_RANGE = 10_000
"""Distances."""
ALL_HOLES = "all"
"""The value of ``--fill-holes`` that has none."""
PRUNINGS = "angle=DEG, chord=D, scale=S, length=D, ratio=Q, mask or none"


def measured(text: str, *, is_exact: bool = False) -> Measured | None:
    """Return a length that has a unit; None for all else."""
    match = _WITH_UNIT.fullmatch(text)
    return None if match is None else Measured(text, decimal(match[1]), _known_unit(match[2]), is_exact)


def _known_unit(name: str) -> str:
    if not is_known(name):
        raise UnexpectedError(f"expected a number alone, or with a unit of {', '.join(METERS)}")
    return name


def exact_length(text: str) -> Measured | Fraction:
    """Return a decimal number, exactly, with a unit or none."""
    return measured(text, is_exact=True) or decimal(text)


def radius(text: str) -> Measured | Fraction | float:
    """Return an exact length, or infinity."""
    if text == "auto":
        raise UnexpectedError("expected a decimal such as 12.5: for the smallest that fits use --auto in place of -r")
    return inf if text == "inf" else exact_length(text)


def length(text: str, *, zero: bool = False) -> Measured | float:
    """Return a finite length with a unit or none, 0 only where that is allowed."""
    found = measured(text)
    try:
        number = float(text) if found is None else found.number
    except ValueError:
        raise UnexpectedError("expected a number such as 0.5") from None
    is_finite = found is not None or isfinite(number)
    if not is_finite or number < 0 or (number == 0 and not zero):
        raise UnexpectedError(f"expected {'0 or more' if zero else 'more than 0'}")
    return float(number) if found is None else found


def length_or_zero(text: str) -> Measured | float:
    """Return a finite length from 0."""
    return length(text, zero=True)


def tolerance_or_auto(text: str) -> Measured | float | None:
    """Return a length above 0; None for ``auto``: each curve by its size."""
    return None if text == "auto" else length(text)


def distances(text: str) -> tuple[Any, ...]:
    """Return different finite numbers other than 0, each with a unit or none, and those of ranges."""
    from vorotool.engines.offsets.offsets import checked_distances

    try:
        found = [each for part in text.split(",") for each in _one_or_range(part.strip())]
    except UnexpectedError:
        raise
    except ValueError:
        raise UnexpectedError("expected numbers such as -2,5, or ranges such as 1:5:0.5") from None
    try:
        plain = iter(checked_distances([x for x in found if not isinstance(x, Measured)] or [1]))
    except UsageError as error:
        raise UnexpectedError(error.typed) from None
    if any(isinstance(each, Measured) and not each.number for each in found):
        raise UnexpectedError("a distance is 0: use positive ones outwards, negative ones inwards")
    return tuple(each if isinstance(each, Measured) else next(plain) for each in found)


def _one_or_range(part: str) -> Sequence[float | Measured]:
    """Return a number, or those of a range, its end included if it is reached."""
    if ":" not in part:
        found = measured(part)
        return [float(part) if found is None else found]
    unit = _UNIT.search(part)
    texts = [text.strip().removesuffix(unit[0]) if unit else text for text in part.split(":")]
    if len(texts) != 3:
        raise UnexpectedError("expected a range START:STOP:STEP, such as 1:5:0.5")
    start, stop, step = (decimal(text.strip()) for text in texts)
    if step == 0 or (stop - start) / step < 0:
        raise UnexpectedError(f"the step {texts[2]} does not lead from {texts[0]} to {texts[1]}")
    count = (stop - start) // step + 1
    if count > MOST_OF_RANGE:
        raise UnexpectedError(f"the range has {count} distances, more than {MOST_OF_RANGE}: use a larger step")
    numbers = [start + k * step for k in range(int(count))]
    if unit is None:
        return [float(number) for number in numbers]
    name = _known_unit(unit[0])
    return [Measured(f"{float(number):g}{name}", number, name, is_exact=False) for number in numbers]


# ---- places --------------------------------------------------------------------------------------
def rectangle(text: str) -> tuple[Any, ...]:
    """Return ``X,Y,W,H`` in the units of the input, or in a unit after the last number or each."""
    return _box(text, 2, "expected four numbers X,Y,W,H, such as 0,0,12.5,8 or 0,0,12.5,8mm")


def rectangle_or_box(text: str) -> tuple[Any, ...]:
    """Return ``X,Y,W,H`` as `rectangle` does, or ``X,Y,Z,W,H,D``."""
    expected = "expected four numbers X,Y,W,H, such as 0,0,12.5,8, or in space six, X,Y,Z,W,H,D"
    return _box(text, 2 if text.count(",") < 4 else 3, expected)


def _box(text: str, axes: int, expected: str) -> tuple[Any, ...]:
    numbers = _numbers(text, 2 * axes, expected)
    if not all(float(each.number if isinstance(each, Measured) else each) > 0 for each in numbers[axes:]):
        raise UnexpectedError(f"expected finite numbers with {'W and H' if axes == 2 else 'W, H and D'} above 0")
    return numbers


def place(text: str) -> tuple[Any, ...]:
    """Return ``X,Y`` in the units of the input, or in a unit after the last number or each."""
    return _numbers(text, 2, "expected two numbers X,Y, such as 12.5,8 or 12.5,8mm")


def _numbers(text: str, count: int, expected: str) -> tuple[Any, ...]:
    """Return finite numbers, all of them with a unit or none."""
    parts = [part.strip() for part in text.split(",")]
    found = [measured(part) for part in parts]
    if any(each is not None for each in found):
        units = [None if each is None else each.unit for each in found]
        numbers = [decimal(part) if each is None else each.number for part, each in zip(parts, found, strict=True)]
        if any(units[:-1]):  # each has its own, but 0 needs none
            units = [unit if number else units[-1] for unit, number in zip(units, numbers, strict=True)]
        ratios = _ratios(units)
        if len(parts) != count or ratios is None:
            raise UnexpectedError(f"{expected}, with one unit for all, after the last one or each")
        last = str(units[-1])
        return tuple(
            Measured(text, number * ratio, last, is_exact=False) for number, ratio in zip(numbers, ratios, strict=True)
        )
    try:
        plain = tuple(map(float, parts))
    except ValueError:
        plain = ()
    if len(plain) != count:
        raise UnexpectedError(expected)
    if not all(map(isfinite, plain)):
        raise UnexpectedError("expected finite numbers")
    return plain


# ---- areas ---------------------------------------------------------------------------------------
def area(text: str, *, zero: bool = False) -> Measured | Fraction:
    """Return an area, or the volume of an object, exactly."""
    match = _AREA.fullmatch(text)
    if match is None:
        raise UnexpectedError("expected a number of pixels such as 50, or an area such as 5um2")
    number, unit, power = match.groups()
    exact = decimal(number)
    if exact < 0 or (exact == 0 and not zero):
        raise UnexpectedError(f"expected {'0 or more' if zero else 'more than 0'}")
    return exact if unit is None else Measured(text, exact, _known_unit(unit), is_exact=True, power=_POWERS[power])


def area_or_zero(text: str) -> Measured | Fraction:
    """Return an area from 0."""
    return area(text, zero=True)


def holes(text: str) -> Measured | Fraction | bool:
    """Return an area, or True for all holes."""
    return True if text == ALL_HOLES else area(text)


def with_hole_areas(arguments: list[str]) -> list[str]:
    """Return arguments in which the option of a hole's area has a value: the next argument, if it is an area."""
    made: list[str] = []
    for at, argument in enumerate(arguments):
        if made and made[-1] == "--fill-holes":
            is_area = _LIKE_AREA.fullmatch(argument)  # a file whose name has an extension is none
            made[-1] += f"={argument if is_area else ALL_HOLES}"
            if is_area:
                continue
        if argument == "--":
            return made + arguments[at:]
        made.append(argument)
    if made and made[-1] == "--fill-holes":
        made[-1] += f"={ALL_HOLES}"
    return made


# ---- pixels --------------------------------------------------------------------------------------
def pixel_size(text: str) -> PixelSize:
    """Return a decimal number above 0 and, if it has one, its unit; or what the file says."""
    if text == "auto":
        return AUTO
    match = _SIDE.fullmatch(text)
    if match is None:
        raise UnexpectedError("expected a number and a unit, such as 0.325um, or auto")
    factor = decimal(match[1])
    if not factor or not 1e-100 < factor < 1e100:
        raise UnexpectedError("expected more than 0, and at most 1e100")
    return PixelSize(factor, match[2] and _known_unit(match[2]))


def spacing(text: str) -> PixelSize:
    """Return two decimal numbers above 0, or three, with a unit or none; or what the file says."""
    if text == "auto":
        return AUTO_SPACING
    matches = [match for part in text.split(",") if (match := _SIDE.fullmatch(part.strip()))]
    if len(matches) not in (2, 3) or len(matches) != text.count(",") + 1:
        raise UnexpectedError(
            "expected the sides of a pixel, such as 0.325,0.5um, of a voxel, such as 1,1,2um, or auto"
        )
    numbers, units = [decimal(match[1]) for match in matches], [match[2] and _known_unit(match[2]) for match in matches]
    if not all(1e-100 < number < 1e100 for number in numbers):
        raise UnexpectedError("expected sides of more than 0, and at most 1e100")
    ratios = _ratios(units)
    if ratios is None:
        raise UnexpectedError("expected one unit for all sides, after the last one or each")
    sides = _with_common_step([number * ratio for number, ratio in zip(numbers, ratios, strict=True)])
    return PixelSize(Fraction(1), units[-1], is_spacing=True, sides=sides)


def _with_common_step(sides: list[Fraction]) -> PixelSides:
    from vorotool.types.pixels import MOST_STEPS, pixel_sides

    try:
        return pixel_sides(sides[::-1], len(sides))
    except UsageError:
        raise UnexpectedError(
            f"expected sides of at most {MOST_STEPS} times their largest common step: round them to fewer digits"
        ) from None


def _ratios(units: list[str | None]) -> list[Fraction] | None:
    """Return how long the unit of each side is in that of the last one; without a unit all are in this one."""
    from vorotool.numeric.length_units import ratio

    last = units[-1]
    if len({*units, None}) == 1 or not any(units[:-1]) or set(units) == {last}:
        return [Fraction(1)] * len(units)
    known = [None if unit is None or last is None else ratio(unit, last) for unit in units]
    return None if None in known else [Fraction(each) for each in known if each is not None]


# ---- pruning -------------------------------------------------------------------------------------
def pruning(text: str) -> Pruning:
    """Return ``CRITERION=THRESHOLD``, ``mask`` or ``none``."""
    if text in ("mask", "none"):
        return Pruning(text)
    criterion, equals, digits = text.partition("=")
    if criterion not in CRITERIA or not equals:
        raise UnexpectedError(f"expected {PRUNINGS}")
    found = measured(digits) if criterion in LENGTHS else None
    if found is not None and found.number < 0:
        raise UnexpectedError("expected a length from 0")
    return Pruning(criterion, criterion, found or _pruning_threshold(criterion, digits))


def _pruning_threshold(criterion: str, digits: str) -> float:
    from vorotool.engines.pruning.pruning import check_threshold

    try:
        threshold = float(digits)
        check_threshold(criterion, threshold)
    except UsageError as error:
        raise UnexpectedError(error.typed) from None
    except ValueError:
        raise UnexpectedError(f"{digits!r} is not a number; give {PRUNINGS}") from None
    return threshold
