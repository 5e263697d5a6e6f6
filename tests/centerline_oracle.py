"""Centerlines of polygons without holes by brute force: all pairs of ends, told by coordinates and angles."""

from itertools import combinations

import networkx
import numpy as np

import vorotool


def angle(ring, k):
    """Inside, at a corner that is convex."""
    before, at, behind = (ring[step % len(ring)] for step in (k - 1, k, k + 1))
    (ux, uy), (vx, vy) = np.subtract(before, at), np.subtract(behind, at)
    return np.degrees(np.arctan2(abs(ux * vy - uy * vx), ux * vx + uy * vy))


def hops(graph, node):
    """(other node, length) of each arc at a node."""
    return [(other, arc["length"]) for other, arcs in graph[node].items() for arc in arcs.values()]


class Ends:
    """Forks and round ends, each grown corner by corner."""

    def __init__(self, skeleton, graph):
        self.ring = skeleton.polygons.ring(0).tolist()
        self.graph, self.radius = graph, skeleton.radius
        place = {tuple(at): k for k, at in enumerate(skeleton.vertices.tolist())}
        leaves = {k: place.get(tuple(at)) for k, at in enumerate(self.ring)}
        self.corner = {node: k for k, node in leaves.items() if node is not None and graph.degree(node) == 1}
        self.found = []
        for k in range(len(self.ring)):
            one, other = leaves[k], leaves[(k + 1) % len(self.ring)]
            if one in self.corner and other in self.corner:
                (a,), (b,) = graph[one], graph[other]
                if a == b and self.is_blunt(k, k + 1):
                    self.found.append(self.grown(a, {one, other}))

    def beside(self, leaf, leaves):
        """Whether a corner is next to one of some, at an edge without tips."""
        k, count = self.corner[leaf], len(self.ring)
        near = [m for m in map(self.corner.get, leaves) if (k - m) % count in (1, count - 1)]
        return any(self.is_blunt(k, m) for m in near)

    def is_blunt(self, k, m):
        one, other = angle(self.ring, k), angle(self.ring, m)
        return min(one, other) >= 45 and abs(one - other) <= 90

    def grown(self, node, leaves):
        """(node, leaves): from a fork on; None where more than one corner comes, which this does not follow."""
        far, come = 0.0, None
        while True:
            steps = [other for other, _ in hops(self.graph, node) if other not in leaves and other != come]
            if len(steps) != 1:
                return (node, leaves) if len(leaves) == 2 else None
            following, step = self.from_to(node, steps[0])
            far += step
            if far > self.radius[following] / 2 or self.graph.degree(following) != 3:
                return node, leaves
            more = [other for other, _ in hops(self.graph, following) if other in self.corner]
            if not more:
                return None
            if len(more) != 1 or not self.beside(more[0], leaves):
                return node, leaves
            turn = 180 - angle(self.ring, self.corner[more[0]])
            if turn < min(180 - angle(self.ring, self.corner[leaf]) for leaf in leaves) / 2:
                return node, leaves
            come = self.before
            node, leaves = following, {*leaves, *more}

    def from_to(self, node, step):
        """The next node that is no mere bend; that before it is kept."""
        far = min(arc["length"] for arc in self.graph[node][step].values())
        come = node
        while self.graph.degree(step) == 2:
            (following,) = [other for other in self.graph[step] if other != come]
            far += min(arc["length"] for arc in self.graph[step][following].values())
            come, step = step, following
        self.before = come
        return step, far


def expected(skeleton):
    """The ends of the longest path (None: a round one), and its length without forks; None if it is not unique."""
    graph = networkx.MultiGraph(vorotool.to_networkx(skeleton, by="arc"))
    ends = Ends(skeleton, graph).found
    if None in ends:
        return None
    at = {}
    for node, found in ends:
        if found & set(at):
            return None
        at |= dict.fromkeys(found, (node, found))
    leaves = [node for node, degree in graph.degree() if degree == 1]
    ways = dict(networkx.all_pairs_dijkstra_path_length(graph, weight="length"))
    pairs = [pair for pair in combinations(leaves, 2) if pair[0] not in at or at[pair[0]] is not at.get(pair[1])]
    pairs.sort(key=lambda pair: -ways[pair[0]][pair[1]])
    (a, b), most = pairs[0], ways[pairs[0][0]][pairs[0][1]]
    if len(pairs) > 1 and ways[pairs[1][0]][pairs[1][1]] > most * (1 - 1e-9):
        return None
    inner = [at[leaf][0] if leaf in at else leaf for leaf in (a, b)]
    return [place(skeleton, at, leaf) for leaf in (a, b)], ways[inner[0]][inner[1]]


def place(skeleton, at, leaf):
    """Where a path ends: None in a round end."""
    if leaf not in at:
        return skeleton.vertices[leaf].tolist()
    leaves = at[leaf][1]
    return skeleton.vertices[list(leaves)].mean(axis=0).tolist() if len(leaves) == 2 else None
