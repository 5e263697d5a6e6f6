"""The brute force against what is known without it."""

import numpy as np
from scipy.spatial import Voronoi

from support.oracles.segment_oracle import differences, rings_of, voronoi_diagram

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]
RING = [(0, 1), (1, 2), (2, 3), (3, 0)]


def test_a_square_by_hand():
    diagram = voronoi_diagram(SQUARE, RING)
    assert rings_of(diagram) == [(0, 4, 7), (1, 5, 4), (2, 6, 5), (3, 7, 6), (4, 5, 6, 7)]
    np.testing.assert_array_equal(diagram.vertices, [*SQUARE, (2, 2)])
    np.testing.assert_array_equal(diagram.radius, [0, 0, 0, 0, 2])
    assert len(diagram.edges) == 12
    assert (diagram.edges == -1).sum() == 8


def test_points_on_a_line():
    for points, segments in ([(0, 0), (1, 1)], []), ([(0, 0), (8, 0), (4, 0)], [(0, 2), (1, 2)]):
        diagram = voronoi_diagram(points, segments)
        assert len(diagram.vertices) == 0
        assert diagram.edges.tolist() == [[-1, -1]] * (len(points) + len(segments) - 1)
    assert len(voronoi_diagram([(3, 3)], []).edges) == 0


def test_a_crossroads_has_no_cell_of_its_own():
    """Gaps of 90 degrees leave the middle without a cell; a gap of 180 degrees leaves it a line."""
    ends = [(0, 0), (4, 0), (0, 4), (-4, 0), (0, -4)]
    cross = voronoi_diagram(ends, [(0, 1), (0, 2), (0, 3), (0, 4)])
    assert (5, 6, 7, 8) in rings_of(cross)
    assert not (cross.edge_sites == 0).any()
    tee = voronoi_diagram(ends[:4], [(0, 1), (0, 2), (0, 3)])
    assert (0, 4, 5, 6) in rings_of(tee)
    assert (tee.edge_sites == 0).any(axis=1).sum() == 2


def test_points_against_qhull():
    rng = np.random.default_rng(3)
    points = rng.integers(-1000, 1000, (14, 2))
    diagram, peer = voronoi_diagram(points, []), Voronoi(points)
    assert len(diagram.edges) == len(peer.ridge_points)
    assert set(map(tuple, np.sort(diagram.edge_sites))) == set(map(tuple, np.sort(peer.ridge_points)))
    for vertices in (diagram.vertices, peer.vertices):
        vertices[:] = vertices[np.lexsort(vertices.T)]
    np.testing.assert_allclose(diagram.vertices, peer.vertices, rtol=1e-9, atol=1e-6)


def test_regular_polygons_have_one_center_and_differences_are_named():
    points = [(5, 0), (4, 3), (3, 4), (0, 5), (-3, 4), (-4, 3), (-5, 0), (0, -5)]
    diagram = voronoi_diagram(points, [])
    assert rings_of(diagram) == [tuple(range(8))]
    assert differences(diagram, diagram) == []
    other = voronoi_diagram(points[:-1], [])
    assert len(differences(other, diagram)) > 8
    moved = voronoi_diagram(points, [])
    moved.vertices += 1e-9
    assert "is at" in differences(moved, diagram)[0]
