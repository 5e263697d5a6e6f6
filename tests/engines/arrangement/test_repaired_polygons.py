"""Polygons read back from their planar graph."""

import warnings

import numpy as np
import pytest
import shapely

from support.families.polygon_families import FAMILIES, draw
from vorotool import PolygonSet, planar_graph
from vorotool.convert.polygons import as_polygons
from vorotool.engines.arrangement.repaired_polygons import repaired_polygons
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL
from vorotool.types.polygons.shapely_geometry import to_shapely

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
