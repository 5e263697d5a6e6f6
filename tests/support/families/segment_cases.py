"""Graphs of few points and segments, which never cross, but often tie."""

from __future__ import annotations

from support.oracles.tangent_discs import Site, dot


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


def random_point(rng, size):
    return rng.randint(-size, size), rng.randint(-size, size)


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
