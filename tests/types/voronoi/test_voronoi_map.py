"""Voronoi maps as values: polygons, tables, data frames, shapes of arrays."""

import geopandas
import numpy as np
import pandas
import pytest
import shapely
from tests.support.families.site_families import mixed_sites

from vorotool import UsageError, voronoi
from vorotool.types.voronoi import tables
from vorotool.types.voronoi.tables import PART_OF_RADIUS, flattened_arcs, site_distances

WALL_AND_TREE = [shapely.LineString([(0, 0), (8, 0)]), shapely.Point(4, 2)]


@pytest.fixture(scope="module")
def cells():
    return voronoi(WALL_AND_TREE, frame=(0, -2, 8, 10))


def test_a_parabola_between_a_wall_and_a_tree(cells):
    parabola = cells.is_parabola
    assert np.count_nonzero(parabola) == 1
    source, target = cells.vertices[cells.arcs[parabola][0]]
    # y = 1 + (x - 4)^2 / 4
    assert sorted([source.tolist(), target.tolist()]) == [[0, 5], [8, 5]]
    assert cells.control[parabola].tolist() == [[4, -3]]
    assert cells.areas.tolist() == pytest.approx([8 * 1 + 32 / 3 + 16, 80 - 24 - 32 / 3])
    assert cells.radius[cells.arcs[parabola][0]].tolist() == [5, 5]


@pytest.mark.parametrize("flatten", [1e-4, 0.1, 100])
def test_polylines_stay_away_from_sites(flatten):
    for seed in range(8):
        sites = mixed_sites(np.random.default_rng(seed), 6)
        made = voronoi(sites)
        points, start = flattened_arcs(made, flatten)
        for arc in np.flatnonzero(made.is_parabola).tolist():
            line = shapely.LineString(points[start[arc] : start[arc + 1]])
            t = np.linspace(0, 1, 200)[:, None]
            a, c, b = made.vertices[made.arcs[arc, 0]], made.control[arc], made.vertices[made.arcs[arc, 1]]
            along = (1 - t) ** 2 * a + 2 * t * (1 - t) * c + t * t * b
            off = shapely.distance(line, shapely.points(along)).max()
            least = min(shapely.distance(sites[k], line) for k in made.sites[arc])
            assert off <= flatten * (1 + 1e-9) + 1e-9
            near = min(shapely.distance(sites[k], shapely.points(along)).min() for k in made.sites[arc])
            assert least >= (1 - PART_OF_RADIUS) * near - 1e-6


# ---- graphs ----------------------------------------------------------------------------------------
def apart(**columns):
    """Two houses that touch, one apart, one that has no cell, in a frame with an index."""
    boxes = [shapely.box(0, 0, 2, 2), shapely.box(2, 0, 4, 2), shapely.box(9, 0, 11, 2), shapely.box(1, 1, 2, 2)]
    return geopandas.GeoDataFrame(columns, geometry=boxes, index=pandas.Index(["a", "b", "c", "d"], name="house"))


def test_a_graph_of_networkx():
    cells = voronoi(apart(name=["A", None, "C", "D"]), max_distance=1)
    graph = cells.to_networkx()
    assert list(graph.nodes) == [0, 1, 2, 3]
    assert sorted(graph.edges) == [(0, 1)]
    assert graph.edges[0, 1] == {"border_length": 4.0, "distance": 0.0}
    assert graph.nodes[2]["area"] == pytest.approx(12 + np.pi)
    assert graph.nodes[2]["max_distance"] == 1
    assert (graph.nodes[0]["name"], graph.nodes[0]["own_area"]) == ("A", 4)
    assert "name" not in graph.nodes[1]
    assert "max_distance" not in graph.nodes[3]


def test_pairs_as_libpysal_takes_them():
    pairs = voronoi(apart(), max_distance=1).to_adjacency()
    assert pairs.values.tolist() == [["a", "b", 4], ["b", "a", 4], ["c", "c", 0], ["d", "d", 0]]
    assert list(pairs) == ["focal", "neighbor", "weight"]
    graphs = pytest.importorskip("libpysal.graph")
    graph = graphs.Graph.from_adjacency(pairs)
    assert graph.isolates.tolist() == ["c", "d"]
    assert graph.adjacency.loc["a"].to_dict() == {"b": 4}
    everything = voronoi(apart())
    graph = graphs.Graph.from_adjacency(everything.to_adjacency())
    assert graph.unique_ids.tolist() == everything.to_geopandas().index.tolist()
    assert graph.adjacency.loc["b"].to_dict() == pytest.approx({"a": 4.2, "c": 4.2})
    assert graph.n_edges == 2 * everything.neighbors.rows


def test_as_a_value(cells):
    assert cells == voronoi(WALL_AND_TREE, frame=(0, -2, 8, 10)) != voronoi(WALL_AND_TREE)
    assert repr(cells) == f"VoronoiMap: 2 cells, {len(cells.arcs)} arcs, {len(cells.vertices)} vertices"
    assert [len(polygons) for polygons in (cells.rings_of(0), cells.rings_of(1))] == [1, 1]
    with pytest.raises(UsageError, match="tolerance"):
        cells.to_shapely(flatten=0)


@pytest.mark.parametrize("most", [1, 1 << 20])
def test_distances_are_those_of_shapely(most, monkeypatch):
    monkeypatch.setattr(tables, "_MANY", most)
    for seed in range(12):
        random = np.random.default_rng(seed)
        sites = mixed_sites(random, 8)
        by = random.integers(4, size=8)
        by[:4] = range(4)
        joined = [shapely.union_all([sites[k] for k in np.flatnonzero(by == each)]) for each in range(4)]
        pairs = np.stack(np.triu_indices(4, 1), axis=1)
        expected = shapely.distance(*np.array(joined)[pairs].T)
        np.testing.assert_allclose(site_distances(voronoi(sites, by=by), pairs), expected, atol=1e-12)


def test_neighbors_have_the_distance_between_them():
    sites = [shapely.box(0, 0, 2, 2), shapely.box(2, 0, 4, 2), shapely.box(7, 0, 9, 2), shapely.Point(8, 1)]
    rows = voronoi(sites).neighbors
    assert rows["label_a"].tolist() == [1, 2]
    assert rows["distance"].tolist() == [0, 3]
    assert voronoi([shapely.Point(0, 0)]).neighbors["distance"].tolist() == []
