"""Pictures of label images and of slices: outlines, PNG and SVG."""

import re
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import vorotool
from support.readers.written import bytes_of
from support.refusals import refused
from vorotool import LimitError, UsageError
from vorotool.render.canvas.styles import CELLS, PictureStyle, picture_palette
from vorotool.render.label_images.picture import LabelPicture, index_bands
from vorotool.render.label_images.slices import SlicePicture
from vorotool.render.label_images.svg import crack_loops, disc_radius
from vorotool.types.images import LabelImage
from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.volumes.volume import LabelVolume, VolumeSeeds, VoxelFrame


def filled(shape: tuple[int, int], loops: list[list[tuple[int, int]]]) -> np.ndarray:
    """Even-odd filling: each vertical step turns all pixels to its right."""
    mask = np.zeros(shape, bool)
    for loop in loops:
        assert len(loop) % 2 == 0
        for (x0, y0), (x1, y1) in zip(loop, loop[1:] + loop[:1], strict=True):
            assert (x0 == x1) != (y0 == y1)
            if x0 == x1:
                mask[min(y0, y1) : max(y0, y1), x0:] ^= True
    return mask


@given(hnp.arrays(np.uint16, hnp.array_shapes(min_dims=2, max_dims=2, max_side=9), elements=st.integers(0, 3)))
def test_filled_outlines_are_the_labels(labels: np.ndarray) -> None:
    found = dict(crack_loops(labels))
    assert list(found) == sorted(set(labels.ravel().tolist()) - {0})
    for label, loops in found.items():
        np.testing.assert_array_equal(filled(labels.shape, loops), labels == label)
        for loop in loops:
            assert loop[0][1] == loop[1][1]


PALETTE = picture_palette(4)
RNG = np.random.default_rng(1)
LAYERS = ["cells", "diagram", "seeds"]
LABELS = RNG.integers(0, 6, (40, 31)).astype(np.uint16)
DIAGRAM = RNG.integers(0, 5, LABELS.shape) == 0
COLORS = np.array([0, 4, 3, 2, 1, 4])
SEEDS = SeedSet(RNG.integers(-2, 34, 9) * 4 + 1, RNG.integers(-2, 43, 9) * 4 + 3, np.arange(1, 10), scale=4)


def picture(
    *,
    diagram: np.ndarray | None = DIAGRAM,
    seeds: SeedSet | None = SEEDS,
    layers: Sequence[str] = LAYERS,
    **framed: Frame,
) -> np.ndarray:
    image = LabelImage(LABELS, seeds=seeds, **framed)
    drawn = LabelPicture(image, (np.arange(1, 6), COLORS[1:]), layers, PictureStyle())
    marks = SimpleNamespace(palette=PALETTE, diagram=diagram, outlines=None, names=None)
    return np.concatenate(list(index_bands(drawn, marks, layers, [])))


def discs(frame: Frame) -> np.ndarray:
    """Brute force: pixel centers within the radius of a seed, and the pixel that a seed lies in."""
    y, x = np.mgrid[: LABELS.shape[0], : LABELS.shape[1]]
    hit = np.zeros(LABELS.shape, bool)
    for sx, sy in zip(SEEDS.x / 4 - frame.x, SEEDS.y / 4 - frame.y, strict=True):
        hit |= (x - sx) ** 2 + (y - sy) ** 2 <= disc_radius(LABELS.shape, len(SEEDS)) ** 2
        hit |= (x == np.floor(sx + 0.5)) & (y == np.floor(sy + 0.5))
    return hit


@pytest.mark.parametrize("framed", [{}, {"frame": Frame(-3, 5, 31, 40)}])
def test_layers_lie_on_each_other(framed: dict[str, Frame]) -> None:
    expected = COLORS[LABELS]
    expected[DIAGRAM] = PALETTE.line
    expected[discs(framed.get("frame", Frame(0, 0, 31, 40)))] = PALETTE.seed
    np.testing.assert_array_equal(picture(**framed), expected)


@pytest.mark.parametrize("rows", [1, 17, 39])
def test_bands_do_not_matter(rows: int, monkeypatch: pytest.MonkeyPatch) -> None:
    expected = picture()
    monkeypatch.setattr("vorotool.render.label_images.picture.BAND_ROWS", rows)
    np.testing.assert_array_equal(picture(), expected)


def test_layers_are_selectable() -> None:
    np.testing.assert_array_equal(picture(layers=["cells"]), COLORS[LABELS])
    np.testing.assert_array_equal(picture(layers=["diagram"]), DIAGRAM * PALETTE.line)
    np.testing.assert_array_equal(picture(layers=["seeds"]), discs(Frame(0, 0, 31, 40)) * PALETTE.seed)
    np.testing.assert_array_equal(picture(diagram=None, seeds=None), COLORS[LABELS])


@pytest.mark.parametrize(
    ("shape", "count", "radius"), [((10, 10), 1, 1.0), ((8192, 8192), 53, 32.768), ((64, 64), 4096, 0.5)]
)
def test_disc_radius(shape: tuple[int, int], count: int, radius: float) -> None:
    assert disc_radius(shape, count) == pytest.approx(radius)


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
    pairs = zip(sizes, FRAME.shape, strict=True)
    z, y, x = (np.floor((np.arange(size) + 0.5) / size * side).astype(int) for size, side in pairs)
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
    [(FRAME, 1, "slices 2"), (FRAME, 7, "slices 2"), (VoxelFrame(0, 0, 0, 2, 2, 1), 1, "slice 0")],
)
def test_no_other_slice_is_there(frame, chosen, words):
    refused(UsageError, words, SlicePicture, frame, chosen=chosen)


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
    refused(LimitError, "209", SlicePicture(FRAME).check, 209)
    SlicePicture(FRAME).check(210)


NS = "{http://www.w3.org/2000/svg}"
FEW_LABELS = np.array([[1, 1, 2, 2], [1, 3, 3, 2], [0, 3, 3, 12]])
FEW_COLORS = np.array([0, 1, 2, 3] + [4] * 9)
FEW_SEEDS = SeedSet(np.array([10, 13, 12, 99]), np.array([20, 20, 22, 99]), np.array([1, 2, 3, 4]))
IMAGE = LabelImage(FEW_LABELS, Frame(10, 20, 4, 3), FEW_SEEDS)


def drawn(image: LabelImage = IMAGE, **options: object) -> bytes:
    labels = np.unique(image.labels[image.labels > 0])
    picture = LabelPicture(image, (labels, FEW_COLORS[labels]), ("cells", "labels", "seeds"), PictureStyle(), **options)
    return bytes_of(picture.write, "svg")


def groups(svg: bytes) -> dict[str, ET.Element]:
    return {group.attrib["id"]: group for group in ET.fromstring(svg).iter(f"{NS}g")}


def test_page_fits_the_data_and_2_percent() -> None:
    root = ET.fromstring(drawn())
    assert root.attrib["viewBox"] == "0 0 1000 760"  # 4.16 x 3.16 pixels
    assert ET.fromstring(drawn(width=500)).attrib["viewBox"] == "0 0 500 380"


def test_cells_are_paths_that_fill_the_labels() -> None:
    cells = groups(drawn())["cells"]
    assert [path.attrib["id"] for path in cells] == ["cell-1", "cell-2", "cell-3", "cell-12"]
    assert [path.attrib["fill"] for path in cells] == [CELLS[0], CELLS[1], CELLS[2], CELLS[3]]
    assert all(path.attrib["vector-effect"] == "non-scaling-stroke" for path in cells)
    scale = 1000 / 4.16
    for path in cells:
        mask, (x, y) = np.zeros(FEW_LABELS.shape, bool), (0.0, 0.0)
        for command, text in re.findall(r"([MHV])([\d. ]+)", path.attrib["d"]):
            numbers = [round(float(word) / scale - 0.08) for word in text.split()]
            if command == "M":
                x, y = numbers
                start = y
            elif command == "H":
                x = numbers[0]
            else:
                mask[min(y, numbers[0]) : max(y, numbers[0]), x:] ^= True
                y = numbers[0]
        mask[min(y, start) : max(y, start), x:] ^= True
        np.testing.assert_array_equal(mask, int(path.attrib["id"][5:]) == FEW_LABELS)


def test_many_pixels_are_refused() -> None:
    refused(LimitError, r"2000", drawn, LabelImage(np.ones((501, 2000), np.uint8)))
