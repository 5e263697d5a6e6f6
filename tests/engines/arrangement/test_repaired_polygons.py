"""Polygons read back from their planar graph."""

import warnings

import numpy as np
import pytest
import shapely

import vorotool
from support.families import skeleton_shapes
from support.families.polygon_families import FAMILIES, draw
from vorotool import PolygonSet
from vorotool.convert.polygons import as_polygons
from vorotool.engines.arrangement.planar_graph import planar_graph, verify_planar_graph
from vorotool.engines.arrangement.repaired_polygons import placed_shapes, repaired_polygons
from vorotool.errors import VorotoolWarning
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL
from vorotool.types.polygons.shapely_geometry import to_shapely
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import Skeleton

SQUARE = [[0, 0], [8, 0], [8, 8], [0, 8]]


def both(source):
    with warnings.catch_warnings(action="ignore"):
        graph = planar_graph(source)
    used = repaired_polygons(graph)
    check(graph, used)
    return graph, used


def check(graph, used):
    """Segments join the points of each ring; borders are used once a polygon, others not at all."""
    shapes = used.polygons
    np.testing.assert_array_equal(shapes.xy, graph.coordinates()[used.point])
    following = np.arange(1, len(used.point) + 1)
    following[shapes.ring_starts[1:] - 1] = shapes.ring_starts[:-1]
    there = used.segment >= 0
    last = shapes.ring_starts[1:][shapes.ring_kind == LINE] - 1
    assert np.flatnonzero(~there).tolist() == last.tolist()
    ends = np.sort(graph.segments[used.segment[there]], axis=1)
    np.testing.assert_array_equal(
        np.sort(np.stack([used.point, used.point[following % max(len(following), 1)]], axis=1)[there]), ends
    )
    ring = np.repeat(np.arange(len(shapes.ring_kind)), np.diff(shapes.ring_starts))
    source = used.source[shapes.ring_polygon[ring]]
    on_ring = shapes.ring_kind[ring] != LINE
    pairs = sorted(zip(used.segment[on_ring].tolist(), source[on_ring].tolist(), strict=True))
    expected = []
    for segment, (left, right) in enumerate(graph.segment_faces):
        expected += [(segment, p) for p in set(graph.polygons_of(left)) ^ set(graph.polygons_of(right))]
    assert pairs == sorted(expected)
    for index in np.flatnonzero(shapes.ring_kind != LINE):
        corners = used.point[shapes.ring_starts[index] : shapes.ring_starts[index + 1]]
        assert len(set(corners.tolist())) == len(corners) >= 3
        assert corners[0] == corners.min()


def test_what_the_input_says_of_polygons_is_kept():
    shapes = as_polygons([[[0, 0], [4, 4], [4, 0], [0, 4]], [[5, 5]], SQUARE])
    given = PolygonSet(
        shapes.xy,
        shapes.ring_starts,
        shapes.ring_kind,
        shapes.ring_polygon,
        ["a", "b", "c"],
        properties={"n": [1, 2, 3]},
        y_axis="up",
        crs={"type": "x"},
    )
    _, used = both(given)
    assert used.source.tolist() == [0, 0, 2]
    assert used.polygons.part.tolist() == [1, 2, 1]
    assert (used.polygons.ids, used.polygons.properties) == (["a", "a", "c"], {"n": [1, 1, 3]})
    assert (used.polygons.y_axis, used.polygons.crs) == ("up", {"type": "x"})


@pytest.mark.parametrize(
    ("shape", "kinds"),
    [
        ({"shell": SQUARE, "holes": [[[0, 0], [2, 1], [1, 2]]]}, [SHELL, HOLE]),
        ({"shell": SQUARE, "holes": [[[2, 2], [4, 2], [4, 4]], [[4, 4], [6, 4], [6, 6]]]}, [SHELL, HOLE, HOLE]),
        ({"shell": SQUARE, "holes": [[[4, 0], [6, 4], [4, 8], [2, 4]]]}, [SHELL, SHELL]),
        ({"shell": SQUARE, "holes": [[[4, 0], [6, 0], [6, 8], [4, 8]]]}, [SHELL, SHELL]),
        (
            {"shell": SQUARE, "holes": [[[2, 2], [6, 2], [4, 4]], [[4, 4], [6, 6], [2, 6]], [[2, 2], [2, 6], [1, 4]]]},
            [SHELL, HOLE, SHELL],
        ),
        ([[0, 0], [4, 4], [8, 0], [8, 8], [4, 4], [0, 8]], [SHELL, SHELL]),
        ([[0, 0], [8, 0], [4, 4], [8, 8], [0, 8], [4, 4]], [SHELL, SHELL]),
        ({"shell": SQUARE, "holes": [SQUARE]}, []),
    ],
)
def test_rings_that_touch(shape, kinds):
    _, used = both([shape])
    assert used.polygons.ring_kind.tolist() == kinds
    parts = to_shapely(used.polygons)
    assert shapely.is_valid(parts).all()
    shell, *holes = (shapely.make_valid(shapely.Polygon(ring)) for ring in as_polygons([shape]).rings_of(0))
    assert sum(part.area for part in parts) == shell.difference(shapely.union_all(holes)).area


@pytest.mark.parametrize("name", [name for name in FAMILIES if name not in ("large", "strips")])
def test_repaired_rings_are_valid(name):
    for seed in range(8):
        vertices, rings = draw(name, 25, [21, seed])
        columns = np.array(rings)
        given = PolygonSet(vertices.astype(float), [0, *columns[:, 1]], columns[:, 2], columns[:, 3])
        _, used = both(given)
        shapes = to_shapely(used.polygons)[~used.polygons.is_line]
        assert shapely.is_valid(shapes).all()
        again, same = both(used.polygons)
        assert again.repairs["crossings"] == again.repairs["idle_segments"] == 0
        assert len(same.polygons) == len(used.polygons)
        assert (np.diff(same.polygons.ring_starts) == np.diff(used.polygons.ring_starts)).all()


# ---- The rings of a planar graph, and what its sites are there ----
def graph_of(shape):
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        return planar_graph(shape)


def site_ends(placed):
    """The places of sites, as a skeleton without arcs has them."""
    nothing = {name: np.empty(0) for name in ("radius", "arcs", "control", "sites", "polygon", "side")}
    rest = {name: np.empty(0) for name in ("branch", "length", "error_bound")}
    return Skeleton(np.empty((0, 2)), **nothing, **rest, site_table=placed.sites, polygons=placed.polygons).site_ends


@pytest.mark.parametrize("family", skeleton_shapes.FAMILIES, ids=lambda family: family.__name__)
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
