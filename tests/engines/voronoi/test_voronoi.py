"""Cells of points, lines and polygons against distances of shapely, and the rule of ties."""

from itertools import permutations

import numpy as np
import pytest
import shapely
from tests.support.families.site_families import mixed_sites
from tests.support.oracles.voronoi_oracle import assert_is_coverage, assert_nearest, quietly

import vorotool
from support.few import few
from vorotool import verify_voronoi, voronoi
from vorotool.errors import InputError, RepairWarning, UsageError

BOX = shapely.box(0, 0, 10, 10)
FRAME = (-10.0, -10.0, 30.0, 30.0)


@pytest.mark.parametrize("seed", few(range(60), 4))
def test_mixed_sites(seed):
    random = np.random.default_rng(seed)
    grid = [None, 10, 4][seed % 3]
    sites = mixed_sites(random, int(random.integers(1, 9)), grid)
    frame = None
    if seed % 2:
        corner = random.uniform(-20, 60, 2)
        frame = (*(corner.round() if grid else corner).tolist(), 50.0, 37.0)
    cells = quietly(sites, frame=frame)
    assert assert_nearest(sites, cells, seed=seed) > 20
    verify_voronoi(cells, places=100)


@pytest.mark.parametrize("name", ["ne_110m_lakes", "ne_110m_land", "great-lakes"])
def test_lakes_and_land(name):
    polygons = vorotool.read(f"data/{name}.geojson")
    cells = quietly(polygons, by=polygons.feature[np.flatnonzero(np.diff(polygons.feature, prepend=-1))])
    assert_is_coverage(cells)
    verify_voronoi(cells, places=300)


@pytest.mark.parametrize("order", list(permutations(range(3))))
def test_overlapping_polygons(order):
    shapes = [shapely.box(0, 0, 6, 6), shapely.box(4, 2, 10, 8), shapely.box(2, 4, 8, 10)]
    given = [shapes[k] for k in order]
    cells = quietly(given, frame=FRAME)
    assert assert_nearest(given, cells) > 100
    left = shapely.MultiPolygon()
    for site, shape in enumerate(given):
        own = shape.difference(left)
        left = left.union(shape)
        assert cells.to_shapely()[site].buffer(1e-6).covers(own)


@pytest.mark.parametrize("wall", [[(2, 10), (6, 10)], [(0, 10), (10, 10)], [(-5, 10), (15, 10)], [(6, 10), (15, 10)]])
@pytest.mark.parametrize("is_first", [True, False])
def test_lines_along_walls(wall, is_first):
    line = shapely.LineString(wall)
    given = [line, BOX] if is_first else [BOX, line]
    cells = quietly(given, frame=FRAME)
    assert assert_nearest(given, cells) > 100
    verify_voronoi(cells)


@pytest.mark.parametrize("is_first", [True, False])
def test_lines_through_polygons(is_first):
    line = shapely.LineString([(-5, 5), (15, 6)])
    given = [line, BOX] if is_first else [BOX, line]
    cells = quietly(given, frame=FRAME)
    assert assert_nearest(given, cells) > 100
    number = 0 if is_first else 1
    assert cells.components[number] == 2
    assert not shapely.area(shapely.intersection(cells.to_shapely()[number], BOX)) > 1e-9


@pytest.mark.parametrize("sites", [[[3, 4]], [shapely.LineString([(0, 0), (4, 1)])], [BOX], [BOX, None]])
def test_one_site_has_the_frame(sites):
    cells = voronoi(sites)
    x, y, w, h = cells.frame
    assert cells.areas[0] == pytest.approx(w * h)
    assert cells.to_shapely()[0].equals(shapely.box(x, y, x + w, y + h))
    assert len(cells.edges["arc"]) == 0


def test_no_sites():
    cells = voronoi([])
    assert (len(cells), len(cells.areas), len(cells.to_shapely())) == (0, 0, 0)
    verify_voronoi(cells)
    assert voronoi([None, shapely.Polygon()]).areas.tolist() == [0, 0]


# ---- frames ----------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("frame", "site"),
    [((2, 2, 1, 1), 0), ((20, 20, 1, 1), 0), ((100, 4, 5, 5), 1), ((-50, 0, 10, 10), 0), ((49, 4, 0.5, 0.5), 1)],
)
def test_a_frame_without_borders(frame, site):
    given = [BOX, shapely.Point(50, 5)]
    assert voronoi(given, frame=frame).areas.tolist() == [frame[2] * frame[3] * (site == k) for k in (0, 1)]


def test_a_ring_around_what_is_cut():
    ring = shapely.Polygon(shapely.box(0, 0, 20, 20).exterior.coords, [shapely.box(2, 2, 18, 18).exterior.coords])
    given = [ring, shapely.Point(6, 6), shapely.box(11, 11, 13, 13), shapely.Point(12, 6)]
    for frame in (None, (1, 1, 18, 18), (4, 4, 10, 10), (-5, 5, 30, 6), (5, -5, 2, 30)):
        cells = voronoi(given, frame=frame)
        assert assert_nearest(given, cells) > 100
        verify_voronoi(cells)


# ---- invariance --------------------------------------------------------------------------------------


# ---- input -------------------------------------------------------------------------------------------
def test_features_with_a_common_value_are_one_site():
    sites = [shapely.Point(0, 0), shapely.Point(8, 0), shapely.Point(0, 8), shapely.Point(8, 8)]
    cells = voronoi(sites, by=["b", "a", "b", "a"], frame=(-4, -4, 16, 16))
    assert cells.areas.tolist() == [128, 128]
    assert cells.ids == ["b", "a"]
    assert list(cells.table()["id"]) == ["b", "a"]
    with pytest.raises(InputError, match="expected one value per feature, 4, but got 2"):
        voronoi(sites, by=["a", "b"])
    with pytest.raises(InputError, match="feature 1 has no value") as caught:
        voronoi(sites, by=["a", None, "b", "c"])
    assert "feature 2 has no value" in caught.value.typed  # on the command line they count from 1
    with pytest.raises(UsageError, match="invalid by 'name'"):
        voronoi(sites, by="name")


def test_spikes_along_other_sites_are_said():
    spike = shapely.Polygon([(0, 0), (4, 0), (4, 4), (2, 4), (2, 10), (2, 4), (0, 4)])
    line = shapely.LineString([(2, 2), (2, 20)])
    with pytest.warns(RepairWarning, match="2 dangling segments"):
        cells = voronoi([spike, line], frame=FRAME)
    plain = voronoi([shapely.box(0, 0, 4, 4), line], frame=FRAME)
    np.testing.assert_allclose(cells.areas, plain.areas)


@pytest.mark.parametrize("seed", few(range(8), 4))
def test_small_things_far_from_the_origin_and_from_each_other(seed):
    random = np.random.default_rng(seed)
    sites = []
    for kind in random.integers(0, 3, 20).tolist():
        place = random.random(2) * 10.0 ** -random.integers(0, 9)
        xy = place + random.normal(size=(3, 2)) * 10.0 ** -random.uniform(0, 9)
        sites.append((shapely.Point(xy[0]), shapely.LineString(xy[:2]), shapely.Polygon(xy))[kind])
    assert_is_coverage(quietly(sites))
    far = [shapely.transform(each, lambda xy: 100 * xy + [2.6e6, 1.2e6]) for each in sites]
    cells = quietly(far)
    assert shapely.coverage_is_valid(cells.to_shapely())
    verify_voronoi(cells, places=100)


def test_a_border_that_leaves_the_frame_where_it_ends():
    """The vertex of the diagram is inside by one rounding only, and its border leads out of the frame."""
    sites = [
        *("LINESTRING (4 7, 2 0)", "POLYGON ((4 4, 4 7, 2 7, 2 4, 4 4))", "POLYGON ((5 5, 5 8, 3 8, 3 5, 5 5))"),
        *("LINESTRING (2 3, 7 5)", "POINT (4 2)"),
    ]
    for order in (sites, sites[::-1]):
        verify_voronoi(voronoi(order))


@pytest.mark.parametrize("options", [{}, {"frame": (2.8, -0.2, 0.4, 2.4)}, {"clip": shapely.box(2.8, -0.2, 3.2, 2.2)}])
def test_a_point_on_a_line_in_the_middle_of_a_frame_has_nothing(options):
    """No border meets the frame, and its middle is as near to the point as to the line."""
    for sites, areas in (
        (["POINT (3 1)", "LINESTRING (3 2, 3 0)", "POINT (3 1)"], [0, 0.96, 0]),
        (["LINESTRING (3 2, 3 0)", "POINT (3 1)"], [0.96, 0]),
    ):
        np.testing.assert_allclose(voronoi(sites, **options).areas, areas, rtol=1e-6)
