"""Triangulations from elsewhere: scipy's, our own from their triangles alone, and what is none."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from vorotool import InputError, Triangulation, VerificationError, delaunay, verify_triangulation

SQUARE = [[0, 0], [2, 0], [2, 1], [0, 1]]


@pytest.mark.filterwarnings("ignore:.*lie on an earlier point")
@pytest.mark.parametrize("seed", range(6))
def test_triangles_alone_give_the_whole_triangulation(seed):
    random = np.random.default_rng(seed)
    points = random.integers(0, 9, (40, 2)) if seed % 2 else random.random((200, 2))
    mesh = delaunay(np.concatenate([points, points[:5]]))
    turned = mesh.triangles[random.permutation(len(mesh))]
    turned = np.where(random.random((len(mesh), 1)) < 0.5, turned[:, ::-1], turned)
    made = Triangulation.from_triangles(mesh.points, turned)
    verify_triangulation(made)
    assert made.hull.tolist() == mesh.hull.tolist()
    assert made.first.tolist() == mesh.first.tolist()
    assert {*map(tuple, made.edges.tolist())} == {*map(tuple, mesh.edges.tolist())}
    again = Triangulation.from_triangles(mesh.points, mesh.triangles)
    assert again.triangles.tolist() == mesh.triangles.tolist()
    assert again.neighbors.tolist() == mesh.neighbors.tolist()


def test_scipys_triangles_pass_the_checker():
    points = np.random.default_rng(7).random((500, 2))
    verify_triangulation(Triangulation.from_triangles(points, Delaunay(points).simplices))


def test_what_is_no_delaunay_triangulation_is_found():
    thin = [[0, 0], [9, 0], [5, 1], [4, -1]]
    verify_triangulation(Triangulation.from_triangles(thin, delaunay(thin).triangles))
    with pytest.raises(VerificationError):
        verify_triangulation(Triangulation.from_triangles(thin, [[0, 1, 2], [0, 3, 1]]))


@pytest.mark.parametrize(
    ("points", "triangles", "message"),
    [
        (SQUARE, [], "triangles is empty"),
        (SQUARE, [[0, 1]], r"\(1, 2\)"),
        (SQUARE, [[0.0, 1.0, 2.0]], "float64"),
        (SQUARE, [[0, 1, 2], [0, 1]], "triangles"),
        (SQUARE, [[0, 1, 4]], "triangle 0 is"),
        (SQUARE, [[0, 1, -1]], "triangle 0 is"),
        (SQUARE, [[0, 1, 2], [1, 1, 2]], "triangle 1 has no area"),
        ([[0, 0], [0.1, 0.1], [0.3, 0.3]], [[0, 1, 2]], "no area"),
        (SQUARE, [[0, 1, 2], [0, 1, 3]], "overlap"),
        ([[0, 0], [1, 0], [0, 1], [5, 0], [6, 0], [5, 1]], [[0, 1, 2], [3, 4, 5]], "several parts"),
        ([[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1]], [[0, 1, 2], [0, 3, 4]], "meets itself"),
    ],
)
def test_what_is_refused(points, triangles, message):
    with pytest.raises(InputError, match=message):
        Triangulation.from_triangles(points, triangles)
