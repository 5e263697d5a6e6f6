"""Results of tessellations with a spacing: tables, borders, shapes and checks in its unit, against brute force."""

from fractions import Fraction

import numpy as np
import pytest

import vorotool
from support.few import few
from vorotool.engines.label_images.regions import measure_regions
from vorotool.engines.tessellation.seeding import seeds_from_raster
from vorotool.engines.tessellation.tessellate import propagate
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import UsageError
from vorotool.types.images import LabelImage
from vorotool.types.pixels import SQUARE, PixelSides, pixel_sides

SPACINGS = [(1.5, 0.325), (Fraction(1, 3), 1), (2, 3), 0.1]
SHAPE = (17, 23)


def points_of(seed, count=9):
    x, y = np.unique(np.random.default_rng(seed).integers(0, 17, (count, 2)), axis=0).T
    return np.stack([x, y], axis=1)


def image_of(seed, spacing, **options):
    return vorotool.tessellate(points_of(seed), shape=SHAPE, spacing=spacing, **options)


def sides_between(labels):
    """(k, 2) labels left and right of vertical pixel sides, and above and below horizontal ones; -1 beyond."""
    padded = np.pad(labels.astype(np.int64), 1, constant_values=-1)
    vertical = np.stack([padded[1:-1, :-1].ravel(), padded[1:-1, 1:].ravel()], axis=1)
    horizontal = np.stack([padded[:-1, 1:-1].ravel(), padded[1:, 1:-1].ravel()], axis=1)
    return vertical, horizontal


@pytest.mark.parametrize("spacing", SPACINGS)
@pytest.mark.parametrize("seed", few(range(3), 1))
def test_labels_are_those_of_distances_in_fractions(seed, spacing):
    points, image = points_of(seed), image_of(seed, spacing)
    height, width = pixel_sides(spacing).lengths
    for row, column in np.ndindex(SHAPE):
        squares = [((column - int(x)) * width) ** 2 + ((row - int(y)) * height) ** 2 for x, y in points]
        assert image.labels[row, column] == squares.index(min(squares)) + 1
    vorotool.verify_tessellation(image)


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


@pytest.mark.parametrize("threads", [1, 2])
def test_vertical_sides_are_counted_over_bands(threads):
    labels = np.random.default_rng(3).integers(0, 4, (1500, 300)).astype(np.uint8)
    measures = measure_regions(LabelImage(labels), threads=threads)
    vertical, horizontal = sides_between(labels)
    for row, label in enumerate(measures.labels.tolist()):
        counts = [((pairs == label).sum(axis=1) == 1).sum() for pairs in (vertical, horizontal)]
        assert measures.faces[row, 0] == counts[0]
        assert measures.faces[row].sum() == sum(counts)
    for row, (a, b) in enumerate(measures.labels[measures.borders].tolist()):
        counts = [(np.sort(pairs, axis=1) == (a, b)).all(axis=1).sum() for pairs in (vertical, horizontal)]
        assert measures.border_faces[row].tolist() == counts


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
