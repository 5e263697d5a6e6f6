"""Slabs of slices from the seeds that they need."""

import numpy as np
import pytest

from vorotool.engines.tessellation.tessellator import SeedBand
from vorotool.types.volumes.volume import VolumeSeeds, VoxelFrame

SEEDS = VolumeSeeds(np.array([[0, 0, 0], [4, 0, 9]]), np.array([1, 2]))
FRAME = VoxelFrame(0, 0, 0, 5, 1, 10)


@pytest.mark.parametrize(
    ("what", "dtype", "expected"),
    [
        ("labels", np.uint8, [1, 2, 2, 2, 2]),
        ("distance2", np.uint32, [25, 25, 20, 17, 16]),
        ("distance", np.float32, np.sqrt(np.float32([25, 25, 20, 17, 16]))),
    ],
)
def test_a_slice_is_that_of_the_whole(what, dtype, expected):
    assert SeedBand(SEEDS, FRAME, 5, 1, what, np.dtype(dtype)).rows()[0, 0].tolist() == list(expected)
