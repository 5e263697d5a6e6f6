"""Pruning by brute force: arcs are sampled, and leaves are peeled one small step at a time."""

from collections import defaultdict
from itertools import pairwise

import numpy as np
import shapely

from vorotool import critical_values, prune
from vorotool.types.skeleton.segment_voronoi import EDGE

SAMPLES = 6
TOLERANCE = 1e-7
"""Of the extent: how far flattened arcs may be from what they are."""
SHORT = 2.0**-44
"""Of the largest coordinate: within 256 ulp."""


def hangs(node, edge, edges, around, anchored):
    """Edges and nodes beyond a node, through an edge; None if these lead back, or to an anchored node."""
    beyond, nodes, todo = {edge}, set(), [(edge, node)]
    while todo:
        k, come = todo.pop()
        a, b = edges[k]
        go = b if a == come else a
        if go in nodes or go == node or go in anchored:
            return None
        nodes.add(go)
        new = around[go] - {k}
        if new & beyond:
            return None
        beyond |= new
        todo += [(other, go) for other in new]
    return beyond, nodes


def incidence(edges):
    around = defaultdict(set)
    for k, (a, b) in enumerate(edges):
        around[a].add(k)
        around[b].add(k)
    return around


class Sampled:
    """A skeleton as many short segments; at both ends of each the angle and the chord of its arc."""

    def __init__(self, skeleton, samples=SAMPLES):
        self.skeleton = skeleton
        self.anchored = set(np.flatnonzero(skeleton.on_frame).tolist())
        self.place, self.radius = skeleton.vertices.tolist(), skeleton.radius.tolist()
        self.segments, self.arc, self.middle, self.seen = [], [], [], []
        self.hanging = {}  # by node and segment, once they are asked for
        for arc, (source, target) in enumerate(skeleton.arcs.tolist()):
            steps = sorted({*np.linspace(0, 1, samples + 2).tolist(), self.widest(arc)})
            nodes = [source]
            for u in steps[1:-1]:
                nodes.append(len(self.place))
                place = self.at(arc, u)
                self.place.append(place.tolist())
                self.radius.append(float(np.hypot(*(place - self.feet(arc, place)[0]))))
            nodes.append(target)
            seen = [self.angle_and_chord(arc, u) for u in steps]
            self.segments += list(pairwise(nodes))
            self.seen += list(pairwise(seen))
            self.middle += [self.at(arc, (a + b) / 2) for a, b in pairwise(steps)]
            self.arc += [arc] * (len(steps) - 1)

    def at(self, arc, u):
        s = self.skeleton
        a, b = s.vertices[s.arcs[arc]]
        c = s.control[arc] if s.is_parabola[arc] else (a + b) / 2
        return (1 - u) ** 2 * a + 2 * u * (1 - u) * c + u * u * b

    def feet(self, arc, place):
        """The nearest places of both sites."""
        feet = []
        for site in self.skeleton.sites[arc]:
            a, b = self.skeleton.site_ends[site]
            way = b - a
            t = np.clip((place - a) @ way / (way @ way), 0, 1) if way @ way > 0 else 0
            feet.append(a + t * way)
        return feet

    def angle_and_chord(self, arc, u):
        """In a corner both feet are one: the angle is that nearby."""
        radius = self.skeleton.radius[self.skeleton.arcs[arc]]
        place = self.at(arc, min(max(u, 0.01 * (radius[0] == 0)), 1 - 0.01 * (radius[1] == 0)))
        a, b = (foot - place for foot in self.feet(arc, place))
        chord = np.hypot(*(np.subtract(*self.feet(arc, self.at(arc, u)))))
        return float(np.degrees(np.arctan2(abs(a[0] * b[1] - a[1] * b[0]), a @ b))), float(chord)

    def widest(self, arc):
        """Where both feet are opposite, if that is inside an arc: half-way between the sites, beside a vertex."""
        s = self.skeleton
        pair = s.sites[arc]
        vertices = [site for site in pair.tolist() if s.site_table.kind[site] != EDGE]
        if not vertices:
            return 0.5
        vertex = s.site_ends[vertices[0], 0]
        (a, b), (source, target) = s.site_ends[pair.sum() - vertices[0]], s.vertices[s.arcs[arc]]
        way = np.array([vertex[1] - a[1], a[0] - vertex[0]])  # across the two vertices
        foot = a
        if len(vertices) == 1:
            way = b - a
            foot = a + (vertex - a) @ way / (way @ way) * way
        along = (target - source) @ way
        u = ((vertex + foot) / 2 - source) @ way / along if along else 0.5
        return float(u) if 0 < u < 1 else 0.5

    def peeled(self, which, threshold):
        """Segments that go, leaf by leaf, while the angle (0) or the chord (1) is below the threshold."""
        removed, around = set(), incidence(self.segments)
        leaves = [node for node in around if len(around[node]) == 1 and node not in self.anchored]
        while leaves:
            node = leaves.pop()
            for segment in list(around[node]):  # one, or none if it went from the other end
                if max(end[which] for end in self.seen[segment]) >= threshold:
                    continue
                removed.add(segment)
                a, b = self.segments[segment]
                inner = b if a == node else a
                around[node].clear()
                around[inner].discard(segment)
                if len(around[inner]) == 1 and inner not in self.anchored:
                    leaves.append(inner)
        return removed

    def in_enlarged_discs(self, scale):
        """Segments whose discs, enlarged, lie in that of some sampled place that they hang on."""
        removed, around = set(), incidence(self.segments)
        place, radius = np.array(self.place), np.array(self.radius)
        for node in around:
            for segment in around[node] - removed:
                if (node, segment) not in self.hanging:
                    self.hanging[node, segment] = hangs(node, segment, self.segments, around, self.anchored)
                found = self.hanging[node, segment]
                if found is None:
                    continue
                beyond, q = found[0], list(found[1])
                away = np.hypot(*(place[q] - place[node]).T)
                if (away <= scale * (radius[node] - radius[q])).all():
                    removed |= beyond
        return removed


def pieces_on_junctions(skeleton):
    """Pieces that hang on a junction and hold no middle of a tree: junction, arcs, longest path to a leaf."""
    edges = [tuple(pair) for pair in skeleton.arcs.tolist()]
    around, anchored = incidence(edges), set(np.flatnonzero(skeleton.on_frame).tolist())
    length, half, pieces = skeleton.length.tolist(), {}, []
    for node in around:
        if node not in half:
            nodes, size = half_diameter(node, edges, around, anchored, length)
            half |= dict.fromkeys(nodes, size)
        if len(around[node]) < 3:
            continue
        for edge in around[node]:
            found = hangs(node, edge, edges, around, anchored)
            if found is None:
                continue
            far = farthest(node, found[0], edges, around, length)
            if far <= half[node] * (1 + 1e-12):
                pieces.append((node, found[0], far))
    return pieces


def in_short_pieces(skeleton, pieces, threshold, relative):
    """Arcs in pieces on junctions whose longest path to a leaf is too short."""
    radius = skeleton.radius
    return set().union(*(arcs for node, arcs, far in pieces if far < threshold * (radius[node] if relative else 1)))


def farthest(node, allowed, edges, around, length):
    """The length of the longest path from a node along some edges, which are a tree."""
    most, todo = 0.0, [(node, None, 0.0)]
    while todo:
        at, come, way = todo.pop()
        most = max(most, way)
        for k in around[at] & allowed - {come}:
            a, b = edges[k]
            todo.append((b if a == at else a, k, way + length[k]))
    return most


def half_diameter(node, edges, around, anchored, length):
    """The nodes that a node hangs together with, and half the diameter of their tree; infinite if it is no tree."""
    nodes, arcs, todo = {node}, set(), [node]
    while todo:
        at = todo.pop()
        for k in around[at]:
            arcs.add(k)
            new = set(edges[k]) - nodes
            nodes |= new
            todo += new
    if nodes & anchored or len(arcs) != len(nodes) - 1:
        return nodes, np.inf
    leaves = [n for n in nodes if len(around[n]) == 1]
    return nodes, max(farthest(leaf, arcs, edges, around, length) for leaf in leaves) / 2


# ---- the library beside it -------------------------------------------------------------------------
def thresholds(values, rng, count=2):
    """Thresholds a little below or above critical values, where most can go wrong."""
    known = np.unique(values.ends[np.isfinite(values.ends)])
    if not len(known):
        return [1.5]
    near = [float(v * (1 + rng.choice([-1, 1]) * 10.0 ** -rng.integers(1, 6))) for v in rng.choice(known, count)]
    limits = {"angle": (0, 180), "scale": (1, 1e9)}.get(values.criterion, (0, np.inf))
    return [threshold for threshold in near if limits[0] <= threshold <= limits[1]]


def arcs_left(skeleton, left, tolerance):
    """The arcs that are left between each two sites, as lines."""
    points, start = left.flattened(tolerance)
    lines = defaultdict(list)
    for arc, pair in enumerate(np.sort(left.sites, axis=1).tolist()):
        lines[tuple(pair)].append(shapely.LineString(points[start[arc] : start[arc + 1]]))
    return [shapely.union_all(lines[tuple(pair)]) for pair in np.sort(skeleton.sites, axis=1).tolist()]


def disagreement(skeleton, rng):
    """What the library prunes otherwise than brute force, in words; None if nothing."""
    sampled = Sampled(skeleton)
    tolerance = TOLERANCE * float(np.ptp(skeleton.polygons.xy, axis=0).max())
    place = np.array(sampled.place)
    size = np.hypot(*(np.diff(place[np.array(sampled.segments)], axis=1)[:, 0].T))
    for which, criterion in enumerate(("angle", "chord")):
        for threshold in thresholds(critical_values(skeleton, criterion), rng):
            gone = sampled.peeled(which, threshold)
            left = arcs_left(skeleton, prune(skeleton, **{criterion: threshold}), tolerance / 4)
            for k, seen in enumerate(sampled.seen):
                low, high = sorted(end[which] for end in seen)
                if low * (1 - 1e-5) < threshold <= high * (1 + 1e-5):
                    continue  # the cut is in this segment
                if size[k] <= 4 * tolerance:
                    continue  # both its ends are as near to the cut as its middle
                distance = shapely.distance(left[sampled.arc[k]], shapely.Point(sampled.middle[k]))
                if (distance <= tolerance) == (k in gone):
                    return (
                        f"{criterion} {threshold}: segment {k} of arc {sampled.arc[k]} is {distance} from what is left"
                    )
    values = critical_values(skeleton, "scale")
    for threshold in thresholds(values, rng):
        gone = sampled.in_enlarged_discs(threshold)
        arcs = {sampled.arc[k] for k in gone} - {sampled.arc[k] for k in set(range(len(sampled.arc))) - gone}
        wrong = differing(arcs, values, threshold, 1e-7, skeleton)
        if wrong:
            return f"scale {threshold}: arcs {wrong}"
    pieces = pieces_on_junctions(skeleton)
    for criterion in ("length", "ratio"):
        values = critical_values(skeleton, criterion)
        for threshold in thresholds(values, rng):
            arcs = in_short_pieces(skeleton, pieces, threshold, criterion == "ratio")
            if any(values.ends[arc].max() < threshold for arc in values.kept_arc):
                arcs |= {k for k in range(len(skeleton)) if values.most[k] < threshold}  # a whole component
            wrong = differing(arcs, values, threshold, 1e-9, skeleton)
            if wrong:
                return f"{criterion} {threshold}: arcs {wrong}"
    return None


def differing(arcs, values, threshold, tolerance, skeleton):
    """Arcs that only one of the two removes; a kept place is on an arc that is removed but for it.

    Of arcs as short as rounding nothing is told.
    """
    removed = set(np.flatnonzero((values.ends < threshold).any(axis=1)).tolist())
    close = set(np.flatnonzero((np.abs(values.ends / threshold - 1) < tolerance).any(axis=1)).tolist())
    kept = set(values.kept_arc.tolist())
    short = set(np.flatnonzero(skeleton.length <= SHORT * np.abs(skeleton.vertices).max()).tolist())
    return (arcs ^ removed) - close - kept - short
