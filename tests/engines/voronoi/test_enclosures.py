"""Enclosures, each shared out among the sites that meet it, against faces and distances of shapely."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import shapely
from tests.support.families.cut_scenes import lattice_lines, lattice_sites
from tests.support.families.site_families import squares
from tests.support.oracles.cut_oracle import assert_cut_coverage, assert_nearest_in_regions, regions_of_lines

from support.few import few
from vorotool import verify_voronoi, voronoi
from vorotool.errors import RepairWarning, VerificationError

FRAME = (-10.0, -10.0, 20.0, 20.0)


def quietly(sites, **options):
    with warnings.catch_warnings(action="ignore", category=RepairWarning):
        return voronoi(sites, **options)


@pytest.mark.parametrize("side", [4, 8, 1000])
@pytest.mark.parametrize("seed", few(range(12), 2))
def test_everything_on_a_lattice(side, seed):
    random = np.random.default_rng(seed)
    sites, lines = lattice_sites(random, side), lattice_lines(random, side)
    box = shapely.box(-2, -2, side + 2, side + 2)
    cells = quietly(sites, enclosures=lines, frame=(-2, -2, side + 4, side + 4))
    regions = regions_of_lines(lines, box, sites)
    assert_cut_coverage(cells, sum(face.area for face, own in regions if own))
    assert_nearest_in_regions(cells, sites, regions, seed=seed)
    verify_voronoi(cells, places=50)


def test_a_line_across_the_frame():
    cells = voronoi([[0, 0], [4, 0], [0, 4]], enclosures=["LINESTRING (-90 1, 90 1)"], frame=(-2, -2, 8, 8))
    assert cells.areas.tolist() == [12, 12, 40]
    along = cells.is_cut & cells.is_border
    assert along.sum() == 2
    assert cells.length[along].tolist() == [4, 4]
    assert np.isnan(cells.radius[cells.arcs[along]]).all()
    assert cells.neighbors["label_a"].tolist() == [1, 1, 2]


def test_a_house_in_two_faces_is_joined_across_the_line():
    house, tree = shapely.box(-2, -2, 2, 2), shapely.Point(0, 8)
    cells = voronoi([house, tree], enclosures=["LINESTRING (-90 0, 90 0)"], frame=FRAME)
    assert cells.components.tolist() == [1, 1]
    assert cells.areas.sum() == 400
    assert not (cells.is_cut & cells.is_border).any()
    whole = voronoi([house, tree], frame=FRAME)
    np.testing.assert_allclose(cells.areas, whole.areas)


def test_distances_go_to_the_whole_site():
    """The part of the first site in the other face is nearer to all of this one."""
    bent = shapely.LineString([(-8, 1), (-8, -1), (8, -1)])
    cells = voronoi([bent, shapely.Point(-4, 9)], enclosures=["LINESTRING (-90 0, 90 0)"], frame=FRAME)
    shape = cells.to_shapely()[0]
    assert shape.contains(shapely.Point(8, 0.5))
    assert cells.areas.sum() == 400


def test_faces_that_no_site_meets():
    lines = ["LINESTRING (-10 0, 10 0)", "LINESTRING (0 -10, 0 10)"]
    cells = voronoi(
        [shapely.Point(5, 5), shapely.box(-4, 0, 0, 2), shapely.Point(0, -3)], enclosures=lines, frame=FRAME
    )
    assert cells.areas.tolist() == [100, 100, 0]
    verify_voronoi(cells)


def test_open_ends_cut_nothing():
    sites = [shapely.Point(-4, 1), shapely.Point(4, 1), shapely.Point(0, -3)]
    ends = ["LINESTRING (-5 0, 5 0)", "LINESTRING (0 -3, 0 9)"]
    assert voronoi(sites, enclosures=ends, frame=FRAME) == replace(
        voronoi(sites, enclosures=ends[:1], frame=FRAME), enclosures=voronoi(sites, enclosures=ends).enclosures
    )
    np.testing.assert_allclose(
        voronoi(sites, enclosures=ends, frame=FRAME).areas, voronoi(sites, frame=FRAME).areas, rtol=1e-6
    )


def test_polygons_are_the_lines_around_them():
    sites = squares(2)
    block = shapely.box(-1, -1, 1.5, 4)
    by_polygon, by_line = (voronoi(sites, enclosures=[each]) for each in (block, block.exterior))
    assert by_polygon.areas.tolist() == by_line.areas.tolist()
    assert by_polygon.frame == pytest.approx((-1.5, -1.5, 5, 6))
    assert_nearest_in_regions(by_polygon, sites, [(block, [0, 2])])


def test_within_a_clip_a_face_keeps_its_sites():
    block = shapely.box(0, 0, 8, 8)
    sites = [shapely.Point(2, 4), shapely.Point(6, 4), shapely.Point(9, 4)]
    cells = voronoi(sites, enclosures=[block], clip=shapely.box(1, 1, 5, 5))
    assert cells.areas.tolist() == [12, 4, 0]
    verify_voronoi(cells)


def test_with_a_limit_of_distance():
    sites = [shapely.Point(-1, 0), shapely.Point(9, 9)]
    cells = voronoi(sites, enclosures=["LINESTRING (0 -90, 0 90)"], frame=FRAME, max_distance=2)
    segment = np.arccos(0.5) * 4 - np.sqrt(3)
    assert cells.areas[0] == pytest.approx(4 * np.pi - segment)
    verify_voronoi(cells)


def test_a_block_of_streets():
    houses = [shapely.transform(each, lambda xy: 4 * xy) for each in squares(6)]
    streets = [
        shapely.LineString(ends) for k in (-2.0, 14.0, 30.0, 46.0) for ends in ([(k, -2), (k, 46)], [(-2, k), (46, k)])
    ]
    cells = voronoi(houses, enclosures=streets, frame=(-10, -10, 64, 64))
    assert cells.areas.tolist() == [64.0] * 36
    assert cells.frame == (-2, -2, 48, 48)
    assert_cut_coverage(cells, 48.0 * 48)


def test_no_sites_and_no_lines():
    assert voronoi([], enclosures=["LINESTRING (0 0, 4 0)"]).areas.tolist() == []
    none = voronoi([[0, 0], [4, 0]], enclosures=[], frame=FRAME)
    np.testing.assert_allclose(none.areas, [240, 160])


@pytest.mark.parametrize("change", ["other line", "nobody", "swapped"])
def test_wrong_maps_are_found(change):
    sites = [shapely.Point(-4, 4), shapely.Point(4, 4), shapely.Point(0, -4)]
    cells = voronoi(sites, enclosures=["LINESTRING (-90 0, 90 0)"], frame=FRAME)
    verify_voronoi(cells)
    if change == "other line":
        wrong = replace(cells, enclosures=voronoi(sites, enclosures=["LINESTRING (-90 3, 90 3)"]).enclosures)
    elif change == "nobody":
        wrong = replace(cells, polygons=voronoi([*sites[:2], shapely.Point(0, 4)]).polygons)
    else:
        wrong = replace(cells, polygons=voronoi([sites[1], sites[0], sites[2]]).polygons)
    with pytest.raises(VerificationError):
        verify_voronoi(wrong)
