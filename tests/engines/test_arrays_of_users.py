"""Arrays of users: unaligned ones are taken, and ones that change meanwhile end no engine in a crash."""

from dataclasses import fields, replace

import numpy as np
import pytest

import vorotool
from support.few import few
from support.processes.ended import ended_python

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


MUTATED = """
import threading
import numpy as np
import vorotool
random = np.random.default_rng(5)
{made}
going = True
def change():
    while going:
        given[...] = {value}
thread = threading.Thread(target=change)
thread.start()
try:
    for _ in range(8):
        {work}
finally:
    going = False
    thread.join()
print("done")
"""
MANY_POINTS = {"made": "given = random.random((20000, 2))", "value": "random.random(given.shape)"}
MANY_LABELS = {
    "made": "given = random.integers(0, 3, (600, 600)).astype(np.uint8)",
    "value": "random.integers(0, 3, given.shape, dtype=np.uint8)",
}
SEEDS = {
    "made": "given = random.integers(0, 500, (2, 20000)); labels = np.arange(1, 20001, dtype=np.uint32)",
    "value": "random.integers(-9000, 9000, given.shape)",
}


@pytest.mark.parametrize(
    ("parts", "work"),
    few(
        [
            (MANY_POINTS, "vorotool.verify_triangulation(vorotool.delaunay(given))"),
            (MANY_LABELS, "vorotool.outlines(given, mode='labels')"),
            (SEEDS, "vorotool.tessellate(vorotool.SeedSet(given[0], given[1], labels), shape=(500, 500))"),
            (MANY_POINTS, "vorotool.alpha_complex(given)"),
            (MANY_POINTS, "vorotool.voronoi_cells(vorotool.delaunay(vorotool.PointSet(given)))"),
            (MANY_POINTS, "vorotool.tessellate(given * 200, shape=(200, 200))"),
            (MANY_POINTS, "vorotool.skeleton_exact(given[:200])"),
            (MANY_POINTS, "vorotool.planar_graph(given[:300])"),
            (MANY_LABELS, "vorotool.region_table(vorotool.LabelImage(given))"),
            (MANY_LABELS, "vorotool.seeds_from_raster(given, mode='components')"),
        ],
        3,
    ),
)
def test_an_engine_ends_whatever_becomes_of_its_input(parts, work):
    program = MUTATED.format(work=work, **parts)
    done = ended_python("-W", "ignore", "-X", "faulthandler", "-c", program)
    assert done.stdout == "done\n", done.stderr[-2000:]
