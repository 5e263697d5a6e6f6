"""Arrays that begin at any byte, as those of a message do: the engines take them, and make of them what they are.

What is wrong with reading such values where they are, the sanitized build reports (`make sanitize`).
"""

from dataclasses import fields, replace

import numpy as np
import pytest

import vorotool

RANDOM = np.random.default_rng(7)
POINTS = RANDOM.random((300, 2))
RING = [[0, 0], [7.5, 1], [9, 6.25], [4, 3], [1, 8]]
LABELS = RANDOM.integers(0, 4, (40, 50)).astype(np.uint32)


def unaligned(array):
    """The same values, one byte behind where they would be."""
    memory = bytearray(array.nbytes + 1)
    moved = np.frombuffer(memory, array.dtype, offset=1, count=array.size).reshape(array.shape)
    assert not moved.flags.aligned
    moved[...] = array
    return moved


def with_unaligned_fields(value):
    """A result all of whose arrays of wide values are unaligned."""
    arrays = {field.name: getattr(value, field.name) for field in fields(value) if field.init}
    wide = {name: array for name, array in arrays.items() if isinstance(array, np.ndarray) and array.itemsize > 1}
    assert wide
    return replace(value, **{name: unaligned(array) for name, array in wide.items()})


def same(made, expected):
    for field in fields(expected):
        if isinstance(getattr(expected, field.name), np.ndarray):
            np.testing.assert_array_equal(getattr(made, field.name), getattr(expected, field.name))


@pytest.mark.parametrize(
    ("function", "given"),
    [
        (vorotool.delaunay, POINTS),
        (vorotool.alpha_complex, POINTS),
        (lambda ring: vorotool.skeleton_exact([ring]), np.array(RING)),
        (lambda labels: vorotool.outlines(labels, mode="labels"), LABELS),
        (lambda xy: vorotool.tessellate(xy, shape=(90, 90)), np.floor(POINTS[:50] * 2560) / 32),
    ],
)
def test_arrays_that_users_give(function, given):
    same(function(unaligned(given)), function(given))


def test_seeds_and_what_is_made_of_them():
    places = RANDOM.choice(10000, 500, replace=False)
    seeds = vorotool.SeedSet(places % 100, places // 100, np.arange(1, 501, dtype=np.uint32))
    expected = vorotool.tessellate(seeds, shape=(100, 100))
    same(vorotool.tessellate(with_unaligned_fields(seeds), shape=(100, 100)), expected)


def test_regions_are_measured():
    labels = vorotool.LabelImage(LABELS)
    measured, expected = vorotool.region_table(with_unaligned_fields(labels)), vorotool.region_table(labels)
    assert {name: list(measured[name]) for name in measured} == {name: list(expected[name]) for name in expected}


def test_results_that_are_read_again():
    mesh = vorotool.delaunay(POINTS)
    vorotool.verify_triangulation(with_unaligned_fields(mesh))
    same(vorotool.voronoi_cells(with_unaligned_fields(mesh)), vorotool.voronoi_cells(mesh))
    skeleton = vorotool.skeleton_exact([RING])
    vorotool.verify_skeleton(with_unaligned_fields(skeleton))
    same(vorotool.prune(with_unaligned_fields(skeleton), angle=1.0), vorotool.prune(skeleton, angle=1.0))
