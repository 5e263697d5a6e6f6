"""Planar graphs by their definition, in rationals and by brute force: what the engine must give.

The input is that of the core: lattice vertices, and rings as (first vertex, one after the last, kind, polygon).
"""

from fractions import Fraction
from functools import lru_cache
from itertools import combinations, pairwise

from support.oracles.delaunay_oracle import cross

SHELL, HOLE, LINE = 0, 1, 2
HALF = Fraction(1, 2)


def lies_on(point, segment):
    """Whether a point is on a closed segment."""
    a, b = segment
    return cross(a, b, point) == 0 and all(min(a[i], b[i]) <= point[i] <= max(a[i], b[i]) for i in (0, 1))


def common_point(s, t):
    """The common point of two segments that are not parallel, or None."""
    (a, b), (c, d) = s, t
    p, q = (b[0] - a[0], b[1] - a[1]), (d[0] - c[0], d[1] - c[1])
    denominator = p[0] * q[1] - p[1] * q[0]
    if denominator == 0:
        return None
    sign = 1 if denominator > 0 else -1
    u = ((c[0] - a[0]) * q[1] - (c[1] - a[1]) * q[0]) * sign
    v = ((c[0] - a[0]) * p[1] - (c[1] - a[1]) * p[0]) * sign
    if not (0 <= u <= abs(denominator) and 0 <= v <= abs(denominator)):
        return None
    u = Fraction(u, abs(denominator))
    return a[0] + u * p[0], a[1] + u * p[1]


def rounded(point):
    return tuple((c + HALF).__floor__() for c in point)


@lru_cache(maxsize=10_000)
def stay_in_cell(segment, center):
    """The middle parameter of the part of a segment in the half-open cell of a lattice point, or None."""
    a, b = segment
    if any(2 * max(a[i], b[i]) < 2 * center[i] - 1 or 2 * min(a[i], b[i]) > 2 * center[i] + 1 for i in (0, 1)):
        return None
    low, high = Fraction(0), Fraction(1)
    for i in (0, 1):
        start, step = segment[0][i], segment[1][i] - segment[0][i]
        near, far = center[i] - HALF, center[i] + HALF
        if step == 0:
            if not near <= start <= far:
                return None
            continue
        bounds = sorted(((near - start) / step, (far - start) / step))
        low, high = max(low, bounds[0]), min(high, bounds[1])
    if low > high:
        return None
    middle = (low + high) / 2  # on the open side, if a part is in the closed cell only, all of it is
    place = [segment[0][i] + middle * (segment[1][i] - segment[0][i]) for i in (0, 1)]
    return middle if all(place[i] < center[i] + HALF for i in (0, 1)) else None


def edges_of(vertices, rings):
    """(edge, ring, from, to) of all edges with a length."""
    found = []
    for ring, (begin, end, kind, _) in enumerate(rings):
        for k in range(begin, end):
            if k + 1 == end and (kind == LINE or begin + 1 == end):
                break
            a, b = vertices[k], vertices[begin if k + 1 == end else k + 1]
            if a != b:
                found.append((k, ring, a, b))
    return found


def snapped_pieces(vertices, rings):
    """{piece (a sorted pair of nodes): edges that it is part of, once for each time}, and the loose segments."""
    edges = edges_of(vertices, rings)
    segments = {tuple(sorted((a, b))) for _, _, a, b in edges}
    nodes, loose = set(vertices), set()
    for s, t in combinations(sorted(segments), 2):
        place = common_point(s, t)
        if place is None:
            continue
        if place[0].denominator == place[1].denominator == 1:
            nodes.add(tuple(map(int, place)))
        else:
            nodes.add(rounded(place))
            loose |= {s, t}
    while True:
        disturbed = {n for n in nodes if any(stay_in_cell(s, n) is not None and cross(*s, n) != 0 for s in loose)}
        more = {s for s in segments if any(stay_in_cell(s, n) is not None for n in disturbed)} | loose
        if more == loose:
            break
        loose = more
    chains = {}
    for s in segments:
        met = [
            (stay_in_cell(s, n), n) for n in nodes if (stay_in_cell(s, n) is not None if s in loose else lies_on(n, s))
        ]
        chains[s] = [n for _, n in sorted(met)]
    pieces = {}
    for k, _, a, b in edges:
        chain = chains[tuple(sorted((a, b)))]
        for piece in pairwise(chain):
            pieces.setdefault(tuple(sorted(piece)), []).append(k)
    return pieces, loose


def ring_of(rings, edge):
    return next(i for i, (begin, end, _, _) in enumerate(rings) if begin <= edge < end)


def flat_holes(vertices, rings):
    """{ring: its one or two places} of holes without an area: points and segments that their polygons go around."""
    places = {ring: set(vertices[begin:end]) for ring, (begin, end, kind, _) in enumerate(rings) if kind == HOLE}
    return {ring: here for ring, here in places.items() if len(here) < 3}


def polygons_at(point, pieces, rings):
    """Polygons that a point on no piece lies in: inside the shell and no hole, each by the even-odd rule."""
    inside = [False] * len(rings)
    for (a, b), edges in pieces.items():
        low, high = sorted((a, b))
        if low[0] <= point[0] < high[0] and cross(low, high, point) < 0:  # the piece is above
            for edge in edges:
                inside[ring_of(rings, edge)] ^= True
    shells = {polygon for ring, (_, _, kind, polygon) in enumerate(rings) if kind == SHELL and inside[ring]}
    holes = {polygon for ring, (_, _, kind, polygon) in enumerate(rings) if kind == HOLE and inside[ring]}
    return shells - holes


def beside(piece, pieces):
    """A point left and a point right of the middle of a piece, nearer than any other piece."""
    (ax, ay), (bx, by) = piece
    middle = (Fraction(ax + bx, 2), Fraction(ay + by, 2))
    step = Fraction(1, 4)
    while True:
        sides = [(middle[0] - s * step * (by - ay), middle[1] + s * step * (bx - ax)) for s in (1, -1)]
        others = (p for p in pieces if p != piece)
        if not any(common_point(p, sides) is not None or any(lies_on(q, p) for q in sides) for p in others):
            return sides
        step /= 16


def planar_graph(vertices, rings):
    """{segment: (edges, polygons left, polygons right)}, and the number of loose edges."""
    vertices = [tuple(v) for v in vertices]
    pieces, loose = snapped_pieces(vertices, rings)
    flat = flat_holes(vertices, rings)
    found = {}
    for piece, edges in pieces.items():
        left, right = (polygons_at(p, pieces, rings) for p in beside(piece, pieces))
        own = {ring_of(rings, e) for e in edges}
        around = {rings[ring][3] for ring in own & flat.keys()} & left & right
        if left != right or any(rings[ring][2] == LINE for ring in own) or around:
            found[piece] = (sorted(edges), left, right)
    moved = sum(tuple(sorted((a, b))) in loose for _, _, a, b in edges_of(vertices, rings))
    return found, moved


def point_holes(vertices, rings, found):
    """{(place, polygon)} of holes of one place in their polygon, where none of the segments that were found ends."""
    vertices = [tuple(v) for v in vertices]
    pieces, _ = snapped_pieces(vertices, rings)
    ends, holes = {place for piece in found for place in piece}, set()
    for ring, places in flat_holes(vertices, rings).items():
        polygon, (place, *others) = rings[ring][3], places
        if others or place in ends:
            continue
        idle = next((piece for piece in pieces if place in piece), None)  # has the same polygons on both sides
        if polygon in polygons_at(beside(idle, pieces)[0] if idle else place, pieces, rings):
            holes.add((place, polygon))
    return holes


def fault(points, segments):
    """What is wrong with a planar graph, by looking at all pairs; None if nothing is."""
    if len(set(points)) < len(points):
        return "points coincide"
    pairs = [tuple(sorted((points[i], points[j]))) for i, j in segments]
    if len(set(pairs)) < len(pairs) or any(a == b for a, b in pairs):
        return "segments coincide or have no length"
    for pair in pairs:
        if any(lies_on(p, pair) and p not in pair for p in points):
            return f"a point is inside {pair}"
    for s, t in combinations(pairs, 2):
        place = common_point(s, t)
        if place is not None and not (place in s and place in t):
            return f"{s} and {t} meet"
    return None


def described(graph):
    """{segment: (edges, polygons left, polygons right)} of a graph, as `planar_graph` gives it."""
    found = {}
    inside = [set(graph.polygons_of(face).tolist()) for face in range(graph.faces)]
    for k, (pair, faces) in enumerate(zip(graph.points[graph.segments].tolist(), graph.segment_faces, strict=True)):
        a, b = map(tuple, pair)
        left, right = faces if a < b else faces[::-1]
        found[tuple(sorted((a, b)))] = (graph.sources_of(k).tolist(), inside[left], inside[right])
    return found


def holes_of(graph):
    """Holes of one place, as `point_holes` gives them."""
    return {(tuple(graph.points[point].tolist()), polygon) for point, _, polygon in graph.point_holes.tolist()}
