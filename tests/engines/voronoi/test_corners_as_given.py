"""Corners of cells at vertices of sites, clips, enclosures and frames have the doubles of these."""

import json

import numpy as np
import pytest
import shapely

from support.few import few
from vorotool import read, verify_voronoi, voronoi, write
from vorotool.engines.voronoi.planar_map import Arcs, Rings, moved_vertices

FAR = shapely.box(500000.1, 3.3, 500010.7, 9.9)
CLIP = shapely.Polygon([(-3.3, -3.1), (70.7, -2.2), (69.9, 66.6), (-5.5, 61.1)], [[(41, 30.3), (42.1, 30.9), (41, 31)]])
WALL = shapely.LineString([(30.3, -10.1), (31.1, 90.7)])
CUTS = {
    "none": {},
    "frame": {"frame": (0.1, 0.1, 60.7, 60.3)},
    "clip": {"clip": [CLIP]},
    "enclosures": {"enclosures": [CLIP.exterior, WALL]},
    "enclosures in a frame": {"enclosures": [CLIP.exterior, WALL], "frame": (0.3, 0.7, 50.1, 50.3)},
    "clip at some distance": {"clip": [CLIP], "max_distance": 1.3},
    "distance": {"max_distance": 2.1},
}


def houses(random, *, side=6):
    """Houses in rows, some of which share walls that are equal up to rounding."""
    made = []
    for i in range(side):
        for j in range(side):
            x, y = i * 10.1 + 0.3, j * 10.3 + 0.7
            made.append(shapely.box(x, y, x + (10.1 if random.random() < 0.5 else 7.7), y + 8.1))
    return made


EITHER = [(name, [[], [FAR]][(k + turn) % 2]) for turn in (0, 1) for k, name in enumerate(CUTS)]


@pytest.mark.parametrize(("name", "others"), few(EITHER, len(CUTS)))
def test_vertices_are_those_of_the_input(name, others, tmp_path):
    sites, cuts = [*houses(np.random.default_rng(1)), *others], CUTS[name]
    cells = voronoi(sites, **cuts)
    given = shapely.get_coordinates([*sites, *cuts.get("clip", []), *cuts.get("enclosures", [])])
    if "frame" in cuts:
        given = np.concatenate([given, shapely.get_coordinates(shapely.box(*frame_sides(cells.frame)))])
    tree, doubles = shapely.STRtree(shapely.points(given)), set(map(tuple, given.tolist()))
    near = np.unique(tree.query(shapely.points(cells.vertices), predicate="dwithin", distance=1e-3)[0])
    assert len(near) > 10
    assert all(tuple(place) in doubles for place in cells.vertices[near].tolist())
    verify_voronoi(cells)
    write(cells, tmp_path / "cells.geojson")
    features = json.loads((tmp_path / "cells.geojson").read_text())["features"]
    shapes = [shapely.geometry.shape(each["geometry"]) for each in features if each["geometry"]]
    assert shapely.is_valid(shapes).all()
    assert shapely.coverage_is_valid(shapes)
    for fmt in ("json", "npz"):
        write(cells, tmp_path / f"cells.{fmt}")
        again = read(tmp_path / f"cells.{fmt}")
        np.testing.assert_array_equal(again.vertices, cells.vertices)
        verify_voronoi(again)


def frame_sides(frame):
    x, y, w, h = frame
    return x, y, x + w, y + h


@pytest.mark.parametrize(("least", "most"), [(0.1, 0.5), (0.1, 0.4), (0.2, 0.5), (-0.1, 0.5)])
@pytest.mark.parametrize("lean", [0, 0.3, -0.3, 3.7])
def test_walls_meet_the_frame_at_vertices_that_are_on_it(least, most, lean):
    wall = [(0.7, 0.1), (0.7 + lean, 0.5)]
    left, right = [(-5.1, 0.1), *wall, (-5.1, 0.5)], [wall[0], (9.3, 0.1), (9.3, 0.5), wall[1]]
    cells = voronoi([shapely.Polygon(left), shapely.Polygon(right)], frame=(0.1, least, 7.3, most - least))
    verify_voronoi(cells)
    places = set(map(tuple, cells.vertices.tolist()))
    side = cells.frame[1], cells.frame[1] + cells.frame[3]
    on_frame = {place for place in wall if place[1] in side}
    assert on_frame
    assert on_frame <= places
    shapes = list(cells.to_shapely())
    assert shapely.is_valid(shapes).all()
    assert shapely.coverage_is_valid(shapes)
    assert all(shapely.get_num_coordinates(each) <= 6 for each in shapes)


def test_a_ring_that_might_turn_over_stays():
    thin, wide = [[0, 0], [4, 1e-3], [4, 0]], [[9, 0], [12, 0], [12, 4]]
    ends = np.array([[0, 1], [1, 2], [0, 2], [3, 4], [4, 5], [3, 5]])
    none, sides, cut = np.full((6, 2), np.nan), np.zeros((6, 2), dtype=np.int64), np.zeros(6, dtype=bool)
    moves = np.array([1, 4]), np.array([[4, -1e-3], [12, 1e-3]])
    arcs = Arcs(np.array([*thin, *wide], dtype=float), np.zeros(6), ends, none, none, sides, sides, sides, cut, moves)
    half_edges = np.array([1, 4, 3, 6, 8, 11])
    rings = Rings(np.array([0, 3, 6]), half_edges, np.array([0, 1]), np.array([0, 1]), np.array([2e-3, 6.0]))
    assert moved_vertices(arcs, rings)[[1, 4]].tolist() == [[4, 1e-3], [12, 1e-3]]
