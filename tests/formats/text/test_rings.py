"""Rings as they are written, beside shapely: valid, on the grid, and a coverage where they were one."""

import numpy as np
import pytest
import shapely

import vorotool
from support.few import few
from vorotool.formats.text.rings import geometry, written_rings
from vorotool.numeric.arrays import Nesting
from vorotool.numeric.coordinates import rounded

DECIMALS = [None, 6, 3, 1, 0]


def lattice(rng, step):
    return rng.permutation(np.stack(np.meshgrid(np.arange(12), np.arange(9)), -1).reshape(-1, 2))[:70] * step


def cocircular(rng, _):
    turn = rng.uniform(0, 2 * np.pi, 40)
    return np.stack([np.cos(turn), np.sin(turn)], 1) * rng.choice([1.0, 3.0], 40)[:, None] + 10


def nearly_cocircular(rng, scale):
    corners = rng.uniform(0, 20 * scale, (20, 1, 2)) + np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * scale
    return (corners + rng.normal(size=(20, 4, 2)) * scale * 1e-15).reshape(-1, 2)


FAMILIES = {
    "random": lambda rng: rng.uniform(0, 30, (60, 2)),
    "tenths": lambda rng: lattice(rng, 0.1),
    "thirds": lambda rng: lattice(rng, 1 / 3) + 1e6,
    "degrees": lambda rng: lattice(rng, 0.001) + np.array([179, -45]),
    "cocircular": lambda rng: cocircular(rng, 1),
    "nearly cocircular": lambda rng: nearly_cocircular(rng, 1.0),
    "far": lambda rng: nearly_cocircular(rng, 0.1) + np.array([500000.3, 5300000.7]),
}


def check(given, nesting, decimals, *, is_coverage=True, in_box=False):
    """All that is promised of written rings; returns them."""
    made = written_rings(given, nesting, decimals=decimals, is_coverage=is_coverage, in_box=in_box)
    shapes = geometry(made.points, made.nesting)
    assert shapely.is_valid(shapes).all()
    assert len(shapes) == len(nesting.cells) - 1
    np.testing.assert_array_equal(rounded(made.points, decimals), made.points)
    if is_coverage:
        assert shapely.coverage_is_valid(shapes[~shapely.is_empty(shapes)])
        shapely.union_all(shapes)
    return made, shapes


@pytest.mark.parametrize("decimals", DECIMALS)
@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("seed", few(range(3), 1))
def test_cells_of_points(family, decimals, seed):
    points = FAMILIES[family](np.random.default_rng(seed))
    low, high = np.floor(points.min(axis=0)) - 1, np.ceil(points.max(axis=0)) + 1
    cells = vorotool.voronoi_cells(points, frame=(*low, *(high - low)))
    made, shapes = check(cells.coordinates, cells.nesting, decimals, in_box=True)
    width, height = high - low
    assert shapely.area(shapes).sum() == pytest.approx(width * height, rel=1e-12)
    step = 10.0**-decimals if decimals is not None else 1e-9
    moved = shapely.hausdorff_distance(shapes, geometry(cells.coordinates, cells.nesting))
    assert np.nan_to_num(moved).max() < 2 * step
    if made.repaired == 0:
        assert made.nesting.rings[-1] <= cells.nesting.rings[-1]


def test_what_is_sound_keeps_its_bits():
    cells = vorotool.voronoi_cells(np.random.default_rng(1).uniform(0, 1, (500, 2)))
    made = written_rings(cells.coordinates, cells.nesting, is_coverage=True)
    assert made.repaired == 0
    np.testing.assert_array_equal(made.points, cells.coordinates)


def nest(*features):
    """Rings of features of polygons of rings."""
    polygons = [polygon for feature in features for polygon in feature]
    rings = [np.array(ring, dtype=float) for polygon in polygons for ring in polygon]
    sizes = [[len(ring) for ring in rings], [len(p) for p in polygons], [len(f) for f in features]]
    return np.concatenate(rings), Nesting(*(np.concatenate([[0], np.cumsum(s)]) for s in sizes))


BOX = [(0, 0), (8, 0), (8, 8), (0, 8)]


@pytest.mark.parametrize(
    ("polygons", "decimals", "wkt"),
    [
        ([[BOX, [(1, 1), (1, 2), (2, 1)]]], None, "POLYGON ((0 0, 8 0, 8 8, 0 8, 0 0), (1 1, 1 2, 2 1, 1 1))"),
        ([[BOX, [(0.4, 1), (1, 2), (2, 1)]]], 0, "POLYGON ((0 0, 8 0, 8 8, 0 8, 0 0), (0 1, 1 2, 2 1, 0 1))"),
        ([[BOX, [(0.4, 1), (0.4, 3), (2, 1)]]], 0, "POLYGON ((0 0, 8 0, 8 8, 0 8, 0 3, 2 1, 0 1, 0 0))"),
        ([[BOX, [(0.1, 0.1), (0.2, 0.4), (0.3, 0.2)]]], 0, "POLYGON ((0 0, 8 0, 8 8, 0 8, 0 0))"),
        ([[[(0, 0), (0.4, 0), (0.2, 5)]]], 0, "POLYGON EMPTY"),
        ([[[(0, 0), (8, 0), (8, 3), (4.4, 0.4), (3.6, 0.4), (0, 3)]]], 0, None),
        ([[BOX], [[(8.4, 0), (9, 0), (9, 8), (8.4, 8)]]], 0, "POLYGON ((0 0, 0 8, 8 8, 9 8, 9 0, 8 0, 0 0))"),
    ],
)
def test_rings_that_meet_after_rounding(polygons, decimals, wkt):
    _, shapes = check(*nest(polygons), decimals, is_coverage=False)
    if wkt is not None:
        assert shapes[0].normalize() == shapely.from_wkt(wkt).normalize()


def test_separate_features_may_overlap():
    other = [(4, 4), (12, 4), (12, 12), (4, 12)]
    points, nesting = nest([[BOX]], [[other]], [[[(0, 0), (5.4, 0), (5, 5.2), (5.3, 0.2)]]])
    made, shapes = check(points, nesting, 0, is_coverage=False)
    assert shapely.area(shapes).tolist()[:2] == [64, 64]
    assert made.repaired == 1


def test_neighbors_get_the_vertices_that_an_edge_receives():
    """A wedge that closes leaves its tip on the edge of the cell below it."""
    points, nesting = nest(
        [[[(0, 0), (10, 0), (10, 5), (0, 5)]]],
        [[[(0, 5), (10, 5), (5, 5.3)]]],
        [[[(0, 5), (5, 5.3), (10, 5), (10, 9), (0, 9)]]],
    )
    made, shapes = check(points, nesting, 0)
    assert made.emptied.tolist() == [1]
    assert (5.0, 5.0) in shapes[0].exterior.coords
    assert shapely.area(shapes).tolist() == [50, 0, 40]


def test_a_cell_that_turns_over():
    """Three cells around a corner, one of which rounding turns inside out."""
    points, nesting = nest(
        [[[(0, 0), (3.4, -2.4), (3.6, -2.6)]]],
        [[[(0, 0), (3.6, -2.6), (9, 0)]]],
        [[[(0, 0), (0, -9), (9, -9), (9, 0), (3.6, -2.6), (3.4, -2.4)]]],
    )
    check(points, nesting, 0)
