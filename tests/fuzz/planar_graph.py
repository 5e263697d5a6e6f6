"""Planar graphs of rings of every family: `--cases 100000 --seed 1`.

Each case is checked by the shipped checker, and its segments given again as lines must come back as they are; small
ones are compared with the definition in rationals: segments, the edges that each is part of, the polygons of its sides.
"""

import numpy as np

from fuzz.runner import Cases, Comparison, Verdict
from support.families.polygon_families import FAMILIES, LINE, draw, graph_of
from support.oracles import planar_graph_oracle as oracle
from vorotool import VorotoolError, verify_planar_graph

SMALL = 11
NAMES = list(FAMILIES)


def failure(vertices: np.ndarray, rings: list[tuple[int, int, int, int]]) -> str | None:
    """What is wrong with the graph of these rings, if anything."""
    graph = graph_of(vertices, rings)
    try:
        verify_planar_graph(graph)
    except VorotoolError as error:
        return str(error)
    if len(graph):
        ends = np.ascontiguousarray(graph.points[graph.segments].reshape(-1, 2))
        lines = [(2 * i, 2 * i + 2, LINE, i) for i in range(len(graph))]
        again = graph_of(ends, lines)
        if any(again.repairs.values()) or not np.array_equal(again.points[again.segments].reshape(-1, 2), ends):
            return "its segments do not come back as they are"
    if len(vertices) <= SMALL:
        expected, moved = oracle.planar_graph(vertices.tolist(), rings)
        if oracle.described(graph) != expected or graph.repairs["moved_edges"] != moved:
            return "not what the definition gives"
        if oracle.holes_of(graph) != oracle.point_holes(vertices.tolist(), rings, expected):
            return "not the holes of one place that the definition gives"
    return None


def check(case: int, cases: Cases) -> Verdict:
    """Make the graph of some rings."""
    rng, name = cases.random(case), NAMES[case % len(NAMES)]
    n = int(rng.integers(1, SMALL + 1)) if rng.random() < 0.5 else int(2 ** rng.uniform(3, 8))
    vertices, rings = draw(name, n, cases.seed(case))
    try:
        wrong = failure(vertices, rings)
    except Exception as error:  # whatever it is, the case is to be known
        wrong = repr(error)
    return name, wrong, f"{len(vertices)} vertices"


COMPARISON = Comparison(10**5, check)
