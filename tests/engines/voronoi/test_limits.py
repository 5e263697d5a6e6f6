"""Voronoi maps with a limit of distance: closed forms, buffers of shapely, ties, frames, symmetries."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from tests.support.families.site_families import mixed_sites
from tests.support.oracles.voronoi_oracle import assert_is_within, quietly

from support.few import few
from vorotool import verify_voronoi, voronoi
from vorotool.errors import UsageError, VerificationError
from vorotool.types.voronoi.tables import PART_OF_RADIUS, flattened_arcs

FRAME = (-10, -10, 30, 30)
ROUND = np.pi


def within(sites, limit, frame=None):
    """Make a map, check it in all ways, and give it."""
    cells = quietly(sites, frame=frame, max_distance=limit)
    assert_is_within(sites, cells)
    verify_voronoi(cells, places=200)
    return cells


# ---- ties, all at once -------------------------------------------------------------------------------
MEETING = [1, 2, 2 * 2**0.5, 3, 2 * 5**0.5, 4, 5]
EITHER = [(limit, k % 2 == turn) for turn in (0, 1) for k, limit in enumerate(MEETING)]


@pytest.mark.parametrize(("limit", "are_joined"), few(EITHER, len(MEETING)))
def test_lattices_whose_discs_meet_in_places(limit, are_joined):
    places = [shapely.Point(4 * x, 4 * y) for x in range(4) for y in range(3)]
    sites = [shapely.MultiPoint(places[::2]), *places[1::2]] if are_joined else places
    cells = within(sites, limit)
    assert (cells.components >= 1).all()


@pytest.mark.parametrize("seed", few(range(9), 2))
def test_limits_a_rounding_away_from_vertices(seed):
    random = np.random.default_rng(seed)
    sites = mixed_sites(random, int(random.integers(2, 9)), grid=(None, 4, 0.3)[seed % 3])
    radius = quietly(sites).radius
    at = float(random.choice(radius[np.isfinite(radius) & (radius > 0)]))
    for limit in (at, np.nextafter(at, 0), np.nextafter(at, 1e9), at * (1 - 1e-15), at * (1 + 1e-12)):
        within(sites, float(limit))


@pytest.mark.parametrize("part", few([2**-53, 0, 2**-45, 2**-52, 2**-50, 2**-30], 2))
def test_holes_as_small_as_rounding(part):
    ring = shapely.box(0, 0, 10, 10).difference(shapely.box(1, 1, 6, 6))
    square = [shapely.Point(x, y) for x in (12, 16) for y in (12, 16)]
    for sites in ([ring], [shapely.MultiPoint(square)], [shapely.MultiPoint(square[1:]), square[0]]):
        for limit in (2.5, 8**0.5):
            within(sites, limit * (1 - part), (-10, -10, 40, 40))


# ---- random ------------------------------------------------------------------------------------------
@pytest.mark.parametrize("seed", few(range(24), 3))
def test_random_sites(seed):
    random = np.random.default_rng(seed)
    sites = mixed_sites(random, int(random.integers(1, 12)), grid=(None, 4, 0.1)[seed % 3])
    limit = 100 * 10 ** random.uniform(-2.5, 0.3)
    frame = None
    if seed % 2:
        frame = (*random.uniform(-30, 60, 2).tolist(), *random.uniform(5, 120, 2).tolist())
    within(sites, limit, frame)


# ---- frames ------------------------------------------------------------------------------------------
def test_frames_in_a_cell_in_a_hole_and_where_nobody_is():
    for frame, areas in (((-0.5, -0.5, 1, 1), [1, 0]), ((20, 20, 4, 4), [0, 0]), ((49, 1, 1, 1), [0, 1])):
        cells = voronoi([[0, 0], [50, 0]], frame=frame, max_distance=5)
        assert cells.areas.tolist() == areas
        assert len(cells.arcs) == 4 * sum(areas)
        verify_voronoi(cells)
    ring = shapely.box(0, 0, 20, 20).difference(shapely.box(2, 2, 18, 18))
    assert within([ring], 1, (5, 5, 4, 4)).areas.tolist() == [0]
    assert within([ring, shapely.Point(10, 10)], 1, (5, 5, 10, 10)).areas.tolist() == pytest.approx([0, ROUND])
    assert within([ring], 4, (1, 1, 18, 18)).areas.tolist() == pytest.approx([18 * 18 - 64])


@pytest.mark.parametrize("limit", [300, 1e4, 1e50])
@pytest.mark.parametrize("seed", range(4))
def test_a_limit_beyond_everything_changes_no_bit(seed, limit):
    sites = mixed_sites(np.random.default_rng(seed), 8, grid=(None, 4)[seed % 2])
    cells = quietly(sites, max_distance=limit, frame=FRAME)
    assert replace(cells, max_distance=None) == quietly(sites, frame=FRAME)


# ---- the default frame -------------------------------------------------------------------------------
ROOMS = ["POLYGON ((0 0, 10 0, 10 10, 0 10, 0 0))", "POLYGON ((13 0, 20 0, 20 7, 13 7, 13 0))",
         "POLYGON ((0 14, 9 14, 9 20, 0 20, 0 14))"]  # fmt: skip


@pytest.mark.parametrize("limit", [0.5, 2, 4, 30, 1e6])
def test_the_default_frame_holds_all_cells(limit):
    shapes = shapely.from_wkt(ROOMS)
    cells = within(shapes, limit)
    whole = shapely.union_all(shapely.buffer(shapes, limit, quad_segs=4096))
    assert cells.areas.sum() == pytest.approx(whole.area, rel=1e-6)
    left, bottom, width, height = cells.frame
    assert shapely.box(left, bottom, left + width, bottom + height).contains_properly(whole)


def test_with_enclosures_the_default_frame_holds_all_cells():
    line = shapely.LineString([(11.5, -3), (11.5, 24)])
    cells = quietly(shapely.from_wkt(ROOMS), max_distance=30, enclosures=line)
    verify_voronoi(cells, places=200)
    whole = shapely.union_all(shapely.buffer(shapely.from_wkt(ROOMS), 30, quad_segs=4096))
    assert cells.areas.sum() == pytest.approx(whole.area, rel=1e-6)


def test_a_limit_beyond_everything_does_not_widen_the_lattice_of_enclosures():
    line = shapely.LineString([(11.5, -3), (11.5, 24)])
    cells = quietly(shapely.from_wkt(ROOMS), max_distance=1e12, enclosures=line)
    assert cells.own_areas.tolist() == pytest.approx([100, 49, 54], rel=1e-4)


def test_order_and_threads():
    random = np.random.default_rng(6)
    sites = [shapely.box(x, y, x + 3, y + 2) for x in range(0, 40, 8) for y in range(0, 40, 8)] + [shapely.Point(5, 5)]
    order = random.permutation(len(sites))
    cells, again = (voronoi(each, max_distance=2.5) for each in (sites, [sites[k] for k in order]))
    assert again.areas.tolist() == cells.areas[order].tolist()
    assert [each.wkb for each in again.to_shapely()] == [cells.to_shapely()[k].wkb for k in order]
    assert voronoi(sites, max_distance=2.5, threads=1) == voronoi(sites, max_distance=2.5, threads=4)


# ---- polylines ---------------------------------------------------------------------------------------
@pytest.mark.parametrize("flatten", [1e-3, 0.3, 100])
def test_polylines_of_circles_are_near(flatten):
    for seed in range(6):
        limit = 0.5 * 4**seed / 16
        cells = quietly(mixed_sites(np.random.default_rng(seed), 6), max_distance=limit)
        points, start = flattened_arcs(cells, flatten)
        for arc in np.flatnonzero(cells.is_circle).tolist():
            along = points[start[arc] : start[arc + 1]]
            inner = (along[1:] + along[:-1]) / 2
            off = limit - np.sqrt(np.square(inner - cells.center[arc]).sum(axis=1))
            assert off.max() <= min(flatten, PART_OF_RADIUS * limit) + 1e-9
            assert off.min() >= -1e-9


# ---- what is refused and found -----------------------------------------------------------------------


def test_limits_that_are_none_or_lost_by_rounding():
    with pytest.raises(UsageError, match="max_distance must be above 0, but is -1"):
        voronoi([[0, 0], [1, 1]], max_distance=-1)
    with pytest.raises(UsageError, match=r"max_distance is .*, too small .*: use at least 1e-10"):
        voronoi([[0, 0], [100, 1]], max_distance=9e-11)
    small = voronoi([[0, 0], [100, 1]], max_distance=1e-10, frame=(-1, -1, 102, 3))
    assert small.areas.tolist() == pytest.approx([ROUND * 1e-20] * 2, rel=1e-3)
    verify_voronoi(small)


def test_wrong_limits_are_found():
    cells = voronoi([[0, 0], [4, 0]], frame=FRAME, max_distance=3)
    verify_voronoi(cells)
    for wrong in (
        replace(cells, max_distance=2.5),
        replace(cells, max_distance=3.5),
        replace(cells, max_distance=None),
        replace(cells, center=np.add(cells.center, [1, 0])),
        replace(voronoi([[0, 0], [4, 0]], frame=cells.frame), max_distance=3.0),
    ):
        with pytest.raises(VerificationError):
            verify_voronoi(wrong)


def test_a_frame_that_touches_and_halves_a_disc():
    for x in (-2, -1, 0, 1, 2):
        cells = within([[0, 0]], 1, (x, -3, 6, 6))
        assert cells.areas.tolist() == pytest.approx([{-2: 1, -1: 1, 0: 0.5}.get(x, 0) * ROUND], abs=1e-12)
    quarter = within([[0, 0]], 5, (0, 0, 6, 6))
    assert quarter.areas.tolist() == pytest.approx([25 * ROUND / 4])
    assert within([[0, 0]], 5, (0, 3, 6, 6)).vertices.shape == (3, 2)


@pytest.mark.parametrize(("x", "y"), [(1e6 / 3, 1e6 / 8), (1e6 / 3, 1e5), (1e6 / 4, 1e6 / 7)])
def test_a_disc_that_touches_two_sides_as_far_as_doubles_tell(x, y):
    """Where a side misses it by less than rounding, its half arc on the other side does not touch that, but its own."""
    cells = voronoi([[x, y], [x - 1.9, y + 0.3]], frame=(x - 0.7, y - 0.1, 1, 0.2), max_distance=0.1)
    assert cells.areas.tolist() == pytest.approx([np.pi / 100, 0], rel=1e-4)
    verify_voronoi(cells, places=100)
