"""The rings of a planar graph, and what its sites are there."""

import warnings

import numpy as np
import pytest

import vorotool
from support.families.skeleton_shapes import FAMILIES
from vorotool.engines.arrangement.planar_graph import planar_graph, verify_planar_graph
from vorotool.engines.arrangement.repaired_polygons import placed_shapes
from vorotool.errors import VorotoolWarning
from vorotool.types.skeleton.skeleton import EDGE, Skeleton


def graph_of(shape):
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        return planar_graph(shape)


def site_ends(placed):
    """The places of sites, as a skeleton without arcs has them."""
    nothing = {name: np.empty(0) for name in ("radius", "arcs", "control", "sites", "polygon", "side")}
    rest = {name: np.empty(0) for name in ("branch", "length", "error_bound")}
    return Skeleton(np.empty((0, 2)), **nothing, **rest, site_table=placed.sites, polygons=placed.polygons).site_ends


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.__name__)
def test_every_site_is_where_the_graph_has_it(family):
    rng = np.random.default_rng(3)
    for _ in range(10):
        graph = graph_of(family(rng))
        placed = placed_shapes(graph)
        points = graph.coordinates()
        ends = site_ends(placed)
        assert np.array_equal(ends[: len(points), 0], points)
        wanted = np.sort(points[graph.segments].view([("x", float), ("y", float)])[..., 0], axis=1)
        found = np.sort(np.ascontiguousarray(ends[len(points) :]).view([("x", float), ("y", float)])[..., 0], axis=1)
        assert np.array_equal(found, wanted)
        assert (placed.sites.kind == EDGE).sum() == len(graph)


@pytest.mark.filterwarnings("ignore::vorotool.errors.RepairWarning")
def test_holes_that_are_points_and_segments_on_the_lattice_only():
    """Vertices of three places that the lattice has at one or two."""
    far = 2.0**40
    point = [[far / 2, far / 2], [far / 2 + 9, far / 2], [far / 2, far / 2 + 9]]
    segment = [[far / 4, far / 4], [far / 4, far / 4 + 9], [far / 2, far / 4]]
    shape = {"shell": [[0, 0], [far, 0], [far, far], [0, far]], "holes": [segment, point]}
    graph = graph_of([shape])
    verify_planar_graph(graph)
    placed = placed_shapes(graph)
    assert np.diff(placed.polygons.ring_starts).tolist() == [4, 2, 1]
    ends = site_ends(placed)
    assert np.array_equal(ends[: len(graph.points), 0], graph.coordinates())
    made, expected = (
        vorotool.skeleton_exact({**shape, "holes": holes}) for holes in ([segment, point], [segment[::2], point[:1]])
    )
    vorotool.verify_skeleton(made)
    assert np.array_equal(made.vertices, expected.vertices)
