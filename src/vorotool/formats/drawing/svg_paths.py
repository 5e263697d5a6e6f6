"""Path data of SVG: svgelements knows their grammar, the curves are made here."""

from __future__ import annotations

from math import isfinite, sqrt
from typing import Any

from vorotool.convert.extras import needed
from vorotool.errors import InputError
from vorotool.formats.drawing.curves import Bezier, Curve, Line, Piece, Point, arc_between, turned
from vorotool.formats.parsing.reader_options import shortened
from vorotool.numeric.curves.inverse_functions import hypotenuse


def path_curves(data: str, place: str) -> list[Curve]:
    """Give the subpaths of path data."""
    lexer = needed("svgelements.svgelements", "cad", "SVG drawings").SVGLexicalParser()
    made = _Path()
    try:
        lexer.parse(made, data)
    except (ValueError, TypeError, AttributeError, OverflowError):
        raise _damaged(data, lexer.pos, place) from None
    if lexer.pos < len(data):
        raise _damaged(data, lexer.pos, place)
    curves = made.curves()
    if not all(curve.is_finite() for curve in curves):
        raise InputError(f"{place}: a coordinate of the path is too large for a double; correct it, or remove it")
    return curves


def _damaged(data: str, position: int, place: str) -> InputError:
    here = shortened(data[max(position - 1, 0) :]) if position < len(data) else "its end"
    return InputError(
        f"{place}: the path data are damaged near character {position + 1} ({here}); correct or remove it"
    )


class _Path:
    """What the parser tells of: its methods have the names that it calls."""

    def __init__(self) -> None:
        self._made: list[Curve] = []
        self._open: Curve | None = None
        self._last: tuple[str, Point] | None = None  # the kind of the curve before, and its last control point

    def curves(self) -> list[Curve]:
        """Give all of them: a lone place to move to is none, but one that is closed is a place."""
        return [curve for curve in self._made if curve.pieces or curve.is_closed]

    def start(self) -> None:
        """Begin."""

    def end(self) -> None:
        """Finish."""

    @property
    def current_point(self) -> Any:
        """Where the path is, as the parser wants it; None at its very beginning."""
        return None if not self._made else _Place(*self._here)

    @property
    def _here(self) -> Point:
        if self._open is not None:
            return self._open.end
        if not self._made:
            raise ValueError  # path data begin with a place to move to
        return self._made[-1].start  # behind a closed subpath, or at a place that was moved to

    def _add(self, piece: Piece, control: tuple[str, Point] | None = None) -> None:
        if self._open is None:
            self._open = Curve(self._here)
            self._made.append(self._open)
        self._open.pieces.append(piece)
        self._last = control

    def _target(self, place: Any) -> Point:
        """Give a place; ``z`` stands for the start of the subpath, which it closes, too."""
        if place in ("z", "Z"):
            return self._open.start if self._open is not None else self._here
        x, y = place
        return (float(x), float(y))

    def _close_if(self, place: Any) -> None:
        if place in ("z", "Z"):
            self.closed()

    def move(self, place: Any, *, relative: bool = False) -> None:
        """Begin a subpath."""
        self._open = Curve(self._target(place))
        self._made.append(self._open)
        self._last = None

    def closed(self, *, relative: bool = False) -> None:
        """Close the subpath; the next one begins where it did, if nothing else is said."""
        if self._open is None:
            self._open = Curve(self._here)
            self._made.append(self._open)
        self._open.is_closed = True
        self._open = None
        self._last = None

    def line(self, place: Any, *, relative: bool = False) -> None:
        """Add a straight line."""
        self._add(Line(self._target(place)))
        self._close_if(place)

    def horizontal(self, x: float, *, relative: bool = False) -> None:
        """Add one to an x."""
        here = self._here
        self._add(Line((here[0] * relative + x, here[1])))

    def vertical(self, y: float, *, relative: bool = False) -> None:
        """Add one to a y."""
        here = self._here
        self._add(Line((here[0], here[1] * relative + y)))

    def quad(self, control: Any, place: Any, *, relative: bool = False) -> None:
        """Add a quadratic curve."""
        middle = self._target(control)
        self._add(Bezier((middle, self._target(place))), ("Q", middle))
        self._close_if(place)

    def smooth_quad(self, place: Any, *, relative: bool = False) -> None:
        """Add one that goes on as the one before."""
        self.quad(self._mirrored("Q"), place)

    def cubic(self, control: Any, second: Any, place: Any, *, relative: bool = False) -> None:
        """Add a cubic curve."""
        last = self._target(second)
        self._add(Bezier((self._target(control), last, self._target(place))), ("C", last))
        self._close_if(place)

    def smooth_cubic(self, second: Any, place: Any, *, relative: bool = False) -> None:
        """Add one that goes on as the one before."""
        self.cubic(self._mirrored("C"), second, place)

    def _mirrored(self, kind: str) -> Point:
        here = self._here
        if self._last is None or self._last[0] != kind:
            return here
        x, y = self._last[1]
        return (2 * here[0] - x, 2 * here[1] - y)

    def arc(
        self, rx: float, ry: float, rotation: float, is_large: Any, sweep: Any, place: Any, *, relative: bool = False
    ) -> None:
        """Add an arc of an ellipse."""
        if is_large is None or sweep is None:
            raise ValueError
        self._add(elliptic_arc(self._here, (rx, ry), rotation, (bool(is_large), bool(sweep)), self._target(place)))
        self._close_if(place)


class _Place:
    """A place with x and y."""

    def __init__(self, x: float, y: float) -> None:
        self.x, self.y = x, y


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
