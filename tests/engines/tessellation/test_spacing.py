"""Tessellations of rectangular pixels, against all distances in exact integers and against SciPy."""

from fractions import Fraction

import numpy as np
import pytest
import tifffile
import xarray
from scipy import ndimage

import vorotool
from support.few import few
from support.oracles.oracles import nearest_seeds
from vorotool import VorotoolWarning
from vorotool.engines import masks
from vorotool.engines.label_images.regions import measure_regions
from vorotool.engines.tessellation.seeding import seeds_from_raster
from vorotool.engines.tessellation.tessellate import propagate, verify_labels
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import UsageError, VerificationError
from vorotool.types.images import LabelImage
from vorotool.types.pixels import SQUARE, Frame, PixelSides, pixel_sides
from vorotool.types.points.seed_set import SeedSet

SIDES = [PixelSides((2, 1)), PixelSides((60, 13), Fraction(1, 40)), PixelSides((5, 7)), PixelSides((1000, 1))]


def brute(seeds, frame, sides):
    """Labels and squared distances: of the nearest seeds the smallest label."""
    window = frame.x, frame.y, frame.width, frame.height
    first, _, least = nearest_seeds(
        np.stack([seeds.x, seeds.y], axis=1), seeds.labels, window, seeds.scale, sides.units
    )
    return first, least


def seeds_of(random, count, frame, scale, reach):
    low = np.array([frame.x, frame.y]) * scale - reach
    high = np.array([frame.x + frame.width, frame.y + frame.height]) * scale + reach
    x, y = random.integers(low, high, (count, 2)).T
    return SeedSet(x, y, random.integers(1, count + 1, count).astype(np.uint32), scale=scale)


@pytest.mark.parametrize("sides", SIDES)
@pytest.mark.parametrize("scale", [1, 4, 256])
@pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")
def test_the_checker_knows_sides(sides, scale):
    random, frame = np.random.default_rng([scale, sides.x]), Frame(-3, 5, 31, 23)
    seeds = seeds_of(random, 30, frame, scale, 9)
    labels, least = brute(seeds, frame, sides)
    sweep = Tessellator(seeds, frame, sides=sides)
    assert np.array_equal(sweep.labels(), labels)
    assert np.array_equal(sweep.squared_distances(), least)
    verify_labels(labels, seeds, frame, sides=sides)
    with pytest.raises(VerificationError):
        verify_labels(np.where(labels == labels.max(), labels.min(), labels), seeds, frame, sides=sides)


def test_large_objects_need_their_outer_pixels_only():
    image = np.zeros((24, 30), np.uint16)
    image[3:18, 3:18], image[6:23, 19:29] = 1, 2
    sides = (0.2, 1.0)
    grown = masks.expand_labels(image, float("inf"), spacing=sides)
    y, x = np.nonzero(image)
    labels, _ = brute(SeedSet(x, y, image[y, x]), Frame(0, 0, 30, 24), pixel_sides(sides))
    assert np.array_equal(grown, labels)


@pytest.mark.parametrize("spacing", [(1.5, 0.325), (1, 2), (0.1, 0.3), (Fraction(1, 3), Fraction(1, 7)), (30, 25)])
def test_distances_are_those_of_scipy(spacing):
    mask = np.random.default_rng(7).random((60, 70)) > 0.02
    ours, indices = masks.distance_transform(mask, spacing=spacing, return_indices=True)
    sampling = [float(side) for side in spacing]
    theirs = ndimage.distance_transform_edt(mask, sampling=sampling)
    np.testing.assert_allclose(ours, theirs, rtol=1e-14, atol=1e-12)
    y, x = np.indices(mask.shape)
    away = np.hypot((indices[0] - y) * sampling[0], (indices[1] - x) * sampling[1])
    np.testing.assert_allclose(away, ours, rtol=1e-14, atol=1e-12)
    if all(side == int(side) for side in spacing):
        assert np.array_equal(ours, theirs)  # whole numbers below 2^53: the last bit too


def test_a_float_is_the_decimal_that_it_is_written_as():
    labels = np.array([[1, 0, 0, 0, 0]])
    assert masks.expand_labels(labels, 0.3, spacing=0.1).tolist() == [[1, 1, 1, 1, 0]]
    assert masks.expand_labels(labels, 0.3, spacing=(5, 0.1)).tolist() == [[1, 1, 1, 1, 0]]


def test_sides_without_a_coarse_step_are_refused():
    with pytest.raises(UsageError, match="round the sides to fewer digits, or give them as fractions"):
        pixel_sides((0.3333333333333333, 1))
    assert pixel_sides((Fraction(1, 3), 1)) == PixelSides((1, 3), Fraction(1, 3))


# ---- Results of tessellations with a spacing: tables, borders, shapes and checks in its unit, against brute force ----
SPACINGS = [(1.5, 0.325), (Fraction(1, 3), 1), (2, 3), 0.1]
SIZE = (17, 23)


def points_of(seed, count=9):
    x, y = np.unique(np.random.default_rng(seed).integers(0, 17, (count, 2)), axis=0).T
    return np.stack([x, y], axis=1)


def image_of(seed, spacing, **options):
    return vorotool.tessellate(points_of(seed), shape=SIZE, spacing=spacing, **options)


def sides_between(labels):
    """(k, 2) labels left and right of vertical pixel sides, and above and below horizontal ones; -1 beyond."""
    padded = np.pad(labels.astype(np.int64), 1, constant_values=-1)
    vertical = np.stack([padded[1:-1, :-1].ravel(), padded[1:-1, 1:].ravel()], axis=1)
    horizontal = np.stack([padded[:-1, 1:-1].ravel(), padded[1:, 1:-1].ravel()], axis=1)
    return vertical, horizontal


@pytest.mark.parametrize("spacing", SPACINGS)
@pytest.mark.parametrize("seed", few(range(3), 1))
def test_tables_are_in_the_unit_of_the_spacing(seed, spacing):
    image = image_of(seed, spacing)
    height, width = map(float, pixel_sides(spacing).lengths)
    squares = Tessellator(image.seeds, image.frame, sides=image.sides).squared_distances()
    table = vorotool.region_table(image, distance2=squares)
    points = points_of(seed) * (width, height)
    vertical, horizontal = sides_between(image.labels)
    for row, label in enumerate(table["label"]):
        mask = image.labels == label
        y, x = np.nonzero(mask)
        apart = [pairs[(pairs == label).sum(axis=1) == 1] for pairs in (vertical, horizontal)]
        others = np.hypot(*(np.delete(points, row, axis=0) - points[row]).T)
        own = np.hypot((x * width - points[row, 0]), (y * height - points[row, 1]))
        expected = {
            "x": points[row, 0],
            "y": points[row, 1],
            "area": mask.sum() * width * height,
            "perimeter": len(apart[0]) * height + len(apart[1]) * width,
            "nearest_distance": others.min(),
            "max_distance": own.max(),
            "bbox_x": x.min() * width,
            "bbox_y": y.min() * height,
            "bbox_w": (np.ptp(x) + 1) * width,
            "bbox_h": (np.ptp(y) + 1) * height,
        }
        for name, value in expected.items():
            assert table[name][row] == pytest.approx(value, rel=1e-12, abs=1e-12), name


@pytest.mark.parametrize("spacing", SPACINGS)
def test_borders_of_neighbors_count_both_kinds_of_sides(spacing):
    image = image_of(5, spacing)
    height, width = map(float, pixel_sides(spacing).lengths)
    vertical, horizontal = sides_between(image.labels)
    table, measures = vorotool.neighbor_table(image), measure_regions(image)
    assert len(table["label_a"])
    for row, (a, b) in enumerate(zip(table["label_a"], table["label_b"], strict=True)):
        counts = [(np.sort(pairs, axis=1) == (a, b)).all(axis=1).sum() for pairs in (vertical, horizontal)]
        assert table["border_length"][row] == pytest.approx(counts[0] * height + counts[1] * width)
        assert measures.border_faces[row].tolist() == counts
        step = (image.seeds.sites[a - 1] - image.seeds.sites[b - 1]) * (width, height)
        assert table["centroid_distance"][row] == pytest.approx(np.hypot(*step))


def test_a_label_image_brings_its_spacing_along():
    image = image_of(1, (1, 3))
    again = vorotool.tessellate(image)
    assert again.sides == image.sides == PixelSides((1, 3))
    assert vorotool.tessellate(image, spacing=1).sides == SQUARE
    assert image.flipped().sides == image.sides
    assert repr(image) == "LabelImage: 23 x 17, 9 labels, uint16, spacing (1, 3)"
    assert image != LabelImage(image.labels, image.frame, image.seeds)


def test_pictures_show_pixels_in_their_aspect(tmp_path):
    image = image_of(6, (0.5, 0.25))
    vorotool.write(image, tmp_path / "a.svg", width=460, scale_bar=True)
    text = (tmp_path / "a.svg").read_text()
    assert 'width="460" height="668"' in text  # 23 columns of 1, 17 rows of 2, and a margin
    assert ">1<" in text  # a quarter of the page is 5.75 / 4 units long
    from matplotlib.figure import Figure

    axes = image.plot(Figure().add_subplot())
    assert axes.images[0].get_extent() == [-0.125, 5.625, 8.25, -0.25]


def test_the_paper_has_square_pixels():
    with pytest.raises(UsageError, match="spacing needs method='exact'"):
        image_of(0, (1, 2), method="propagation")
    seeds = seeds_from_raster(np.eye(4, dtype=bool), mode="pixels")
    assert np.array_equal(vorotool.tessellate(seeds, spacing=1, method="propagation").labels, propagate(seeds).labels)


# ---- Values that carry a size: warned of once, measured in with ``spacing="auto"``, in the plane and in space ----
LABELS = np.zeros((6, 8), np.uint8)
LABELS[1, 2], LABELS[4, 6] = 1, 2
SOLID = np.stack([LABELS, np.zeros_like(LABELS), LABELS[::-1]])


def raster(tmp_path):
    sizes = {"PhysicalSizeX": 0.25, "PhysicalSizeY": 0.5, "PhysicalSizeXUnit": "µm", "PhysicalSizeYUnit": "µm"}
    tifffile.imwrite(tmp_path / "in.tif", LABELS, ome=True, metadata={"axes": "YX", **sizes})
    return vorotool.read(tmp_path / "in.tif")


def plane(_=None):
    coords = {
        "y": ("y", 0.5 * np.arange(6), {"units": "um"}),
        "x": ("x", 0.25 * np.arange(8), {"units": "um"}),
    }
    return xarray.DataArray(LABELS, dims=("y", "x"), coords=coords)


def solid(_=None):
    coords = {
        "z": ("z", 2000 * np.arange(3), {"units": "nm"}),
        "y": ("y", 0.5 * np.arange(6), {"units": "um"}),
        "x": ("x", 0.25 * np.arange(8), {"units": "um"}),
    }
    return xarray.DataArray(SOLID, dims=("z", "y", "x"), coords=coords)


STATED = {raster: (0.5, 0.25), plane: (0.5, 0.25), solid: (2, 0.5, 0.25)}
FUNCTIONS = {
    "tessellate": lambda value, **more: vorotool.tessellate(value, **more).labels,
    "expand_labels": lambda value, **more: masks.expand_labels(value, 1.1, **more),
    "distance_transform": lambda value, **more: masks.distance_transform(value == 0, **more),
    "local_thickness": vorotool.local_thickness,
}


NEITHER = {("local_thickness", solid), ("distance_transform", raster)}
"""The one is of the plane, the other compares a Raster with 0."""
CASES = [
    pytest.param(name, make, id=f"{name} {make.__name__}")
    for name in FUNCTIONS
    for make in STATED
    if (name, make) not in NEITHER
]


@pytest.mark.parametrize(("name", "make"), CASES)
def test_auto_is_what_would_be_typed(tmp_path, name, make):
    value, call = make(tmp_path), FUNCTIONS[name]
    auto, typed, plain = (call(value, spacing=spacing) for spacing in ("auto", STATED[make], 1))
    assert np.array_equal(auto, typed)
    assert not np.array_equal(auto, plain)
    with pytest.warns(VorotoolWarning, match=r"spacing='auto'") as told:
        assert np.array_equal(call(value), plain)
    assert len(told) == 1
    assert "0.25 x 0.5" in str(told[0].message)


@pytest.mark.parametrize("value", [LABELS, SOLID])
def test_auto_needs_a_size(value):
    with pytest.raises(UsageError, match=r"spacing='auto' needs an image that states the size"):
        vorotool.tessellate(value, spacing="auto")
    with pytest.raises(UsageError, match=r"invalid spacing 'um'"):
        vorotool.tessellate(value, spacing="um")
