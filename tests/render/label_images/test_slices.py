"""Pictures of slices: which voxel each pixel shows, in the aspect of the voxels, and which seeds are drawn."""

import numpy as np
import pytest

import vorotool
from vorotool import LimitError, UsageError
from vorotool.render.label_images.slices import SlicePicture
from vorotool.types.volumes.label_volume import LabelVolume
from vorotool.types.volumes.volume_seeds import VolumeSeeds
from vorotool.types.volumes.voxel_frame import VoxelFrame

FRAME = VoxelFrame(-3, 5, 2, 7, 6, 5)


def volume_of(seeds=None, frame=FRAME):
    labels = np.arange(1, frame.voxels + 1, dtype=np.uint16).reshape(frame.shape)
    return LabelVolume(labels, frame, seeds)


@pytest.mark.parametrize("units", [(1, 1, 1), (3, 1, 1), (1, 2, 5), (10, 13, 17), (1, 1, 40)])
def test_each_pixel_shows_the_voxel_that_its_center_is_in(units):
    volume, picture = volume_of(), SlicePicture(FRAME, units)
    sizes = [round(side * unit / min(units)) for side, unit in zip(FRAME.shape, units, strict=True)]
    assert picture.sizes == tuple(sizes)
    drawn = picture.image(volume).labels
    depth, height, width = FRAME.shape
    voxel = [
        np.floor((np.arange(size) + 0.5) / size * side).astype(int)
        for size, side in zip(sizes, FRAME.shape, strict=True)
    ]
    z, y, x = voxel
    labels = volume.labels
    np.testing.assert_array_equal(drawn[: sizes[1], : sizes[2]], labels[depth // 2][np.ix_(y, x)])
    np.testing.assert_array_equal(drawn[: sizes[1], -sizes[0] :], labels[:, :, width // 2].T[np.ix_(y, z)])
    np.testing.assert_array_equal(drawn[-sizes[0] :, : sizes[2]], labels[:, height // 2][np.ix_(z, x)])
    assert np.count_nonzero(drawn) == sizes[1] * sizes[2] + sizes[1] * sizes[0] + sizes[0] * sizes[2]


def test_one_slice_is_chosen_by_its_z():
    picture = SlicePicture(FRAME, chosen=4)
    np.testing.assert_array_equal(picture.image(volume_of()).labels, volume_of().labels[2])
    assert picture.shape == (6, 7)


@pytest.mark.parametrize(
    ("frame", "chosen", "words"),
    [
        (FRAME, 1, "slices 2"),
        (FRAME, 7, "slices 2"),
        (VoxelFrame(0, 0, 0, 2, 2, 1), 1, "slice 0"),
    ],
)
def test_no_other_slice_is_there(frame, chosen, words):
    with pytest.raises(UsageError, match=words):
        SlicePicture(frame, chosen=chosen)


def test_points_between_voxels_keep_their_places():
    seeds = VolumeSeeds(np.array([[-5, 12, 9]]), np.array([1]), scale=2)  # (-2.5, 6, 4.5), between slices 4 and 5
    assert len(SlicePicture(FRAME, chosen=4).image(volume_of(seeds)).seeds) == 0
    marks = SlicePicture(FRAME, (1, 2, 1), chosen=5).image(volume_of(seeds)).seeds
    assert (marks.x / 256, marks.y / 256) == (0.5, 2.5)


@pytest.mark.parametrize("chosen", [None, 3])
def test_objects_are_drawn_whole(chosen):
    mask = np.zeros((7, 8, 9), bool)
    mask[1:6, 1:6, 2:7] = True
    mask[3, 3, 4] = False  # a cavity
    seeds = vorotool.seeds_from_volume(mask)
    assert seeds.filled.any()
    volume = vorotool.tessellate(seeds)
    picture = SlicePicture(volume.frame, (2, 1, 1), chosen)
    marks = picture.image(volume).seeds
    drawn = np.zeros(picture.shape, bool)
    drawn[marks.y, marks.x] = True
    np.testing.assert_array_equal(drawn[:8, :9], mask[3])
    if chosen is None:
        np.testing.assert_array_equal(drawn[:8, -14:], np.repeat(mask[:, :, 4].T, 2, axis=1))
        np.testing.assert_array_equal(drawn[-14:, :9], np.repeat(mask[:, 4], 2, axis=0))
    assert marks.frame is not None


def test_pictures_are_limited():
    with pytest.raises(LimitError, match="209"):
        SlicePicture(FRAME).check(209)
    SlicePicture(FRAME).check(210)
