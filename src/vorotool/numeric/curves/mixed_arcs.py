"""Arcs of three kinds, straight lines, parabolas and circular arcs: lengths, areas beside them, polylines."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from vorotool.frozen import frozen
from vorotool.numeric.arrays import Columns, Floats, Indices, crosses, dots, norms, ranges, starts_of
from vorotool.numeric.curves.flatten import chords_of, polylines
from vorotool.numeric.curves.inverse_functions import PI, hypotenuse, inverse_sine, inverse_sinh

_SMALL = 0.25
"""Sines of half angles up to which segments of circles are sums of series: beyond, four bits at most are lost."""

_LARGE = 0.998
"""Sines of half angles from which angles are those of cosines: a sine tells little of an angle near a quarter turn."""

_TERMS = 15
"""Of the series: the next one is below 2^-60 of the first where the sine is small."""


@frozen(eq=False)
class MixedArcs(Columns):
    """Arcs with two ends each."""

    source: Floats  # (n, 2) float64 array: the ends
    target: Floats  # (n, 2) float64 array: the ends
    # (n, 2) float64 array: the control point of a quadratic Bezier curve, which each parabola is; NaN of other arcs
    control: Floats
    center: Floats  # (n, 2) float64 array: of the circle of each circular arc; NaN of other arcs
    is_left: NDArray[np.bool_]  # (n,) bool array: whether a circular arc goes counter-clockwise around its center

    def reversed(self, chosen: NDArray[np.bool_]) -> MixedArcs:
        """The same arcs, some the other way round."""
        ends = (self.source, self.target)
        source, target = (np.where(chosen[:, None], a, b) for a, b in (ends[::-1], ends))
        return replace(self, source=source, target=target, is_left=self.is_left ^ chosen)

    @property
    def is_circle(self) -> NDArray[np.bool_]:
        """(n,) whether each is a circular arc."""
        return ~np.isnan(self.center[:, 0])

    @cached_property
    def lengths(self) -> Floats:
        """(n,) lengths."""
        lengths = lengths_of(self.source, self.control, self.target)
        circles = np.flatnonzero(self.is_circle)
        if circles.size:
            radius, sine, cosine, is_over = self._half_angles(circles)
            angle = 2 * _angles_of(sine, cosine)
            lengths[circles] = radius * np.where(is_over, 2 * PI - angle, angle)
        return lengths

    def areas_beside(self, place: Floats) -> Floats:
        """(n,) signed areas between a place and arcs, as of `areas_beside`."""
        areas = areas_beside(self.source, self.control, self.target, place)
        circles = np.flatnonzero(self.is_circle)
        if circles.size:
            radius, sine, cosine, is_over = self._half_angles(circles)
            square = radius * radius
            segment = square * _segments_of(sine, cosine)
            segment = np.where(is_over, PI * square - segment, segment)
            areas[circles] += np.where(self.is_left[circles], segment, -segment)
        return areas

    @cached_property
    def sagittas(self) -> Floats:
        """(n,) how far circular arcs are from their chords; infinity of other arcs."""
        sagittas = np.full(len(self.source), np.inf)
        circles = np.flatnonzero(self.is_circle)
        if circles.size:
            radius, sine, cosine, is_over = self._half_angles(circles)
            sagittas[circles] = radius * np.where(is_over, 1 + cosine, sine * sine / (1 + cosine))
        return sagittas

    def polylines(self, tolerance: float | Floats) -> tuple[Floats, Indices]:
        """Give each arc as a polyline; circular arcs are at most half a circle."""
        is_parabola = ~np.isnan(self.control[:, 0])
        made, made_start = polylines(self.source, self.control, self.target, is_parabola, tolerance)
        circles = np.flatnonzero(self.is_circle)
        if not circles.size:
            return made, made_start
        of_circles = np.broadcast_to(tolerance, len(self.source))[circles]
        arcs = self[circles]
        inner, first = chords_of(arcs.source, arcs.target, arcs.center, arcs.is_left, of_circles)
        sizes = np.diff(made_start)
        sizes[circles] = np.diff(first) + 1
        start = starts_of(sizes)
        points = np.empty((int(start[-1]), 2))
        points[start[1:] - 1] = self.target
        others = np.flatnonzero(~self.is_circle)
        points[ranges(start[others], sizes[others])] = made[ranges(made_start[others], sizes[others])]
        points[ranges(start[circles], sizes[circles] - 1)] = inner
        return points, start

    def _half_angles(self, circles: Indices) -> tuple[Floats, Floats, Floats, NDArray[np.bool_]]:
        """Radius, sine and cosine of half the angle, and whether that is over half a turn, of circular arcs."""
        a, b = self.source[circles] - self.center[circles], self.target[circles] - self.center[circles]
        radius, chord = hypotenuse(*a.T), hypotenuse(*(b - a).T)
        cross = crosses(a, b)
        sine = np.minimum(np.divide(chord, 2 * radius, out=np.zeros_like(chord), where=radius > 0), 1)
        cosine = np.sqrt((1 - sine) * (1 + sine))
        np.divide(np.abs(cross), chord * radius, out=cosine, where=sine > _LARGE)
        return radius, sine, cosine, np.where(self.is_left[circles], cross < 0, cross > 0)


def _angles_of(sine: Floats, cosine: Floats) -> Floats:
    """Angles up to a quarter turn."""
    is_large = sine > _LARGE
    angle = inverse_sine(np.where(is_large, cosine, sine))
    return np.where(is_large, PI / 2 - angle, angle)


def _segments_of(sine: Floats, cosine: Floats) -> Floats:
    """Areas between chords of the unit circle and their arcs, from half the angle, up to half a circle."""
    area = _angles_of(sine, cosine) - sine * cosine
    small = np.flatnonzero(sine <= _SMALL)
    s = sine[small]
    square, total, coefficient = s * s, np.zeros(len(s)), 1.0
    power = 2 * s * square
    for k in range(_TERMS):
        total += coefficient * power / (2 * k + 3)
        power = power * square
        coefficient *= (2 * k + 1) / (2 * k + 2)
    area[small] = total
    return area


def areas_beside(source: Floats, control: Floats, target: Floats, center: Floats) -> Floats:
    """(n,) signed areas between a place and curves: positive where they go counter-clockwise around it."""
    a, b = source - center, target - center
    triangle = (crosses(a, b)) / 2
    u, v = control - source, target - source
    beside = (crosses(u, v)) / 3
    return triangle + np.where(np.isnan(beside), 0, beside)


def lengths_of(source: Floats, control: Floats, target: Floats) -> Floats:
    """(n,) lengths of curves."""
    length = norms(target - source)
    bent = np.flatnonzero(~np.isnan(control[:, 0]))
    first, second = control[bent] - source[bent], target[bent] - control[bent]
    bend = second - first
    size = norms(bend)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        axis = bend / size[:, None]
        along = np.abs(crosses(first, axis))
        s0, s1 = (dots(way, axis) / along for way in (first, second))
        curved = along * along / size * _rise(s0, s1, size / along)
    folded = norms(first) + norms(second)
    length[bent] = np.where((size > 0) & (along > 0) & np.isfinite(curved), curved, folded)
    return length


def _rise(s0: Floats, s1: Floats, step: Floats) -> Floats:
    """The difference of s w + asinh s, w = sqrt(1 + s^2), from s0 to s1, a known step above it."""
    w0, w1 = np.sqrt(1 + s0 * s0), np.sqrt(1 + s1 * s1)
    same = s0 * s1
    products = (w0 + w1) / 2 + (s0 + s1) * (s0 + s1) / (2 * (w0 + w1))
    outer = np.where(same > 0, (1 + s0 * s0 + s1 * s1) / (w0 * w1 + same), w0 * w1 - same)
    return step * products + inverse_sinh(np.nan_to_num(step * (1 + outer) / (w0 + w1)))
