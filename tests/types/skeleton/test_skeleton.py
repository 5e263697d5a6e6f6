"""The value type of skeletons, and its tables."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import vorotool
from vorotool.numeric import parallel
from vorotool.numeric.arrays import connected_roots

SHAPES = vorotool.read(Path(__file__).parents[3] / "data" / "two-shapes.json")
MADE = vorotool.skeleton_exact(SHAPES, side="both")


@pytest.mark.parametrize("tolerance", [3.0, 0.1, 1e-5])
def test_flattened_arcs_are_within_the_tolerance(tolerance):
    points, start = MADE.flattened(tolerance)
    for arc in np.flatnonzero(MADE.is_parabola):
        own = points[start[arc] : start[arc + 1]]
        ends = MADE.vertices[MADE.arcs[arc]]
        assert np.array_equal(own[[0, -1]], ends)
        for t in np.linspace(0, 1, 33):
            place = (1 - t) ** 2 * ends[0] + 2 * t * (1 - t) * MADE.control[arc] + t * t * ends[1]
            way = np.diff(own, axis=0)
            along = np.clip(((place - own[:-1]) * way).sum(axis=1) / (way**2).sum(axis=1), 0, 1)
            assert np.hypot(*(own[:-1] + along[:, None] * way - place).T).min() <= tolerance
    assert (np.diff(start)[~MADE.is_parabola] == 2).all()


def test_flattened_lengths_are_the_lengths():
    points, start = MADE.flattened(1e-7)
    steps = np.hypot(*np.diff(points, axis=0).T)
    sums = [steps[a : b - 1].sum() for a, b in pairwise(start)]
    assert np.abs(np.array(sums) - MADE.length).max() < 1e-6


def test_polygons():
    table = vorotool.polygon_table(MADE)
    import shapely

    from vorotool.types.polygons.shapely_geometry import to_shapely

    shapes = to_shapely(SHAPES)
    assert table["area"].tolist() == pytest.approx(shapely.area(shapes).tolist(), rel=1e-14)
    assert table["perimeter"].tolist() == pytest.approx(shapely.length(shapes).tolist(), rel=1e-14)
    assert table["holes"].tolist() == [0, 1]
    assert table["cycles"].tolist() == [0, 1]
    assert table["width_max"][0] == 2 * MADE.radius[MADE.arcs[MADE.polygon == 0]].max()
    assert (table["width_mean"] < table["width_max"]).all()


def test_elements_have_the_labels_of_the_paper():
    table = vorotool.element_table(vorotool.skeleton_exact(SHAPES, gap=4))
    edges = np.array(table["kind"]) == "edge"
    assert (table["label_b"].mask == edges).all()
    assert (
        sorted(np.bincount(np.concatenate([table["label_a"][~edges], table["label_b"][~edges]]))[1:].tolist())
        == [2] * 23
    )
    way = np.hypot(table["x1"][edges] - table["x0"][edges], table["y1"][edges] - table["y0"][edges])
    full = np.sqrt((np.diff(MADE.site_ends[edges], axis=1) ** 2).sum(axis=-1))[:, 0]
    assert np.abs(way - (full - 8)).max() < 1e-9


def test_connected_roots_are_the_smallest():
    rng = np.random.default_rng(1)
    pairs = rng.integers(0, 60, (40, 2))
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    _, labels = connected_components(coo_array((np.ones(40), pairs.T), shape=(60, 60)), directed=False)
    roots = connected_roots(pairs, 60)
    for label in set(labels.tolist()):
        members = np.flatnonzero(labels == label)
        assert (roots[members] == members.min()).all()


@pytest.mark.parametrize("rows", [1, 2, 3, 5, 7])
def test_rings_may_go_on_in_another_chunk(rows, monkeypatch):
    polygons = vorotool.outlines(np.random.default_rng(3).random((12, 15)) < 0.6)
    for shapes in (SHAPES, polygons):
        skeleton = vorotool.skeleton_exact(shapes)
        expected = vorotool.polygon_table(replace(skeleton))
        with monkeypatch.context() as patch:
            patch.setattr(parallel, "CHUNK", rows)
            made = vorotool.polygon_table(replace(skeleton))
        for name in ("area", "perimeter", "width_mean", "width_max"):
            assert made[name].tolist() == expected[name].tolist()


def test_the_width_of_a_single_place():
    """Pruning leaves the middle of a square, where the skeleton has no length, but a width."""
    square = [[0, 0], [50, 0], [50, 50], [0, 50]]
    table = vorotool.polygon_table(vorotool.prune(vorotool.skeleton_exact(square), length=40))
    assert [table[name].tolist() for name in ("length", "width_max", "width_mean")] == [[0], [50], [50]]
