"""Skeletons of masks: their topology against scikit-image's, the checker, and corners that pixels hang together at."""

import string
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image, ImageDraw, ImageFont
from scipy.ndimage import gaussian_filter
from skimage.measure import label
from skimage.morphology import medial_axis, skeletonize

import vorotool
from support.oracles.outline_oracle import random_labels
from vorotool.engines.pruning.pruning import default_pruning_for_masks
from vorotool.errors import VerificationError
from vorotool.numeric.arrays import connected_roots

SIDE, ACROSS = 64, 20
COUNT = 80


def letter(random):
    canvas = Image.new("1", (SIDE - 2, SIDE - 2))
    text = "".join(random.choice(list(string.ascii_letters + string.digits), 2))
    ImageDraw.Draw(canvas).text((2, 2), text, fill=1, font=ImageFont.load_default(int(random.integers(12, 44))))
    return np.asarray(canvas)


def blob(random):
    field = gaussian_filter(random.standard_normal((SIDE - 2, SIDE - 2)), float(random.choice([1, 2, 4])))
    return field > field.std() * random.choice([-0.3, 0.2, 0.8])


def noise(random):
    return random.random((SIDE - 2, SIDE - 2)) < random.choice([0.1, 0.3, 0.5, 0.7])


def strokes(random):
    canvas = Image.new("1", (SIDE - 2, SIDE - 2))
    for _ in range(6):
        ends = random.integers(0, SIDE - 2, 4).tolist()
        ImageDraw.Draw(canvas).line(ends, fill=1, width=int(random.integers(1, 6)))
    return np.asarray(canvas)


def tiled(masks):
    """One image of many masks, apart from each other."""
    padded = np.pad(np.stack(masks), ((0, 0), (1, 1), (1, 1)))
    return padded.reshape(-1, ACROSS, SIDE, SIDE).swapaxes(1, 2).reshape(-1, ACROSS * SIDE)


MASKS = tiled([(letter, blob, noise, strokes)[k % 4](np.random.default_rng(k)) for k in range(COUNT)])
TILE = np.arange(MASKS.shape[0])[:, None] // SIDE * ACROSS + np.arange(MASKS.shape[1]) // SIDE


def tiles_of(regions):
    """How many numbered regions each tile has."""
    first = np.unique(regions, return_index=True)[1][1:]
    return np.bincount(TILE.ravel()[first], minlength=COUNT)


def pixel_topology(skeleton, mask):
    """Components, and cycles around background, of 8-connected lines of pixels in each tile."""
    outside = label(~skeleton, connectivity=1)
    holes = np.where(np.isin(outside, np.unique(outside[~mask])) & (outside != outside[0, 0]), outside, 0)
    return tiles_of(label(skeleton, connectivity=2)), tiles_of(holes)


def exact_topology(mask, connectivity, pruning=None):
    polygons = vorotool.outlines(mask, connectivity=connectivity)
    skeleton = vorotool.skeleton_exact(polygons)
    if pruning:
        skeleton = vorotool.prune(skeleton, **dict([pruning]))
    table = vorotool.polygon_table(skeleton)
    assert table["area"].sum() == mask.sum()
    column, row = np.rint(polygons.xy[polygons.ring_starts[polygons.polygon_starts[:-1]]] + 0.5).astype(int).T
    root = connected_roots(skeleton.arcs, len(skeleton.vertices))
    node_polygon = np.zeros(len(root), dtype=int)
    node_polygon[skeleton.arcs[:, 0]] = skeleton.polygon
    parts = np.bincount(node_polygon[root == np.arange(len(root))], minlength=len(polygons))
    tile = TILE[row, column]
    return np.bincount(tile, parts, COUNT), np.bincount(tile, table["cycles"], COUNT)


def test_components_and_cycles_are_those_of_scikit_image():
    """For scikit-image's medial axis, cycles around background: it has others, around single pixels of the mask."""
    parts, cycles = exact_topology(MASKS, 8)
    for axis in (medial_axis(MASKS, rng=0), skeletonize(MASKS, method="lee").astype(bool)):
        expected = pixel_topology(axis, MASKS)
        assert np.array_equal(parts, expected[0])
        assert np.array_equal(cycles, expected[1])
    pruned = exact_topology(MASKS, 8, default_pruning_for_masks())
    assert np.array_equal(pruned, (parts, cycles))
    assert parts.min() > 0
    assert np.count_nonzero(cycles) > COUNT / 2


def test_components_and_cycles_with_4_connectivity():
    masks = MASKS[: 3 * SIDE]
    parts, cycles = exact_topology(masks, 4)
    assert np.array_equal(parts, tiles_of(label(masks, connectivity=1)))
    outside = label(~masks, connectivity=2)
    assert np.array_equal(cycles, tiles_of(np.where(outside != outside[0, 0], outside, 0)))


@pytest.mark.parametrize("outline", ["crack", "contour"])
@pytest.mark.parametrize("connectivity", [4, 8])
def test_the_checker_passes_all_of_them(outline, connectivity):
    for seed in range(100, 102):
        image = random_labels(np.random.default_rng(seed), 20)
        if not image.any():
            continue
        for simplify in (None, 1.0):
            polygons = vorotool.outlines(
                image, mode="labels", outline=outline, connectivity=connectivity, simplify=simplify
            )
            skeleton = vorotool.skeleton_exact(polygons, side="both")
            vorotool.verify_skeleton(skeleton)


PAIR = vorotool.outlines(np.array([[1, 0], [0, 1]], dtype=bool))


@pytest.mark.parametrize("gap", [0.0, 0.25])
def test_what_is_outside_goes_through_with_4_connectivity(gap):
    """The two pixels without label of a square of four, enclosed by a frame."""
    image = np.pad(np.array([[1, 0], [0, 1]]), 1, constant_values=1).astype(bool)
    for connectivity, joints in ((4, [0, 1]), (8, [1, 0])):
        polygons = vorotool.outlines(image, connectivity=connectivity)
        for side, count in zip(("interior", "exterior"), joints, strict=True):
            made = vorotool.skeleton_exact(polygons, side=side, gap=gap)
            at = (made.vertices == [1.5, 1.5]).all(axis=1)
            assert np.count_nonzero(made.degree[at] == 2) == count
            assert np.count_nonzero(made.degree[at] == 1) == 2 - 2 * count


def test_the_checker_finds_corners_that_are_not_joined_or_should_not_be():
    joined, apart = vorotool.skeleton_exact(PAIR), vorotool.skeleton_exact(replace(PAIR, connectivity=None))
    with pytest.raises(VerificationError, match="but not joined"):
        vorotool.verify_skeleton(replace(apart, polygons=PAIR))
    with pytest.raises(VerificationError, match=r"does not go on|several arcs end there"):
        vorotool.verify_skeleton(replace(joined, polygons=replace(PAIR, connectivity=None)))


def test_the_checker_finds_a_corner_that_two_labels_share():
    two = vorotool.skeleton_exact(vorotool.outlines(np.array([[1, 2], [2, 1]])))
    first, second = np.flatnonzero((two.vertices == [0.5, 0.5]).all(axis=1))
    numbers = np.delete(np.arange(len(two.vertices)), second)
    arcs = np.searchsorted(numbers, np.where(two.arcs == second, first, two.arcs))
    ends_branch = (arcs[1:, 0] != arcs[:-1, 1]) | (np.bincount(arcs.ravel())[arcs[1:, 0]] != 2)
    branch = np.concatenate([[0], np.cumsum(ends_branch)])
    shared = replace(two, arcs=arcs, branch=branch, vertices=two.vertices[numbers], radius=two.radius[numbers])
    with pytest.raises(VerificationError, match="arcs in different polygons share"):
        vorotool.verify_skeleton(shared)


@pytest.mark.parametrize("connectivity", [4, 8])
def test_the_approximate_skeleton_within_a_tolerance_has_the_same_topology(connectivity):
    masks = MASKS[:SIDE, : 4 * SIDE]
    polygons = vorotool.outlines(masks, connectivity=connectivity)
    exact = vorotool.polygon_table(vorotool.skeleton_exact(polygons))
    made = vorotool.skeleton_approx(polygons, tolerance=0.05)
    assert vorotool.polygon_table(made)["cycles"].tolist() == exact["cycles"].tolist()
    root = connected_roots(made.arcs, len(made.vertices))
    assert np.count_nonzero(root == np.arange(len(root))) == len(polygons)


def test_pixels():
    mask = np.array([[0, 1, 1], [1, 0, 1]])
    found = vorotool.tessellate(vorotool.seeds_from_raster(vorotool.Raster(mask), mode="pixels")).labels
    assert found[mask == 1].tolist() == [1, 2, 3, 4]
