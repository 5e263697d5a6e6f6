"""Pictures as layers of lines, polygons, points and texts, in the coordinates of the data, and the page they go to."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError, meant
from vorotool.frozen import frozen
from vorotool.numeric.arrays import following, owners, starts_of, within
from vorotool.numeric.curves.flatten import chords_of, cubic_polylines, polylines
from vorotool.numeric.curves.mixed_arcs import MixedArcs
from vorotool.numeric.numbers import shown_number
from vorotool.products.formats import resolved
from vorotool.products.registry import is_of
from vorotool.render.canvas.styles import INK, SEED, PictureStyle, edge_color
from vorotool.types.box import bounds
from vorotool.types.fields import is_up
from vorotool.types.identity import column_of
from vorotool.types.pixels import PixelGrid

MARGIN = 0.02
"""Of the larger side of the data, on each side of the page, where nothing else says."""

TALLEST = 4
"""A page is at most so many times as high as wide: narrower data are drawn smaller."""


@frozen(eq=False)
class Lines:
    """Straight lines."""

    name: str  # of the layer: the id of its group in SVG
    points: NDArray[np.float64]  # (n, 2) float64 array: finite coordinates
    pairs: NDArray[np.int32]  # (m, 2) int32 array: ends of each line, indices of points
    color: str = INK
    width: float = 1.5  # in px, whatever the scale

    @classmethod
    def between(cls, name: str, ends: NDArray[np.float64], color: str = INK, width: float = 1.5) -> Lines:
        """Make a line between each pair of (m, 2, 2) ends."""
        return cls(name, ends.reshape(-1, 2), np.arange(2 * len(ends), dtype=np.int32).reshape(-1, 2), color, width)


@frozen(eq=False)
class Curves:
    """Straight lines, quadratic Bezier curves and circular arcs; those that follow each other are drawn as one path."""

    name: str  # as of `Lines`, like the points, pairs, color and width
    points: NDArray[np.float64]
    pairs: NDArray[np.int32]
    control: NDArray[np.int32]  # (m,) int32 array: the control point of each; -1: it is a straight line
    color: str = INK
    width: float = 1.5
    is_broken: bool = False  # drawn as a broken line in SVG
    # (m, 2) float64 array: of the circle of each circular arc, which is at most half of one; NaN of others
    center: NDArray[np.float64] | None = None
    # (m,) bool array: whether each arc turns counter-clockwise with y upwards; there if there are centers
    is_left: NDArray[np.bool_] | None = None

    def polylines(self, tolerance: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Give places along each curve, its ends included, and where those of each begin."""
        source, target = self.points[self.pairs.T]
        control, is_bent = self.points[self.control], self.control >= 0
        if self.center is None or self.is_left is None:
            return polylines(source, control, target, is_bent, tolerance)
        control = np.where(is_bent[:, None], control, np.nan)
        return MixedArcs(source, target, control, self.center, self.is_left).polylines(tolerance)

    def chords(self, tolerance: float) -> Lines:
        """Straight lines instead of the curves, which are off by no more than a length of the data."""
        points, start = self.polylines(tolerance)
        first = np.delete(np.arange(len(points)), start[1:] - 1)
        return Lines(self.name, points, np.stack([first, first + 1], axis=1).astype(np.int32), self.color, self.width)


@frozen(eq=False)
class Polygons:
    """Polygons of one or more rings each, filled by the even-odd rule."""

    name: str
    points: NDArray[np.float64]
    # (k,) int32 array: indices of points, ring after ring; rings are not closed by repetition
    corners: NDArray[np.int32]
    rings: NDArray[np.int64]  # (r + 1,) integer array: where each ring begins in `corners`, and `k`
    # (p + 1,) integer array: where each polygon begins among the rings, and `r`; by default each ring is a polygon
    first_rings: NDArray[np.int64] | None = None
    colors: Sequence[str] = ("#ffffff",)
    # (p,) integer array: index of each polygon's fill; by default all have the first
    color_of: NDArray[np.integer] | None = None
    # id of each polygon in SVG: each is a path of its own then, unless they are too many
    ids: Sequence[str] | None = None
    edge: str | None = None  # color of the outlines
    width: float = 1.5  # of the outlines, in px
    # (p,) bool array: polygons that are paths of their own in SVG in any case, since others lie over them
    is_alone: NDArray[np.bool_] | None = None
    is_sheer: bool = False  # half of what lies beneath is seen through the fills, as it is over an image in any case
    # each has a hair of its own color around it, so that nothing shines through between neighbors
    is_sealed: bool = False

    @property
    def ring_limits(self) -> NDArray[np.int64]:
        """(p + 1,) where each polygon begins among the rings."""
        if self.first_rings is not None:
            return np.asarray(self.first_rings, dtype=np.int64)
        return np.arange(len(self.rings), dtype=np.int64)

    @property
    def polygon_of_ring(self) -> NDArray[np.int64]:
        """(r,) polygon that each ring belongs to."""
        limits = self.ring_limits
        return owners(np.diff(limits))

    def sides(self) -> NDArray[np.int32]:
        """(k, 2) corners at the ends of each side, in the order of ``corners``."""
        rings = np.asarray(self.rings)
        after = following(rings[np.append(rings[1:] > rings[:-1], True)])  # no ring is empty
        return np.stack([self.corners, self.corners[after]], axis=1)


@frozen(eq=False)
class CurvedPolygons(Polygons):
    """Polygons whose sides may be curves, which two of them share."""

    curves: Curves = field(kw_only=True)
    # (k,) int32 array: the side that leads on from each corner, counted from 1, below 0 against its direction
    along: NDArray[np.int32] = field(kw_only=True)

    def chords(self, tolerance: float) -> Polygons:
        """Polygons with straight sides instead, which are off by no more than a length of the data."""
        points, start = self.curves.polylines(tolerance)
        side, is_back = np.abs(self.along) - 1, self.along < 0
        sizes = np.diff(start)[side] - 1
        row, step = owners(sizes), within(sizes)
        taken = np.where(is_back[row], start[side + 1][row] - 1 - step, start[side][row] + step)
        rings = starts_of(sizes)[np.asarray(self.rings)]
        fills = self.first_rings, self.colors, self.color_of, self.ids
        looks = self.edge, self.width, self.is_alone, self.is_sheer
        return Polygons(self.name, points, taken.astype(np.int32), rings, *fills, *looks)


@frozen(eq=False)
class Points:
    """Discs of one radius, in px; those with a halo, a color, have an edge around them."""

    name: str
    points: NDArray[np.float64]
    color: str = SEED
    radius: float = 2.5
    halo: str | None = None

    @property
    def edge(self) -> float:
        """Width of the halo, in px."""
        return min(1.0, self.radius)


@frozen(eq=False)
class Texts:
    """Short texts beside points."""

    name: str
    points: NDArray[np.float64]
    texts: Sequence[str]
    color: str = INK
    size: float = 12.0  # of the letters, in px
    # color of an edge around the letters, which sets them off from what they lie on; in PNG there always is one
    halo: str | None = None
    is_centered: bool = False  # write them on the points instead, as names of what is around these
    is_led: bool = False  # they begin at the points, and are not in the middle over them

    def lowered(self, y: NDArray[np.float64], capital: float) -> NDArray[np.float64]:
        """Give the px from the top at which the letters stand, for points at these."""
        if self.is_centered:
            return y + self.size * capital / 2
        below = y < (y.min(initial=0.0) + y.max(initial=0.0)) / 2
        return y + self.size * np.where(below, 1.1, -0.5)


@frozen(eq=False)
class Arcs:
    """Closed curves of circular arcs and straight lines, filled by the even-odd rule or not at all."""

    name: str
    # (k, 2) float64 array: of each arc, which is at most half a circle; the center of a straight line is NaN
    start: NDArray[np.float64]
    # (k, 2) float64 array: of each arc, which is at most half a circle; the center of a straight line is NaN
    end: NDArray[np.float64]
    # (k, 2) float64 array: of each arc, which is at most half a circle; the center of a straight line is NaN
    center: NDArray[np.float64]
    rings: NDArray[np.int64]  # (r + 1,) integer array: where each curve begins among the arcs, and `k`
    fill: str | None
    edge: str
    width: float = 1.5  # of the curves, in px
    # (k,) bool array: whether each arc turns counter-clockwise with y upwards; by default none does
    is_left: NDArray[np.bool_] | None = None

    @property
    def points(self) -> NDArray[np.float64]:
        """(k, 2) where arcs begin, and so end."""
        return self.start

    @property
    def turns_left(self) -> NDArray[np.bool_]:
        """(k,) whether each arc does."""
        return np.zeros(len(self.start), dtype=bool) if self.is_left is None else self.is_left

    def chords(self, tolerance: float) -> Polygons | Lines:
        """Chords instead that are off by no more than a length of the data; only lines if there is no fill."""
        places, first = chords_of(self.start, self.end, self.center, self.turns_left, tolerance)
        corners, rings = np.arange(len(places), dtype=np.int32), first[self.rings]
        whole = np.array([0, len(self.rings) - 1]) if len(self.rings) > 1 else None
        colors = [self.edge if self.fill is None else self.fill]
        filled = Polygons(self.name, places, corners, rings, whole, colors, edge=self.edge, width=self.width)
        return Lines(self.name, places, filled.sides(), self.edge, self.width) if self.fill is None else filled


def name_size(page: Page, count: int) -> float:
    """Give the size in px of the names of so many objects, which get smaller where these are many."""
    return min(max(page.spacing(count) / 4, 6.0), 16.0)


Layer = Lines | Curves | Polygons | Points | Texts | Arcs
Makers = dict[str, Callable[[], list[Layer]]]
"""What makes the layers of each name, from below."""


def checked_layers(layers: Iterable[str], known: Sequence[str]) -> frozenset[str]:
    """Return the layers as a set."""
    wanted = tuple(layers)
    for layer in wanted:
        if layer not in known:
            raise UsageError(
                f"the layer {shown_number(layer)} does not exist: use {', '.join(known)}{meant(layer, known)}"
            )
    return frozenset(wanted)


def made_layers(layers: Iterable[str], make: Makers) -> list[Layer]:
    """Make the layers that are wanted."""
    wanted = checked_layers(layers, tuple(make))
    return [layer for name, own in make.items() if name in wanted for layer in own()]


def bounds_of(*places: NDArray[np.float64]) -> tuple[float, float, float, float]:
    """Smallest box that holds places: least x, least y, largest x, largest y."""
    used = [bounds(each) for each in places if len(each)]
    if not used:
        return (0.0, 0.0, 1.0, 1.0)
    low, high = np.min([low for low, _ in used], axis=0), np.max([high for _, high in used], axis=0)
    return (*low.tolist(), *high.tolist())


class Page:
    """Where the data are on the page."""

    style = PictureStyle()
    decimals = 2

    def __init__(
        self,
        bounds: tuple[float, float, float, float],
        *,
        width: int,
        y_up: bool,
        aspect: float = 1.0,
        margin: float = MARGIN,
    ) -> None:
        self.bounds, self.aspect = bounds, aspect
        box = np.array(bounds, dtype=np.float64)
        self._exponent = int(np.frexp(np.abs(box).max())[1])  # a power of two keeps differences within range
        low, high = np.ldexp(box, -self._exponent).reshape(2, 2)
        span = high - low
        sides = span * (1.0, aspect)
        across, down = sides + 2 * margin * (sides.max() or 1.0)
        self.scale = float(min(width / across, TALLEST * width / down))  # px a unit of the scaled data
        self.width, self.height = width, max(1, round(float(down * self.scale)))
        self.y_up, self._middle = y_up, low + span / 2
        self._rest = (low - self._middle) + span / 2  # of the middle of places that are neighbors, half their distance

    @property
    def backdrop(self) -> Backdrop | None:
        """The ground beneath the layers."""
        return None

    @property
    def size(self) -> str:
        """Attributes of its size in SVG."""
        return f'width="{self.width}" height="{self.height}"'

    @property
    def extent(self) -> str:
        """Its width and height in px, as a viewBox has them."""
        return f"{self.width} {self.height}"

    def place(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 2) px from the left and from the top."""
        scale = np.array([self.scale, (-self.scale if self.y_up else self.scale) * self.aspect])
        center = np.array([self.width / 2, self.height / 2])
        return (np.ldexp(points, -self._exponent) - self._middle - self._rest) * scale + center

    def length(self, distance: float) -> float:
        """Px of a distance along x."""
        return float(np.ldexp(distance, -self._exponent) * self.scale)

    def distance(self, length: float) -> float:
        """Give a length in px as one of the data, which is no longer than that in any direction."""
        return float(np.ldexp(length / (self.scale * max(self.aspect, 1.0)), self._exponent))

    def spacing(self, count: int) -> float:
        """Distance in px between neighbors of so many points, spread evenly over the page."""
        return math.sqrt(self.width * self.height / max(count, 1))


@frozen(eq=False)
class Backdrop:
    """An image to draw over."""

    pixels: NDArray[np.uint8]  # (H, W, 3) uint8 array: red, green and blue
    encode: Callable[[], bytes]  # gives the image as the bytes of a PNG file
    y_up: bool = False  # what is drawn over it has y upwards: row r is at y = -r
    grid: PixelGrid | None = None  # what its file says of its pixels
    side: float = 1.0  # of a pixel, in the coordinates of what is drawn over it


class ImagePage(Page):
    """The page of an image: a px is a pixel, whose center is at integers of the data."""

    def __init__(self, backdrop: Backdrop) -> None:
        height, width = backdrop.pixels.shape[:2]
        top = 0.5 - height if backdrop.y_up else -0.5
        box = (-0.5, top, width - 0.5, top + height)
        left, low, right, high = (edge * backdrop.side for edge in box)
        super().__init__((left, low, right, high), width=width, y_up=backdrop.y_up)
        self.height, self._backdrop = height, backdrop

    @property
    def backdrop(self) -> Backdrop:
        """The image."""
        return self._backdrop

    def place(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 2) px from the left and from the top."""
        return (points * (1.0, -1.0) if self.y_up else points) / self._backdrop.side + 0.5

    def length(self, distance: float) -> float:
        """Px of a distance."""
        return distance / self._backdrop.side


def halo_width(width: float) -> float:
    """Give the width of a line with an edge of up to 1 px on both sides: many fine lines leave no more room."""
    return width + min(2.0, 2 * width)


def with_halos(layers: Sequence[Layer]) -> list[Layer]:
    """Put an edge beneath each layer of lines and of points, so that they show on dark and on light ground."""
    made: list[Layer] = []
    for layer in layers:
        name = f"{layer.name}-halo"
        if isinstance(layer, Arcs):
            made.append(
                replace(layer, name=name, width=halo_width(layer.width), edge=edge_color(layer.edge), fill=None)
            )
        elif isinstance(layer, Lines | Curves):
            made.append(replace(layer, name=name, width=halo_width(layer.width), color=edge_color(layer.color)))
        elif isinstance(layer, Points):
            made.append(replace(layer, halo=edge_color(layer.color)))
            continue
        made.append(layer)
    return made


@frozen(eq=False)
class Circles(Arcs):
    """Circles, each of two arcs of half of it; see `circles`."""

    @property
    def radius(self) -> NDArray[np.float64]:
        """(n,) of the circles."""
        return np.asarray((self.start[::2, 0] - self.end[::2, 0]) / 2)


def circles(name: str, xy: NDArray[np.float64], radius: NDArray[np.float64], edge: str, width: float) -> Circles:
    """Give a layer of circles that are not filled."""
    right, left = (xy + way * radius[:, None] * (1, 0) for way in (1, -1))
    start, end = (np.stack(ends, axis=1).reshape(-1, 2) for ends in ((right, left), (left, right)))
    rings = np.arange(0, 2 * len(xy) + 1, 2)
    return Circles(name, start, end, np.repeat(xy, 2, axis=0), rings, None, edge, width, np.ones(2 * len(xy), bool))


@frozen(eq=False)
class CubicCurves(Curves):
    """Cubic Bézier curves."""

    second: NDArray[np.int32] = field(kw_only=True)  # (m,) int32 array: its second one

    def polylines(self, tolerance: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """As of `Curves`."""
        control = np.stack([self.pairs[:, 0], self.control, self.second, self.pairs[:, 1]], axis=1)
        return cubic_polylines(self.points[control], tolerance)


def column_texts(properties: Mapping[str, Sequence[Any]], column: str | None, ids: Iterable[Any]) -> list[str]:
    """Give what is written on objects."""
    return [text_of(value) for value in (ids if column is None else column_of(properties, column) or ())]


def text_of(value: Any) -> str:
    """Give a value as what is written, shortest; nothing for what is missing."""
    if value is None or value is np.ma.masked:
        return ""
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return "" if value != value else repr(value).removesuffix(".0")  # noqa: PLR0124  # NaN is not itself
    return str(value).strip()


def without_empty(texts: Texts) -> Texts:
    """Leave out the places where nothing is written."""
    kept = [k for k, text in enumerate(texts.texts) if text]
    if len(kept) == len(texts.texts):
        return texts
    return replace(texts, points=texts.points[kept], texts=[texts.texts[k] for k in kept])


def page_of(value: Any, *, width: int = 1000, bounds: tuple[float, float, float, float] | None = None) -> Page:
    """Make the page of a picture: with all that is drawn of a value, or with other bounds."""
    is_in_space = is_of(value, "Tetrahedralization", "SpaceAlphaShape")
    if bounds is None:
        places = [resolved("render.layers.mesh:seen")(value.points)] if is_in_space else value._shown_places()
        bounds = bounds_of(*places)
    return Page(bounds, width=width, y_up=is_up(value) or is_in_space)
