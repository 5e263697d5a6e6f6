"""Triples of sites with a query, for the exact signs: sites never cross, but often share ends, tie and nearly tie."""

from __future__ import annotations

import itertools
import math
import random

from support.oracles.tangent_discs import Site, dot

LIMIT = 2**30 - 1


def crosses(s, t):
    """Whether two sites have more in common than ends that they share."""
    if s.is_point and t.is_point:
        return s.a == t.a
    if s.is_point or t.is_point:
        p, line = (s.a, t) if s.is_point else (t.a, s)
        along = dot(line.along, (p[0] - line.a[0], p[1] - line.a[1]))
        return line.height(p) == 0 and 0 < along < dot(line.along, line.along)
    shared = s.ends & t.ends
    if len(shared) == 2:
        return True
    if any(crosses(s, Site(p, p)) for p in t.ends - shared) or any(crosses(t, Site(p, p)) for p in s.ends - shared):
        return True
    apart = s.height(t.a) * s.height(t.b) >= 0 or t.height(s.a) * t.height(s.b) >= 0
    return not shared and not apart


def lattice_sites(rng, count, size):
    """Few points, so that sites share ends and tie."""
    sites = []
    points = [random_point(rng, size) for _ in range(rng.choice([3, 4, 5, 8]))]
    while len(sites) < count:
        a, b = rng.choice(points), rng.choice(points)
        site = Site(a, b) if rng.random() < 0.7 else Site(a, a)
        if any(crosses(site, other) or site.ends == other.ends for other in sites):
            points.append(random_point(rng, size))
        else:
            sites.append(site)
    return sites


def random_point(rng, size):
    return rng.randint(-size, size), rng.randint(-size, size)


def tangent_sites(rng, count, size):
    """Sites that nearly touch one circle, the last one best."""
    radius = size * 10 ** rng.uniform(-4, -0.5)
    x, y = rng.uniform(-0.3, 0.3) * size, rng.uniform(-0.3, 0.3) * size
    start = rng.uniform(0, math.tau)
    sites = []
    spread = rng.choice([1.0, 1.0, 0.01])
    tries = 0
    while len(sites) < count:
        tries += 1
        angle = start + rng.uniform(0, math.tau) * spread
        nx, ny = math.cos(angle), math.sin(angle)
        before, after = (size * 10 ** rng.uniform(-5, -0.6) for _ in range(2))
        if rng.random() < 0.35:
            before = after = 0
        a = round(x + radius * nx + before * ny), round(y + radius * ny - before * nx)
        b = round(x + radius * nx - after * ny), round(y + radius * ny + after * nx)
        site = Site(a, b)
        inside = max(abs(v) for v in (*a, *b)) <= LIMIT
        if inside and not any(crosses(site, other) or site.ends == other.ends for other in sites):
            sites.append(site)
        elif tries > 100:
            spread, sites, tries = 1.0, [], 0
    return sites


def polygon_sites(rng, count, size):
    """Tangent sites of which some are joined: three sites of a chain, and what is near."""
    sites = tangent_sites(rng, count, size)
    first = sites[0]
    point = Site(first.b, first.b)
    if rng.random() < 0.5 and all(point != s for s in sites):
        sites[1] = point
    joined = Site(first.b, sites[2].a)
    others = sites[:2] + sites[3:]
    if first.b != sites[2].a and not any(crosses(joined, s) or joined.ends == s.ends for s in others):
        sites[2] = joined
    return sites


SAME, HALF_TURN = (1, 0, 0, 1), (-1, 0, 0, -1)
TURNS = [SAME, (0, -1, 1, 0), HALF_TURN, (0, 1, -1, 0)]
FLIPS = [SAME, (-1, 0, 0, 1), HALF_TURN, (1, 0, 0, -1)]
"""Groups of symmetries of the square: matrices by rows."""


def mirrored_sites(rng):
    """Two sites and an image of each, or four images of one: ties of any kind, most of them irrational, far out too."""
    size = rng.choice([2, 3, 10, 1000, 10**6, 10**8])
    x, y = (rng.randint(-LIMIT + 3 * size, LIMIT - 3 * size) for _ in range(2))

    def image(site, matrix):
        a, b, c, d = matrix
        return Site(*((x + a * u + b * v, y + c * u + d * v) for u, v in (site.a, site.b)))

    while True:
        ends = [random_point(rng, size) for _ in range(4)]
        if rng.random() < 0.4:
            ends[2] = rng.choice([ends[0], (ends[0][0], -ends[0][1])])
        one, other = (Site(p, p if rng.random() < 0.3 else q) for p, q in (ends[:2], ends[2:]))
        if rng.random() < 0.3:
            sites = [image(one, matrix) for matrix in rng.choice([TURNS, FLIPS])]
        else:
            sites = [image(site, matrix) for matrix in (SAME, rng.choice(FLIPS[1:])) for site in (one, other)]
        rng.shuffle(sites)
        if not any(crosses(s, t) or s.ends == t.ends for s, t in itertools.combinations(sites, 2)):
            return sites


def case(rng, count=4):
    """A few sites from a random family; the first three have a disc only if one is lucky."""
    size = rng.choice([2, 3, 5, 10, 100, 10**6, LIMIT])
    if size < 1000 or rng.random() < 0.2:
        return lattice_sites(rng, count, size)
    return rng.choice([tangent_sites, polygon_sites])(rng, count, size)


def cases(seed, number, count=4):
    rng = random.Random(seed)
    return [case(rng, count) for _ in range(number)]


def random_graph(rng, points, segments, size):
    """Points and segments that meet at ends only; small sizes give many ties."""
    chosen = []
    while len(chosen) < points:
        p = random_point(rng, size)
        if p not in chosen:
            chosen.append(p)
    sites = [Site(p, p) for p in chosen]
    edges = []
    for _ in range(4 * segments):
        i, j = sorted(rng.sample(range(points), 2))
        new = Site(chosen[i], chosen[j])
        if len(edges) < segments and not any(crosses(new, s) for s in sites):
            sites.append(new)
            edges.append((i, j))
    return chosen, edges
