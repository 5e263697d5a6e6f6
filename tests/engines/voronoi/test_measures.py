"""Own areas and largest distances of cells, against shapely at many places, and against what is known."""

import numpy as np
import pytest
import shapely
from tests.support.families.site_families import mixed_sites, squares
from tests.support.oracles.voronoi_oracle import EQUAL, NEARLY, distances_of

import vorotool
from support.few import few
from support.oracles.voronoi_oracle import quietly
from vorotool import voronoi
from vorotool.convert.sites import as_sites
from vorotool.engines.voronoi.regions import site_at
from vorotool.engines.voronoi.site_graph import owned_graph
from vorotool.engines.voronoi.voronoi import ties

BOX = shapely.box(0, 0, 10, 10)
FRAME = (-10.0, -10.0, 30.0, 30.0)
STEP = 0.6


def places_in(cell):
    """Places of a cell no farther apart than `STEP` and half of it again, and densely along its border."""
    low_x, low_y, high_x, high_y = cell.bounds
    lattice = np.meshgrid(np.arange(low_x, high_x, STEP), np.arange(low_y, high_y, STEP))
    along = shapely.get_coordinates(shapely.segmentize(cell, STEP / 4))
    points = shapely.points(np.concatenate([np.stack(lattice, axis=-1).reshape(-1, 2), along]))
    return points[shapely.intersects(cell, points)]


def assert_measured(sites, cells):
    shapes = cells.to_shapely(flatten=1e-4)
    for site, cell, own, reach in zip(sites, shapes, cells.own_areas, cells.reaches, strict=True):
        if cell.is_empty:
            assert own == 0
            assert np.isnan(reach)
            continue
        assert own == pytest.approx(shapely.intersection(cell, shapely.make_valid(site)).area, abs=1e-5)
        found = shapely.distance(site, places_in(cell)).max(initial=0)
        assert found - 1e-6 <= reach <= found + STEP


@pytest.mark.parametrize("seed", few(range(18), 3))
def test_mixed_sites(seed):
    random = np.random.default_rng(seed)
    grid = [None, 10, 4][seed % 3]
    sites = mixed_sites(random, int(random.integers(1, 9)), grid)
    frame = None
    if seed % 2:
        corner = random.uniform(-20, 60, 2)
        frame = (*(corner.round() if grid else corner).tolist(), 50.0, 37.0)
    assert_measured(sites, quietly(sites, frame=frame))


@pytest.mark.parametrize("seed", few(range(12), 3))
def test_cut_sites(seed):
    random = np.random.default_rng(seed)
    sites = mixed_sites(random, 6, [None, 4][seed % 2])
    discs = shapely.buffer(shapely.points(random.random((2, 2)) * 100), random.uniform(20, 60, 2), quad_segs=3)
    streets = shapely.linestrings(random.random((4, 2, 2)) * 140 - 20)
    clip = [None, discs, discs][seed % 3]
    enclosures = [streets, None, streets][seed % 3]
    limit = [None, 8][seed % 2]
    cells = quietly(sites, clip=clip, enclosures=enclosures, max_distance=limit)
    assert limit is None or np.nanmax(cells.reaches) <= limit
    assert_measured(sites, cells)


@pytest.mark.parametrize(
    ("sites", "own"),
    [
        ([BOX, BOX], [100, 0]),
        ([BOX, shapely.box(4, 4, 6, 6)], [100, 0]),
        ([shapely.box(4, 4, 6, 6), BOX], [4, 96]),
        ([BOX.difference(shapely.box(4, 4, 6, 6)), shapely.Point(5, 5)], [96, 0]),
        ([shapely.LineString([(-5, 5), (15, 5)]), BOX], [0, 100]),
        ([shapely.Point(1, 1), shapely.Point(2, 1)], [0, 0]),
    ],
)
def test_own_areas_after_overlaps(sites, own):
    assert voronoi(sites, frame=FRAME).own_areas.tolist() == own


@pytest.mark.parametrize(
    ("frame", "own"),
    [
        ((-1, -1, 12, 12), 84),
        ((0, 0, 10, 10), 84),
        ((2, 2, 8, 8), 48),
        ((-5, 1, 30, 2), 20),
        ((4, 4, 1, 1), 0),
        ((20, 20, 5, 5), 0),
        ((-5, -5, 6, 6), 1),
    ],
)
def test_own_areas_in_a_frame(frame, own):
    ring = BOX.difference(shapely.box(3, 3, 7, 7))
    assert voronoi([ring, shapely.Point(60, 60)], frame=frame).own_areas.tolist() == [own, 0]


COURT = shapely.LineString([(0, 0), (4, 0), (4, 4), (0, 4), (0, 0)])


@pytest.mark.parametrize(
    ("sites", "frame", "reach"),
    [
        ([shapely.Point(0, 0)], (-3, -4, 3, 4), [5]),
        ([COURT], (0, 0, 4, 4), [2]),  # in the middle of the site itself
        # on the diagonal of the court, where x = (2 - x) sqrt(2)
        ([COURT, shapely.Point(2, 2)], (0, 0, 4, 4), [4 - 2 * 2**0.5] * 2),
        ([shapely.LineString([(0, 4), (2, 0), (4, 4)])], (0, 1, 4, 3), [4 / 5**0.5]),  # where its bisector is cut
        ([BOX], (2, 2, 3, 3), [0]),
        ([BOX, BOX], (0, 0, 10, 10), [0, np.nan]),
    ],
)
def test_largest_distances_that_are_known(sites, frame, reach):
    np.testing.assert_allclose(voronoi(sites, frame=frame).reaches, reach, rtol=1e-9)


def test_nothing_is_computed_for_shapes():
    cells = quietly(vorotool.read("data/great-lakes.geojson"))
    cells.to_shapely()
    assert "reaches" not in vars(cells)
    assert cells.to_geopandas()["max_distance"].tolist() == cells.reaches.tolist()


def test_a_court_is_cut_where_its_middle_is_too_far():
    for limit, reach in ((3, 2), (2, 2), (1.5, 1.5)):
        assert voronoi([COURT], frame=(0, 0, 4, 4), max_distance=limit).reaches.tolist() == [reach]


@pytest.mark.parametrize("clip", [[(-1, -1), (11, -1), (11, 11), (-1, 11)], [(0, 0), (10, 0), (10, 10), (0, 10)]])
def test_a_clip_is_as_a_frame(clip):
    sites = mixed_sites(np.random.default_rng(11), 5)
    low, high = np.min(clip, axis=0) * 5, np.max(clip, axis=0) * 5
    cut, framed = quietly(sites, clip=[5 * np.array(clip)]), quietly(sites, frame=(*low, *(high - low)))
    np.testing.assert_allclose(cut.own_areas, framed.own_areas, atol=1e-6)
    np.testing.assert_allclose(cut.reaches, framed.reaches, atol=1e-6)


def test_what_several_sites_have_is_counted():
    apart = voronoi([shapely.box(0, 0, 2, 2), shapely.Point(5, 1)])
    assert ties(apart) == {"shared_points": 0, "shared_segments": 0, "overlaps": 0}
    row = [shapely.box(k, 0, k + 1, 1) for k in range(4)]
    assert ties(voronoi(row)) == {"shared_points": 6, "shared_segments": 3, "overlaps": 0}
    assert ties(voronoi([row[0], row[0], row[0]])) == {"shared_points": 4, "shared_segments": 4, "overlaps": 1}
    assert ties(voronoi(row, by=[0, 0, 0, 0])) == {"shared_points": 0, "shared_segments": 0, "overlaps": 0}
    cross = [shapely.LineString([(0, 0), (2, 2)]), shapely.LineString([(0, 2), (2, 0)]), shapely.Point(1, 1)]
    assert ties(voronoi(cross)) == {"shared_points": 1, "shared_segments": 0, "overlaps": 0}
    corner = [shapely.Point(0, 0), shapely.box(0, 0, 2, 2), shapely.box(1, 1, 3, 3)]
    assert ties(voronoi(corner)) == {"shared_points": 3, "shared_segments": 0, "overlaps": 1}


# ---- The site of one place against shapely, and where places tie exactly ----
def owned_of(geometry):
    sites = as_sites(geometry)
    return owned_graph(sites.polygons, sites.site)


@pytest.mark.filterwarnings("ignore::vorotool.errors.RepairWarning")
@pytest.mark.parametrize("seed", range(12))
def test_random_places(seed):
    random = np.random.default_rng(seed)
    geometry = mixed_sites(random, int(random.integers(1, 9)), [None, 10][seed % 2])
    owned = owned_of(geometry)
    places = random.random((60, 2)) * 140 - 20
    distance = distances_of(geometry, places)
    least = distance.min(axis=0)
    ties = distance <= least + EQUAL * 100
    for k in np.flatnonzero((ties == (distance <= least + NEARLY * 100)).all(axis=0)).tolist():
        assert site_at(owned, tuple(places[k].tolist())) == ties[:, k].argmax()


def test_ties_are_of_the_first():
    owned = owned_of(squares(3))
    assert [site_at(owned, (x, 1.5)) for x in (1.5, 3.5)] == [0, 1]
    for places in ([[0, 0], [6, 0]], [[6, 0], [0, 0]]):
        assert site_at(owned_of(places), (3.0, 7.0)) == 0
        near = np.nextafter(3.0, 4.0)  # nearer to (6, 0), by less than distances in doubles tell
        assert site_at(owned_of(places), (near, 7.0)) == places.index([6, 0])
    assert site_at(owned_of([shapely.box(2, 2, 4, 4), shapely.box(0, 0, 6, 6)]), (3.0, 3.0)) == 0
    assert site_at(owned_of([shapely.box(2, 2, 4, 4), shapely.box(0, 0, 6, 6)]), (1.0, 3.0)) == 1
