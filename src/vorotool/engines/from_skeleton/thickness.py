"""A check of local thickness by the arcs of the skeleton one by one, at some of the pixels."""

from __future__ import annotations

from math import inf, ldexp
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.common import fail
from vorotool.engines.skeleton.parts import core_skeleton, with_arcs
from vorotool.errors import InputError, UsageError
from vorotool.numeric.arrays import Floats, dots, norms
from vorotool.numeric.checks import as_array, checked_threads, described
from vorotool.numeric.numbers import pair_of_doubles, shown_number, whole_number
from vorotool.numeric.parallel import Progress, report
from vorotool.types.arguments import check_value
from vorotool.types.fields import is_up
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton

SLACK = 46
"""A disc covers what is at most 2^-46 of the largest coordinate beyond it: 64 units in the last place of that."""


def thickness_of_pixels(
    skeleton: Skeleton,
    shape: tuple[int, int],
    *,
    sides: tuple[float, float] = (1.0, 1.0),
    threads: int = 0,
    progress: Progress = None,
) -> NDArray[np.float64]:
    """Give for each pixel the diameter of the largest disc inside the polygons that covers its center."""
    check_value(skeleton, "skeleton", "Skeleton")
    if skeleton.gap:
        raise InputError("the skeleton has a gap, so its discs do not touch the outline: compute it without a gap")
    inside = with_arcs(skeleton, skeleton.side == INTERIOR)
    (height, width), (down, across) = shape, map(float, sides)
    lowest = -(height - 1) * down if is_up(skeleton) else 0.0
    made = _core.thickness.local_thickness(
        core_skeleton(inside, threads=threads),
        (0.0, lowest),
        (across, down),
        height,
        width,
        slack_of(inside, shape, sides),
        checked_threads(threads),
        progress,
    )
    return np.ascontiguousarray(made[::-1]) if is_up(skeleton) else made


def slack_of(skeleton: Skeleton, shape: tuple[int, int], sides: tuple[float, float]) -> float:
    """How far beyond a disc a place may be that it is taken to cover: what rounding makes of a place on its rim."""
    reach = max(shape[0] * sides[0], shape[1] * sides[1], np.abs(skeleton.vertices).max(initial=0.0))
    return ldexp(float(reach), -SLACK)


SAMPLES = 128
"""Pixels that are looked at, if there are more."""

RIM = 2.0**-44
"""Of the extent: whether a place so near the rim of a disc is covered is left open."""

BESIDE = 2.0**-10
"""Of a pixel: centers so near the outline, which simplified ones may go through, are neither inside nor outside."""

ROUNDING = 2.0**-36
"""Of the extent: values differ by no more."""


def verify_thickness(
    thickness: Floats,
    skeleton: Skeleton,
    *,
    sides: tuple[float, float] = (1.0, 1.0),
    samples: int = SAMPLES,
    progress: Progress = None,
) -> None:
    """Check the local thickness of an image at pixels spread over it.

    The value is the largest diameter of all discs centered on the skeleton that cover the center of the pixel, found by
    the roots of a polynomial for each arc; it is at least twice the distance from the outlines, and 0 just outside of
    these. Pixels whose centers are on an outline are left out: there no digit of a value is sure.

    Parameters
    ----------
    thickness : (H, W) float64 array
        However it was computed.
    skeleton : Skeleton
        Of the outlines, neither pruned nor with a gap.
    sides : (float, float)
        Height and width of a pixel.
    samples : int
        Pixels to look at: half of them among those that are not 0.
    progress : callable, optional
        Called with the fraction done.

    Raises
    ------
    VerificationError
        Naming the first pixel that is wrong.

    Examples
    --------
    >>> from vorotool import outlines, skeleton_exact
    >>> skeleton = skeleton_exact(outlines(np.ones((3, 5), dtype=bool)))
    >>> verify_thickness(np.full((3, 5), 3.0), skeleton)
    >>> verify_thickness(np.full((3, 5), 2.0), skeleton)
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: the thickness in row 0, column 0 is 2.0, but discs of 3.0 to 3.0 cover it
    """
    check_value(skeleton, "skeleton", "Skeleton")
    thickness, sides = _values(thickness), pair_of_doubles(sides, "sides")
    if not all(0 < side < inf for side in sides):
        raise UsageError(f"sides is {shown_number(sides)}: give numbers above 0, (height, width)")
    if whole_number(samples, "samples") < 1:
        raise UsageError(f"samples is {shown_number(samples)}: give at least 1")
    height, width = thickness.shape
    discs = _Discs(skeleton)
    extent = max(height * sides[0], width * sides[1], discs.extent)
    chosen = _spread(thickness, samples)
    for done, pixel in enumerate(chosen.tolist()):
        row, column = divmod(pixel, width)
        place = np.array([column * sides[1], (-row if is_up(skeleton) else row) * sides[0]], dtype=np.float64)
        found, named = float(thickness[row, column]), f"the thickness in row {row}, column {column}"
        distance = discs.distance(place)
        if distance > BESIDE * min(sides):
            _check_pixel(discs, place, found, distance, extent, named)
        report(progress, (done + 1) / len(chosen))


def _values(thickness: Any) -> Floats:
    """Check that it is an image of numbers."""
    values = as_array(thickness, "thickness")
    if values.ndim != 2 or values.dtype.kind not in "biuf":
        raise InputError(f"invalid thickness: expected numbers of shape (H, W), but got {described(thickness)}")
    return values.astype(np.float64, copy=False)


def _check_pixel(discs: _Discs, place: Floats, found: float, distance: float, extent: float, named: str) -> None:
    least, most = (2 * discs.largest_over(place, rim) for rim in (-RIM * extent, RIM * extent))
    if not least - ROUNDING * extent <= found <= most + ROUNDING * extent:
        fail(f"{named} is {found}, but discs of {least} to {most} cover it")
    if discs.holds(place) != (found > 0):
        fail(f"{named} is {found}, but it is {'inside' if found <= 0 else 'outside'}")
    if found > 0 and found < 2 * distance - ROUNDING * extent:
        fail(f"{named} is {found}, but it is {distance} from the outlines")


def _spread(thickness: Floats, samples: int) -> NDArray[np.int64]:
    """Numbers of pixels at even steps: among all, and among those with a thickness."""
    flat = thickness.reshape(-1)
    inner = np.flatnonzero(flat)
    if len(flat) <= samples:
        return np.arange(len(flat))
    steps = np.arange(samples // 2) / (samples // 2)
    of_inner = inner[(steps[: len(inner)] * len(inner)).astype(np.int64)]
    return np.unique(np.concatenate([(steps * len(flat)).astype(np.int64), of_inner]))


class _Discs:
    """The discs of a skeleton inside polygons, and their outlines."""

    def __init__(self, skeleton: Skeleton) -> None:
        inside = skeleton.side == INTERIOR
        arcs, sites = skeleton.arcs[inside], skeleton.sites[inside]
        self.source, self.target = skeleton.vertices[arcs].swapaxes(0, 1)
        self.radius = skeleton.radius[arcs]
        control = skeleton.control[inside]
        middle = np.where(np.isnan(control), (self.source + self.target) / 2, control)
        self.bend, self.way = self.source - 2 * middle + self.target, 2 * (middle - self.source)
        is_edge, ends = skeleton.site_table.kind[sites] == EDGE, skeleton.site_ends
        self.is_linear = is_edge.all(axis=1)
        self.focus = np.where(is_edge[:, :1], ends[sites[:, 1], 0], ends[sites[:, 0], 0])
        self.reach = self.radius.max(axis=1, initial=0.0) + skeleton.length[inside]
        self._columns = np.ascontiguousarray(self.source.T)
        xy, polygons = skeleton.polygons.xy, skeleton.polygons
        self.first, self.last = np.ascontiguousarray(xy.T), np.ascontiguousarray(xy[polygons.following].T)
        self.polygon = np.repeat(polygons.ring_polygon, np.diff(polygons.ring_starts))
        self.is_line = polygons.is_line
        self.extent = float(np.abs(xy).max(initial=0.0))

    def largest_over(self, place: Floats, rim: float) -> float:
        """The largest radius of a disc, so much larger, that covers a place; 0 if none does."""
        near = np.flatnonzero(_squared(place, self._columns) <= np.square(self.reach + abs(rim)))
        largest = 0.0
        for end, radius in ((self.source, self.radius[:, 0]), (self.target, self.radius[:, 1])):
            distance = norms(place - end[near])
            largest = max(largest, radius[near][distance <= radius[near] + rim].max(initial=0.0))
        u, of_root = self._roots(place, near)
        radii = self._radius_at(u, of_root)
        within = (u >= 0) & (u <= 1)
        return float(max(largest, radii[within].max(initial=0.0)))

    def _roots(self, place: Floats, near: NDArray[np.int64]) -> tuple[Floats, NDArray[np.int64]]:
        """Where the rims of the discs of some arcs go through a place, and on which arcs."""
        to_focus, to_source = place - self.focus[near], place - self.source[near]
        way, radius = (self.target - self.source)[near], self.radius[near]
        growth = radius[:, 1] - radius[:, 0]
        linear = (dots(way, way) - growth * growth, -dots(way, to_source) - growth * radius[:, 0])
        bent = (-2 * dots(self.bend[near], to_focus), -dots(self.way[near], to_focus))
        start = dots(to_focus, to_focus) - 2 * dots(self.source[near] - self.focus[near], to_focus)
        is_linear = self.is_linear[near]
        a, b = np.where(is_linear, linear, bent)
        c = np.where(is_linear, dots(to_source, to_source) - radius[:, 0] * radius[:, 0], start)
        with np.errstate(divide="ignore", invalid="ignore"):
            sums = -(b + np.copysign(np.sqrt(b * b - a * c), b))
            u = np.concatenate([sums / a, c / sums])
        kept = np.isfinite(u)
        return u[kept], np.concatenate([near, near])[kept]

    def _radius_at(self, u: Floats, arc: NDArray[np.int64]) -> Floats:
        center = self.source[arc] + u[:, None] * (self.way[arc] + u[:, None] * self.bend[arc])
        source, target = self.radius[arc].T
        from_focus = norms(center - self.focus[arc])
        return np.asarray(np.where(self.is_linear[arc], source + u * (target - source), from_focus))

    def distance(self, place: Floats) -> float:
        """From the nearest outline."""
        (x, y), way = place[:, None] - self.first, self.last - self.first
        length = way[0] * way[0] + way[1] * way[1]
        part = np.divide(x * way[0] + y * way[1], length, out=np.zeros_like(length), where=length > 0).clip(0, 1)
        squares = np.square(x - part * way[0]) + np.square(y - part * way[1])
        return float(np.sqrt(squares.min(initial=np.inf)))

    def holds(self, place: Floats) -> bool:
        """Whether a place is inside a polygon, by the even-odd rule."""
        meets = np.flatnonzero((self.first[1] > place[1]) != (self.last[1] > place[1]))
        (x0, y0), (x1, y1) = self.first[:, meets], self.last[:, meets]
        crosses = meets[x0 + (place[1] - y0) * (x1 - x0) / (y1 - y0) > place[0]]
        odd = np.bincount(self.polygon[crosses], minlength=len(self.is_line)) % 2 == 1
        return bool((odd & ~self.is_line).any())


def _squared(place: Floats, columns: Floats) -> Floats:
    """Squares of distances from some places."""
    return np.asarray(np.square(columns[0] - place[0]) + np.square(columns[1] - place[1]))
