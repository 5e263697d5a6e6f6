""""""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import shapely
from scipy.spatial import Delaunay

import vorotool
from support.families.point_families import FAMILIES, draw
from support.few import few
from support.oracles.proximity_oracle import gabriel_edges, relative_edges, squares_of, tree_lengths
from support.readers.written import assert_same
from vorotool import (
    InputError,
    PointSet,
    Triangulation,
    UsageError,
    VerificationError,
    VorotoolWarning,
    _core,
    delaunay,
    insert_points,
    proximity_graph,
    verify_proximity_graph,
    verify_triangulation,
)
from vorotool.engines.delaunay import delaunay as insertion

ARRAYS = ("triangles", "neighbors", "edges", "hull", "first")


def edge_set(edges):
    return {tuple(sorted(edge)) for edge in edges.tolist()}


def test_against_scipy():
    for seed in range(3):
        points = draw("uniform", 2000, seed)
        peer = Delaunay(points).simplices
        assert edge_set(delaunay(points).edges) == edge_set(
            np.concatenate([peer[:, [0, 1]], peer[:, 1:], peer[:, ::2]])
        )


@pytest.mark.parametrize(
    ("points", "edges", "hull"),
    [
        ([], [], []),
        ([[5, 5]], [], [0]),
        ([[5, 5], [1, 2]], [[0, 1]], [1, 0]),
        ([[2, 2], [0, 0], [1, 1], [3, 3]], [[1, 2], [0, 2], [0, 3]], [1, 2, 0, 3]),
    ],
)
def test_chains(points, edges, hull):
    mesh = delaunay(points)
    verify_triangulation(mesh)
    assert mesh.triangles.shape == mesh.neighbors.shape == (0, 3)
    assert edge_set(mesh.edges) == set(map(tuple, edges))
    assert mesh.edges.shape == (len(edges), 2)
    assert mesh.hull.tolist() == hull
    assert mesh.circumcenters.shape == (0, 2)
    assert mesh.circumradii.shape == mesh.areas.shape == (0,)


def test_arrays_and_their_types():
    mesh = delaunay([[0, 0], [2, 0], [2, 1], [0, 1], [1, 3]])
    for array in ARRAYS:
        assert getattr(mesh, array).dtype == np.int32
    assert (mesh.edges[:, 0] < mesh.edges[:, 1]).all()
    assert edge_set(mesh.edges) == {(0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (2, 4), (3, 4)}
    assert mesh.hull.tolist() == [0, 1, 2, 4, 3]


def test_what_is_accepted():
    points = [(0.0, 0.0), (4.0, 1.0), (1.0, 3.0), (2.0, 7.0)]
    mesh = delaunay(points)
    shapes = [shapely.Point(p) for p in points]
    fortran = np.asfortranarray(points)
    for source in (
        np.array(points, np.float32),
        fortran,
        shapes,
        shapely.MultiPoint(points),
        np.array(shapes),
        iter(points),
    ):
        np.testing.assert_array_equal(delaunay(source).triangles, mesh.triangles)
    given = PointSet(points, labels=[3, 1, 4, 2], properties={"name": list("abcd")}, y_axis="up", crs="x")
    told = delaunay(given)
    assert (told.labels.tolist(), told.properties, told.y_axis, told.crs) == ([3, 1, 4, 2], given.properties, "up", "x")
    assert told.label_array.tolist() == [3, 1, 4, 2]
    assert mesh.label_array.tolist() == [1, 2, 3, 4]
    seeds = vorotool.seeds_from_points(given)
    assert delaunay(seeds).label_array.tolist() == [1, 2, 3, 4]
    assert delaunay(seeds).points.tolist() == [list(points[i]) for i in (1, 3, 0, 2)]


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_not_finite_is_refused_naming_the_row(bad):
    with pytest.raises(InputError, match=r"^invalid points: point \[2\] is \(1\.0, "):
        delaunay([[0, 0], [1, 0], [1, bad]])


@pytest.mark.parametrize("bad", [5, [[1, 2, 3, 4]], [["a", "b"]], [1, 2, 3]])
def test_no_points(bad):
    with pytest.raises(InputError, match=r"^invalid points: expected "):
        delaunay(bad)


def test_duplicates_are_counted():
    points = [[0, 0], [1, 0], [0, 0], [0, 1], [1, 0], [0.0, -0.0]]
    with pytest.warns(VorotoolWarning, match="^3 of 6 points lie on an earlier point"):
        mesh = delaunay(points)
    assert mesh.first.tolist() == [0, 1, 0, 3, 1, 0]
    assert mesh.duplicates == 3
    with pytest.raises(InputError, match="3 of 6 points lie on an earlier point: remove the duplicates"):
        delaunay(points, strict=True)


# ---- Triangulations from elsewhere: scipy's, our own from their triangles alone, and what is none ----
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


# ---- test_insertion.py ----
@pytest.fixture(autouse=True)
def duplicates_are_expected():
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        yield


def check(points, count, **options):
    """Insert all but the first `count` points; compare with the triangulation of all."""
    points = np.ascontiguousarray(points, dtype=np.float64)
    before = delaunay(points[:count])
    made = insert_points(before, points[count:], **options)
    verify_triangulation(made)
    right = delaunay(points)
    np.testing.assert_array_equal(made.points, right.points)
    assert_same(ARRAYS, made, right)
    return before, made


def outermost_first(points):
    """The same points; those on the bounds come first, so that others are inserted within them."""
    places = {int(each) for axis in (0, 1) for each in (points[:, axis].argmin(), points[:, axis].argmax())}
    order = [*places, *(i for i in range(len(points)) if i not in places)]
    return points[order]


@pytest.fixture
def always_local(monkeypatch):
    """Insert however many points there are, and count how often that was done."""
    done = []
    kernel = _core.delaunay.insert_points

    def counted(*arguments, **run):
        result = kernel(*arguments, **run)
        done.append(result is not None)
        return result

    monkeypatch.setattr(insertion, "MANY", 1000.0)
    monkeypatch.setattr(insertion._core.delaunay, "insert_points", counted)
    return done


@pytest.mark.parametrize("name", ["uniform", "small_lattice", "collinear", "any_double"])
def test_points_are_inserted_anywhere(name):
    points = draw(name, 20, 0)
    for count in (0, 1, 4, 10, 19, 20):
        check(points, count)


def test_hints_change_nothing(always_local):
    points = outermost_first(draw("uniform", 500, 2))
    rng = np.random.default_rng(0)
    for hint in (0, 399, rng.integers(0, 400, 100), [3] * 100):
        check(points, 400, hint=hint)
    doubled = np.concatenate([points[:400], points[:1], points[400:]])
    check(doubled, 401, hint=400)
    assert all(always_local)


def test_threads_change_nothing(always_local):
    points = outermost_first(draw("uniform", 40_000, 2))
    for threads in (1, 2, 5):
        check(points, 39_500, threads=threads)
    assert all(always_local)


def test_what_points_bring():
    old = PointSet(
        [[0, 0], [4, 0], [0, 3]], labels=[7, 3, 9], properties={"name": ["a", "b", "c"]}, y_axis="up", crs="x"
    )
    mesh = insert_points(delaunay(old), PointSet([[1, 1], [2, 1]], properties={"size": [1, 2]}))
    assert mesh.label_array.tolist() == [7, 3, 9, 10, 11]
    assert mesh.properties == {"name": ["a", "b", "c", None, None], "size": [None, None, None, 1, 2]}
    assert (mesh.y_axis, mesh.crs) == ("up", "x")
    assert insert_points(delaunay(old.xy), [[1, 1]]).labels is None
    own = insert_points(delaunay(old.xy), PointSet([[1, 1]], labels=[70]))
    assert own.label_array.tolist() == [1, 2, 3, 70]


def test_duplicates_are_counted_or_refused():
    mesh = delaunay([[0, 0], [4, 0], [0, 3], [4, 3], [1, 1]])
    with pytest.warns(VorotoolWarning, match=r"^1 of 6 points lie on an earlier point"):
        insert_points(mesh, [[1, 1]])
    with pytest.raises(InputError, match="1 of 6"):
        insert_points(mesh, [[1, 1]], strict=True)


@pytest.mark.parametrize(
    ("hint", "message"),
    [
        (5, r"hint \[0\] is 5"),
        (-1, r"hint \[0\] is -1"),
        ([0, 9], r"hint \[1\] is 9"),
        ([0], "has shape"),
        (0.5, "integer"),
    ],
)
def test_bad_hints(hint, message):
    mesh = delaunay([[0, 0], [4, 0], [0, 3], [4, 3], [1, 1]])
    with pytest.raises(InputError, match=message):
        insert_points(mesh, [[1, 2], [2, 2]], hint=hint)


@pytest.mark.parametrize(
    "change",
    [
        {"triangles": [[0, 1, 9], [1, 3, 2]]},
        {"neighbors": [[0, -1, -1], [-1, -1, 0]]},
        {"neighbors": [[7, -1, -1], [-1, -1, 0]]},
        {"neighbors": [[-1, -1, -1], [-1, -1, -1]]},
        {"hull": [0, 1, 77, 2]},
        {"first": [0, 1, 2, 77]},
        {"edges": [[0, 99]]},
        {"triangles": [[0, 2, 1], [1, 2, 3]]},
    ],
)
def test_arrays_that_are_no_triangulation(change, always_local):
    mesh = replace(delaunay([[0, 0], [4, 0], [0, 3], [4, 3]]), **change)
    with pytest.raises(InputError, match="triangulation"):
        insert_points(mesh, [[1.5, 0.5]])


# ---- Proximity graphs beside their definitions in rationals, and what must not change them ----
KINDS = ("gabriel", "relative", "mst")


def pairs(graph):
    return {frozenset(edge) for edge in graph.edges.tolist()}


@pytest.mark.parametrize("name", few(FAMILIES, 10))
def test_the_definitions_in_rationals(name):
    for seed in range(5):
        points = np.unique(draw(name, 5 + 3 * seed, seed), axis=0)
        points = np.random.default_rng(seed).permutation(points)
        mesh, given = delaunay(points), points.tolist()
        gabriel, relative, tree = (proximity_graph(mesh, kind) for kind in KINDS)
        assert pairs(gabriel) == gabriel_edges(given)
        assert pairs(relative) == relative_edges(given)
        square = squares_of(given)
        assert sorted(square[pair] for pair in pairs(tree)) == tree_lengths(given)
        assert pairs(tree) <= pairs(relative) <= pairs(gabriel)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", few(FAMILIES, 7))
def test_the_check_finds_every_edge_that_is_wrong(name, kind):
    points = np.unique(draw(name, 16 if name == "any_double" else 30, 2), axis=0)
    graph = proximity_graph(points, kind)
    verify_proximity_graph(graph)
    rng = np.random.default_rng(1)
    for number in rng.permutation(len(graph.mesh.edges))[:5].tolist():
        index = np.setxor1d(graph.edge_index, [number]).astype(np.int32)
        a, b = sorted((graph.mesh.edges[number] + 1).tolist())
        with pytest.raises(VerificationError, match=f"from point {a} to point {b} (is missing|does not belong)"):
            verify_proximity_graph(replace(graph, edge_index=index))


def test_a_lune_that_many_triangles_meet():
    """Two dense arcs far apart: between their nearest points the lune is empty, and wide."""
    angle = np.linspace(-0.5, 0.5, 401)
    left = np.stack([-10 + 5 * np.cos(angle), 5 * np.sin(angle)], axis=1)
    points = np.concatenate([left, -left])
    graph = proximity_graph(points, "relative")
    nearest = {200, 601}
    assert nearest in [set(edge) for edge in graph.edges.tolist()]
    assert len(proximity_graph(points, "mst")) == len(points) - 1


def test_few_points_and_duplicates():
    assert [len(proximity_graph(np.zeros((n, 2)), "mst")) for n in (0, 1)] == [0, 0]
    with pytest.warns(VorotoolWarning, match="earlier"):
        graph = proximity_graph([[0, 0], [3, 0], [0, 0], [7, 0]], "mst")
    assert graph.edges.tolist() == [[0, 1], [1, 3]]
    assert graph.degrees.tolist() == [1, 2, 0, 1]


def test_what_is_no_graph_is_refused():
    with pytest.raises(UsageError, match="kind is 'beta': use gabriel, relative or mst"):
        proximity_graph([[0, 0], [1, 0]], "beta")
    mesh = delaunay([[0, 0], [4, 0], [0, 3], [1, 1]])
    with pytest.raises(InputError, match="give a Delaunay triangulation"):
        proximity_graph(replace(mesh, edges=mesh.edges[:3]), "relative")


def test_what_a_graph_turns_into(tmp_path):
    points = vorotool.PointSet([[0, 0], [4, 0], [0, 3], [1, 1]], properties={"name": list("abcd")})
    graph = proximity_graph(points, "mst")
    assert repr(graph) == "ProximityGraph: mst, 4 points, 3 edges"
    assert graph.table()["label_b"].tolist() == [4, 4, 4]
    assert sorted(dict(graph.to_networkx().degree).values()) == [1, 1, 1, 3]
    assert [line.length for line in graph.to_shapely()] == graph.edge_lengths().tolist()
    assert graph.to_pandas()["length"].tolist() == graph.edge_lengths().tolist()
    for fmt in ("csv", "geojson", "obj", "edge", "npy", "svg", "png"):
        vorotool.write(graph, tmp_path / f"graph.{fmt}")
    assert np.load(tmp_path / "graph.npy").tolist() == graph.edges.tolist()
    assert (tmp_path / "graph.edge").read_text().splitlines()[0] == "3 1"
