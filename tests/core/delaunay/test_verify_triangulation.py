"""Mutations: the checker finds every fault that is put into a right triangulation."""

from dataclasses import replace

import numpy as np
import pytest

from support.families.point_families import draw
from vorotool import Triangulation, VerificationError, delaunay, verify_triangulation

pytestmark = pytest.mark.filterwarnings("ignore::vorotool.VorotoolWarning")
ARRAYS = ("triangles", "neighbors", "edges", "hull", "first")
SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]


def from_triangles(points, triangles):
    """A mesh with the neighbors, edges and hull that follow from its triangles."""
    triangles = np.asarray(triangles, np.int32)
    sides = {}
    for t, corners in enumerate(triangles.tolist()):
        for k in range(3):
            sides[corners[(k + 1) % 3], corners[(k + 2) % 3]] = t, k
    neighbors = np.full_like(triangles, -1)
    for (a, b), (t, k) in sides.items():
        neighbors[t, k] = sides.get((b, a), (-1, 0))[0]
    onwards = {a: b for a, b in sides if (b, a) not in sides}
    hull = [min(onwards, key=lambda v: tuple(points[v]))]
    while onwards[hull[-1]] != hull[0] and len(hull) < len(points):
        hull.append(onwards[hull[-1]])
    edges = sorted({(min(a, b), max(a, b)) for a, b in sides})
    return Triangulation(points, triangles, neighbors, edges, hull, np.arange(len(points)))


def flipped(mesh, t, k):
    """The triangles with one edge replaced by the other diagonal."""
    triangles, u = mesh.triangles.copy(), mesh.neighbors[t, k]
    apex, a, b = np.roll(triangles[t], -k)
    far = next(v for v in triangles[u] if v not in (a, b))
    triangles[t], triangles[u] = (apex, a, far), (apex, far, b)
    return from_triangles(mesh.points, triangles)


def fault(mesh):
    with pytest.raises(VerificationError) as caught:
        verify_triangulation(mesh, threads=2)
    return str(caught.value)


@pytest.mark.parametrize("name", ["uniform", "grid", "rotated_grid"])
def test_the_mesh_that_follows_from_the_triangles_is_right(name):
    mesh = delaunay(draw(name, 80, 1))
    verify_triangulation(from_triangles(mesh.points, mesh.triangles))


@pytest.mark.parametrize("name", ["uniform", "small_lattice", "circle"])
def test_every_flip_is_found(name):
    points = np.unique(draw(name, 40, 2), axis=0)
    mesh = delaunay(points)
    found = set()
    for t, k in np.argwhere(mesh.neighbors >= 0):
        found.add(fault(flipped(mesh, t, k)).translate(str.maketrans("", "", "0123456789")).strip())
    if name == "uniform":
        assert found == {"the circle of triangle  holds point", "triangle  is not counter-clockwise"}


def test_every_dropped_triangle_is_found():
    mesh = delaunay(draw("uniform", 40, 3))
    for t in range(len(mesh)):
        fault(from_triangles(mesh.points, np.delete(mesh.triangles, t, axis=0)))


@pytest.mark.parametrize("name", ["uniform", "small_lattice"])
def test_any_changed_number_is_found(name):
    """Every entry of every array, changed to something else that is in range or just out of it."""
    mesh = delaunay(draw(name, 10, 4))
    for array in ARRAYS:
        values = getattr(mesh, array)
        limit = len(mesh) if array == "neighbors" else len(mesh.points)
        for place in np.ndindex(values.shape):
            for other in range(-2, limit + 1):
                if other == values[place]:
                    continue
                changed = values.copy()
                changed[place] = other
                fault(replace(mesh, **{array: changed}))


def test_a_hull_gone_round_twice_is_found():
    """A double cover of a disc, branched at its middle: locally all is Delaunay."""
    angle = np.arange(12) * (4 * np.pi / 12)
    radius = 1 + 0.05 * (np.arange(12) >= 6)
    points = np.concatenate([np.stack([np.cos(angle), np.sin(angle)], 1) * radius[:, None], [[0, 0]]])
    triangles = [[12, i, (i + 1) % 12] for i in range(12)]
    assert "hull" in fault(from_triangles(points, triangles))


def test_a_notch_in_the_hull_is_found():
    mesh = delaunay([[0, 0], [4, 0], [4, 4], [0, 4], [2, 1]])
    below = next(t for t, corners in enumerate(mesh.triangles.tolist()) if set(corners) == {0, 1, 4})
    left = from_triangles(mesh.points, np.delete(mesh.triangles, below, axis=0))
    assert fault(left) == "the hull is not convex at point 4"


def test_not_finite():
    mesh = delaunay(SQUARE)
    assert fault(replace(mesh, points=[*SQUARE[:3], [0, np.nan]])) == "a coordinate is not finite"
