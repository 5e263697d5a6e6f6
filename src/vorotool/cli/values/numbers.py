"""Numbers, sizes and places."""

from __future__ import annotations

import re
from fractions import Fraction
from math import isfinite, nan
from typing import Any

from vorotool.cli.values import UnexpectedError
from vorotool.jobs.options import ALL_PAGES, AUTO_LEVELS

LARGEST_EXPONENT = 400
"""Of decimal numbers: an exact power of ten beyond any float's takes time and memory, and means nothing."""
MOST_LEVELS = 30
"""A side has at most 2^30 voxels."""
LEAST_ASPECT = 0.001
"""Pictures that are a thousand times stretched show nothing."""


def number_or_nan(text: str) -> float:
    """Return a float; NaN for what is not a number."""
    try:
        return float(text)
    except ValueError:
        return nan


def decimal(text: str) -> Fraction:
    """Return a decimal number, exactly."""
    try:
        if abs(int(text.lower().partition("e")[2] or 0)) > LARGEST_EXPONENT:
            raise ValueError
        return Fraction(text)
    except (ValueError, ZeroDivisionError):
        raise UnexpectedError("expected a decimal such as 12.5") from None


def threshold(text: str) -> float | str:
    """Return a number, or ``otsu``."""
    number = number_or_nan(text)
    if text != "otsu" and not isfinite(number):
        raise UnexpectedError("expected a number or otsu")
    return "otsu" if text == "otsu" else number


def aspect(text: str) -> float:
    """Return a ratio of heights to widths."""
    number = number_or_nan(text)
    if not LEAST_ASPECT <= number <= 1 / LEAST_ASPECT:
        raise UnexpectedError(f"expected a number from {LEAST_ASPECT:g} to {1 / LEAST_ASPECT:g}, such as 1")
    return number


def _sides(text: str, counts: tuple[int, ...], expected: str) -> tuple[int, ...]:
    parts = text.lower().replace("×", "x").split("x")
    if len(parts) not in counts or not all(re.fullmatch("0*[1-9][0-9]{0,17}", part) for part in parts):
        raise UnexpectedError(expected)
    return tuple(map(int, parts))


def size(text: str) -> tuple[int, ...]:
    """Return ``WxH`` in pixels."""
    return _sides(text, (2,), "expected width and height in pixels, such as 640x480")


def size_or_volume(text: str) -> tuple[int, ...]:
    """Return ``WxH`` in pixels, or ``WxHxD`` in voxels."""
    expected = "expected width and height in pixels, such as 640x480, and of a volume the depth: 640x480x20"
    return _sides(text, (2, 3), expected)


def window(text: str, expected: str = "expected four integers X,Y,W,H, such as -10,-10,640,480") -> tuple[Any, ...]:
    """Return ``X,Y,W,H``: integers in pixels, or decimal numbers in the units of a map, exactly."""
    try:
        x, y, w, h = (_exact(part) for part in text.split(","))
    except (ValueError, ZeroDivisionError):
        raise UnexpectedError(expected) from None
    if w <= 0 or h <= 0:
        raise UnexpectedError("the window is empty: W and H must be at least 1")
    return (x, y, w, h)


def _exact(text: str) -> int | Fraction:
    """Return an integer, or a decimal number that is no larger than a float's."""
    try:
        return int(text)
    except ValueError:
        return decimal(text) if isfinite(float(text)) else Fraction(nan)


def window_or_volume(text: str) -> tuple[Any, ...]:
    """Return ``X,Y,W,H``, or six integers in voxels."""
    if text.count(",") != 5:
        return window(text, "expected four integers X,Y,W,H, such as -10,-10,640,480, or of a volume six, X,Y,Z,W,H,D")
    try:
        numbers = tuple(map(int, text.split(",")))
    except ValueError:
        raise UnexpectedError("expected six integers X,Y,Z,W,H,D, such as -10,-10,0,640,480,20") from None
    if min(numbers[3:]) <= 0:
        raise UnexpectedError("the window is empty: W, H and D must be at least 1")
    return numbers


def shard(text: str) -> tuple[int, int]:
    """Return I and N of ``I/N``, the I-th of N parts."""
    match = re.fullmatch("([0-9]{1,9})/([0-9]{1,9})", text)
    if match is None or not 1 <= int(match[1]) <= int(match[2]):
        raise UnexpectedError("expected I/N with I from 1 to N, such as 2/8")
    return (int(match[1]), int(match[2]))


def page(text: str) -> int:
    """Return the number of a page, or what stands for all."""
    if text != "all" and not re.fullmatch("[0-9]{1,9}", text):
        raise UnexpectedError("expected the number of a page, from 0, or all")
    return ALL_PAGES if text == "all" else int(text)


def levels(text: str) -> int:
    """Return a number of copies, or what stands for as many as are useful."""
    if text == "auto":
        return AUTO_LEVELS
    if not re.fullmatch("[0-9]{1,2}", text) or int(text) > MOST_LEVELS:
        raise UnexpectedError(f"expected a number of coarser copies up to {MOST_LEVELS}, or auto")
    return int(text)
