"""The Voronoi diagram of points and open segments by brute force, in numbers of many digits.

Every disc that touches three sites is computed (see tangent_discs.py), and kept if no site enters it.
"""

import functools
import itertools
from collections import defaultdict
from dataclasses import dataclass

import numpy as np

from support.oracles.tangent_discs import (
    FIRST,
    Disc,
    certain,
    clearance,
    counter_clockwise,
    cross,
    dot,
    foot_within,
    precision,
    sign,
    sites_of,
    tangent_circles,
    touches,
)


@dataclass(frozen=True)
class Vertex:
    disc: Disc
    ring: tuple[int, ...]
    """Sites whose cells meet here, counter-clockwise from the smallest number."""


@dataclass
class Diagram:
    """The arrays of the segment Voronoi diagram; values rounded from many digits."""

    points: np.ndarray
    segments: np.ndarray
    vertices: np.ndarray
    radius: np.ndarray
    vertex_starts: np.ndarray
    vertex_sites: np.ndarray
    edges: np.ndarray
    edge_sites: np.ndarray


def voronoi_diagram(points, segments):
    """The diagram of a planar straight-line graph, in the order of the vertices' rings."""
    points = np.asarray(points, dtype=np.int32).reshape(-1, 2)
    segments = np.asarray(segments, dtype=np.int32).reshape(-1, 2)
    sites = sites_of(points, segments)
    vertices = sorted(find_vertices(sites), key=lambda v: v.ring)
    edges = sorted(find_edges(sites, vertices))
    return Diagram(
        points,
        segments,
        np.array([(float(v.disc.x), float(v.disc.y)) for v in vertices]).reshape(-1, 2),
        np.array([float(v.disc.r) for v in vertices]),
        np.cumsum([0, *(len(v.ring) for v in vertices)], dtype=np.int32),
        np.array([k for v in vertices for k in v.ring], dtype=np.int32),
        np.array([edge[:2] for edge in edges], dtype=np.int32).reshape(-1, 2),
        np.array([edge[2:] for edge in edges], dtype=np.int32).reshape(-1, 2),
    )


def find_vertices(sites):
    doubles = Doubles(sites)
    vertices = {}
    for triple in itertools.combinations(range(len(sites)), 3):
        if all(sites[k].is_point for k in triple) and any(set(triple) <= set(ring) for ring in vertices):
            continue  # three points have one circle
        for vertex in certain(functools.partial(vertices_of, sites, triple, doubles)):
            vertices.setdefault(vertex.ring, vertex)
    return list(vertices.values())


class Doubles:
    """What doubles show of where sites are to a disc."""

    def __init__(self, sites):
        self.a = np.array([s.a for s in sites], dtype=float).reshape(-1, 2)
        self.u = np.array([s.along for s in sites], dtype=float).reshape(-1, 2)
        self.length2 = np.maximum((self.u**2).sum(axis=1), 1)
        self.extent = np.abs(self.a).max(initial=1)

    def near(self, disc):
        """The sites that may enter or touch the disc; None if one surely enters it."""
        way = np.array([float(disc.x), float(disc.y)]) - self.a
        t = np.clip((way * self.u).sum(axis=1) / self.length2, 0, 1)
        beyond = np.hypot(*(way - t[:, None] * self.u).T) - float(disc.r)
        error = 1e-9 * (float(disc.r) + self.extent)  # each operation's error is below 2^-50 of these lengths
        return None if beyond.min() < -error else np.flatnonzero(beyond <= error).tolist()


def vertices_of(sites, triple, doubles, tie, sure):
    chosen = [sites[k] for k in triple]
    found = []
    for disc in tangent_circles(chosen):
        near = doubles.near(disc)
        if near is None or not feet_on_segments(disc, chosen, tie, sure):
            continue
        others = [k for k in near if k not in triple]
        if any(sign(clearance(disc, sites[k]), tie, sure) < 0 for k in others):
            continue
        others = [k for k in others if touches(disc, sites[k], tie, sure)]
        touching = [(k, sites[k]) for k in (*triple, *others)]
        ring = counter_clockwise(disc, touching, tie, sure) if sign(disc.r, tie, sure) else corner_ring(touching)
        first = ring.index(min(ring))
        found.append(Vertex(disc, tuple(ring[first:] + ring[:first])))
    return found


def feet_on_segments(disc, sites, tie, sure):
    """For a circle tangent to the sites' lines: does it touch them on the segments?

    That it touches a segment at an end which is one of the sites goes without saying.
    """
    points = {s.a for s in sites if s.is_point}
    return all(s.is_point or s.ends & points or foot_within(disc, s, tie, sure) for s in sites)


def corner_ring(touching):
    """A point and its segments, of which not all are on one line, around a disc of radius 0.

    The point has a cell in the gap between two segments of 180° or more, if there is one.
    """
    ((point, at),) = [(k, s.a) for k, s in touching if s.is_point]
    ways = {k: s.way_from(at) for k, s in touching if not s.is_point}
    ring = sorted(ways, key=functools.cmp_to_key(lambda i, j: by_angle(ways[i], ways[j])))
    for i, k in enumerate(ring):
        following = ring[(i + 1) % len(ring)]
        if cross(ways[k], ways[following]) <= 0:
            return [*ring[: i + 1], point, *ring[i + 1 :]]
    return ring


def by_angle(u, v):
    def half(w):
        return 0 if w[1] > 0 or (w[1] == 0 and w[0] > 0) else 1

    return half(u) - half(v) or -cross(u, v)


# ---- edges: along a bisector, vertices where an edge goes on and vertices where one ends alternate ----


def find_edges(sites, vertices):
    """(source, target, left, right) with -1 for infinity; the site on the left has the smaller number."""
    with precision(FIRST[0]):
        if not vertices:
            return edges_across_a_line(sites)
        ends = defaultdict(list)
        for v, vertex in enumerate(vertices):
            for before, after in itertools.pairwise((*vertex.ring, vertex.ring[0])):
                # counter-clockwise, the edge between two contacts leaves with the second on its left
                left, right = min(before, after), max(before, after)
                inside = inside_corner(sites, vertex.disc, before, after)
                branch, place = place_on_bisector(sites[left], sites[right], vertex.disc, inside)
                ends[left, right, branch].append((place, left == after, v))
        return [(*edge, *key[:2]) for key, places in ends.items() for edge in paired(sorted(places))]


def paired(places):
    """(source, target) of the edges along one bisector."""
    edges, source, open_edge = [], -1, not places[0][1]
    for (place, leaves, v), following in itertools.pairwise([*places, (None, None, None)]):
        assert following[0] is None or following[0] - place > FIRST[1], "two vertices at one place"
        assert leaves != open_edge, "an edge ends that has not begun"
        if leaves:
            source = v
        else:
            edges.append((source, v))
        open_edge = leaves
    return [*edges, (source, -1)] if open_edge else edges


def edges_across_a_line(sites):
    """All sites are on one line: bisectors across it, from infinity to infinity."""
    along = sorted(range(len(sites)), key=lambda k: tuple(map(sum, zip(sites[k].a, sites[k].b, strict=True))))
    return [(-1, -1, min(i, j), max(i, j)) for i, j in itertools.pairwise(along)]


def inside_corner(sites, disc, before, after):
    """For two segments at a corner a point of their sector, elsewhere the disc's center."""
    if disc.r > FIRST[1] or sites[before].is_point or sites[after].is_point:
        return disc.x, disc.y
    (corner,) = sites[before].ends & sites[after].ends
    u, v = sites[before].way_from(corner), sites[after].way_from(corner)
    return corner[0] + u[0] + v[0], corner[1] + u[1] + v[1]


def place_on_bisector(left, right, disc, inside):
    """Which branch of the bisector, and a number that grows as one goes along it with `left` on the left."""
    if right.is_point:  # so is the left one, of the smaller number
        way = left.a[0] - right.a[0], left.a[1] - right.a[1]
        return None, dot((way[1], -way[0]), (disc.x, disc.y))
    if left.is_point and left.a in right.ends:
        way = right.way_from(left.a)
        return None, dot((-way[1], way[0]), (disc.x, disc.y))
    u = right.along
    if left.is_point:
        return None, dot(u, (disc.x, disc.y)) * (1 if right.height(left.a) > 0 else -1)
    sides = left.height(inside) > 0, right.height(inside) > 0
    return sides, dot(u, (disc.x, disc.y)) * (1 if sides[1] else -1)


# ---- what differs ----


def differences(got, right, ulps=4):
    """What is wrong with a diagram, in words; nothing if it is the other but for the order and rounded values."""
    found = []
    got_rings, right_rings = rings_of(got), rings_of(right)
    got_at, right_at = {r: v for v, r in enumerate(got_rings)}, {r: v for v, r in enumerate(right_rings)}
    if len(got_at) < len(got_rings):
        found.append("a vertex is there twice")
    found += [f"vertex {r} at {got.vertices[v]} should not be" for r, v in got_at.items() if r not in right_at]
    found += [f"vertex {r} at {right.vertices[v]} is missing" for r, v in right_at.items() if r not in got_at]
    for ring, v in got_at.items():
        if ring in right_at:
            found += value_differences(got, v, right, right_at[ring], ring, ulps)
    got_edges, right_edges = edges_by_rings(got, got_rings), edges_by_rings(right, right_rings)
    if len(set(got_edges)) < len(got_edges):
        found.append("an edge is there twice")
    found += [f"edge {e} should not be" for e in sorted(set(got_edges) - set(right_edges))]
    found += [f"edge {e} is missing" for e in sorted(set(right_edges) - set(got_edges))]
    return found


def rings_of(diagram):
    rings = [tuple(map(int, r)) for r in np.split(diagram.vertex_sites, diagram.vertex_starts[1:-1])]
    return rings if len(diagram.vertices) else []


def edges_by_rings(diagram, rings):
    """(ring of the source, of the target, left, right) with the smaller site on the left, () for infinity."""
    rows = []
    for (v, w), (left, right) in zip(diagram.edges.tolist(), diagram.edge_sites.tolist(), strict=True):
        ends = [rings[k] if k >= 0 else () for k in (v, w)]
        rows.append((*ends, left, right) if left < right else (*reversed(ends), right, left))
    return rows


def value_differences(got, v, right, w, ring, ulps):
    """The radius in ulp of its own, coordinates in ulp of the radius or of the larger of both."""
    values = np.append(got.vertices[v], got.radius[v]), np.append(right.vertices[w], right.radius[w])
    size = np.abs(values[1]).max()
    bound = ulps * np.spacing([size, size, values[1][2]])
    if (np.abs(values[0] - values[1]) <= bound).all():
        return []
    return [f"vertex {ring} is at {values[0].tolist()}, not at {values[1].tolist()}"]
