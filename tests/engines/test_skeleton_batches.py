"""Skeletons of masks made in batches: the same arrays as of one diagram."""

import warnings
from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

import vorotool
from outline_oracle import random_labels
from vorotool.engines import skeleton_batches
from vorotool.engines.planar_graph import placed_vertices
from vorotool.engines.skeleton_batches import batch_starts, batched_skeleton
from vorotool.engines.skeleton_exact import shape_diagram, skeleton_of

ARRAYS = ("vertices", "radius", "arcs", "control", "sites", "polygon", "side", "branch", "length", "error_bound")


@pytest.fixture(autouse=True)
def small_batches(monkeypatch):
    monkeypatch.setattr(skeleton_batches, "BATCH", 60)


def differing(made, expected):
    wrong = [name for name in ARRAYS if getattr(made, name).tobytes() != getattr(expected, name).tobytes()]
    tables = made.site_table, expected.site_table
    columns = [field.name for field in fields(tables[0])]
    return wrong + [name for name in columns if not np.array_equal(*(getattr(table, name) for table in tables))]


def masks():
    for seed in range(6):
        random = np.random.default_rng(seed)
        yield random_labels(random, 40) > 0
        yield gaussian_filter(random.standard_normal((90, 70)), 2.0) > 0.02
        yield random.random((40, 50)) < 0.4
    nested = np.zeros((60, 60), dtype=bool)
    for k in range(0, 28, 4):
        nested[k : 60 - k, k : 60 - k] = True
        nested[k + 2 : 58 - k, k + 2 : 58 - k] = False
    yield np.tile(nested, (2, 3))


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("threads", [1, 2])
def test_all_arrays_are_those_of_one_diagram(connectivity, threads):
    split = 0
    for mask in masks():
        polygons = vorotool.outlines(mask, connectivity=connectivity)
        made = batched_skeleton(polygons, threads=threads)
        split += made is not None
        if made is not None:
            assert differing(made, skeleton_of(shape_diagram(polygons))) == []
    assert split > 5


def test_labels_that_touch_are_in_one_batch():
    tiles = np.pad(np.array([[1, 2], [3, 3]]).repeat(6, axis=0).repeat(6, axis=1), 2)
    image = np.concatenate([np.where(tiles, tiles + 3 * k, 0) for k in range(12)])
    polygons = vorotool.outlines(image, mode="labels")
    starts = batch_starts(polygons, placed_vertices(polygons).vertices)
    assert (starts % 3 == 0).all()
    made = batched_skeleton(polygons, threads=2)
    assert made is not None
    assert differing(made, skeleton_of(shape_diagram(polygons))) == []


@pytest.mark.parametrize("connectivity", [4, 8])
def test_batches_begin_where_they_may(connectivity):
    """By the definition: polygons before and after have no vertex in common, and the batch is large enough."""
    for seed in range(8):
        image = random_labels(np.random.default_rng(seed), 50)
        if not image.any():
            continue
        polygons = vorotool.outlines(image, mode="labels", connectivity=connectivity)
        corners = [{tuple(v) for ring in polygons.rings_of(k) for v in ring.tolist()} for k in range(len(polygons))]
        sizes = [sum(map(len, polygons.rings_of(k))) for k in range(len(polygons))]
        expected = [0]
        for k in range(1, len(polygons) + 1):
            is_free = set().union(*corners[:k]).isdisjoint(set().union(*corners[k:]))
            if is_free and (k == len(polygons) or sum(sizes[expected[-1] : k]) >= skeleton_batches.BATCH):
                expected.append(k)
        assert batch_starts(polygons, placed_vertices(polygons).vertices).tolist() == expected


def test_what_may_meet_is_not_split():
    polygons = vorotool.outlines(np.tile(np.pad(np.ones((3, 3), dtype=bool), 2), (9, 9)))
    assert batched_skeleton(polygons, threads=2) is not None
    assert batched_skeleton(replace(polygons, connectivity=None), threads=2) is None
    spike = polygons.xy.copy()
    spike[1] = spike[0] + [0.5, 0]
    spike[2] = spike[0] + [0.25, 0]
    broken = replace(polygons, xy=spike)
    assert batched_skeleton(broken, threads=2) is None
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        vorotool.skeleton_exact(broken)
    assert len(caught) == 1


def test_what_progress_raises_stops_the_work():
    polygons = vorotool.outlines(np.tile(np.pad(np.ones((3, 3), dtype=bool), 2), (9, 9)))

    def stop(_):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        batched_skeleton(polygons, threads=2, progress=stop)
