"""Voronoi maps in clips, against overlays and distances of shapely."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import shapely
from tests.support.families.meeting_cuts import meeting_scene, moved_scene
from tests.support.families.site_families import mixed_sites, squares
from tests.support.oracles.cut_oracle import assert_cut_coverage, assert_nearest_in_regions, faces_between, meets_itself
from tests.support.oracles.meeting_regions import area_within, areas_of_points, regions_of_cuts

import vorotool
from support.few import few
from support.oracles.voronoi_oracle import quietly
from vorotool import VorotoolWarning, verify_voronoi, voronoi
from vorotool.convert.polygons import as_polygons
from vorotool.errors import InputError, VerificationError

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


# ---- Enclosures, each shared out among the sites that meet it, against faces and distances of shapely ----
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


# ---- Frames, clips and enclosures that contain, overlap, touch and miss each other, against shapely ----
TWO = [shapely.Point(0, 0), shapely.Point(1, 1)]
CORNER = shapely.Polygon([(9, 9), (10, 9), (9, 10)])


@pytest.mark.parametrize("seed", few(range(60), 6))
def test_scenes_on_a_lattice(seed):
    check_scene(*meeting_scene(seed), seed)


@pytest.mark.parametrize("seed", few(range(60), 6))
def test_scenes_scaled_and_shifted(seed):
    check_scene(*moved_scene(seed), seed)


def check_scene(sites, options, seed):
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        cells = voronoi(sites, **options)
    limit, regions = options.get("max_distance"), regions_of_cuts(sites, cells.frame, options)
    area = area_within(regions, np.array(sites), limit)
    assert cells.areas.sum() == pytest.approx(area, rel=1e-5, abs=1e-5)
    assert_nearest_in_regions(cells, sites, regions, limit=limit, seed=seed)
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


# ---- limits that touch each other on a cut --------------------------------------------------------------
def blocks(mask):
    """Unit squares, those of one number as one site."""
    squares = {}
    for y, x in np.argwhere(mask).tolist():
        squares.setdefault(mask[y, x], []).append(shapely.box(x, y, x + 1, y + 1))
    return [shapely.union_all(own) for own in squares.values()]


def assert_within_faces(sites, lines, frame, limit):
    """Cells cover the buffers of the sites that have an area in each face, overlap nowhere, and are right."""
    cells = voronoi(sites, enclosures=lines, frame=frame, max_distance=limit)
    verify_voronoi(cells, places=50)
    x, y, w, h = frame
    near = shapely.buffer(sites, limit, quad_segs=1024)
    area = 0
    for face in faces_between(lines, shapely.box(x, y, x + w, y + h)):
        own = (shapely.area(shapely.intersection(sites, face)) > 1e-9) | (not lines)
        area += shapely.intersection(face, shapely.union_all(near[own])).area
    assert cells.areas.sum() == pytest.approx(area, rel=1e-5, abs=1e-6)
    shapes = cells.to_shapely(flatten=1e-3)
    assert shapely.coverage_is_valid(shapes) or meets_itself(shapes)
    assert shapely.union_all(shapes).area == pytest.approx(shapely.area(shapes).sum(), rel=1e-9)


MEETING = [
    ([[0, 1], [0, 0], [1, 0]], 0.5, []),  # corners above each other, the touch on the frame's left side
    ([[1], [0], [1]], 0.5, [[(0, 2.5), (1, 0.5)]]),  # sides, across the touch
    ([[1], [0], [1]], 0.5, [[(1, 0), (1, 3)]]),  # sides, at the end of the touch
    ([[0, 1], [0, 0], [1, 0]], 0.5, [[(0, 3), (2, 0)]]),
    ([[1, 0, 2]], 0.5, [[(1, 1), (3, 0)]]),
    ([[0, 1], [0, 0], [0, 0], [1, 0]], 1, [[(0, 0.5), (2, 3.5)]]),
]
"""Blocks, the limit at which they touch, and lines across the touch."""


@pytest.mark.parametrize(("rows", "limit", "lines"), MEETING)
def test_limits_that_touch_each_other_on_a_cut(rows, limit, lines):
    sites = np.array(blocks(np.array(rows)))
    lines = [shapely.LineString(line) for line in lines]
    assert_within_faces(sites, lines, (-1, -1, 6, 6), limit)
    verify_voronoi(voronoi(sites, enclosures=lines, frame=(1, 0, 1, 3), max_distance=limit))


@pytest.mark.parametrize("seed", few(range(100), 8))
def test_random_blocks_with_lines_across_where_their_limits_touch(seed):
    random = np.random.default_rng(seed)
    mask = random.choice([0, 0, 0, 1, 1 + (seed % 3 > 1)], random.integers(3, 7, 2))
    mask[tuple(random.integers(0, 3, 2))] = 1
    height, width = mask.shape
    sites = np.array(blocks(mask))
    corners = np.unique(shapely.get_coordinates(sites), axis=0)
    a, b = corners[random.choice(len(corners), 2, replace=False)]
    middle, limit = (a + b) / 2, float(np.hypot(*(b - a))) / 2
    ways = random.choice([[1, 0], [0, 1], [1, 1], [1, -1], [1, 2], [3, -2]], 1 + seed % 2)
    lines = [shapely.LineString([middle - 99 * way, middle + 99 * way]) for way in ways]
    assert_within_faces(sites, lines, (-5, -5, width + 10, height + 10), limit)


def test_a_site_that_only_touches_the_frame_may_have_a_face():
    """The checker takes no other site for the nearest along the line, whose other side this one has."""
    sites = [shapely.box(0.5, 0, 1.5, 1), shapely.box(2.5, -1, 3.5, 0)]
    line = shapely.LineString([(1.5, 1.5), (3.5, -6.5)])
    cells = voronoi(sites, enclosures=[line], frame=(1, 0, 2.5, 1), max_distance=1)
    assert (cells.areas > 0).all()
    verify_voronoi(cells)


@pytest.mark.parametrize("limit", [np.nextafter(0.5, 0), 0.5, np.nextafter(0.5, 1)])
@pytest.mark.parametrize("frame", [(0.5, 0, 0.5, 3), (0, 0, 1, 4), (1, 0, 0.5, 3), (0.5, 0, 1, 3)])
def test_limits_a_rounding_apart_along_the_frame(frame, limit):
    sites = np.array([shapely.union_all([shapely.box(-0.5, 2.5, 0.5, 3.5), shapely.box(1.5, 2.5, 2.5, 3.5)])])
    assert_within_faces(sites, [], frame, limit)


LIMIT = 2 / 3
TOUCHING_ENDS = [
    (
        shapely.box(1 / 6, 2 / 15, 0.5, 7 / 15).union(shapely.box(7 / 6, 22 / 15, 1.5, 1.8)),
        [
            "LINESTRING (1 0.9666666666666666, 2.6666666666666665 1.6333333333333333)",
            "LINESTRING (1.6666666666666665 1.6333333333333333, 0.3333333333333333 0.3)",
        ],
        (0.0, 0.3, 2.6666666666666665, 3.333333333333333),
    ),
    (
        shapely.box(5 / 6, 144.35714285714286, 7 / 6, 144.6904761904762),
        [
            "LINESTRING (0.3333333333333333 143.85714285714286, 1.3333333333333333 142.85714285714286)",
            "LINESTRING (0.3333333333333333 145.1904761904762, 1 143.1904761904762)",
        ],
        (0.0, 142.85714285714286, 1.3333333333333333, 2.333333333333343),
    ),
]
"""A site, enclosures of which one ends on the other, as far as doubles tell, and a frame."""


@pytest.mark.parametrize(("site", "lines", "frame"), TOUCHING_ENDS)
def test_the_checker_takes_ends_beside_lines_for_touching_or_not(site, lines, frame):
    sites, options = [*shapely.get_parts(site)], {"enclosures": shapely.from_wkt(lines), "frame": frame}
    cells = voronoi(sites, max_distance=LIMIT, **options)
    area = area_within(regions_of_cuts(sites, frame, options), np.array(sites), LIMIT)
    assert cells.areas.sum() == pytest.approx(area, rel=1e-6)
    verify_voronoi(cells, places=200)


@pytest.mark.parametrize("seed", [63, 272, 754, 2946, 5283, 5669, 5679, 6405])
def test_the_checker_takes_what_the_lattice_moves_for_right(seed):
    """The lattice decides where lines, the frame and clips touch at corners, run along each other, or share slivers."""
    sites, options = moved_scene(seed)
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        verify_voronoi(voronoi(sites, **options), places=200)
