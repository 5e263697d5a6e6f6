"""Centerlines of polygons without holes by brute force: all pairs of ends, and forks told by coordinates and angles."""

from itertools import combinations

import networkx
import numpy as np

import vorotool


def angle(before, at, behind):
    (ux, uy), (vx, vy) = np.subtract(before, at), np.subtract(behind, at)
    return np.degrees(np.arctan2(abs(ux * vy - uy * vx), ux * vx + uy * vy))


def forks(skeleton, graph):
    """(node, leaf, leaf) of each edge of the polygon that both arcs of a fork lead to, and the middle of the edge."""
    ring = skeleton.polygons.ring(0).tolist()
    node = {tuple(place): k for k, place in enumerate(skeleton.vertices.tolist())}
    count, found = len(ring), {}
    for k in range(count):
        before, a, b, behind = (ring[(k + step) % count] for step in (-1, 0, 1, 2))
        one, other = node.get(tuple(a)), node.get(tuple(b))
        if one is None or other is None or graph.degree(one) != 1 or graph.degree(other) != 1:
            continue
        junctions = {*graph[one], *graph[other]}
        if len(junctions) == 1 and abs(angle(before, a, b) - angle(a, b, behind)) <= 90:
            found[(*junctions, one, other)] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]
    return found


def expected(skeleton):
    """The ends of the longest path, in order, and the length of what is between the forks; None if that is not unique.

    No three arcs of one junction may lead to corners.
    """
    graph = networkx.MultiGraph(vorotool.to_networkx(skeleton, by="arc"))
    middle = {}
    for (node, one, other), place in forks(skeleton, graph).items():
        if not {one, other} <= set(graph) or graph.degree(node) != 3:
            return None
        reach = {leaf: next(iter(graph[leaf][node].values()))["length"] for leaf in (one, other)}
        shorter = min(reach, key=reach.get)
        longer = one + other - shorter
        graph.remove_node(shorter)
        middle[longer] = place
    leaves = [node for node, degree in graph.degree() if degree == 1]
    ways = dict(networkx.all_pairs_dijkstra_path_length(graph, weight="length"))
    pairs = sorted(combinations(leaves, 2), key=lambda pair: ways[pair[0]][pair[1]])
    if len(pairs) < 2 or ways[pairs[-1][0]][pairs[-1][1]] < ways[pairs[-2][0]][pairs[-2][1]] * (1 + 1e-9):
        return None
    a, b = pairs[-1]
    own = ways[a][b] - sum(
        sum(arc["length"] for arc in next(iter(graph[leaf].values())).values()) for leaf in (a, b) if leaf in middle
    )
    return sorted(middle.get(leaf, skeleton.vertices[leaf].tolist()) for leaf in (a, b)), own
