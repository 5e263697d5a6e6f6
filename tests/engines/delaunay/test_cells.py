"""Voronoi cells of points beside rationals and shapely, their frames, clips and checker."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import shapely

import vorotool
from support.families.point_families import draw
from support.few import few
from vorotool import Box, InputError, VerificationError, VorotoolWarning, delaunay, verify_cells, voronoi_cells
from vorotool.engines.delaunay.cells import cut_out


def quietly(points, **options):
    """The cells, checked; duplicates are expected."""
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        cells = voronoi_cells(points, **options)
    if "clip" not in options:
        verify_cells(cells, threads=1)
    return cells


def test_against_shapely():
    for name in ("uniform", "clustered", "offset_1e9"):
        points = draw(name, 3000, 3)
        cells = quietly(points)
        frame = shapely.box(*cells.frame.sides)
        peer = shapely.get_parts(shapely.voronoi_polygons(shapely.MultiPoint(points), extend_to=frame))
        polygon, site = shapely.STRtree(shapely.points(points)).query(peer, predicate="contains")
        areas = np.zeros(len(points))
        areas[site] = shapely.area(shapely.intersection(peer[polygon], frame))
        np.testing.assert_allclose(cells.areas, areas, rtol=1e-4)  # GEOS merges close vertices


def test_sites_outside_the_frame():
    """A frame in one cell alone; a cell that touches the frame along a side, or at a corner, is empty."""
    cells = quietly([[0, 0], [10, 0], [0, 10]], frame=(0, 0, 1, 1))
    assert cells.is_empty.tolist() == [False, True, True]
    cells = quietly([[-1, 0.5], [1, 0.5]], frame=(0, 0, 1, 1))
    assert cells.is_empty.tolist() == [True, False]
    assert cells.areas.tolist() == [0.0, 1.0]
    cells = quietly([[-1, -1], [1, 1]], frame=(0, 0, 1, 1))
    assert cells.is_empty.tolist() == [True, False]


def test_default_frame():
    assert quietly([[0, 0], [20, 10]]).frame == Box(-2, -2, 22, 12)
    assert quietly([[3, 4]]).frame == Box(2.5, 3.5, 3.5, 4.5)
    assert quietly([[1e17, 0]]).frame.left < 1e17


# ---- clipping to polygons ----


def test_clip_cuts_cells_into_parts_with_holes():
    """A frame of two strips, cut to a ring whose hole and outline both divide cells."""
    outline = shapely.box(0, 0, 6, 6)
    ring = outline.difference(shapely.box(1, 2, 5, 4))
    points = [[3, 1], [3, 3], [3, 5], [100, 3]]
    cells = quietly(points, clip=ring)
    assert cells.frame == Box(0, 0, 6, 6)
    shapes = cells.to_shapely()
    assert [shape.geom_type for shape in shapes] == ["Polygon", "MultiPolygon", "Polygon", "Polygon"]
    assert cells.is_empty.tolist() == [False, False, False, True]
    np.testing.assert_allclose(cells.areas, [12, 4, 12, 0])
    np.testing.assert_allclose(cells.perimeters, shapely.length(shapes))
    holed = quietly([[3, 3]], clip=ring)
    assert [len(shape.interiors) for shape in holed.to_shapely()] == [1]
    assert holed.areas.tolist() == [28.0]
    assert holed.perimeters.tolist() == [24.0 + 12.0]


def test_clip_against_plain_intersection():
    points = draw("uniform", 400, 1)
    area = shapely.Point(0.5, 0.5).buffer(0.4).difference(shapely.Point(0.4, 0.5).buffer(0.15))
    whole, cut = quietly(points), quietly(points, clip=area)
    right = shapely.intersection(whole.to_shapely(), area)
    np.testing.assert_allclose(cut.areas, shapely.area(right), atol=1e-12)
    assert (shapely.area(shapely.symmetric_difference(cut.to_shapely(), right)) < 1e-12).all()
    assert shapely.is_valid(cut.to_shapely()).all()
    inside = shapely.contains_properly(area, whole.to_shapely())
    assert inside.sum() > 50
    for i in np.flatnonzero(inside):
        assert shapely.equals_exact(cut.to_shapely()[i], whole.to_shapely()[i])


def test_clip_polygons_are_united_and_repaired():
    bow = shapely.Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])
    with pytest.warns(VorotoolWarning, match=r"^1 of 2 clip polygons are invalid .*Self-intersection"):
        cells = voronoi_cells([[1, 1]], clip=[bow, shapely.box(3, 0, 4, 2)])
    assert cells.areas.tolist() == [4.0]
    assert cells.to_shapely()[0].geom_type == "MultiPolygon"


@pytest.mark.parametrize("clip", [shapely.Point(0, 0), [shapely.LineString([(0, 0), (1, 1)])], shapely.Polygon(), 5])
def test_what_cannot_be_clipped_to(clip):
    with pytest.raises(InputError, match="clip"):
        voronoi_cells([[0, 0]], clip=clip)


# ---- bad input ----


@pytest.mark.parametrize(
    "change",
    [
        {"triangles": [[0, 1, 9]]},
        {"triangles": [[0, 2, 1]]},
        {"neighbors": [[5, -1, -1]]},
        {"first": [0, 1, 77]},
        {"hull": [0, 1, 77]},
        {"points": [[0, 0], [1, 0], [0, np.nan]]},
    ],
)
def test_arrays_that_are_no_triangulation(change):
    mesh = replace(delaunay([[0, 0], [1, 0], [0, 1]]), **change)
    with pytest.raises(InputError, match="triangulation"):
        voronoi_cells(mesh)


# ---- the checker ----


def moved(cells, row, by):
    coordinates = cells.coordinates.copy()
    coordinates[row] += by
    return replace(cells, coordinates=coordinates)


def test_the_checker_finds_faults():
    cells = voronoi_cells(draw("uniform", 50, 0))
    verify_cells(cells)
    inner = np.flatnonzero((np.abs(cells.coordinates - 0.5) < 0.3).all(axis=1))
    for row in inner[:40]:
        for step in (1e-9, 1e-15):
            with pytest.raises(VerificationError, match=r"nearer|convex|add up"):
                verify_cells(moved(cells, row, [step, 0]))
    with pytest.raises(VerificationError, match=r"of cell 0 is not in the frame"):
        verify_cells(replace(cells, frame=Box(0.9, 0.9, 1, 1)))
    with pytest.raises(VerificationError, match=r"add up to 0\."):
        verify_cells(replace(cells, frame=Box(-1, -1, 2, 2)))
    with pytest.raises(VerificationError, match="not finite"):
        verify_cells(moved(cells, 0, [np.nan, 0]))
    with pytest.raises(VerificationError, match="has only 1 vertices"):
        verify_cells(vorotool.CellSet([[0, 0]], [[0, 0]], [0, 1], Box(0, 0, 1, 1)))
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    with pytest.raises(VerificationError, match="point 1 lies on an earlier one"):
        verify_cells(vorotool.CellSet([[0, 0], [0, 0]], square, [0, 0, 4], Box(0, 0, 1, 1)))
    with pytest.raises(VerificationError, match="is repeated"):
        verify_cells(vorotool.CellSet([[0, 0]], [*square, square[3]], [0, 5], Box(0, 0, 1, 1)))
    with pytest.raises(VerificationError, match="not convex"):
        verify_cells(vorotool.CellSet([[0, 0]], square[::-1], [0, 4], Box(0, 0, 1, 1)))
    with pytest.raises(InputError, match="before clipping"):
        verify_cells(quietly([[0, 0]], clip=shapely.box(0, 0, 1, 1)))


def coast(count, seed, holes=3):
    """A polygon of many vertices with holes, and an island."""
    random = np.random.default_rng(seed)

    def ring(x, y, size, corners):
        angle = np.sort(random.uniform(0, 2 * np.pi, corners))
        radius = size * random.uniform(0.7, 1.0, corners)
        return np.column_stack([x + radius * np.cos(angle), y + radius * np.sin(angle)])

    inner = [ring(4 * k - 4, 0, 1, 60) for k in range(holes)]
    return shapely.union_all([shapely.Polygon(ring(0, 0, 10, count), inner), shapely.Polygon(ring(20, 3, 2, 80))])


def boxes(count, seed, size):
    random = np.random.default_rng(seed)
    x, y = random.uniform(-12, 23, count), random.uniform(-12, 12, count)
    return shapely.box(x, y, x + random.uniform(0.1, size, count), y + random.uniform(0.1, size, count))


@pytest.mark.parametrize("seed", few(range(4), 1))
@pytest.mark.parametrize("size", [0.7, 6.0, 40.0])
def test_pieces_are_those_of_the_whole(seed, size):
    area, shapes = coast(1500, seed), boxes(120, seed, size)
    for ours, theirs in zip(cut_out(shapes, area), shapely.intersection(shapes, area), strict=True):
        assert ours.wkb == theirs.wkb
