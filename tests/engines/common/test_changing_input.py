"""Arrays that another thread writes to while an engine reads them: it ends, and what it made is right for something."""

import pytest

from support.few import few
from support.processes.ended import ended_python

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
POINTS = {"made": "given = random.random((20000, 2))", "value": "random.random(given.shape)"}
LABELS = {
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
            (POINTS, "vorotool.verify_triangulation(vorotool.delaunay(given))"),
            (LABELS, "vorotool.outlines(given, mode='labels')"),
            (SEEDS, "vorotool.tessellate(vorotool.SeedSet(given[0], given[1], labels), shape=(500, 500))"),
            (POINTS, "vorotool.alpha_complex(given)"),
            (POINTS, "vorotool.voronoi_cells(vorotool.delaunay(vorotool.PointSet(given)))"),
            (POINTS, "vorotool.tessellate(given * 200, shape=(200, 200))"),
            (POINTS, "vorotool.skeleton_exact(given[:200])"),
            (POINTS, "vorotool.planar_graph(given[:300])"),
            (LABELS, "vorotool.region_table(vorotool.LabelImage(given))"),
            (LABELS, "vorotool.seeds_from_raster(given, mode='components')"),
        ],
        3,
    ),
)
def test_an_engine_ends_whatever_becomes_of_its_input(parts, work):
    program = MUTATED.format(work=work, **parts)
    done = ended_python("-W", "ignore", "-X", "faulthandler", "-c", program)
    assert done.stdout == "done\n", done.stderr[-2000:]
