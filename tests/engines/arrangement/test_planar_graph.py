"""Planar graphs of polygons and lines as the library makes them."""

import re
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

from support.few import few
from vorotool import (
    InputError,
    LimitError,
    PolygonSet,
    VerificationError,
    VorotoolWarning,
    planar_graph,
    read,
    skeleton_approx,
    skeleton_exact,
    verify_planar_graph,
    voronoi,
)
from vorotool.convert.polygons import as_polygons
from vorotool.errors import RepairWarning
from vorotool.types.polygons.shapely_geometry import to_shapely

DATA = Path(__file__).parents[3] / "data"
SQUARE = [[0, 0], [8, 0], [8, 8], [0, 8]]
BOW = [[0, 0], [5, 4], [5, 0], [0, 3]]


def quietly(polygons, **options):
    """The graph, checked, and the warnings."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", VorotoolWarning)
        graph = planar_graph(polygons, **options)
    verify_planar_graph(graph)
    return graph, [str(each.message) for each in caught]


def area_of(graph, polygon):
    """The area of one polygon: that of its borders, each with the polygon on one side only."""
    inside = np.zeros(graph.faces, dtype=bool)
    inside[np.repeat(np.arange(graph.faces), np.diff(graph.face_starts))[graph.face_polygon == polygon]] = True
    side = inside[graph.segment_faces].astype(int)
    (ax, ay), (bx, by) = graph.points[graph.segments].astype(float).transpose(1, 2, 0)
    return float(((side[:, 0] - side[:, 1]) * (ax * by - ay * bx)).sum() / 2 * graph.scale * graph.scale)


def test_a_valid_polygon_is_only_placed():
    shape = shapely.Polygon(SQUARE, [[[1, 1], [2, 1], [1, 2]], [[5, 5], [6, 5], [5, 6.5]]])
    graph, said = quietly(shape)
    assert said == []
    assert graph.coordinates().tolist() == as_polygons(shape).xy.tolist()
    assert graph.point_vertex.tolist() == list(range(10))
    assert graph.largest_move == 0
    assert (graph.faces, graph.is_inside.tolist()) == (4, [False, True, False, False])
    assert graph.sources_of(3).tolist() == [3]
    assert graph.polygons_of(1).tolist() == [0]
    assert area_of(graph, 0) == shape.area


def test_nothing():
    for source in ([], shapely.Polygon()):
        graph, said = quietly(source)
        assert (len(graph), len(graph.points), graph.faces, said) == (0, 0, 1, [])
    graph, said = quietly([{"line": [[3, 4]]}])
    assert (graph.coordinates().tolist(), len(graph), said) == ([[3.0, 4.0]], 0, [])
    graph, said = quietly([{"line": [[3, 4], [3, 4]]}])
    assert len(graph.points) == 1
    assert said == ["repaired: 1 repeated vertex dropped, in feature 1"]


@pytest.mark.parametrize(
    ("source", "counts", "place"),
    [
        ([[0, 0], [8, 0], [8, 0], [8, 8]], {"repeated_vertices": 1}, "polygon 1, shell, vertex 2 at (8.0, 0.0)"),
        ([SQUARE, [[4, 4], [12, 4], [12, 12], [4, 12]]], {"crossings": 2}, "polygon 1, shell, edge 2 from (8.0, 0.0)"),
        (BOW, {"crossings": 1, "moved_edges": 2}, "polygon 1, shell, edge 1 from (0.0, 0.0) to (5.0, 4.0)"),
        ([[0, 0], [8, 0], [8, 8], [0, 8], [0, 12], [0, 8]], {"idle_segments": 1}, "polygon 1, shell, edge 4"),
        (
            [SQUARE, [[20, 20], [30, 30]]],
            {"idle_segments": 1, "empty_polygons": 1},
            "polygon 2, shell, edge 1 from (20.0",
        ),
        ([[[7, 7]]], {"empty_polygons": 1}, "polygon 1 at (7.0, 7.0)"),
    ],
)
def test_repairs(source, counts, place):
    graph, said = quietly(source)
    assert len(said) == 1
    assert {name: count for name, count in graph.repairs.items() if count} == counts
    with pytest.raises(InputError) as caught:
        planar_graph(source, strict=True)
    assert str(caught.value).startswith(place)


def test_strict_takes_what_needs_no_repair():
    """Holes that touch at vertices, shared edges and placement are none."""
    touching = {"shell": SQUARE, "holes": [[[0, 0], [2, 1], [1, 2]], [[2, 1], [4, 1], [4, 3]]]}
    beside = [[8, 0], [16, 0.1], [16, 8], [8, 8]]
    graph = planar_graph([touching, beside], strict=True)
    verify_planar_graph(graph)
    assert graph.source_count.max() == 2
    assert 0 < graph.largest_move <= 0.71 * graph.scale


@pytest.mark.parametrize(
    "source",
    [
        [SQUARE, [[8, 2], [12, 2], [12, 4]]],
        {"shell": SQUARE, "holes": [[[0, 4], [2, 3], [2, 5]]]},
        {"shell": [*SQUARE, [0, 4]], "holes": [[[0, 4], [2, 3], [2, 5]]]},
    ],
)
def test_strict_takes_a_vertex_on_an_edge(source):
    """Valid polygons may touch each other, and their holes the shell, with a vertex there or without."""
    graph, said = quietly(source)
    assert said == []
    assert planar_graph(source, strict=True).repairs == graph.repairs
    assert len(skeleton_exact(source, strict=True)) > 0


def test_the_rule_of_insides():
    """Twice covered by one ring is outside; overlapping holes are a hole, and reach not beyond their shell."""
    twice = [[0, 0], [9, 0], [9, 9], [3, 9], [3, 3], [6, 3], [6, 12], [0, 12]]
    graph, _ = quietly(twice)
    assert area_of(graph, 0) == shapely.make_valid(shapely.Polygon(twice)).area
    holes = {"shell": SQUARE, "holes": [[[1, 1], [5, 1], [5, 5], [1, 5]], [[3, 3], [12, 3], [12, 6], [3, 6]]]}
    graph, _ = quietly([holes])
    shell, *cut = (shapely.Polygon(ring) for ring in as_polygons([holes]).rings_of(0))
    assert area_of(graph, 0) == shell.difference(shapely.union_all(cut)).area
    graph, _ = quietly([SQUARE, [[4, 4], [12, 4], [12, 12], [4, 12]], SQUARE])
    assert sorted(graph.polygons_of(f).tolist() for f in range(graph.faces)) == [[], [0, 1, 2], [0, 2], [1]]


@pytest.mark.parametrize("scale", [1.0, 1e-300, 1e290])
def test_areas_beside_geos(scale):
    """Random rings: the even-odd rule is that of make_valid."""
    for seed in range(30):
        rng = np.random.default_rng(seed)
        ring = rng.uniform(0, 1, (int(rng.integers(3, 15)), 2))
        graph, _ = quietly(ring * scale)
        found = area_of(replace(graph, scale=graph.scale / scale), 0)
        assert found == pytest.approx(shapely.make_valid(shapely.Polygon(ring)).area, abs=1e-7)


def test_lines_beside_geos():
    """Noding of lines whose crossings are far from each other and from the ends."""
    for seed in range(20):
        rng = np.random.default_rng(seed)
        lines = [shapely.LineString(rng.integers(0, 10**6, (3, 2))) for _ in range(6)]
        graph, _ = quietly(lines)
        noded = shapely.union_all(lines)
        assert len(graph) == len(shapely.get_parts(shapely.get_parts(noded))) + sum(
            shapely.get_num_coordinates(part) - 2 for part in shapely.get_parts(noded)
        )
        assert shapely.MultiLineString(list(graph.coordinates()[graph.segments])).length == pytest.approx(noded.length)


@pytest.mark.parametrize("name", few(["110m_lakes", "110m_land", "50m_lakes", "50m_land"], 3))
def test_natural_earth(name):
    shapes = read(DATA / f"ne_{name}.geojson")
    graph, said = quietly(shapes)
    expected = {
        "110m_lakes": ["5 repeated vertices dropped"],
        "110m_land": ["1 edge cut at a vertex on it, 2 dangling segments dropped"],
        "50m_lakes": ["457 repeated vertices dropped"],
        "50m_land": [],
    }[name]
    assert [each.split(", in feature")[0] for each in said] == [f"repaired: {each}" for each in expected]
    np.testing.assert_allclose(graph.coordinates(), shapes.xy[graph.point_vertex], atol=graph.largest_move, rtol=0)
    assert graph.largest_move < 2e-7
    assert (np.diff(graph.face_starts) <= 1).all()
    for polygon, shape in list(enumerate(to_shapely(shapes)))[:25]:
        assert area_of(graph, polygon) == pytest.approx(shape.area, abs=2 * graph.largest_move * shape.length)


def test_limits(monkeypatch):
    monkeypatch.setattr("vorotool.engines.arrangement.planar_graph.MOST_VERTICES", 3)
    with pytest.raises(LimitError, match="4 vertices, more than 3"):
        planar_graph(SQUARE)


def nested_squares(count):
    size = np.arange(1, count + 1)[:, None, None]
    corners = (np.array([[[-1, -1], [1, -1], [1, 1], [-1, 1]]]) * size).reshape(-1, 2)
    return PolygonSet(corners, 4 * np.arange(count + 1), np.zeros(count), np.arange(count))


def test_polygons_that_nest_deep():
    graph, said = quietly(nested_squares(300))
    assert said == []
    assert sorted(np.diff(graph.face_starts).tolist()) == list(range(301))
    with pytest.raises(LimitError, match="overlap or nest more than 67108864 times"):
        planar_graph(nested_squares(12_000))


def changed(graph, **arrays):
    return replace(graph, **{name: np.array(values) for name, values in arrays.items()})


def test_the_checker_finds_faults():
    hole = {"shell": SQUARE, "holes": [[[1, 1], [3, 1], [1, 3]]]}
    graph, _ = quietly([hole, {"line": [[20, 20], [30, 20]]}])
    start = graph.face_starts
    for faulty, message in [
        (changed(graph, segments=graph.segments[:, ::-1]), "left of all segments is not face 0"),
        (changed(graph, segment_faces=graph.segment_faces + 7), "a face that does not exist"),
        (changed(graph, segment_faces=1 - graph.segment_faces), "one corner|left of all|does not exist"),
        (changed(graph, face_starts=start[:-1]), "a segment names a face|does not divide"),
        (changed(graph, face_starts=[0, 1, 1, 1]), "face 0, which is unbounded"),
        (changed(graph, face_polygon=[1]), "segment 0 divides a polygon"),
        (changed(graph, face_starts=[0, 0, 0, 0], face_polygon=[]), "segment 0 is dangling"),
        (changed(graph, source_edge=graph.source_edge[[1, 0, *range(2, 8)]]), "segment 0 is not where edge 1 runs"),
        (changed(graph, point_vertex=np.roll(graph.point_vertex, 1)), "a point is not where its vertex is"),
        (replace(graph, scale=1.0), "this is not the lattice of the input"),
        (changed(graph, face_starts=[0, 0, 2, 2], face_polygon=[1, 0]), "are not ascending"),
    ]:
        with pytest.raises(VerificationError, match=message):
            verify_planar_graph(faulty)


# ---- What is said of polygons on the lattice: which features were repaired, and for which it is coarse ----
TEN = np.array([[0, 0], [10, 0], [10, 10], [0, 10]])
SPIKE = np.array([[0, 0], [10, 0], [10, 10], [5, 10], [5, 30], [5, 10], [0, 10]])
ENGINES = [planar_graph, skeleton_exact, lambda given: skeleton_exact(given, features="together"), voronoi]


def shifted(ring, x, y):
    return ring + np.array([x, y])


def said_by(call, *arguments, **options):
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        call(*arguments, **options)
    return [str(each.message) for each in said if issubclass(each.category, RepairWarning)]


def features_in(text):
    names = re.search(r"features? ([0-9, ]+)", text)
    assert names is not None, text
    return [int(each) for each in names[1].split(",") if each.strip()]


@pytest.mark.parametrize("engine", ENGINES)
def test_features_that_are_repaired_are_named(engine):
    twice = np.array([[0, 0], [0, 0], [10, 0], [10, 10], [0, 10]])
    hole = {"shell": shifted(TEN, 160, 0), "holes": [shifted(TEN, 200, 0).tolist()]}
    given = [
        TEN,
        shifted(SPIKE, 40, 0),
        shifted(TEN, 80, 0),
        shifted(twice, 120, 0),
        hole,
        {"line": [[1000, 3], [1001, 3]]},
    ]
    (text,) = said_by(engine, given)
    assert features_in(text) == [2, 4, 5]


@pytest.mark.parametrize("engine", ENGINES)
def test_the_first_ten_features_are_named(engine):
    (text,) = said_by(engine, [shifted(SPIKE, 100 * k, 0) for k in range(14)])
    assert features_in(text) == list(range(1, 11))
    assert "4 more" in text


def test_sites_that_meet_are_not_named():
    (text,) = said_by(voronoi, [TEN, shifted(TEN, 5, 5), shifted(SPIKE, 40, 0), shifted(TEN, 45, 15)])
    assert features_in(text) == [3]


@pytest.mark.parametrize("engine", [*ENGINES, lambda given: skeleton_approx(given, step=1)])
@pytest.mark.parametrize("height", [1e-7, 1e-12])
def test_what_the_lattice_is_coarse_for_is_said(engine, height):
    turn = np.array([[0.8, 0.6], [-0.6, 0.8]])
    for sliver in (TEN * [1.2, height / 10], TEN * [1.2, height / 10] @ turn + 0.1):
        text = said_by(engine, [shifted(TEN, 40, 0), sliver])[-1]
        assert features_in(text) == [2]
        assert f"{2.0**-25:.3g}" in text


@pytest.mark.parametrize("engine", ENGINES)
def test_small_houses_beside_something_far_are_said(engine):
    houses = [shifted(TEN * 1e-4, k / 3, k / 7) for k in range(12)]
    far = shifted(TEN, 1e4, 1e4)
    (text,) = said_by(engine, [*houses, far])
    assert features_in(text) == list(range(1, 11))
    assert "2 more" in text
    assert not said_by(engine, houses)


def test_what_the_lattice_has_as_it_is_given_is_not_coarse():
    pixels = [TEN / 10, TEN / 10 + [2.0**30, 0], TEN / 10 + [0, 2.0**30]]
    for engine in ENGINES:
        assert not said_by(engine, pixels)


def test_strict_refuses_what_the_lattice_is_coarse_for():
    given = [shifted(TEN, 40, 0), TEN * [1.2, 1e-8]]
    for engine in (planar_graph, skeleton_exact):
        with pytest.raises(InputError) as caught:
            engine(given, strict=True)
        assert features_in(str(caught.value)) == [2]
