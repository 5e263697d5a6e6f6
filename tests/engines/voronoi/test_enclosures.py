"""Enclosures, each shared out among the sites that meet it, against faces and distances of shapely."""

from dataclasses import replace

import pytest
import shapely
from tests.support.families.site_families import squares
from tests.support.oracles.cut_oracle import assert_cut_coverage

from vorotool import verify_voronoi, voronoi
from vorotool.errors import VerificationError

FRAME = (-10.0, -10.0, 20.0, 20.0)


def test_faces_that_no_site_meets():
    lines = ["LINESTRING (-10 0, 10 0)", "LINESTRING (0 -10, 0 10)"]
    cells = voronoi(
        [shapely.Point(5, 5), shapely.box(-4, 0, 0, 2), shapely.Point(0, -3)], enclosures=lines, frame=FRAME
    )
    assert cells.areas.tolist() == [100, 100, 0]
    verify_voronoi(cells)


def test_within_a_clip_a_face_keeps_its_sites():
    block = shapely.box(0, 0, 8, 8)
    sites = [shapely.Point(2, 4), shapely.Point(6, 4), shapely.Point(9, 4)]
    cells = voronoi(sites, enclosures=[block], clip=shapely.box(1, 1, 5, 5))
    assert cells.areas.tolist() == [12, 4, 0]
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
