"""Necks by brute force: all pairs of vertices and edges in fractions, and what is beside each by walks on a graph."""

from fractions import Fraction
from itertools import combinations, pairwise, product

import numpy as np

from support.oracles.tangent_discs import cross, dot

LINE = 2
ONE_HALF = Fraction(1, 2)


def brute_necks(skeleton):
    """(neck, center, square of the width) of all features of a skeleton, on its lattice: sets of `Fraction`."""
    polygons = skeleton.polygons
    step = skeleton.scale or 1.0
    lattice = np.rint((polygons.xy - np.asarray(skeleton.origin)) / step).astype(np.int64)
    feature = np.zeros(len(polygons), dtype=int) if skeleton.features == "together" else polygons.feature
    found = []
    for each in np.unique(feature).tolist():
        chosen = np.flatnonzero(feature == each).tolist()
        rings = [
            (polygon, kind, list(map(tuple, lattice[slice(*polygons.ring_starts[[ring, ring + 1]])].tolist())))
            for polygon in chosen
            for ring in range(*polygons.polygon_starts[[polygon, polygon + 1]])
            for kind in [int(polygons.ring_kind[ring])]
        ]
        found += [(each, *neck) for neck in Shape(rings).necks()]
    return found


class Shape:
    """Rings of one feature: straight vertices are left out, so that an edge is as long as its line."""

    def __init__(self, rings):
        self.rings = rings
        self.edges, self.vertices = [], set()
        for _, kind, ring in rings:
            if kind == LINE:
                self.vertices.update(ring)
                self.edges += [(a, b) for a, b in pairwise(ring) if a != b]
                continue
            kept = without_straight(ring)
            self.vertices.update(kept)
            pairs = zip(kept, [*kept[1:], kept[0]], strict=True)
            self.edges += [(a, b) for a, b in pairs if a != b] if len(kept) > 2 else [tuple(kept)] * (len(kept) == 2)
        self.edges = joined_lines({tuple(sorted(edge)) for edge in self.edges})
        self.vertices = sorted(self.vertices)
        self.elements = [*self.edges, *((v, v) for v in self.vertices)]
        self.ends = np.array(self.elements, dtype=float).reshape(-1, 2, 2)

    def necks(self):
        """(center, square of the width) of each."""
        chords = {tuple(sorted(pair)) for pair in combinations(self.vertices, 2)}
        for v, (a, b) in product(self.vertices, self.edges):
            foot = projected(v, a, b)
            if foot is not None and foot != v:
                chords.add(tuple(sorted((v, foot))))
        chords = sorted(chords)
        made = {self._of_chord(p, q) for p, q in (chords[k] for k in self._hopeful(chords))}
        made |= {self._of_parallels(e, f) for e, f in combinations(self.edges, 2) if cross(way(*e), way(*f)) == 0}
        return sorted(made - {None})

    def _hopeful(self, chords):
        """Those that doubles do not rule out."""
        if not chords:
            return []
        p, q = np.array([[[float(x) for x in end] for end in chord] for chord in chords]).swapaxes(0, 1)
        center, half = (p + q) / 2, np.sqrt(((q - p) ** 2).sum(axis=1)) / 2
        a, d = self.ends[:, 0], self.ends[:, 1] - self.ends[:, 0]
        t = ((center[:, None] - a) * d).sum(axis=2) / np.maximum((d * d).sum(axis=1), 1)
        off = center[:, None] - a - np.clip(t, 0, 1)[..., None] * d
        slack = 64 * np.spacing(np.abs(self.ends).max())
        return np.flatnonzero(np.sqrt((off * off).sum(axis=2)).min(axis=1) > half * (1 - 1e-9) - slack).tolist()

    def _of_chord(self, p, q):
        """The neck across a chord, unless something is nearer, a third place is touched, or it is on a plateau."""
        center, square = middle(p, q), norm(way(p, q)) / 4
        for a, b in self.elements:
            near = nearest(center, a, b)
            distance = norm(way(center, near))
            if distance < square or (distance == square and near not in (p, q)):
                return None
        if not self._is_inside(center) or self._directions(p, q) & self._directions(q, p):
            return None
        return center, 4 * square

    def _directions(self, foot, other):
        """To which sides of a chord, 1 and -1, the boundary leads at right angles from a foot."""
        x, y = way(foot, other) if foot < other else way(other, foot)
        found = set()
        for a, b in self.edges:
            if cross(way(a, foot), way(a, b)) == 0 and nearest(foot, a, b) == foot:
                for end in (a, b):
                    step = way(foot, end)
                    if step != (0, 0) and dot(step, (x, y)) == 0:
                        found.add(1 if cross((x, y), step) > 0 else -1)
        return found

    def _of_parallels(self, e, f):
        """The neck half-way along two parallel edges, if nothing else is touched but where one of them ends."""
        (a, b), (c, d) = e, f
        u = way(a, b)
        if cross(u, way(a, c)) == 0:
            return None
        low = max(Fraction(0), min(dot(way(a, c), u), dot(way(a, d), u)) / Fraction(norm(u)))
        high = min(Fraction(1), max(dot(way(a, c), u), dot(way(a, d), u)) / Fraction(norm(u)))
        if low >= high:
            return None
        feet = [[along(a, b, t), foot_on_line(along(a, b, t), c, d)] for t in (low, high)]
        line = [middle(*pair) for pair in feet]
        square = norm(way(*feet[0])) / 4
        for g in self.elements:
            if g in (e, f):
                continue
            touched = [(nearest(end, *g), end) for end in line] + [(end, nearest(end, *line)) for end in g]
            distance = min(norm(way(*pair)) for pair in touched)
            if distance < square or meet(line, g):
                return None
            if any(norm(way(*pair)) == square and not (is_on(pair[0], e) or is_on(pair[0], f)) for pair in touched):
                return None
        center = middle(*line)
        return (center, 4 * square) if self._is_inside(center) else None

    def _is_inside(self, place):
        shells, holes = set(), set()
        for polygon, kind, ring in self.rings:
            if kind < 2 and len(ring) > 2 and is_around(ring, place):
                (holes if kind == 1 else shells).add(polygon)
        return bool(shells - holes)


# ---- arithmetic ----------------------------------------------------------------------------------
def way(a, b):
    return (b[0] - a[0], b[1] - a[1])


def norm(a):
    return Fraction(dot(a, a))


def middle(a, b):
    return ((a[0] + b[0]) * ONE_HALF, (a[1] + b[1]) * ONE_HALF)


def along(a, b, t):
    return (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]))


def nearest(place, a, b):
    """The nearest place on a closed edge, or at a point."""
    u = way(a, b)
    if u == (0, 0):
        return a
    t = Fraction(dot(way(a, place), u)) / norm(u)
    return along(a, b, min(max(t, Fraction(0)), Fraction(1)))


def foot_on_line(place, a, b):
    return along(a, b, Fraction(dot(way(a, place), way(a, b))) / norm(way(a, b)))


def projected(place, a, b):
    """The foot inside an edge or at its end; None beyond it."""
    t = Fraction(dot(way(a, place), way(a, b))) / norm(way(a, b))
    return along(a, b, t) if 0 <= t <= 1 else None


def meet(line, edge):
    """Whether two edges cross."""
    (a, b), (c, d) = line, edge
    sides = [cross(way(a, b), way(a, p)) for p in (c, d)], [cross(way(c, d), way(c, p)) for p in (a, b)]
    return all(x * y < 0 for x, y in sides)


def without_straight(ring):
    """A ring without vertices where it goes straight on."""
    kept = [v for v, after in zip(ring, [*ring[1:], ring[0]], strict=True) if v != after] or ring[:1]
    k = 0
    while len(kept) > 2 and k < len(kept):
        a, b, c = kept[k - 1], kept[k], kept[(k + 1) % len(kept)]
        if cross(way(a, b), way(b, c)) == 0 and dot(way(a, b), way(b, c)) > 0:
            del kept[k]
            k = max(k - 1, 0)
        else:
            k += 1
    return kept


def joined_lines(edges):
    """Edges that go on straight from a common end as one, whatever else ends there."""
    edges = set(edges)
    while True:
        pairs = (pair for pair in combinations(sorted(edges), 2) if set(pair[0]) & set(pair[1]))
        pair = next((pair for pair in pairs if is_straight(*pair)), None)
        if pair is None:
            return sorted(edges)
        edges -= set(pair)
        edges.add(tuple(sorted(set(pair[0]) ^ set(pair[1]))))


def is_straight(e, f):
    (shared,) = set(e) & set(f)
    a, b = set(e) ^ set(f)
    return cross(way(a, shared), way(shared, b)) == 0 and dot(way(a, shared), way(shared, b)) > 0


def is_on(place, edge):
    return nearest(place, *edge) == place


def is_around(ring, place):
    inside = False
    for a, b in zip(ring, [*ring[1:], ring[0]], strict=True):
        if (a[1] > place[1]) != (b[1] > place[1]):
            side = cross(way(a, b), way(a, place))
            inside ^= (side > 0) == (b[1] > a[1])
    return inside


# ---- what is compared ----------------------------------------------------------------------------
def disagreement(necks):
    """What is wrong with the necks of polygons, if anything."""
    skeleton = necks.skeleton
    expected = brute_necks(skeleton)
    if len(expected) != len(necks):
        return f"{len(necks)} necks instead of {len(expected)}"
    step, origin = skeleton.scale or 1.0, np.asarray(skeleton.origin)
    own = np.zeros(len(necks)) if skeleton.features == "together" else skeleton.polygons.feature[necks.polygon]
    squares = {}
    tolerance = 64 * np.spacing(max(np.abs(skeleton.polygons.xy).max(initial=1.0), np.abs(origin).max()))
    for feature, center, square in expected:
        place = origin + step * np.array([float(x) for x in center])
        off = np.abs(necks.xy - place).max(axis=1) + 1e300 * (own != feature)
        k = int(off.argmin())
        width = step * float(square) ** 0.5
        if off[k] > tolerance or abs(necks.width[k] - width) > 4 * np.spacing(width) or k in squares:
            return f"no neck of its own at {place.tolist()}, of width {width}"
        squares[k] = square
    return besides(necks, squares)


def besides(necks, squares):
    """What is wrong with the clearances beside necks, by a walk from each over the skeleton."""
    skeleton = necks.skeleton
    rank = [(squares[k], k) for k in range(len(necks))]
    at_node, in_arc = {}, {}
    for k, arc in enumerate(necks.arc.tolist()):
        ends = skeleton.arcs[arc].tolist()
        near = [n for n in ends if is_at(skeleton, n, necks, k)]
        if near:
            at_node[near[0]] = k
        else:
            in_arc[arc] = k
    around = {}
    for arc, (a, b) in enumerate(skeleton.arcs.tolist()):
        around.setdefault(a, []).append((arc, b))
        around.setdefault(b, []).append((arc, a))
    for k, arc in enumerate(necks.arc.tolist()):
        node = next((n for n, other in at_node.items() if other == k), None)
        inside = [(n, arc) for n in skeleton.arcs[arc].tolist()]
        starts = inside if node is None else [(other, way_out) for way_out, other in around[node]]
        found = sorted(walk(skeleton, around, at_node, in_arc, rank, k, n, way_out) for n, way_out in starts)
        if not np.allclose(found, necks.beside[k], rtol=1e-12, atol=0):
            return f"neck {k} has {necks.beside[k].tolist()} beside, not {found}"
    return None


def is_at(skeleton, node, necks, neck):
    """Whether a neck is at a node of two arcs."""
    off = np.abs(skeleton.vertices[node] - necks.xy[neck]).max()
    size = np.abs(skeleton.polygons.xy).max()
    return skeleton.degree[node] == 2 and off <= 64 * np.spacing(size) and skeleton.radius[node] > 0


def walk(skeleton, around, at_node, in_arc, rank, neck, first, came_by):
    """The largest clearance that is reached by way of a node before a narrower neck."""
    seen, todo, largest = set(), [(first, came_by)], 0.0

    def blocked(other):
        return other is not None and rank[other] <= rank[neck]

    while todo:
        node, arc = todo.pop()
        if node in seen or skeleton.radius[node] == 0:
            continue
        if blocked(at_node.get(node)):
            continue
        seen.add(node)
        largest = max(largest, float(skeleton.radius[node]))
        todo += [(far, way_out) for way_out, far in around[node] if way_out != arc and not blocked(in_arc.get(way_out))]
    return largest
