"""Every fault that a map may have is found."""

import json
from dataclasses import replace

import numpy as np
import pytest
import shapely
from tests.support.families.site_families import row_houses

from support.few import few
from vorotool import PolygonSet, read, verify_voronoi, voronoi, write
from vorotool.engines.voronoi.planar_map import Arcs, Rings, moved_vertices
from vorotool.errors import VerificationError

SITES = [*row_houses(1, 3), shapely.Point(30, 5), shapely.LineString([(0, 20), (20, 22)]), shapely.box(5, 5, 8, 12)]


@pytest.fixture(scope="module")
def cells():
    made = voronoi(SITES)
    verify_voronoi(made)
    return made


def changed(cells, name, change):
    array = getattr(cells, name).copy()
    change(array)
    return replace(cells, **{name: array})


def swap(array):
    array[:] = array[::-1]


FAULTS = {
    "an arc that is turned": ("arcs", lambda a: a[:1].sort(axis=1) or swap(a[0])),
    "an arc that does not exist": ("ring_arcs", lambda a: a.__setitem__(0, 10**6)),
    "a ring against its cell": ("ring_arcs", lambda a: np.negative(a, out=a)),
    "a ring in another order": ("ring_arcs", lambda a: swap(a[:3])),
    "sides of another cell": ("sites", swap),
    "a radius": ("radius", lambda a: a.__imul__(1.01)),
    "a vertex": ("vertices", lambda a: a.__setitem__(0, a[0] + 1e-3)),
    "all vertices": ("vertices", lambda a: a.__iadd__(1)),
    "a control point": ("control", lambda a: a.__iadd__(0.1)),
}


@pytest.mark.parametrize("name", list(FAULTS))
def test_faults(cells, name):
    with pytest.raises(VerificationError):
        verify_voronoi(changed(cells, *FAULTS[name]))


def test_another_frame(cells):
    x, y, w, h = cells.frame
    with pytest.raises(VerificationError, match="the cells have an area"):
        verify_voronoi(replace(cells, frame=(x, y, w, h + 1)))


@pytest.mark.parametrize("far", [300.3, 30033.7])
def test_what_a_far_frame_moves_between_enclosures_is_no_fault(far):
    random = np.random.default_rng(0)
    sites, walls = random.random((20, 2)) * 10, shapely.Polygon(random.random((3, 2)) * 14 - 2)
    verify_voronoi(voronoi(sites, enclosures=walls, frame=(-far, -far, 2 * far, 2 * far)))


def test_another_order_of_ties():
    made = voronoi([shapely.box(0, 0, 6, 6), shapely.box(0, 0, 6, 9)])
    with pytest.raises(VerificationError, match="comes first"):
        verify_voronoi(exchanged(made))
    with pytest.raises(VerificationError, match="comes first"):
        verify_voronoi(
            exchanged(voronoi([shapely.LineString([(0, 0), (-8, -1)]), shapely.LineString([(0, 0), (-8, 1)])]))
        )


def exchanged(cells):
    """The cells of two sites in the other order."""
    half = len(cells.ring_arcs) - cells.ring_starts[cells.polygon_starts[cells.cell_starts[1]]]
    rings = np.roll(cells.ring_arcs, half)
    assert len(cells.ring_starts) == 3
    sites = np.where(cells.sites < 0, cells.sites, 1 - cells.sites)
    return replace(
        cells,
        ring_arcs=rings,
        ring_starts=[0, half, len(rings)],
        sites=sites,
        polygons=PolygonSet(
            np.concatenate([cells.polygons.ring(1), cells.polygons.ring(0)]),
            [0, len(cells.polygons.ring(1)), len(cells.polygons.xy)],
            cells.polygons.ring_kind,
            [0, 1],
        ),
    )


def test_another_site():
    made = voronoi([[0, 0], [4, 0]])
    with pytest.raises(VerificationError):
        verify_voronoi(replace(made, polygons=voronoi([[0, 0], [4.1, 0]]).polygons))


# ---- Corners of cells at vertices of sites, clips, enclosures and frames have the doubles of these ----
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
