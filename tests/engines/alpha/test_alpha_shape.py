"""Alpha shapes: their polygons and counts, the choice of r, thresholds, and what their checker finds."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
import shapely

from support.families.alpha_cases import quietly
from support.families.point_families import draw
from support.few import few
from vorotool import (
    InputError,
    UsageError,
    VerificationError,
    VorotoolWarning,
    alpha_complex,
    alpha_curves,
    alpha_shape,
    verify_alpha_shape,
)
from vorotool.engines.tessellation.seeding import seeds_from_raster
from vorotool.types.alpha.complex import classes_of


def shape_triangles(shape):
    return shapely.polygons(shape.points[shape.family.mesh.triangles[shape.inside]])


def check_polygons(shape):
    """Polygons are valid, one a region, and together what the triangles are."""
    verify_alpha_shape(shape)
    polygons = shape.polygons
    assert len(polygons) == shape.region_count
    made = []
    for k in range(len(polygons)):
        shell, *holes = polygons.rings_of(k)
        for ring in (shell, *holes):
            assert len(np.unique(ring, axis=0)) == len(ring)
        assert shapely.is_ccw(shapely.linearrings(shell))
        assert not any(shapely.is_ccw(shapely.linearrings(hole)) for hole in holes)
        made.append(shapely.Polygon(shell, holes))
        assert made[-1].is_valid, shapely.is_valid_reason(made[-1])
    areas = shapely.area(shape_triangles(shape))
    np.testing.assert_allclose(shapely.area(made), shape.region_areas, rtol=1e-9)
    assert shape.area == pytest.approx(areas.sum(), rel=1e-12)
    union = shapely.union_all(shape_triangles(shape))
    assert shape.area == pytest.approx(union.area, rel=1e-9)
    return union


def complement_holes(union):
    """Bounded components of what a union leaves, by taking it away from a frame."""
    if union.is_empty:
        return 0
    low_x, low_y, high_x, high_y = union.bounds
    frame = shapely.box(low_x - 1, low_y - 1, high_x + 1, high_y + 1)
    return len(shapely.get_parts(shapely.difference(frame, union))) - 1


@pytest.mark.parametrize(
    "name", few(["uniform", "small_lattice", "grid", "exact_circle", "clustered", "duplicates"], 3)
)
def test_shapes_and_curves(name):
    for seed in range(2):
        points = draw(name, 60, seed)
        family = quietly(points)
        curves = alpha_curves(family)
        assert curves["r"] is family.spectrum
        for k in range(0, len(family.spectrum), max(1, len(family.spectrum) // 9)):
            shape = alpha_shape(family, r=family.radius_from(k))
            assert family.reached(shape.r) == k + 1
            assert (shape.family.triangle_rank <= k).tolist() == shape.inside.tolist()
            union = check_polygons(shape)
            assert curves["regions"][k] == shape.region_count
            assert curves["cavities"][k] == shape.cavity_count == complement_holes(union)
            assert curves["edges"][k] == len(shape.edges)
            assert curves["area"][k] == pytest.approx(shape.area, rel=1e-13)
            assert curves["perimeter"][k] == pytest.approx(shape.perimeter, rel=1e-13, abs=1e-13)
            assert shape.perimeter == pytest.approx(sum(part.length for part in _boundaries(shape)), rel=1e-12)
            everywhere = classes_of(family, k + 1, k + 1)
            np.testing.assert_array_equal(shape.edge_classes, everywhere)
            np.testing.assert_array_equal(np.flatnonzero((everywhere == 1) | (everywhere == 2)), shape.edge_index)
            check_point_classes(shape, everywhere)


def _boundaries(shape):
    return [shapely.LinearRing(ring) for k in range(len(shape.polygons)) for ring in shape.polygons.rings_of(k)]


def check_point_classes(shape, classes):
    edges, first = shape.family.edges, shape.family.mesh.first
    for v, found in enumerate(shape.point_classes.tolist()):
        around = set(classes[(edges == first[v]).any(axis=1)].tolist())
        right = 2 if 2 in around else 3 if 3 in around else 1 if 1 in around else 0
        assert found == right
    touching = [set() for _ in shape.points]
    for t in np.flatnonzero(shape.inside):
        for v in shape.family.mesh.triangles[t]:
            touching[v].add(int(shape.region[t]))
    assert shape.point_regions.tolist() == [min(touching[v], default=-1) for v in first]
    assert shape.isolated.tolist() == [
        v
        for v in range(len(first))
        if first[v] == v and not {1, 2, 3} & set(classes[(edges == v).any(axis=1)].tolist())
    ]


def contains_every_point(shape):
    return all(shapely.intersects(shapely.union_all(shape_triangles(shape)), shapely.points(shape.points)))


@pytest.mark.parametrize("name", ["uniform", "small_lattice", "clustered", "exact_circle"])
@pytest.mark.parametrize("regions", few([1, 2, 5], 1))
def test_auto_is_the_smallest(name, regions):
    for seed in range(2):
        points = draw(name, 25, seed + 10)
        family = quietly(points)
        shape = alpha_shape(family, regions=regions)
        rank = family.reached(shape.r) - 1
        assert shape.region_count <= regions
        assert contains_every_point(shape)
        for k in range(rank):
            smaller = alpha_shape(family, r=family.radius_from(k))
            assert smaller.region_count > regions or not contains_every_point(smaller)


def test_auto_where_the_regions_are_not_monotone():
    """A hole of four triangles of which the inner one has the smallest circle: one region, two, then one again."""
    inner = np.array([[0, 0], [1, 0], [0.5, 0.75**0.5]])
    center = inner.mean(axis=0)
    middles = (np.roll(inner, -1, axis=0) + np.roll(inner, -2, axis=0)) / 2
    outward = (middles - center) / np.hypot(*(middles - center).T)[:, None]
    apexes = middles + 0.9 * outward
    hexagon = shapely.Polygon([inner[0], apexes[2], inner[1], apexes[0], inner[2], apexes[1]])
    grid = np.stack(np.meshgrid(np.arange(-3, 4, 0.3), np.arange(-3, 4, 0.3)), axis=-1).reshape(-1, 2)
    around = grid[shapely.distance(hexagon, shapely.points(grid)) > 0.4]
    family = alpha_complex(np.concatenate([inner, apexes, around]))
    shape = alpha_shape(family)
    regions = alpha_curves(family)["regions"][family.reached(shape.r) - 1 :]
    assert regions[0] == regions[-1] == shape.region_count == 1
    assert regions.max() == 2


@pytest.mark.parametrize("n", [2, 3, 7])
def test_collinear_points_are_a_chain(n):
    points = np.stack([np.arange(n) ** 2, 2 * np.arange(n) ** 2], axis=1)
    family = alpha_complex(points)
    assert family.edges.shape == (n - 1, 2)
    assert np.isinf(family.r_mid).all()
    assert np.isinf(family.r_max).all()
    lengths = np.hypot(*np.diff(points, axis=0).T)
    np.testing.assert_allclose(np.sort(family.r_min), lengths / 2)
    shape = alpha_shape(family, r=1e9)
    assert set(shape.classes.tolist()) == {"singular"}
    assert (shape.region_count, shape.area, shape.cavity_count, shape.hole_count) == (0, 0.0, 0, 0)
    with pytest.raises(InputError, match=r"span no triangle, .*: give r itself"):
        alpha_shape(family)


def test_thresholds():
    """A square frame of points with a small and a large gap, and a far pair of triangles."""
    grid = np.stack(np.meshgrid(np.arange(12), np.arange(9)), axis=-1).reshape(-1, 2).astype(float)
    x, y = grid.T
    gaps = ((abs(x - 3) <= 0) & (abs(y - 4) <= 0)) | ((abs(x - 8) <= 1) & (abs(y - 4) <= 1))
    far = np.array([[30.0, 0], [31, 0], [30, 1]])
    family = alpha_complex(np.concatenate([grid[~gaps], far]))
    plain = alpha_shape(family, r=0.8)
    assert (plain.region_count, plain.cavity_count) == (2, 2)
    check_polygons(plain)
    small, large = 2.0, 14.0  # areas of the gaps, corners cut
    assert plain.area == 88 + 0.5 - small - large
    for threshold, holes in ((1.9, 2), (2, 1), (13.9, 1), (14, 0)):
        filled = alpha_shape(family, r=0.8, hole_threshold=threshold)
        assert filled.cavity_count == holes
        check_polygons(filled)
    for threshold, regions in ((0.4, 2), (Fraction(1, 2), 1), (80, 0)):
        dropped = alpha_shape(family, r=0.8, region_threshold=threshold)
        assert dropped.region_count == regions
        check_polygons(dropped)
    both = alpha_shape(family, r=0.8, hole_threshold=100, region_threshold=80)
    assert (both.region_count, both.cavity_count, both.area) == (1, 0, 88.0)
    np.testing.assert_array_equal(both.edge_classes == 2, both.edge_classes == 2)
    assert set(both.classes.tolist()) == {"boundary"}


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"r": -1}, UsageError, "r is -1: a radius must be positive"),
        (
            {"alpha": 0.1},
            UsageError,
            r"alpha must be negative \(α = −1/r\): for the alphashape package's 0.1 use r=10$",
        ),
        ({"alpha": 0}, UsageError, r"alpha must be negative \(α = −1/r\): for the convex hull use r=inf$"),
        ({"r": 1, "alpha": -1}, UsageError, "r and alpha each set the radius: give only one of"),
        ({"r": 1, "regions": 2}, UsageError, "regions applies to the automatic radius"),
        ({"rule": "other"}, UsageError, "rule is 'other': use corrected, or printed"),
    ],
)
def test_bad_options(options, error, message):
    with pytest.raises(error, match=message):
        alpha_shape([[0, 0], [4, 0], [0, 3]], **options)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([], "two distinct points, but got 0 points"),
        ([[1, 2]], "got 1 point"),
        ([[1, 2], [np.nan, 0]], r"point \[1\] is"),
    ],
)
def test_too_few_points(points, message):
    with pytest.raises(InputError, match=message):
        alpha_shape(points, r=1)
    with pytest.warns(VorotoolWarning), pytest.raises(InputError, match="2 points, all at one position"):
        alpha_shape([[1, 2], [1, 2]], r=1)


def changed(shape, array, index, value):
    values = getattr(shape, array).copy()
    values[index] = value
    return replace(shape, **{array: values})


def test_the_checker_finds_faults():
    family = alpha_complex(draw("uniform", 60, 2))
    shape = alpha_shape(family, r=float(np.median(family.spectrum)))
    verify_alpha_shape(shape)
    inside, outside = int(np.argmax(shape.inside)), int(np.argmin(shape.inside))
    last = shape.region_count - 1
    polygons = shape.polygons
    faulty = {
        "is in the shape, but its circumradius": replace(shape, r=shape.r / 2),
        "is not in the shape, but its circumradius": replace(shape, r=shape.r * 2),
        "triangle": changed(shape, "region", outside, 0),
        "triangle ": changed(shape, "region", inside, -1),
        "but should be": changed(shape, "kind", 0, 3 - int(shape.kind[0])),
        "edge": replace(shape, edge_index=shape.edge_index[1:], kind=shape.kind[1:]),
        "regions": replace(shape, region=np.minimum(shape.region, last - 1)),
        "rings": replace(shape, polygons=replace(polygons, xy=np.roll(polygons.xy, 1, axis=0))),
        "edges are not those": replace(shape, family=replace(family, edges=np.roll(family.edges, 1, axis=1))),
        "not a side of a triangle": replace(shape, family=replace(family, sides=np.roll(family.sides, 3, axis=0))),
    }
    for words, wrong in faulty.items():
        with pytest.raises(VerificationError, match=words):
            verify_alpha_shape(wrong)


def test_too_few_objects_of_an_image():
    """Are told and empty; points are refused, unless the caller allows it."""
    image = np.zeros((9, 9), bool)
    image[2, 2] = True
    with pytest.warns(VorotoolWarning, match=r"got 1 point; the shape is empty$"):
        shape = alpha_shape(seeds_from_raster(image))
    assert (len(shape.family), len(shape.polygons), shape.isolated.tolist()) == (0, 0, [0])
    image[6, 7] = True
    with pytest.warns(VorotoolWarning, match=r"^two points span no triangle.*; the shape is empty$"):
        shape = alpha_shape(seeds_from_raster(image))
    verify_alpha_shape(shape)
    assert (len(shape.edges), shape.isolated.tolist()) == (0, [0, 1])
    assert shape.r < shape.family.spectrum[0]
    with pytest.raises(InputError, match="leave out strict=True"):
        alpha_shape(seeds_from_raster(image), strict=True)
    with pytest.raises(InputError, match="span no triangle"):
        alpha_shape([[0, 0], [4, 0]])
    with pytest.warns(VorotoolWarning, match="span no triangle"):
        assert not len(alpha_shape([[0, 0], [4, 0]], allow_empty=True).edges)


def test_the_checker_takes_no_digit_from_products_that_vanish():
    """The squares of two sides are near the smallest number where that of the radius is not."""
    points = [[-2.7e-95, 0.0], [-3.0e-93, -2.623065247051060e-32], [8.27e-113, 1.69e-68], [7.9e-297, 1.3e-188]]
    family = alpha_complex(points)
    for rank in range(len(family.spectrum)):
        verify_alpha_shape(alpha_shape(family, r=family.radius_from(rank)))
