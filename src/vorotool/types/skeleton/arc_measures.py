"""Measures along the arcs of a skeleton: places, radii, lengths, the integral of the radius, and clearance."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, dots, norms
from vorotool.numeric.curves.inverse_functions import inverse_sinh
from vorotool.types import fields as f
from vorotool.types.fields import Record, record

if TYPE_CHECKING:
    from vorotool.types.pixels import PixelGrid

_FLAT = 0.125
"""Slopes that differ by less along an arc: 8 Gauss nodes integrate it to 2^-60, where closed forms cancel."""

_GAUSS_RULE = tuple(
    (sign * node, weight)
    for node, weight in (
        (0.1834346424956498, 0.362683783378362),
        (0.525532409916329, 0.31370664587788727),
        (0.7966664774136267, 0.22238103445337448),
        (0.9602898564975363, 0.10122853629037626),
    )
    for sign in (-1, 1)
)
"""Nodes on [-1, 1] and their weights."""

_STEPS = 64
"""Of Newton's method; it ends by itself, since the length is convex in the slope on each side of 0."""


class ArcMeasures:
    """Measures of some arcs of a skeleton, by the parameter u of the Bezier curve that each is: 0 to 1."""

    def __init__(
        self,
        ends: Floats,
        radius: Floats,
        control: Floats,
        sites: Floats,
        is_edge: NDArray[np.bool_],
        length: Floats,
    ) -> None:
        self.source, self.target = np.ascontiguousarray(ends.swapaxes(0, 1))
        self.r0, self.r1 = np.ascontiguousarray(radius.T)
        self.length = length
        self.is_parabola = ~np.isnan(control[:, 0])
        self._control = control
        self.is_parting = ~is_edge.any(axis=0) & ~self.is_parabola
        self._set_slopes(sites[:, :, 0])

    def _set_slopes(self, sites: Floats) -> None:
        """Slopes at the source and the target; between two vertices x / c."""
        self.along, self.half, self.slope0, self.slope1 = np.zeros((4, len(self.length)))
        bent = np.flatnonzero(self.is_parabola)
        growth = self.r1[bent] - self.r0[bent]
        source, target = self.source.take(bent, axis=0), self.target.take(bent, axis=0)
        chord = norms(target - source)
        along = np.sqrt(np.maximum(chord - np.abs(growth), 0) * (chord + np.abs(growth)))
        height = norms(source - 2 * self._control.take(bent, axis=0) + target)
        middle, half_way = _ratio(growth, along), _ratio(height, along)
        self.along[bent], self.slope0[bent], self.slope1[bent] = along, middle - half_way, middle + half_way
        # the left site is to the left of the arc
        apart = np.flatnonzero(self.is_parting)
        left, right = sites.take(apart, axis=1)
        across, between = left - right, (left + right) / 2
        half = norms(across) / 2
        way = np.stack([across[:, 1], -across[:, 0]], axis=1)
        self.half[apart] = half
        for slope, ends in ((self.slope0, self.source), (self.slope1, self.target)):
            slope[apart] = _ratio(dots(ends.take(apart, axis=0) - between, way), 2 * half * half)

    def __getitem__(self, chosen: NDArray[Any]) -> ArcMeasures:
        """Measures of some of the arcs."""
        part = object.__new__(ArcMeasures)
        part.__dict__ = {name: values[chosen] for name, values in self.__dict__.items()}
        return part

    @property
    def control(self) -> Floats:
        """(n, 2) control points; of straight lines half-way."""
        return np.where(self.is_parabola[:, None], self._control, (self.source + self.target) / 2)

    def place(self, u: Floats) -> Floats:
        """(n, 2) a place on each arc."""
        v, control = u[:, None], self.control
        straight = self.source + v * (self.target - self.source)
        bend = self.source - 2 * control + self.target
        bent = self.source + v * (2 * (control - self.source) + v * bend)
        return np.where(v >= 1, self.target, np.where(self.is_parabola[:, None], bent, straight))

    def radius(self, u: Floats) -> Floats:
        """(n,) the radius there."""
        slope = self._slope(u)
        bent = self.r0 + self.along * u * (self.slope0 + slope) / 2
        inner = np.where(self.is_parting, self.half * np.sqrt(1 + slope * slope), self.r0 + u * (self.r1 - self.r0))
        return np.where(u <= 0, self.r0, np.where(u >= 1, self.r1, np.where(self.is_parabola, bent, inner)))

    def _slope(self, u: Floats) -> Floats:
        return self.slope0 + u * (self.slope1 - self.slope0)

    def parameter(self, distance: Floats) -> Floats:
        """(n,) u at a distance along each arc from its source."""
        low, high = np.zeros_like(distance), np.ones_like(distance)
        u = np.clip(_ratio(distance, self.length), 0, 1)
        curved = self.is_parabola & (u > 0) & (u < 1)
        for _ in range(_STEPS):
            excess = self.along * u * mean_root(self.slope0, self._slope(u)) - distance
            low, high = np.where(excess < 0, u, low), np.where(excess > 0, u, high)
            slope = self._slope(u)
            newton = u - _ratio(excess, self.along * np.sqrt(1 + slope * slope))
            better = np.where((newton > low) & (newton < high), newton, (low + high) / 2)
            moves = curved & (excess != 0) & (better != u) & (np.abs(better - u) > np.spacing(u))
            if not moves.any():
                break
            u = np.where(moves, better, u)
        return u

    @property
    def integral(self) -> Floats:
        """(n,) of the radius along each arc."""
        found: Floats = self.length * (self.r0 + self.r1) / 2
        apart = np.flatnonzero(self.is_parting)
        found[apart] = self.half[apart] * self.length[apart] * mean_root(self.slope0[apart], self.slope1[apart])
        bends = self.slope1 - self.slope0
        flat = np.flatnonzero(self.is_parabola & (bends < _FLAT))
        found[flat] = _quadrature(self.r0[flat], self.along[flat], self.slope0[flat], bends[flat])
        steep = np.flatnonzero(self.is_parabola & ~(bends < _FLAT))
        found[steep] = _closed_integral(self.along[steep], self.slope0[steep], self.slope1[steep])
        return found


def _closed_integral(along: Floats, s: Floats, t: Floats) -> Floats:
    """h^2 / 2 times the integral of (1 + x^2)^(3/2) over the slope x from s to t, where h = d / (t - s)."""
    v, w = np.sqrt(1 + s * s), np.sqrt(1 + t * t)
    # s w^3 at both ends, by (t - s) times a sum of positive numbers
    cubes = (v * v * v + w * w * w) / 2 + (s + t) * (s + t) / 2 * (v * v + v * w + w * w) / (v + w)
    return along * along / (2 * (t - s)) * (cubes / 4 + 3 / 4 * mean_root(s, t))


def _quadrature(r0: Floats, along: Floats, slope0: Floats, bend: Floats) -> Floats:
    total = np.zeros_like(r0)
    for node, weight in _GAUSS_RULE:
        u = (node + 1) / 2
        slope = slope0 + u * bend
        radius = r0 + along * u * (slope0 + slope) / 2
        total += weight / 2 * radius * along * np.sqrt(1 + slope * slope)
    return total


def mean_root(s: Floats, t: Floats) -> Floats:
    """Mean of sqrt(1 + x^2) for x from s to t, by sums of positive numbers."""
    v, w = np.sqrt(1 + s * s), np.sqrt(1 + t * t)
    products = (v + w) / 2 + (s + t) * (s + t) / (2 * (v + w))
    same = s * t
    outer = np.where(same > 0, (1 + s * s + t * t) / (v * w + np.abs(same)), v * w - same)
    factor = (1 + outer) / (v + w)
    x = np.abs(t - s) * factor
    ratio = np.where(x > 0, _ratio(inverse_sinh(x), x), 1.0)
    return (products + factor * ratio) / 2


def _ratio(a: Floats, b: Floats) -> Floats:
    """Quotients, 0 where the divisor is."""
    return np.divide(a, b, out=np.zeros(np.broadcast(a, b).shape), where=b != 0)


@frozen(eq=False)
class ClearanceCourse:
    """Signs that decide where the clearance has its extremes; along an arc it is convex, or the same everywhere."""

    # (a, 2) int8 array: how the clearance begins to change where the source, and where the target, is left along the
    # arc: 1 it grows, -1 it shrinks, 0 it is the same on the whole arc. An arc has (1, -1) where it grows from its
    # source to its target, (-1, 1) where it shrinks, (-1, -1) where it is least inside, (0, 0) between parallel edges
    slope: NDArray[np.int8]
    # (a,) float64 array: where it is least on an arc with (-1, -1), from 0 at its source to 1 at its target, by the
    # parameter of the Bezier curve; NaN on others
    least: NDArray[np.float64]


@record
class ThicknessImage(Record):
    """The diameter of the largest inscribed disc over each pixel."""

    values: NDArray[np.float64] = f.length("rows", "columns")  # (H, W) float64 array: 0 where there is no object
    grid: PixelGrid | None = None  # sides and places of the pixels, where the file says them

    @property
    def largest(self) -> float:
        """The largest thickness; 0 without objects."""
        return float(self.values.max(initial=0.0))
