"""The two places where the boundary is touched at necks, and how far they are from each other."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.necks.axis import Ways
from vorotool.numeric.arrays import Floats, Indices
from vorotool.plain import plain
from vorotool.types.polygons.input_vertices import projected
from vorotool.types.skeleton.skeleton import EDGE, Skeleton

_CLOSE = 2.0**-50
"""Part of a width: as a double it is rounded by at most 4 units of 2^-53."""

_SNAP = 4
"""Ulp of the largest coordinate by which the projection of a place half-way along a plateau is rounded at most."""


@plain(eq=False)
class Feet:
    """Feet of necks: left and right of the way from the first of their ways to the second."""

    site: Indices  # (n, 2) int64 array: what each foot is on
    xy: Floats  # (n, 2, 2) float64 array: where they are
    width: Floats  # (n,) float64 array: between them
    # (n, 2) int64 array: the exact square of the width in steps of the lattice. Between two vertices it is the first
    # number, the second is 0. Else one is on an edge: it is the square of the first number over the second, the
    # square of the length of that edge
    square: Indices

    def taken(self, chosen: NDArray[np.bool_] | Indices) -> Feet:
        """Those of some necks."""
        return Feet(self.site[chosen], self.xy[chosen], self.width[chosen], self.square[chosen])


def feet_of(skeleton: Skeleton, ways: Ways) -> Feet:
    """Find both feet: a vertex, where one is touched; on an edge, the place nearest to the other foot."""
    site = _sites(skeleton, ways)
    ends, is_edge = skeleton.site_ends[site], _is_edge(skeleton)[site]
    xy = ends[:, :, 0].copy()
    both = is_edge.all(axis=1)
    tolerance = _SNAP * float(np.spacing(np.abs(skeleton.polygons.xy).max(initial=1.0)))
    for hand in (0, 1):
        alone = is_edge[:, hand] & ~both
        xy[alone, hand] = projected(ends[alone, hand], ends[alone, 1 - hand, 0])
        xy[both, hand] = _at_ends(projected(ends[both, hand], ways.middle[both]), ends[both, hand], tolerance)
    width, square = _widths(skeleton, ends, is_edge)
    return Feet(site, xy, width, square)


def _is_edge(skeleton: Skeleton) -> NDArray[np.bool_]:
    found: NDArray[np.bool_] = skeleton.site_table.kind == EDGE
    return found


def _sites(skeleton: Skeleton, ways: Ways) -> Indices:
    """(n, 2) the sites left and right of each neck; where they change there, the vertex."""
    is_edge = _is_edge(skeleton)
    sites = skeleton.sites[ways.arc].astype(np.int64)  # (n, way, hand)
    # from the first way to the second: the first is walked towards its end at the neck, the second from there
    turned = ways.end == (0, 1)
    sites = np.where(turned[:, :, None], sites[:, :, ::-1], sites)
    first, second = sites[:, 0], sites[:, 1]
    return np.where(is_edge[first] & ~is_edge[second], second, first)


def _at_ends(foot: Floats, edge: Floats, tolerance: float) -> Floats:
    """Feet, but the end of the edge where this is where rounding may have kept them from."""
    for end in (0, 1):
        is_off = np.abs(foot - edge[:, end]).max(axis=1, keepdims=True) > tolerance
        foot = np.where(is_off, foot, edge[:, end])
    return foot


def _widths(skeleton: Skeleton, ends: Floats, is_edge: NDArray[np.bool_]) -> tuple[Floats, Indices]:
    """Distances between the sites of each neck: products of coordinates below 2^30 in magnitude fit in 64 bits."""
    step = skeleton.scale or 1.0
    places = np.rint((ends - np.asarray(skeleton.origin)) / step).astype(np.int64)
    turned = is_edge[:, 1]
    edge = np.where(turned[:, None, None], places[:, 1], places[:, 0])
    point = np.where(turned[:, None], places[:, 0, 0], places[:, 1, 0])
    way, to_point = edge[:, 1] - edge[:, 0], point - edge[:, 0]
    cross = np.abs(way[:, 0] * to_point[:, 1] - way[:, 1] * to_point[:, 0])
    between, along = np.square(to_point).sum(axis=1), np.square(way).sum(axis=1)
    has_edge = is_edge[:, 0] | is_edge[:, 1]
    square = np.where(has_edge[:, None], np.stack([cross, along], axis=1), np.stack([between, 0 * between], axis=1))
    length = np.sqrt(np.maximum(along, 1).astype(np.float64))
    width = np.where(has_edge, cross / length, np.sqrt(between.astype(np.float64)))
    return step * width, square


def by_width(square: Indices) -> Indices:
    """Give the numbers of necks from the widest to the narrowest, of equal ones the last first."""
    kinds, of = np.unique(square, axis=0, return_inverse=True)
    rank = _ranks(kinds)[of.reshape(-1)]
    return np.lexsort((np.arange(len(rank)), rank))[::-1]


def _ranks(kinds: Indices) -> Indices:
    """Numbers that rise with squares, the same for equal ones."""
    length = np.sqrt(np.maximum(kinds[:, 1], 1).astype(np.float64))
    rounded = np.where(kinds[:, 1] > 0, kinds[:, 0] / length, np.sqrt(kinds[:, 0].astype(np.float64)))
    order = np.argsort(rounded, kind="stable")
    is_apart = np.diff(rounded[order]) > _CLOSE * rounded[order[1:]]
    group = np.concatenate([[0], np.cumsum(is_apart)])[: len(order)]
    rank = np.empty(len(kinds), dtype=np.int64)
    rank[order] = group << 32
    for members in np.split(order, np.flatnonzero(is_apart) + 1):
        if len(members) > 1:
            exact = [_exact(*kind) for kind in kinds[members].tolist()]
            number = {value: k for k, value in enumerate(sorted(set(exact)))}
            rank[members] += [number[value] for value in exact]
    return rank


def _exact(number: int, over: int) -> Fraction:
    return Fraction(number * number, over) if over else Fraction(number)
