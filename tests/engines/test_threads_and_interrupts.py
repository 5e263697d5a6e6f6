"""Results are the same for any number of threads, and what a callback for progress raises stops the work."""

import warnings
from pathlib import Path

import numpy as np
import pytest
import shapely

import vorotool
from support.families.families import distinct_pixels
from support.families.point_families import SLOW_LAST, draw
from support.families.segment_families import draw as draw_graph
from support.few import few
from vorotool.engines.features import batches
from vorotool.engines.label_images.regions import measure_regions, voronoi_diagram
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi
from vorotool.engines.skeleton.diagrams import feature_skeleton
from vorotool.engines.tessellation.tessellate import verify_labels
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.numeric.checks import is_equal
from vorotool.types.images import LabelImage
from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.volumes.volume import LabelVolume, VolumeSeeds, VoxelFrame

RANDOM = np.random.default_rng
LAKE = vorotool.read(Path(__file__).parents[2] / "data" / "great-lakes.geojson", properties=False)
WALK = RANDOM(1).normal(size=(70_000, 2)).cumsum(axis=0)
LINES = [[shapely.LineString(RANDOM(seed).random((5000, 2)).cumsum(axis=0))] for seed in (3, 4)]
HOLES = shapely.box(0, 0, 1000, 700) - shapely.MultiPoint(RANDOM(1).uniform(60, 640, (5, 2))).buffer(45, quad_segs=2)
NOISE = RANDOM(1).integers(1, 60_000, (1500, 2000)).astype(np.uint16)


def blobs(side):
    from scipy.ndimage import gaussian_filter

    return gaussian_filter(RANDOM(0).random((side, side)), 4.0) > 0.5


MANY = {  # enough of everything to be shared
    **{
        f"triangles of {name}": (lambda threads, name=name: vorotool.delaunay(draw(name, 2100, 4), threads=threads))
        for name in SLOW_LAST
    },
    **{
        f"alpha complex of {name}": lambda threads, name=name: vorotool.alpha_complex(
            draw(name, 100 if name == "any_double" else 3000, 4), threads=threads
        )
        for name in SLOW_LAST
    },
    **{
        f"cells of {name}": lambda threads, name=name: vorotool.voronoi_cells(
            vorotool.delaunay(draw(name, 3000, 4)), threads=threads
        )
        for name in SLOW_LAST
    },
}
ONE = {
    **{
        kind: lambda threads, kind=kind: vorotool.proximity_graph(RANDOM(1).random((30_000, 2)), kind, threads=threads)
        for kind in ("gabriel", "relative", "mst")
    },
    "planar graph": lambda threads: vorotool.planar_graph(WALK[::700], threads=threads),
    "hausdorff": lambda threads: vorotool.hausdorff(*LINES, threads=threads),
    "hausdorff of boundaries": lambda threads: vorotool.hausdorff(*LINES, boundary=True, threads=threads),
    "distance": lambda threads: vorotool.distance(*LINES, threads=threads),
    "thickness": lambda threads: vorotool.local_thickness(blobs(400), threads=threads),
    "approximate": lambda threads: vorotool.skeleton_approx(HOLES, step=7.0, threads=threads),
    "skeleton": lambda threads: vorotool.skeleton_exact(LAKE.xy[: LAKE.ring_starts[1]], side="both", threads=threads),
    "diagram": lambda threads: voronoi_diagram(NOISE % 6, threads=threads),
    **{
        f"segments of {name}": lambda threads, name=name: (
            vars(segment_voronoi(*draw_graph(name, 20_000, 2), threads=threads)) | {"counts": "of work, not compared"}
        )
        for name in ("star_smooth", "comb")
    },
}


@pytest.mark.parametrize("name", [*few(MANY, 6), *ONE])
@pytest.mark.filterwarnings("ignore::vorotool.VorotoolWarning")
def test_threads_change_nothing(name):
    make = (MANY | ONE)[name]
    one = make(1)
    assert all(is_equal(make(threads), one) for threads in (2, 5))


POINTS = RANDOM(0).random((300_000, 2))
MANY_SEEDS = np.unique(RANDOM(0).integers(0, 20_000**2, 100_000))
CALLS = {
    "delaunay": lambda stop: vorotool.delaunay(POINTS, threads=1, progress=stop),
    "cells": lambda stop: vorotool.voronoi_cells(vorotool.delaunay(POINTS), threads=1, progress=stop),
    "alpha": lambda stop: vorotool.alpha_complex(vorotool.delaunay(POINTS), threads=1, progress=stop),
    "planar graph": lambda stop: vorotool.planar_graph(np.tile(WALK[:20_000], (20, 1)), progress=stop),
    "segments": lambda stop: segment_voronoi(*draw_graph("star_rough", 30_000, 1), threads=1, progress=stop),
    "repair": lambda stop: vorotool.repair_digital(
        distinct_pixels(6, 2048, 200_000), shape=(2048, 2048), progress=stop
    ),
    "regions": lambda stop: measure_regions(LabelImage(NOISE), threads=2, progress=stop),
    "regions of a volume": lambda stop: measure_regions(
        LabelVolume(NOISE.reshape(40, 75, 1000)), threads=2, progress=stop
    ),
    "features": lambda stop: feature_skeleton(
        vorotool.outlines(np.tile(np.pad(np.ones((3, 3), dtype=bool), 2), (9, 9))), threads=2, progress=stop
    ),
    "tessellation": lambda stop: Tessellator(
        SeedSet(*np.divmod(MANY_SEEDS, 20_000), np.arange(1, len(MANY_SEEDS) + 1)),
        Frame(0, 0, 20_000, 20_000),
        threads=1,
        progress=stop,
    ).labels(0, 8000),
    "check of labels": lambda stop: verify_labels(
        NOISE.reshape(40, 75, 1000) % 900 + 1,
        VolumeSeeds(RANDOM(2).integers(0, 75, (900, 3)), np.arange(1, 901)),
        VoxelFrame(0, 0, 0, 1000, 75, 40),
        threads=2,
        progress=stop,
    ),
}


@pytest.mark.parametrize("name", CALLS)
def test_what_progress_raises_stops_the_work(name, monkeypatch):
    monkeypatch.setattr(batches, "BATCH", 60)
    seen = []

    def stop(fraction):
        seen.append(fraction)
        raise KeyboardInterrupt

    with warnings.catch_warnings(action="ignore"), pytest.raises(KeyboardInterrupt):
        CALLS[name](stop)
    assert len(seen) == 1
    assert 0 <= seen[0] <= 1
