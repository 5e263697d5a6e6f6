"""Voronoi maps in clips, against overlays and distances of shapely."""

import warnings

import numpy as np
import pytest
import shapely
from tests.support.families.cut_scenes import lattice_clip, lattice_sites
from tests.support.families.site_families import mixed_sites, squares
from tests.support.oracles.cut_oracle import assert_cut_coverage

import vorotool
from support.few import few
from support.oracles.voronoi_oracle import quietly
from vorotool import verify_voronoi, voronoi
from vorotool.convert.polygons import as_polygons
from vorotool.errors import InputError

BOX = shapely.box(0, 0, 10, 10)


@pytest.mark.parametrize("seed", range(6))
def test_a_clip_cuts_what_there_is_without_it(seed):
    random = np.random.default_rng(seed)
    sites = mixed_sites(random, 8)
    clip = shapely.Point(50, 50).buffer(35).difference(shapely.Point(40, 55).buffer(12))
    cut = quietly(sites, clip=clip)
    whole = quietly(sites, frame=(0, 0, 100, 100)).to_shapely(flatten=1e-4)
    np.testing.assert_allclose(cut.areas, shapely.area(shapely.intersection(whole, clip)), atol=0.05)
    assert_cut_coverage(cut, clip.area)


def symmetric(geometry, k):
    """One of the eight symmetries of a square around the origin."""

    def turned(xy):
        x, y = xy.T
        x, y = [(x, y), (-y, x), (-x, -y), (y, -x)][k % 4]
        return np.stack([x, -y] if k > 3 else [x, y], axis=1)

    return [shapely.transform(each, turned) for each in geometry]


@pytest.mark.parametrize("seed", few(range(4), 2))
def test_eight_symmetries(seed):
    random = np.random.default_rng(seed)
    sites = lattice_sites(random, 8)
    clip = lattice_clip(random, 8, sites)
    once = quietly(sites, clip=clip)
    for k in range(1, 8):
        again = quietly(symmetric(sites, k), clip=symmetric(clip, k))
        np.testing.assert_allclose(again.areas, once.areas, atol=1e-6)
        np.testing.assert_allclose(again.perimeters.sum(), once.perimeters.sum(), rtol=1e-5)


@pytest.mark.parametrize("far", few([30.03, 3003.3, 3.1e8], 1))
@pytest.mark.parametrize("others", [{}, {"enclosures": shapely.box(-1.3, -1, 5.1, 17.7)}, {"max_distance": 2.5}])
def test_a_frame_far_around_the_clip_changes_nothing(far, others):
    sites = np.random.default_rng(7).random((20, 2)) * 10
    clip = shapely.box(-2.7, -2.9, 12.3, 11.1)
    around = voronoi(sites, clip=clip, frame=(-far, -far, 2 * far, 2 * far), **others)
    assert around == voronoi(sites, clip=clip, **others)
    beside = voronoi(sites, clip=clip, frame=(4.25, -far, far, 2 * far), **others)
    verify_voronoi(around)
    verify_voronoi(beside)
    assert beside.vertices[:, 0].min() == 4.25
    right = voronoi(sites, clip=shapely.box(4.25, -2.9, 12.3, 11.1), **others)
    np.testing.assert_allclose(beside.areas, right.areas, atol=1e-5)


@pytest.mark.parametrize(
    ("clip", "areas"),
    [
        (shapely.box(-0.5, -0.5, 5.5, 5.5), [4.0] * 9),
        (shapely.box(-0.5, -0.5, 1.5, 1.5), [4.0] + [0.0] * 8),
        (shapely.box(0, 0, 5, 5), [2.25, 3, 2.25, 3, 4, 3, 2.25, 3, 2.25]),
        (
            shapely.Polygon([(2.5, -0.5), (5.5, 2.5), (2.5, 5.5), (-0.5, 2.5)]),
            [0.5, 3, 0.5, 3, 4, 3, 0.5, 3, 0.5],
        ),
    ],
)
def test_clips_along_borders_and_walls(clip, areas):
    np.testing.assert_allclose(voronoi(squares(3), clip=clip).areas, areas, atol=1e-7)


@pytest.mark.parametrize("seed", range(4))
def test_cells_as_a_clip(seed):
    """Its edges run along borders, a step of the lattice beside them."""
    random = np.random.default_rng(seed)
    sites = mixed_sites(random, 6)
    cells = [cell for cell in quietly(sites).to_shapely(flatten=0.5) if not cell.is_empty]
    assert_cut_coverage(quietly(sites, clip=cells[::2]), shapely.union_all(cells[::2]).area)


def test_with_a_limit_of_distance():
    cells = voronoi([[0, 0], [10, 0]], clip=shapely.box(-1, -4, 20, 4), max_distance=2)
    segment = np.arccos(0.5) * 4 - np.sqrt(3)
    np.testing.assert_allclose(cells.areas, [4 * np.pi - segment, 4 * np.pi])
    assert (cells.is_circle | cells.is_cut).all()
    verify_voronoi(cells)
    nothing = voronoi([[0, 0]], clip=shapely.box(5, 5, 6, 6), max_distance=1)
    assert nothing.areas.tolist() == [0]


@pytest.mark.parametrize("name", few(["ne_110m_lakes", "great-lakes"], 1))
def test_lakes_on_land(name):
    lakes, land = vorotool.read(f"data/{name}.geojson"), vorotool.read("data/ne_110m_land.geojson")
    with warnings.catch_warnings(action="ignore"):
        cells = voronoi(lakes, clip=land)
    assert shapely.coverage_is_valid(cells.to_shapely())
    verify_voronoi(cells, places=200)


def test_what_is_said_of_a_clip():
    cells = voronoi([[1, 1], [3, 1]], clip=shapely.box(0, 0, 4, 2))
    assert cells.is_cut.sum() == 6
    assert (cells.is_cut == ~cells.is_border).all()
    assert cells.frame == (0, 0, 4, 2)
    assert cells.clip == as_polygons(shapely.box(0, 0, 4, 2))
    assert np.isnan(cells.radius).sum() == 4
    assert voronoi([], clip=BOX).frame == (0, 0, 10, 10)


@pytest.mark.parametrize(
    "clip",
    [
        [shapely.LineString([(0, 0), (4, 4)])],
        [shapely.Polygon([(0, 0), (4, 4), (8, 8)])],
        shapely.box(0, 0, 1e-12, 1e-12),
    ],
)
def test_clips_without_area(clip):
    with warnings.catch_warnings(action="ignore"), pytest.raises(InputError, match="the clip has no"):
        voronoi([[0, 0], [9, 9]], clip=clip)


def test_systems_of_reference():
    sites = as_polygons({"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 1], [0, 0]]]})
    crs = {"type": "name", "properties": {"name": "EPSG:2056"}}
    data = {"type": "FeatureCollection", "crs": crs, "features": []}
    box = {"type": "Feature", "properties": {}, "geometry": shapely.geometry.mapping(BOX)}
    swiss = as_polygons({**data, "features": [box]})
    other = as_polygons({**data, "features": [box], "crs": {**crs, "properties": {"name": "EPSG:3857"}}})
    assert voronoi(swiss, clip=sites).clip.crs == swiss.crs
    with pytest.raises(InputError, match=r"the clip and the sites are in different .* EPSG:3857 and EPSG:2056"):
        voronoi(swiss, clip=other)
    with pytest.raises(InputError, match="the enclosures and the sites"):
        voronoi(swiss, enclosures=other)
