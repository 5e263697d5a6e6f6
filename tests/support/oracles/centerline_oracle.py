"""Centerlines of polygons without holes by brute force: all pairs of ends, told by coordinates and angles."""

from itertools import combinations

import networkx
import numpy as np


def angle(ring, k):
    """Inside, at a corner that is convex."""
    before, at, behind = (ring[step % len(ring)] for step in (k - 1, k, k + 1))
    (ux, uy), (vx, vy) = np.subtract(before, at), np.subtract(behind, at)
    return np.degrees(np.arctan2(abs(ux * vy - uy * vx), ux * vx + uy * vy))


def branch_graph(skeleton):
    """Junctions and leaves; on each branch its length, and the sites that are beside all of it."""
    graph = networkx.MultiGraph()
    for branch in np.unique(skeleton.branch):
        arcs = np.flatnonzero(skeleton.branch == branch)
        beside = set.intersection(*({*pair} for pair in skeleton.sites[arcs].tolist()))
        ends = int(skeleton.arcs[arcs[0], 0]), int(skeleton.arcs[arcs[-1], 1])
        graph.add_edge(*ends, length=skeleton.length[arcs].sum(), beside=beside)
    return graph


class Ends:
    """Forks and round ends, each grown corner by corner."""

    def __init__(self, skeleton, graph):
        self.ring = skeleton.polygons.ring(0).tolist()
        self.graph, self.radius = graph, skeleton.radius
        table = skeleton.site_table
        self.edge = {int(table.index[site]): site for site in np.flatnonzero(table.kind == 1).tolist()}
        place = {tuple(at): k for k, at in enumerate(skeleton.vertices.tolist())}
        leaves = [place.get(tuple(at)) for at in self.ring]
        self.corner = {node: k for k, node in enumerate(leaves) if graph.has_node(node) and graph.degree(node) == 1}
        self.found = []
        for k, one in enumerate(leaves):
            other = leaves[(k + 1) % len(leaves)]
            if one in self.corner and other in self.corner:
                (a,), (b,) = graph[one], graph[other]
                if a == b and self.is_end(k):
                    self.found.append(self.grown(a, {one, other}))

    def is_end(self, k):
        """Whether the edge from a corner to the next one is along both branches, and neither is a tip."""
        count = len(self.ring)
        angles = [angle(self.ring, corner) for corner in (k, k + 1)]
        corners = [node for node, at in self.corner.items() if at in (k % count, (k + 1) % count)]
        branches = [arc for node in corners for _, _, arc in self.graph.edges(node, data=True)]
        along = all(self.edge[k % count] in arc["beside"] for arc in branches)
        return len(corners) == 2 and along and min(angles) >= 45 and abs(angles[0] - angles[1]) <= 90

    def beside(self, leaf, leaves):
        """Whether a corner is next to one of some, at an edge that is an end of both."""
        k, count = self.corner[leaf], len(self.ring)
        others = {self.corner[other] for other in leaves}
        return ((k + 1) % count in others and self.is_end(k)) or ((k - 1) % count in others and self.is_end(k - 1))

    def grown(self, node, leaves):
        """(node, leaves): from a fork on; None where more than one corner comes, which this does not follow."""
        far = 0.0
        come = None
        while True:
            steps = [(other, arc) for _, other, arc in self.graph.edges(node, data=True) if other not in leaves]
            steps = [(other, arc) for other, arc in steps if other != come]
            if len(steps) != 1:
                return (node, leaves) if len(leaves) == 2 else None
            ((following, arc),) = steps
            far += arc["length"]
            if far > self.radius[following] / 2:
                return node, leaves
            more = [other for other in self.graph[following] if other in self.corner]
            if len(more) != 1 or self.graph.degree(following) != 3:
                return None
            if not self.beside(more[0], leaves):
                return node, leaves
            turn = 180 - angle(self.ring, self.corner[more[0]])
            if turn < min(180 - angle(self.ring, self.corner[leaf]) for leaf in leaves) / 2:
                return node, leaves
            come, node, leaves = node, following, {*leaves, *more}


def expected(skeleton):
    """The ends of the longest path (None: a round one), and its length without forks; None if it is not unique."""
    graph = branch_graph(skeleton)
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
