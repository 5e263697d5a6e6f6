"""Regions that are measured slab by slab: their tables are those of the volume held in memory, whatever the slabs."""

from fractions import Fraction

import numpy as np
import pytest

from vorotool.engines.label_images.measured_regions import regions_of_parts
from vorotool.engines.label_images.regions import neighbor_table, region_table
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.types.pixels import pixel_sides
from vorotool.types.volumes.volume import LabelVolume, VolumeSeeds, VoxelFrame

FRAME = VoxelFrame(-4, 2, 7, 13, 9, 16)


def sweep_of(random, *, scale, spacing, max_distance):
    extent = np.array([FRAME.width, FRAME.height, FRAME.depth]) * scale
    corner = np.array([FRAME.x, FRAME.y, FRAME.z]) * scale
    places = corner + random.integers(-extent // 4, extent + extent // 4, (12, 3))  # some are outside
    labels = random.choice([1, 2, 3, 5, 300, 70000], 12)
    seeds = VolumeSeeds(places, labels, scale=scale)
    return Tessellator(seeds, FRAME, sides=pixel_sides(spacing, 3), max_distance=max_distance)


@pytest.mark.parametrize(("scale", "spacing"), [(1, (1, 1, 1)), (4, (1, 1, 1)), (2, (Fraction(5, 2), 1, 3))])
@pytest.mark.parametrize("max_distance", [None, 4])
def test_tables_do_not_depend_on_slabs(scale, spacing, max_distance):
    random = np.random.default_rng(scale)
    for _ in range(5):
        sweep = sweep_of(random, scale=scale, spacing=spacing, max_distance=max_distance)
        volume = LabelVolume(sweep.labels(), FRAME, sweep.seeds, sweep.sides)
        cuts = np.unique(random.integers(1, FRAME.depth, 4))
        parts = zip(np.split(volume.labels, cuts), np.split(sweep.squared_distances(), cuts), strict=True)
        regions = regions_of_parts(parts, FRAME, sweep.sides, sweep.seeds)
        assert regions.table() == region_table(volume, distance2=sweep.squared_distances())
        assert regions.neighbors() == neighbor_table(volume)


def test_without_distances_there_is_no_largest():
    sweep = sweep_of(np.random.default_rng(1), scale=1, spacing=(1, 1, 1), max_distance=None)
    regions = regions_of_parts([(sweep.labels(), None)], FRAME, sweep.sides, sweep.seeds)
    volume = LabelVolume(sweep.labels(), FRAME, sweep.seeds, sweep.sides)
    assert regions.largest_squares is None
    assert regions.table() == region_table(volume)
