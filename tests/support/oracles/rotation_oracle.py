"""What a rotation may do to skeletons: every vertex moves by at most the placement, and what follows from that.

Let d be the distance from the boundary, and let no vertex be farther than m from where the rotation takes it. Edges are
then within m of each other, and d differs by m at most. The largest disc does too, and what is farther than t from the
boundary lies between what is farther than t + m and t - m: areas of offsets are in that order.

A skeleton as a set does not depend continuously on the boundary: a corner of nearly 180 degrees, bent or not, has a
branch or none. What is true is told place by place. A place with radius r, which two feet are seen from under an angle,
has them nearly at one distance in the other shape: d1 <= d2 <= d1 + 2 m. Straight away from the nearer foot, in
direction n, that is no longer nearest after (d2^2 - d1^2) / (2 (d1 - n . (q - f2))), so that the other skeleton is
within this way of q. One of both feet is seen from the nearest one under half the angle at least, which makes it some
2 m / (1 - cos(angle / 2)): 6.8 m at 90 degrees, 4 m at 120, and nothing where the angle vanishes. So a skeleton pruned
by an angle is within a multiple of the placement of the unpruned one of the rotated shape, but for what leads from one
remaining piece to another under less; and each place of an unpruned skeleton has a bound of its own. Which piece hangs
on which may change: for the other criteria, and for what is left of both, there is no such bound.
"""

from dataclasses import dataclass, replace

import numpy as np

from vorotool import offset, prune, skeleton_exact
from vorotool.engines.skeleton.clearance import SitePlaces
from vorotool.engines.skeleton.parts import with_polygons
from vorotool.engines.skeleton.verify_bounds import distances_to, places_on_arcs

ANGLES = (30, 60, 90, 120)
"""Degrees that skeletons are pruned by."""

INSIDE = np.linspace(0, 1, 5)
"""Where arcs are looked at, by the parameter of the Bezier curve."""

SHARES = (0.2, 0.6, 0.9)
"""Of the largest radius: how far offsets are."""

ROUNDING = 2.0**-46
"""Of the largest coordinate: of centers, feet and distances, some dozens of ulp."""


@dataclass
class Rotation:
    """By a number of degrees."""

    degrees: float

    @property
    def matrix(self):
        angle = np.radians(self.degrees)
        return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def turned(self, xy):
        return xy @ self.matrix.T

    def back(self, xy):
        return xy @ self.matrix


class Pair:
    """The skeletons of a shape and of the rotated one; with a step, its vertices are rounded to multiples of that."""

    def __init__(self, shape, rotation, step=0.0):
        xy = rotation.turned(shape.xy)
        self.first = skeleton_exact(shape, strict=True)
        self.second = skeleton_exact(replace(shape, xy=np.round(xy / step) * step if step else xy), strict=True)
        a, b = self.first.polygons.xy, rotation.back(self.second.polygons.xy)
        self.rotation = rotation
        self.rounding = ROUNDING * max(np.abs(a).max(), np.abs(b).max())
        self.move = float(np.hypot(*(a - b).T).max()) + self.rounding

    def directions(self):
        """Each skeleton with the other one, and what takes its places there."""
        return ((self.first, self.second, self.rotation.turned), (self.second, self.first, self.rotation.back))


def nearest_feet(skeleton, places):
    """(n, 2) the nearest place on the boundary, of all edges, one by one."""
    sites = SitePlaces(skeleton)
    edges = np.flatnonzero(sites.is_edge)
    distance = np.stack([sites.distances(np.full(len(places), k), places) for k in edges])
    return sites.feet(edges[distance.argmin(axis=0)], places)


def fault(pair, worst):
    """What a rotation changes more than it may, in words; None if nothing.

    `worst` keeps the largest moves by angle, as multiples of the placement.
    """
    for *both, to_other in pair.directions():
        for own, other in by_feature(*both):
            wrong = place_fault(own, other, to_other, pair) or pruned_fault(own, other, to_other, pair, worst)
            if wrong:
                return wrong
    return radius_fault(pair) or area_fault(pair)


def by_feature(own, other):
    """What two skeletons have inside each feature: where features overlap, each is as if there were no others."""
    feature = own.polygons.feature
    for each in np.unique(feature[own.polygon]):
        chosen = np.flatnonzero(feature == each)
        yield with_polygons(own, chosen), with_polygons(other, chosen)


def place_fault(own, other, to_other, pair):
    """Places of a skeleton, seen from the other shape: their distance from the boundary, and from its skeleton."""
    places = places_on_arcs(own, INSIDE)
    count = places.shape[1]
    arc = np.repeat(np.arange(len(own)), count)
    q = to_other(places.reshape(-1, 2))
    radius = own.measures(arc).radius(np.tile(INSIDE, len(own)))
    foot = nearest_feet(other, q)
    d1 = np.hypot(*(q - foot).T)
    if (np.abs(d1 - radius) > pair.move + pair.rounding).any():
        return (
            f"the distance from the boundary changes by {np.abs(d1 - radius).max():.3g}, the placement {pair.move:.3g}"
        )
    bound = np.full(len(q), np.inf)
    sites = SitePlaces(other)
    for hand in (0, 1):
        second = sites.feet(own.sites[arc, hand], q)
        d2 = np.hypot(*(q - second).T)
        if (d2 > radius + pair.move + pair.rounding).any():
            return f"site {hand} is farther by {(d2 - radius).max():.3g}, the placement {pair.move:.3g}"
        with np.errstate(divide="ignore", invalid="ignore"):
            dive = d1 - ((q - foot) / d1[:, None] * (q - second)).sum(axis=1)
            way = (d2 - d1) * (d2 + d1) / (2 * dive)
        # where nearly the same foot is meant, rounding tells the sign
        bound = np.where((dive > 2.0**-20 * d1) & (d1 > 0), np.minimum(bound, np.maximum(way, 0)), bound)
    away = distances_to(other, q)
    known = np.isfinite(bound) & (radius > 2 * pair.move)  # inside the other shape, too
    beyond = away[known] - bound[known] - 2.0**20 * pair.rounding
    return f"a place is {beyond.max():.3g} farther than its bound" if (beyond > 0).any() else None


def pruned_fault(own, other, to_other, pair, worst):
    """What is left by an angle, where it is seen under that."""
    for angle in ANGLES:
        places, seen = seen_places(prune(own, angle=angle), 1000 * pair.move)
        sharp = seen >= angle * (1 - 1e-9)
        if not sharp.any():
            continue
        away = distances_to(other, to_other(places[sharp])).max()
        worst[angle] = max(worst.get(angle, 0.0), float(away / pair.move))
        # the radius and the angle there change by a thousandth, or two
        if away > 1.05 * 2 * pair.move / (1 - np.cos(np.radians(angle) / 2)):
            return f"pruned by {angle} degrees a place is {away / pair.move:.3g} times the placement away"
    return None


def seen_places(skeleton, least):
    """Places on arcs, and the angles in degrees under which they see their feet; 0 where these are too near."""
    places = places_on_arcs(skeleton, INSIDE)
    arc = np.repeat(np.arange(len(skeleton)), places.shape[1])
    places = places.reshape(-1, 2)
    sites = SitePlaces(skeleton)
    a, b = (sites.feet(skeleton.sites[arc, hand], places) - places for hand in (0, 1))
    cross, dot = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), (a * b).sum(axis=1)
    return places, np.where(np.hypot(*a.T) > least, np.degrees(np.arctan2(cross, dot)), 0.0)


def radius_fault(pair):
    """The largest discs."""
    change = abs(pair.first.radius.max() - pair.second.radius.max())
    return f"the largest radius changes by {change:.3g}" if change > pair.move + pair.rounding else None


def area_fault(pair):
    """What is farther from the boundary than some distance."""
    most = pair.first.radius.max()
    for share in SHARES:
        t, m = share * most, pair.move
        if t - m <= 0:
            continue
        inner, outer = (inner_area(pair.first, t + sign * m) for sign in (1, -1))
        area = inner_area(pair.second, t)
        slack = pair.rounding * np.abs(pair.first.polygons.xy).max() * len(pair.first.polygons.xy)
        if not inner - slack <= area <= outer + slack:
            return f"the area farther than {t:.6g} is {area}, not between {inner} and {outer}"
    return None


def inner_area(skeleton, distance):
    """Of what is farther from the boundary."""
    return float(offset(skeleton, -distance).area.sum())
