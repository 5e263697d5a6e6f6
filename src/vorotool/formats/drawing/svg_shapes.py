"""The curves of the shapes and paths of SVG, their lengths, and the transforms and viewports around them."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from math import inf, isfinite, sqrt
from typing import NamedTuple

from vorotool.errors import InputError
from vorotool.formats.drawing.curves import (
    Affine,
    Arc,
    Bezier,
    Curve,
    Line,
    Piece,
    Point,
    arc_between,
    turned,
    turned_each,
    whole_ellipse,
)
from vorotool.formats.parsing.reader_options import shortened
from vorotool.numeric.curves.inverse_functions import hypotenuse

_NUMBER = r"(?>[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?)"  # in one way only: damaged text takes no longer
_LENGTH = re.compile(rf"\s*({_NUMBER})\s*(|px|mm|cm|in|pt|pc|q|%)\s*", re.IGNORECASE)
_GAP = r"(?>\s*,\s*|\s+|(?=[-+.)])|$)"
# Groups are repeated without a "+" behind: Python 3.11.2 keeps what the last one matched in part, as of "rotate(1".
_NUMBERS = re.compile(rf"\s*(?:{_NUMBER}{_GAP})*")
_TRANSFORMS = re.compile(
    rf"\s*(?:(?:matrix|translate|scale|rotate|skewX|skewY)\s*\(\s*(?:{_NUMBER}(?:px|deg)?{_GAP})+\)[\s,]*+)*"
)
MM = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72, "pc": 25.4 / 6, "q": 0.25}
"""Millimeters of the units of physical lengths."""
PX = 25.4 / 96
"""Millimeters of a px, which is the unit of coordinates where no viewBox makes another one of it."""


class Viewport(NamedTuple):
    """The width and height that percentages are of."""

    width: float
    height: float

    @property
    def diagonal(self) -> float:
        """What percentages of radii are of."""
        return sqrt((self.width * self.width + self.height * self.height) / 2)


class Geometry:
    """The attributes of one element that are numbers, with messages that name it."""

    def __init__(self, attributes: Mapping[str, str], place: str, viewport: Viewport) -> None:
        self.attributes, self.place, self.viewport = attributes, place, viewport

    def length(self, name: str, of: float, default: float = 0.0) -> float:
        """Give an attribute in px; percentages are of a length."""
        text = self.attributes.get(name, "")
        if not text.strip() or text.strip() == "auto":
            return default
        number, unit = parsed_length(text, f"{self.place}: {name}")
        return number * of / 100 if unit == "%" else number * MM[unit] / PX if unit in MM else number

    def across(self, name: str, default: float = 0.0) -> float:
        """Give one of which percentages are of the width."""
        return self.length(name, self.viewport.width, default)

    def down(self, name: str, default: float = 0.0) -> float:
        """Give one of which percentages are of the height."""
        return self.length(name, self.viewport.height, default)

    def size(self, name: str, of: float) -> float:
        """Give one that cannot be negative."""
        value = self.length(name, of)
        if value < 0:
            raise InputError(f"{self.place}: {name} is {value:g}; write 0 or more")
        return value

    def points(self) -> list[Point]:
        """Give the places of a polyline or polygon."""
        text = self.attributes.get("points", "")
        if _NUMBERS.fullmatch(text) is None:
            raise InputError(f"{self.place}: points is {shortened(text)}; write x,y x,y …")
        numbers = [float(number) for number in re.findall(_NUMBER, text)]
        if len(numbers) % 2:
            raise InputError(f"{self.place}: points has {len(numbers)} numbers; each point needs two")
        return list(zip(numbers[::2], numbers[1::2], strict=True))


def parsed_length(text: str, what: str) -> tuple[float, str]:
    """Give the number and the unit of a length; a px has none."""
    match = _LENGTH.fullmatch(text)
    number = float("nan") if match is None else float(match[1])
    if match is None or not isfinite(number):
        raise InputError(f"{what} is {shortened(text)}; write a number with px, mm, cm, in, pt, pc, q, % or no unit")
    return number, match[2].lower().removesuffix("px")


# ---- shapes --------------------------------------------------------------------------------------
def _path(of: Geometry) -> list[Curve]:
    data = of.attributes.get("d", "").strip()
    return [] if data in ("", "none") else path_curves(data, of.place)


def _polyline(of: Geometry) -> list[Curve]:
    points = of.points()
    return [Curve(points[0], [Line(point) for point in points[1:]])] if points else []


def _polygon(of: Geometry) -> list[Curve]:
    curves = _polyline(of)
    for curve in curves:
        curve.is_closed = True
    return curves


def _line(of: Geometry) -> list[Curve]:
    start, end = ((of.across(f"x{k}"), of.down(f"y{k}")) for k in (1, 2))
    return [Curve(start, [Line(end)])]


def _circle(of: Geometry) -> list[Curve]:
    return _ellipse_of(of, *[of.size("r", of.viewport.diagonal)] * 2)


def _ellipse(of: Geometry) -> list[Curve]:
    return _ellipse_of(of, *_corner(of))


def _ellipse_of(of: Geometry, rx: float, ry: float) -> list[Curve]:
    if not rx or not ry:
        return []
    return [whole_ellipse((of.across("cx"), of.down("cy")), (rx, 0.0), (0.0, ry))]


def _corner(of: Geometry) -> tuple[float, float]:
    """Radii, of which one may stand for both."""
    rx, ry = of.size("rx", of.viewport.width), of.size("ry", of.viewport.height)
    given = [of.attributes.get(name, "auto").strip() not in ("", "auto") for name in ("rx", "ry")]
    return (rx if given[0] else ry, ry if given[1] else rx)


def _rect(of: Geometry) -> list[Curve]:
    width, height = of.size("width", of.viewport.width), of.size("height", of.viewport.height)
    if not width or not height:
        return []
    x, y = of.across("x"), of.down("y")
    rx, ry = _corner(of)
    rx, ry = min(rx, width / 2), min(ry, height / 2)
    right, bottom = x + width, y + height
    if not rx or not ry:
        corners = ((right, y), (right, bottom), (x, bottom))
        return [Curve((x, y), [Line(corner) for corner in corners], is_closed=True)]
    curve = Curve((x + rx, y), is_closed=True)
    for cx, cy, end, ways, next_start in (
        (right - rx, y + ry, (right, y + ry), ((0.0, -1.0), (1.0, 0.0)), (right - rx, y)),
        (right - rx, bottom - ry, (right - rx, bottom), ((1.0, 0.0), (0.0, 1.0)), (right, bottom - ry)),
        (x + rx, bottom - ry, (x, bottom - ry), ((0.0, 1.0), (-1.0, 0.0)), (x + rx, bottom)),
        (x + rx, y + ry, (x + rx, y), ((-1.0, 0.0), (0.0, -1.0)), (x, y + ry)),
    ):
        curve.pieces += [Line(next_start), Arc((cx, cy), (rx, 0.0), (0.0, ry), ways, end)]
    return [curve]


SHAPES: dict[str, Callable[[Geometry], list[Curve]]] = {
    "path": _path,
    "polygon": _polygon,
    "polyline": _polyline,
    "line": _line,
    "rect": _rect,
    "circle": _circle,
    "ellipse": _ellipse,
}
"""What makes the curves of each element that is a shape."""


# ---- maps ----------------------------------------------------------------------------------------
def _rotated(way: Point, x: float = 0.0, y: float = 0.0) -> Affine:
    cosine, sine = way
    return Affine(cosine, sine, 0.0 - sine, cosine, x, y).after(Affine(e=-x, f=-y))


def _skewed(way: Point) -> float:
    cosine, sine = way
    return sine / cosine if cosine else inf


_MAPS: dict[str, Callable[..., Affine]] = {
    "matrix": Affine,
    "translate": lambda x, y=0.0: Affine(e=x, f=y),
    "scale": lambda x, y=None: Affine(a=x, d=x if y is None else y),
}
_TURNS: dict[str, Callable[..., Affine]] = {
    "rotate": _rotated,
    "skewX": lambda way: Affine(c=_skewed(way)),
    "skewY": lambda way: Affine(b=_skewed(way)),
}
"""Maps whose first number is an angle: they are given its cosine and sine."""
_COUNTS = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3), "skewX": (1,), "skewY": (1,)}
_TRANSFORM = re.compile(r"([a-zA-Z]+)\s*\(([^)]*)\)")


def parsed_transform(text: str, place: str) -> Affine:
    """Give the map of a transform attribute."""
    if text in ("", "none"):
        return Affine()
    if _TRANSFORMS.fullmatch(text) is None:
        raise InputError(
            f"{place}: transform is {shortened(text)}; write matrix, translate, scale, rotate, skewX, skewY of numbers"
        )
    steps = _TRANSFORM.findall(text)
    numbers = {step: [float(number) for number in re.findall(_NUMBER, step[1])] for step in dict.fromkeys(steps)}
    for (name, _), given in numbers.items():
        if len(given) not in _COUNTS[name]:
            raise InputError(f"{place}: transform is {shortened(text)}: {name} has a wrong count of numbers")
        if not all(map(isfinite, given)):
            raise InputError(f"{place}: transform is {shortened(text)}, which gives coordinates too large for a double")
    turns = [step for step in numbers if step[0] in _TURNS]
    ways = dict(zip(turns, turned_each([numbers[step][0] for step in turns]), strict=True))
    maps = {
        step: _TURNS[step[0]](ways[step], *given[1:]) if step in ways else _MAPS[step[0]](*given)
        for step, given in numbers.items()
    }
    made = Affine()
    for step in steps:
        made = made.after(maps[step])
    if not all(map(isfinite, made)):
        raise InputError(f"{place}: transform is {shortened(text)}, which gives coordinates too large for a double")
    return made


def viewbox_of(attributes: Mapping[str, str], place: str) -> tuple[float, float, float, float] | None:
    """Give x, y, width and height of a viewBox; None if there is none."""
    text = attributes.get("viewBox", "")
    if not text.strip():
        return None
    numbers = [float(number) for number in re.findall(_NUMBER, text)] if _NUMBERS.fullmatch(text) else []
    if len(numbers) != 4 or not all(map(isfinite, numbers)) or numbers[2] < 0 or numbers[3] < 0:
        raise InputError(f"{place}: viewBox is {shortened(text)}; write x y width height")
    x, y, width, height = numbers
    return (x, y, width, height)


def fitted(box: tuple[float, float, float, float], viewport: Viewport, aspect: str) -> Affine:
    """Give the map of a viewBox into a viewport, as preserveAspectRatio says."""
    x, y, width, height = box
    across, down = viewport.width / width, viewport.height / height
    words = aspect.removeprefix("defer").lower().split() or ["xmidymid"]
    if words[0] != "none":
        across = down = (max if "slice" in words else min)(across, down)
    left, over = viewport.width - across * width, viewport.height - down * height
    shares = {"min": 0.0, "mid": 0.5, "max": 1.0}
    along, below = shares.get(words[0][1:4], 0.5), shares.get(words[0][5:8], 0.5)
    if words[0] == "none":
        along = below = 0.0
    return Affine(across, 0.0, 0.0, down, along * left - across * x, below * over - down * y)


# ---- path data -----------------------------------------------------------------------------------
_COMMAND = re.compile(r"[\s,]*([MLTHVCSQAZ])", re.IGNORECASE)
_STEPS = {"M": "nn", "L": "nn", "T": "nn", "H": "n", "V": "n", "C": "nnnnnn", "S": "nnnn", "Q": "nnnn", "A": "nnnffnn"}
"""Numbers and flags of a step of each kind; one that closes has none."""
_FORMS = {"n": re.compile(rf"[\s,]*({_NUMBER})"), "f": re.compile(r"[\s,]*([01])")}
_DEGREES = {"T": 2, "S": 3}
"""Of curves that go on as the one before, if that is of their degree."""


def path_curves(data: str, place: str) -> list[Curve]:
    """Give the subpaths of path data."""
    made, at, end = _Path(), 0, len(data.rstrip(" \t\r\n\f,"))
    letter = "Z"
    while at < end:
        command = _COMMAND.match(data, at)
        if command is not None:
            letter, at = command[1], command.end()
        elif letter in "Zz":
            raise _damaged(data, at, place)
        kind, values = letter.upper(), list[float]()
        step = _STEPS.get(kind, "")
        while len(values) < len(step) and (value := _FORMS[step[len(values)]].match(data, at)):
            values.append(float(value[1]))
            at = value.end()
        missing = len(step) - len(values)
        closing = _COMMAND.match(data, at) if missing == 2 and kind != "M" else None
        if (missing and (closing is None or closing[1] not in "Zz")) or not (made.curves or kind == "M"):
            raise _damaged(data, at, place)
        if kind != "Z":
            made.add(kind, values, is_relative=letter.islower(), is_closing=closing is not None)
        if kind == "Z" or closing is not None:
            made.close()
            at = at if closing is None else closing.end()
        letter = {"M": "L", "m": "l"}.get(letter, letter)  # of places that follow
    curves = [curve for curve in made.curves if curve.pieces or curve.is_closed]  # a lone place to move to is none
    if not all(curve.is_finite() for curve in curves):
        raise InputError(f"{place}: a coordinate of the path is too large for a double; correct it, or remove it")
    return curves


def _damaged(data: str, position: int, place: str) -> InputError:
    here = shortened(data[max(position - 1, 0) :]) if position < len(data) else "its end"
    return InputError(
        f"{place}: the path data are damaged near character {position + 1} ({here}); correct or remove it"
    )


class _Path:
    """Subpaths that grow step by step."""

    def __init__(self) -> None:
        self.curves: list[Curve] = []
        self._open: Curve | None = None
        self._last: tuple[int, Point] | None = None  # the degree of the curve before, and its last control point

    @property
    def _here(self) -> Point:
        """Where the next step begins: behind a closed subpath at its start."""
        if self._open is not None:
            return self._open.end
        return self.curves[-1].start if self.curves else (0.0, 0.0)

    def _begin(self, start: Point) -> Curve:
        self._open = Curve(start)
        self.curves.append(self._open)
        return self._open

    def add(self, kind: str, values: list[float], *, is_relative: bool, is_closing: bool) -> None:
        """Add a step, whose last place may be the start of the subpath."""
        x, y = here = self._here
        if kind in "HV":
            (value,) = values
            value += (x if kind == "H" else y) * is_relative
            places = [(value, y) if kind == "H" else (x, value)]
        else:
            pairs = values[5:] if kind == "A" else values
            places = list(zip(pairs[::2], pairs[1::2], strict=True))
            if is_relative and self.curves:
                places = [(a + x, b + y) for a, b in places]
        if is_closing:  # the place that closes it is left out
            places.append(here if self._open is None else self._open.start)
        if kind == "M":
            self._begin(places[0])
            self._last = None
            return
        if kind in _DEGREES:
            places.insert(0, self._mirrored(_DEGREES[kind]))
        if kind == "A":
            rx, ry, rotation, is_large, sweep = values[:5]
            piece = elliptic_arc(here, (rx, ry), rotation, (bool(is_large), bool(sweep)), places[0])
        else:
            piece = Bezier(tuple(places)) if len(places) > 1 else Line(places[0])
        (self._open or self._begin(here)).pieces.append(piece)
        self._last = (len(places), places[-2]) if len(places) > 1 else None

    def _mirrored(self, degree: int) -> Point:
        x, y = here = self._here
        if self._last is None or self._last[0] != degree:
            return here
        a, b = self._last[1]
        return (2 * x - a, 2 * y - b)

    def close(self) -> None:
        """Close the subpath; the next one begins where it did, if nothing else is said."""
        (self._open or self._begin(self._here)).is_closed = True
        self._open = self._last = None


def elliptic_arc(start: Point, radii: Point, rotation: float, flags: tuple[bool, bool], end: Point) -> Piece:
    """Give the arc that SVG describes by its ends (SVG 1.1, appendix F.6.5)."""
    rx, ry = abs(radii[0]), abs(radii[1])
    if start == end or not rx > 0 or not ry > 0 or not isfinite(rx + ry + rotation):
        return Line(end)
    cosine, sine = turned(rotation)
    # half the chord in the frame in which the ellipse is the unit circle
    across, down = (start[0] - end[0]) / 2, (start[1] - end[1]) / 2
    x, y = (cosine * across + sine * down) / rx, (cosine * down - sine * across) / ry
    half = float(hypotenuse(x, y))
    if not isfinite(half) or not half > 0:
        return Line(end)
    if half > 1:
        rx, ry, x, y, half = rx * half, ry * half, x / half, y / half, 1.0
    is_large, sweep = flags
    away = sqrt(max((1 - half) * (1 + half), 0.0)) / half * (-1 if is_large == sweep else 1)
    u, v = away * y, -away * x  # the center there, from the middle of the chord
    turn = 1.0 if sweep else -1.0
    first, second = (rx * cosine, rx * sine), (-turn * ry * sine, turn * ry * cosine)
    center = (
        (start[0] + end[0]) / 2 + rx * cosine * u - ry * sine * v,
        (start[1] + end[1]) / 2 + rx * sine * u + ry * cosine * v,
    )
    a, b = (x - u, turn * (y - v)), (-x - u, turn * (-y - v))
    if half == 1:
        b = (-a[0], -a[1])
    return arc_between(center, first, second, (a, b), end)
