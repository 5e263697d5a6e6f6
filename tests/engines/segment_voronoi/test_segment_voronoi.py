"""The segment Voronoi diagram against brute force, the checker, and itself under symmetries."""

import warnings

import numpy as np
import pytest

import vorotool
from support.families import skeleton_shapes
from support.families.segment_families import (
    BOOST_FAILURE,
    FAMILIES,
    JOINED,
    LIMIT,
    coarse,
    draw,
    polygon,
    symmetries,
)
from support.few import few
from support.oracles import boost_oracle
from support.oracles.segment_oracle import differences, voronoi_diagram
from vorotool import _core
from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi, unwanted_sides, verify_segment_voronoi
from vorotool.errors import InputError, LimitError

SMALL = 16
"""Sites that brute force takes a fraction of a second for."""


def assert_right(points, segments):
    diagram = segment_voronoi(points, segments, threads=1)
    assert not differences(diagram, voronoi_diagram(points, segments))
    verify_segment_voronoi(diagram, threads=1)


@pytest.mark.parametrize("name", few([name for name in FAMILIES if name not in ("contour", "partition")], 12))
def test_brute_force_agrees(name):
    points, segments = next(
        graph for n in range(7, 0, -1) for graph in [draw(name, n, 1)] if len(graph[0]) + len(graph[1]) <= SMALL
    )
    assert_right(points, segments)


@pytest.mark.parametrize("name", few(FAMILIES, 12))
def test_boost_agrees_on_small_coordinates(name):
    for seed in range(4):
        points, segments = coarse(*draw(name, 40, seed), 2**12)
        diagram = segment_voronoi(points, segments, threads=1)
        assert not boost_oracle.differences(diagram, boost_oracle.boost_edges(points, segments))


@pytest.mark.parametrize(
    ("points", "segments"),
    [
        polygon(BOOST_FAILURE),
        # Points beside a segment, small coordinates.
        ([[-11, 29], [0, 28], [1, 27], [5, 26], [6, -25], [6, 1], [6, 27]], [[0, 3]]),
        ([[-3802, 3390], [-3283, -1014], [-3236, -172], [-2901, -2183]], [[3, 0]]),
    ],
)
def test_graphs_on_which_boost_is_wrong(points, segments):
    """Not in every direction of its sweep."""
    points, segments = np.array(points, np.int32), np.array(segments, np.int32)
    assert_right(points, segments)
    wrong = 0
    for turned in symmetries(points):
        diagram = segment_voronoi(turned, segments)
        verify_segment_voronoi(diagram)
        wrong += bool(boost_oracle.differences(diagram, boost_oracle.boost_edges(turned, segments)))
    assert wrong, "Boost is right now: say so where the polygon is named"


@pytest.mark.parametrize(
    ("points", "segments"),
    [
        # A segment enters a disc so near to its end that doubles do not tell on which side of the end.
        ([[1, -3], [2, -2], [0, -1000001], [0, -1000003]], [[2, 0], [1, 2], [2, 3], [1, 3]]),
        (
            [[0, 0], [LIMIT, 0], *([LIMIT - (k % 5 in (2, 4, 5)), -k] for k in range(1, 5)), [LIMIT // 2 + 1, -5]],
            [[0, k] for k in range(1, 7)],
        ),
        # Two vertices on the normal of a segment at its end, on opposite sides.
        ([[1, 1073741786], [1, 1073741785], [2, 1073741786], [0, 3]], [[0, 3], [1, 2]]),
    ],
)
def test_graphs_that_were_wrong_once(points, segments):
    for k, turned in enumerate(symmetries(np.array(points, np.int32))):
        diagram = segment_voronoi(turned, np.array(segments, np.int32), threads=1)
        verify_segment_voronoi(diagram, threads=1)
        if k % 4 == 0 or len(points) < 6:
            assert not differences(diagram, voronoi_diagram(turned, segments))


def test_a_closed_form_with_five_roundings_too_many_is_refined():
    """The disc on the normal at a point that touches a segment: formulas in doubles err by 5 ulp here."""
    points = np.array(
        [[-96936238, -298339065], [-203354759, -279893813], [-313710510, 0], [-309901800, -100693199]], dtype=np.int32
    )
    diagram = segment_voronoi(points, np.array([[1, 0], [2, 3]], dtype=np.int32))
    expected = 259239000.470605083663605  # in 60 digits
    error = np.abs(diagram.radius - expected).min()
    assert error <= np.spacing(expected)


def test_what_is_far_away_changes_no_digit():
    """Of three lines two are parallel: their disc is rounded from exact numbers, whichever line was inserted last."""
    shape = [(148589473, -268454), (215698337, -268454), (215698337, -268119), (182143905, -268052)]
    bounds = [(-618351521, -201595080), (618351521, 201595080)]
    found = set()
    for count in range(8):
        far = [(1000 * k - 618351521, 100 * k * k - 201595080) for k in range(1, 2 * count + 1)]
        points = np.array([*shape, (148589473, -268052), *bounds, *far], dtype=np.int32)
        segments = np.array([*((k, (k + 1) % 5) for k in range(5)), *((k, k + 1) for k in range(7, len(points), 2))])
        diagram = segment_voronoi(points, segments)
        inside = (np.abs(diagram.radius - 201) < 1) & (diagram.vertices[:, 0] > shape[0][0])
        found.add((diagram.vertices[inside].tobytes(), diagram.radius[inside].tobytes()))
    assert len(found) == 1


@pytest.mark.parametrize("name", few(name for name in FAMILIES if name not in JOINED))
def test_visited_vertices_grow_as_log_n(name):
    """Every doubling adds at most 4. Teeth see all the others: in a plain spatial order the work is quadratic."""
    graphs = [draw(name, n, 2) for n in (256, 1_024, 4_096)]
    visited = [
        _core.segment_voronoi.SegmentVoronoi(*graph, 1, None).counts["visited"] / len(graph[1]) for graph in graphs
    ]
    assert (np.diff(visited) < 4 * np.log2(4)).all()


@pytest.mark.parametrize(
    ("points", "segments", "vertices", "edges"),
    [
        ([], [], 0, 0),
        ([[3, 4]], [], 0, 0),
        ([[0, 0], [4, 0]], [], 0, 1),
        ([[0, 0], [4, 0]], [[0, 1]], 0, 2),
        ([[0, 0], [4, 0], [8, 0]], [[1, 0], [1, 2]], 0, 4),
        ([[0, 0], [4, 0], [0, 3]], [], 1, 3),
        ([[0, 0], [2, 0], [2, 2], [0, 2]], [], 1, 4),
    ],
)
def test_few_sites(points, segments, vertices, edges):
    diagram = segment_voronoi(points, segments)
    assert (len(diagram), len(diagram.edges)) == (vertices, edges)
    assert_right(np.array(points, np.int32).reshape(-1, 2), np.array(segments, np.int32).reshape(-1, 2))


@pytest.mark.parametrize(
    ("points", "segments", "message"),
    [
        ([[0, 0], [1, 1]], [[0, 2]], "segment 0 ends at point 2, but there are 2 points"),
        ([[0, 0], [1, 1]], [[0, 1], [1, 1]], "both ends of segment 1 are the same point"),
        ([[0, 0], [1, 1], [0, 0]], [], "points 0 and 2 are at one place"),
        ([[0, 2**30]], [], "beyond 1073741823"),
        ([[0.5, 1]], [], "must be integers"),
        ([0, 1], [], "must have shape"),
        ([[0, 0], [9, 9], [0, 9], [9, 0]], [[0, 1], [2, 3]], "segments 0 and 1 cross"),
        ([[0, 0], [9, 0], [4, 0]], [[0, 1]], "point 2 lies inside segment 0"),
    ],
)
def test_bad_input_is_named(points, segments, message):
    with pytest.raises(InputError, match=message):
        segment_voronoi(points, segments)


def test_too_many_sites_are_refused_before_memory_is_taken():
    points = np.broadcast_to(np.zeros((1, 2), np.int32), (2**28, 2))
    with pytest.raises(LimitError, match="more than 268435455"):
        segment_voronoi(points, [])


# ---- Diagrams of which one side is left out: what is made of the other one is the same ----
def contours(random):
    """Polygons with vertices inside straight edges, at which cells have no area."""
    image = np.kron(random.integers(0, 2, (6, 8)), np.ones((3, 3), dtype=int))
    return vorotool.outlines(image, outline="contour")


SHAPES = (*skeleton_shapes.FAMILIES, *skeleton_shapes.TOUCHING, contours)


def graphs(family):
    with warnings.catch_warnings(action="ignore"):
        for seed in range(12):
            graph = planar_graph(family(np.random.default_rng(seed)))
            is_joined = np.isin(np.arange(len(graph.points)), graph.segments).all()
            if graph.is_inside.any() and is_joined:
                yield graph


@pytest.mark.parametrize("family", SHAPES, ids=lambda family: family.__name__)
def test_what_is_left_is_of_the_whole_diagram_and_in_its_order(family):
    for graph in graphs(family):
        whole = segment_voronoi(graph.points, graph.segments)
        part = segment_voronoi(graph.points, graph.segments, unwanted=unwanted_sides(graph, graph.is_inside))
        known = {tuple(whole.sites_of(v).tolist()): v for v in range(len(whole))}
        at = [known[tuple(part.sites_of(v).tolist())] for v in range(len(part))]
        assert at == sorted(at)
        assert np.array_equal(whole.vertices[at], part.vertices)
        assert np.array_equal(whole.radius[at], part.radius)
        assert (whole.radius[np.setdiff1d(np.arange(len(whole)), at)] > 0).all()
        number = np.append(at, -1)
        edges = {tuple(row): k for k, row in enumerate(np.hstack([whole.edges, whole.edge_sites]).tolist())}
        own = np.hstack([number[part.edges], part.edge_sites]).tolist()
        places = [edges[tuple(row)] for row in own]
        assert places == sorted(places)
