"""Frames, clips and enclosures that contain, overlap, touch and miss each other, against shapely."""

import warnings

import numpy as np
import pytest
import shapely
from tests.support.families.meeting_cuts import meeting_scene
from tests.support.oracles.cut_oracle import assert_nearest_in_regions
from tests.support.oracles.meeting_regions import areas_of_points, regions_of_cuts

from support.few import few
from vorotool import VorotoolWarning, verify_voronoi, voronoi

TWO = [shapely.Point(0, 0), shapely.Point(1, 1)]
CORNER = shapely.Polygon([(9, 9), (10, 9), (9, 10)])


@pytest.mark.parametrize("seed", few(range(60), 6))
def test_scenes_on_a_lattice(seed):
    check_scene(seed)


def check_scene(seed):
    sites, options = meeting_scene(seed)
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        cells = voronoi(sites, **options)
    limit, regions = options.get("max_distance"), regions_of_cuts(sites, cells.frame, options)
    if limit is None:
        assert cells.areas.sum() == pytest.approx(sum(region.area for region, own in regions if own), abs=1e-5)
        assert_nearest_in_regions(cells, sites, regions, seed=seed)
    if all(site.geom_type == "Point" for site in sites):
        np.testing.assert_allclose(cells.areas, areas_of_points(sites, regions, limit), atol=2e-4)
    verify_voronoi(cells, places=30)


@pytest.mark.parametrize("frame", [(0, 0, 2, 2), (8, 8, 1, 1), (8, 8, 1, 2), (10, 9, 2, 2), (9.5, 9.5, 1, 1)])
@pytest.mark.parametrize("options", [{}, {"max_distance": 2}, {"enclosures": [shapely.box(0, 0, 9, 9)]}])
def test_a_frame_without_any_of_the_clip(frame, options):
    with pytest.warns(VorotoolWarning, match="all 2 cells are empty"):
        cells = voronoi(TWO, frame=frame, clip=CORNER, **options)
    assert cells.areas.tolist() == [0, 0]
    assert cells.frame == frame
    assert len(cells.arcs) == 0
    verify_voronoi(cells)


@pytest.mark.parametrize("line", [[(0, 0), (0, 4)], [(0, -9), (0, 9)], [(0, 1), (0, 2)]])
@pytest.mark.parametrize("cut", [{"frame": (0, 0, 4, 4)}, {"clip": shapely.box(0, 0, 4, 4)}])
def test_a_line_along_an_edge_of_what_is_shared_out(line, cut):
    sites = [shapely.Point(-1, 2), shapely.Point(2, 2)]
    np.testing.assert_allclose(voronoi(sites, **cut).areas, [2, 14])
    cells = voronoi(sites, enclosures=[shapely.LineString(line)], **cut)
    assert cells.areas.tolist() == [0, 16]
    verify_voronoi(cells)


def test_a_limit_that_only_touches_an_edge_shares_out_nothing():
    clip = shapely.Polygon([(-1, 1), (1, -1), (3, 1), (1, 3)])
    cells = voronoi([[2, 2], [1, 0]], frame=(0, 1, 1, 2), clip=clip, max_distance=1)
    assert cells.areas.tolist() == [0, 0]


def test_a_site_where_parts_of_a_clip_touch_is_in_both():
    clip = [shapely.box(0, 0, 2, 2), shapely.box(2, 2, 4, 4)]
    lines = [shapely.LineString([(0, 1), (2, 1)])]
    cells = voronoi([shapely.Point(2, 2), shapely.Point(1, 0)], clip=clip, enclosures=lines)
    assert cells.areas.tolist() == [6, 2]
    verify_voronoi(cells)
