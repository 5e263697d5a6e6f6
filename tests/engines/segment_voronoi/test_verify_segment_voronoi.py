from dataclasses import replace

import numpy as np
import pytest

from support.families import segment_families
from support.few import few
from support.oracles.segment_oracle import voronoi_diagram
from vorotool.engines.segment_voronoi.segment_voronoi import verify_segment_voronoi
from vorotool.errors import VerificationError
from vorotool.types.skeleton.segment_voronoi import SegmentVoronoiDiagram

SQUARE = ([(0, 0), (8, 0), (8, 4), (0, 4)], [(0, 1), (1, 2), (2, 3), (3, 0)])
TEE = ([(0, 0), (4, 0), (8, 0), (4, 4), (-20, 7)], [(0, 1), (1, 2), (1, 3)])


def right(points, segments):
    """The diagram by brute force."""
    diagram = voronoi_diagram(points, segments)
    return SegmentVoronoiDiagram(**vars(diagram))


def fault_of(diagram):
    with pytest.raises(VerificationError) as caught:
        verify_segment_voronoi(diagram)
    return str(caught.value)


@pytest.fixture(scope="module")
def graph():
    """A diagram with parabolas, corners, dangling ends, lone points and infinite edges."""
    points = [(0, 0), (40, 0), (40, 30), (0, 30), (10, 10), (30, 12), (20, 22), (60, 5), (70, 40), (-20, -9)]
    return right(points, [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (7, 8)])


@pytest.mark.parametrize("size", [2, 4, 9, 60, 10**6, 2**30 - 1])
def test_right_diagrams_pass(size):
    rng = np.random.default_rng(size)
    for _ in range(2):
        graph = segment_families.random_graph(rng, int(rng.integers(2, 9)), int(rng.choice([0, 6, 12, 24])), size)
        verify_segment_voronoi(right(*graph))


@pytest.mark.parametrize(
    "name", few(["regular", "tiled", "needles", "strips", "wheel", "chains", "clusters", "crowded"], 3)
)
def test_right_diagrams_of_families_pass(name):
    verify_segment_voronoi(right(*segment_families.draw(name, 5, 4)))


@pytest.mark.parametrize("points", [[], [(3, 4)], [(3, 4), (5, 6)], [(0, 0), (1, 2), (3, 6)]])
def test_few_and_collinear_points_pass(points):
    verify_segment_voronoi(right(points, []))


# ---- each kind of corruption is found ----


@pytest.mark.parametrize("ulps", [-100, 100])
@pytest.mark.parametrize("what", ["x", "y", "r"])
def test_values_off_by_some_ulp(graph, what, ulps):
    for vertex in np.flatnonzero(graph.radius > 0):
        vertices, radius = graph.vertices.copy(), graph.radius.copy()
        size = max(np.abs(vertices[vertex]).max(), radius[vertex])
        if what == "r":
            radius[vertex] += ulps * np.spacing(radius[vertex])
        else:
            vertices[vertex, "xy".index(what)] += ulps * np.spacing(size)
        fault = fault_of(replace(graph, vertices=vertices, radius=radius))
        assert fault.startswith(f"vertex {vertex} of sites")
        assert "would be right" in fault


def test_few_ulps_pass(graph):
    sign = np.where(np.arange(len(graph)) % 2 == 0, 1, -1)
    moved = graph.vertices + (graph.radius > 0)[:, None] * sign[:, None] * np.spacing(np.abs(graph.vertices))
    verify_segment_voronoi(replace(graph, vertices=moved))


def test_a_disc_that_a_site_enters(graph):
    """A further lone point that no cell belongs to; and one whose cell is a neighbor's."""
    points = np.append(graph.points, [[25, 5]], axis=0).astype(np.int32)
    count = len(graph.points)

    def renumbered(sites):
        return sites + (sites >= count)

    more = replace(
        graph, points=points, vertex_sites=renumbered(graph.vertex_sites), edge_sites=renumbered(graph.edge_sites)
    )
    assert fault_of(more) == f"site {count} has no cell"
    moved = graph.points.copy()
    moved[9] = 50, 20  # the lone point: other vertices' discs hold it now
    assert "vertex" in fault_of(replace(graph, points=moved)) or "edge" in fault_of(replace(graph, points=moved))


def test_a_point_moved_into_a_disc():
    points = [(0, 0), (100, 0), (100, 100), (0, 100), (50, 140)]
    diagram = right(points, [(0, 1), (1, 2), (2, 3), (3, 0)])
    for y in range(139, 101, -5):
        moved = replace(diagram, points=np.array([*points[:4], (50, y)], dtype=np.int32))
        assert "would be right" in fault_of(moved)
    far = right([*points, (50, 1000)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    lone = np.array([*points, (50, 149)], dtype=np.int32)
    assert fault_of(replace(far, points=lone))


def dropped(diagram, vertex):
    """Without one vertex of degree 3, one of its edges, and the other two in one."""
    ends = [k for k in range(len(diagram.edges)) if vertex in diagram.edges[k]]
    edges, sites = diagram.edges.tolist(), diagram.edge_sites.tolist()
    gone, first, second = ends
    other = [v for k in (first, second) for v in edges[k] if v != vertex]
    keep = [k for k in range(len(edges)) if k not in ends]
    number = [v - (v > vertex) for v in range(len(diagram))]
    start = diagram.vertex_starts
    return replace(
        diagram,
        vertices=np.delete(diagram.vertices, vertex, axis=0),
        radius=np.delete(diagram.radius, vertex),
        vertex_starts=np.cumsum([0, *np.delete(np.diff(start), vertex)]),
        vertex_sites=np.delete(diagram.vertex_sites, np.arange(start[vertex], start[vertex + 1])),
        edges=[[number[v] if v >= 0 else -1 for v in edges[k]] for k in keep]
        + [[number[v] if v >= 0 else -1 for v in other]],
        edge_sites=[sites[k] for k in keep] + [sites[first]],
    ), gone


def test_missing_vertices(graph):
    for vertex in np.flatnonzero(np.diff(graph.vertex_starts) == 3):
        assert fault_of(dropped(graph, vertex)[0])


def test_missing_repeated_and_turned_edges(graph):
    for k in range(len(graph.edges)):
        without = replace(
            graph, edges=np.delete(graph.edges, k, axis=0), edge_sites=np.delete(graph.edge_sites, k, axis=0)
        )
        assert "no edge" in fault_of(without)
        twice = replace(
            graph,
            edges=np.append(graph.edges, graph.edges[k : k + 1], axis=0),
            edge_sites=np.append(graph.edge_sites, graph.edge_sites[k : k + 1], axis=0),
        )
        assert "have one place" in fault_of(twice)
        sites = graph.edge_sites.copy()
        sites[k] = sites[k, ::-1]
        assert "does not fit" in fault_of(replace(graph, edge_sites=sites))
        both = graph.edges.copy()
        both[k] = both[k, ::-1]
        verify_segment_voronoi(replace(graph, edges=both, edge_sites=sites))


def test_edges_of_one_bisector_exchanged():
    """Two walls with a post between them: the rings fit."""
    diagram = right([(0, 0), (100, 0), (0, 10), (100, 10), (50, 5)], [(0, 1), (2, 3)])
    pairs = np.sort(diagram.edge_sites, axis=1)
    twins = [k for k in range(len(pairs)) if (pairs == pairs[k]).all(axis=1).sum() == 2]
    i, j = [k for k in twins if (pairs[k] == [5, 6]).all()]
    edges = diagram.edges.copy()
    same = (diagram.edge_sites[i] == diagram.edge_sites[j]).all()
    column = 1 if same else 0
    edges[i, 1], edges[j, column] = edges[j, column], edges[i, 1]
    fault = fault_of(replace(diagram, edges=edges))
    assert "bisector" in fault or "cycle" in fault


def test_rings(graph):
    ring = graph.vertex_sites.copy()
    start = int(graph.vertex_starts[3])
    ring[start : start + 3] = np.roll(ring[start : start + 3], 1)
    assert "the smallest site is not the first" in fault_of(replace(graph, vertex_sites=ring))
    ring[start + 1] = ring[start]
    assert "a site is twice" in fault_of(replace(graph, vertex_sites=ring))
    ring[start] = 99
    assert "out of range" in fault_of(replace(graph, vertex_sites=ring))


def test_a_vertex_split_in_two():
    """The center of a rectangle's tie as two vertices that an edge of length zero joins."""
    diagram = right([(0, 0), (2, 0), (2, 2), (0, 2)], [])
    verify_segment_voronoi(diagram)
    split = SegmentVoronoiDiagram(
        diagram.points,
        diagram.segments,
        [[1, 1], [1, 1]],
        [2**0.5, 2**0.5],
        [0, 3, 6],
        [0, 1, 2, 0, 2, 3],
        [[-1, 0], [-1, 0], [-1, 1], [-1, 1], [0, 1]],
        [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]],
    )
    assert "touches site" in fault_of(split)


def test_mirrored_diagrams_are_no_diagrams(graph):
    mirrored = replace(graph, points=graph.points * [-1, 1], vertices=graph.vertices * [-1, 1])
    assert fault_of(mirrored)


def test_a_tee_and_a_square_by_their_cells():
    for graph in (SQUARE, TEE):
        diagram = right(*graph)
        verify_segment_voronoi(diagram)
        sites = diagram.vertex_sites.copy()
        for k in range(len(sites)):
            changed = sites.copy()
            changed[k] = (changed[k] + 1) % (len(graph[0]) + len(graph[1]))
            assert fault_of(replace(diagram, vertex_sites=changed))


def test_the_first_fault_does_not_depend_on_threads(graph):
    radius = graph.radius * 2
    faults = set()
    for threads in (1, 2, 3):
        with pytest.raises(VerificationError) as caught:
            verify_segment_voronoi(replace(graph, radius=radius), threads=threads)
        faults.add(str(caught.value))
    assert len(faults) == 1
