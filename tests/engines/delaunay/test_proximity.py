"""Proximity graphs beside their definitions in rationals, and what must not change them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import vorotool
from support.families.point_families import FAMILIES, draw
from support.few import few
from support.oracles.proximity_oracle import gabriel_edges, relative_edges, squares_of, tree_lengths
from vorotool import (
    InputError,
    UsageError,
    VerificationError,
    VorotoolWarning,
    delaunay,
    proximity_graph,
    verify_proximity_graph,
)

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


@pytest.mark.parametrize("kind", KINDS)
def test_threads_change_nothing(kind):
    points = np.random.default_rng(1).random((30000, 2))
    assert proximity_graph(points, kind, threads=1) == proximity_graph(points, kind, threads=3)


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


def test_what_is_refused():
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
