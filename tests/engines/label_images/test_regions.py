"""Measures, tables, diagram and colors of label images and volumes, against plain loops and SciPy."""

from fractions import Fraction
from math import prod
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy import ndimage

import vorotool
from vorotool.engines.label_images.measured_regions import measure_parts, regions_of_parts
from vorotool.engines.label_images.regions import (
    color_regions,
    measure_regions,
    neighbor_table,
    region_colors,
    region_table,
    voronoi_diagram,
)
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import InputError, LimitError, UsageError
from vorotool.types.images import LabelImage
from vorotool.types.pixels import Frame, pixel_sides
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.volumes.volume import LabelVolume, Volume, VolumeSeeds, VoxelFrame

DTYPES = (np.uint8, np.uint16, np.uint32, np.int32)


class Kind(NamedTuple):
    """Images or volumes: their type, what sizes of regions and borders are called, and a shape of some thousands."""

    image: type
    size: str
    outline: str
    border: str
    shape: tuple[int, ...]

    @property
    def columns(self):
        """Those of the table of regions."""
        ndim = len(self.shape)
        return [
            *("label", *"xyz"[:ndim], self.size, self.outline, "neighbors", "nearest_label", "nearest_distance"),
            *("touches_frame", "max_distance", "components"),
            *(f"bbox_{name}" for name in "xyz"[:ndim] + "whd"[:ndim]),
        ]


IMAGES = Kind(LabelImage, "area", "perimeter", "border_length", (50, 61))
VOLUMES = Kind(LabelVolume, "volume", "surface", "border_area", (9, 12, 14))
kinds = pytest.mark.parametrize("kind", [IMAGES, VOLUMES], ids=["image", "volume"])


def kind_of(labels):
    return IMAGES if labels.ndim == 2 else VOLUMES


label_arrays = st.one_of(
    hnp.arrays(
        st.sampled_from(DTYPES), hnp.array_shapes(min_dims=n, max_dims=n, max_side=side), elements=st.integers(0, 5)
    )
    for n, side in ((2, 40), (3, 9))
)


# ---- oracles ------------------------------------------------------------------------------------------


def faces(labels):
    """For x, y and z: pairs of labels on the two sides of every side of a pixel or voxel, the outside as -1."""
    padded = np.pad(labels.astype(np.int64), 1, constant_values=-1)
    for axis in reversed(range(labels.ndim)):
        inner = tuple(slice(None) if other == axis else slice(1, -1) for other in range(labels.ndim))
        ends = np.moveaxis(padded[inner], axis, 0)
        pairs = np.stack([ends[:-1].ravel(), ends[1:].ravel()], axis=1)
        yield np.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1)


def expected_rows(labels):
    apart, kind = list(faces(labels)), kind_of(labels)
    for label in np.unique(labels[labels > 0]):
        mask = labels == label
        places = np.nonzero(mask)[::-1]
        beside = np.concatenate([pairs[(pairs == label).any(axis=1)].ravel() for pairs in apart])
        yield {
            "label": int(label),
            kind.size: int(mask.sum()),
            kind.outline: sum(int((pairs == label).any(axis=1).sum()) for pairs in apart),
            "neighbors": len(set(beside.tolist()) - {-1, 0, int(label)}),
            "components": int(ndimage.label(mask)[1]),
            "touches_frame": int(
                any(p.min() == 0 or p.max() == side - 1 for p, side in zip(places, mask.shape[::-1], strict=True))
            ),
            **{name: p.mean() for name, p in zip("xyz", places, strict=False)},
            **{f"bbox_{name}": int(p.min()) for name, p in zip("xyz", places, strict=False)},
            **{f"bbox_{name}": int(np.ptp(p)) + 1 for name, p in zip("whd", places, strict=False)},
        }


def expected_borders(labels):
    counts: dict[tuple[int, int], list[int]] = {}
    for axis, pairs in enumerate(faces(labels)):
        for a, b in pairs[pairs[:, 0] > 0].tolist():
            counts.setdefault((a, b), [0] * labels.ndim)[axis] += 1
    return sorted(counts.items())


def borders_of(measures):
    pairs = measures.labels[measures.borders].tolist()
    return [((a, b), count) for (a, b), count in zip(pairs, measures.border_faces.tolist(), strict=True)]


def expected_diagram(labels):
    padded = np.pad(labels.astype(np.int64), 1)
    largest = np.max([np.roll(padded, step, axis) for axis in range(labels.ndim) for step in (1, -1)], axis=0)
    return ((labels > 0) & (largest[(slice(1, -1),) * labels.ndim] > labels)).astype(np.uint8)


def check(labels, **options):
    kind = kind_of(labels)
    table, expected = region_table(kind.image(labels), **options), list(expected_rows(labels))
    assert list(table) == kind.columns
    assert table["label"].tolist() == [row["label"] for row in expected]
    for name in expected[0] if expected else ():
        if name in "xyz":
            np.testing.assert_allclose(table[name], [row[name] for row in expected], rtol=1e-13)
        else:
            assert table[name].dtype.kind == "i"
            assert table[name].tolist() == [row[name] for row in expected], name
    borders = expected_borders(labels)
    assert borders_of(measure_regions(kind.image(labels), **options)) == borders
    pairs = neighbor_table(kind.image(labels), **options)
    found = zip(*(pairs[name].tolist() for name in ("label_a", "label_b", kind.border)), strict=True)
    assert list(found) == [(*pair, sum(count)) for pair, count in borders]


def nearest(shape, count, seed, units=(1, 1, 1)):
    """A tessellation by brute force: labels, squared distances, seeds; units along z, y, x."""
    random, ndim = np.random.default_rng(seed), len(shape)
    places = np.stack([random.integers(0, side, count) for side in shape[::-1]], axis=1)
    d2 = sum(
        (unit * (axis[..., None] - places[:, k])) ** 2
        for k, (axis, unit) in enumerate(zip(np.indices(shape)[::-1], units[-ndim:][::-1], strict=True))
    )
    numbers = np.arange(1, count + 1)
    seeds = SeedSet(*places.T, numbers) if ndim == 2 else VolumeSeeds(places, numbers)
    return (d2.argmin(axis=ndim) + 1).astype(np.uint16), d2.min(axis=ndim), seeds


# ---- measures and tables ------------------------------------------------------------------------------


@given(label_arrays)
@settings(max_examples=80, deadline=None)
def test_measures_agree_with_plain_loops(labels):
    check(labels, threads=2)
    np.testing.assert_array_equal(voronoi_diagram(kind_of(labels).image(labels)), expected_diagram(labels))


@kinds
@pytest.mark.parametrize("pattern", ["comb", "shells", "chequers", "snake"])
def test_components_that_meet_late(kind, pattern):
    labels = np.zeros((9, 11, 13)[-len(kind.shape) :] if kind is VOLUMES else (41, 41), dtype=np.uint16)
    places = np.indices(labels.shape)
    middle = np.reshape([side // 2 for side in labels.shape], (-1,) + (1,) * labels.ndim)
    if pattern == "comb":
        labels[(slice(None), *(slice(None, None, 2),) * (labels.ndim - 1))] = 1
        labels[-1] = 1
    elif pattern == "shells":
        labels[:] = abs(places - middle).max(axis=0) % 3
    elif pattern == "chequers":
        labels[:] = places.sum(axis=0) % 2 + 1
    else:
        labels[..., 1::2, :] = 1
        rows = labels if kind is VOLUMES else labels[:, None]
        rows[::4, ::2, 0] = rows[2::4, ::2, -1] = 1
    check(labels)
    check(labels[::-1])


@kinds
@pytest.mark.parametrize("threads", [1, 2, 5])
def test_bands_leave_no_trace(kind, threads):
    """Rows of 2^19 pixels, or slices of 2^21 voxels, make pieces of one; regions run through many of them."""
    shape, factors = ((37, 64), (1, 8192)) if kind is IMAGES else ((7, 8, 8), (1, 256, 1024))
    small = large = np.random.default_rng(1).integers(0, 3, shape).astype(np.uint8)
    for axis, factor in enumerate(factors):
        large = large.repeat(factor, axis=axis)
    whole, one = measure_regions(kind.image(large), threads=threads), measure_regions(kind.image(small))
    steps = np.array(factors[::-1])
    assert whole.cells.tolist() == (one.cells * prod(factors)).tolist()
    assert whole.components.tolist() == one.components.tolist()
    assert whole.faces.tolist() == (one.faces * (prod(factors) // steps)).tolist()
    assert whole.border_faces.tolist() == (one.border_faces * (prod(factors) // steps)).tolist()
    assert whole.low.tolist() == (one.low * steps).tolist()
    assert whole.high.tolist() == (one.high * steps + (steps - 1)).tolist()
    places = np.nonzero(large == 1)[::-1]
    assert whole.sums[0].tolist() == [int(p.sum()) for p in places]


def test_one_slice_is_an_image():
    labels = np.random.default_rng(5).integers(0, 5, (20, 30)).astype(np.uint8)
    flat, volume = measure_regions(labels), measure_regions(labels[None])
    assert volume.cells.tolist() == flat.cells.tolist()
    assert volume.faces[:, :2].sum(axis=1).tolist() == flat.faces.sum(axis=1).tolist()
    assert volume.faces[:, 2].tolist() == (2 * volume.cells).tolist()
    assert volume.components.tolist() == flat.components.tolist()
    np.testing.assert_array_equal(volume.borders, flat.borders)
    assert volume.border_faces.sum(axis=1).tolist() == flat.border_faces.sum(axis=1).tolist()
    np.testing.assert_array_equal(voronoi_diagram(labels[None])[0], voronoi_diagram(labels))


def test_sides_scale_lengths_areas_and_volumes():
    labels, d2, seeds = nearest((9, 12, 14), 15, 3, (5, 2, 3))
    volume = LabelVolume(labels, None, seeds, pixel_sides((1.25, 0.5, 0.75), 3))
    table = region_table(volume, distance2=d2.astype(np.uint32))
    plain = list(expected_rows(labels))
    apart = list(faces(labels))
    areas = (0.625, 0.9375, 0.375)
    rows = table["volume"] > 0
    assert table["volume"][rows].tolist() == [row["volume"] * 0.46875 for row in plain]
    assert table["surface"][rows].tolist() == [
        sum(area * int((pairs == row["label"]).any(axis=1).sum()) for area, pairs in zip(areas, apart, strict=True))
        for row in plain
    ]
    for name, side in zip("xyzwhd", (0.75, 0.5, 1.25) * 2, strict=True):
        assert table[f"bbox_{name}"][rows].tolist() == [row[f"bbox_{name}"] * side for row in plain]
    np.testing.assert_array_equal(np.stack([table[name] for name in "xyz"], axis=1), seeds.sites * (0.75, 0.5, 1.25))
    expected = np.sqrt(ndimage.maximum(d2, labels, table["label"][rows])) * 0.25
    np.testing.assert_array_equal(table["max_distance"].compressed(), expected)
    sites = seeds.sites * (3, 2, 5)
    between = np.sqrt(((sites[:, None] - sites) ** 2).sum(axis=2))
    np.fill_diagonal(between, np.inf)
    assert table["nearest_label"].tolist() == (between.argmin(axis=1) + 1).tolist()
    np.testing.assert_array_equal(table["nearest_distance"], between.min(axis=1) * 0.25)
    pairs = neighbor_table(volume)
    expected_areas = [float(np.dot(count, areas)) for _, count in expected_borders(labels)]
    assert pairs["border_area"].tolist() == expected_areas
    a, b = pairs["label_a"] - 1, pairs["label_b"] - 1
    np.testing.assert_allclose(pairs["centroid_distance"], between[a, b] * 0.25, rtol=1e-15)


@kinds
def test_every_site_has_a_row_with_seeds(kind):
    given = {
        f"object_{kind.size}": np.array([1, 2, 3]),
        "properties": {"name": ["a", "b", "c"], kind.size: list("vwx")},
    }
    numbers, places = np.array([3, 5, 8]), np.array([[2, 0, 0], [2, 0, 0], [900, 0, 0]])
    if kind is IMAGES:
        seeds, frame = SeedSet(*places[:, :2].T, numbers, **given), Frame(0, 0, 6, 1)
    else:
        seeds, frame = VolumeSeeds(places, numbers, **given), VoxelFrame(0, 0, 0, 6, 1, 1)
    shape = (1,) * (len(kind.shape) - 1) + (6,)
    image = kind.image(np.full(shape, 3, dtype=np.uint8), frame, seeds)
    distance2 = ((np.arange(6) - 2) ** 2).reshape(shape)
    table = region_table(image, distance2=distance2)
    assert table["label"].tolist() == [3, 5, 8]
    assert table[f"voro_{kind.size}"].tolist() == [6, 0, 0]
    assert table["nearest_label"].tolist() == [5, 3, 3]
    assert table["nearest_distance"].tolist() == [0.0, 0.0, 898.0]
    assert table["max_distance"].tolist() == [3.0, None, None]
    for name in ("touches_frame", *(name for name in kind.columns if name.startswith("bbox"))):
        assert table[name].tolist()[1:] == [None, None]
    assert list(table)[-3:] == [f"object_{kind.size}", "name", kind.size]
    assert "name" not in region_table(image, properties=False)
    assert region_table(image, distance2=distance2, distance_scale=2)["max_distance"][0] == 1.5


@kinds
@pytest.mark.parametrize("dtype", [np.uint32, np.uint64, np.int64])
def test_max_distance_by_region(kind, dtype):
    labels, d2, seeds = nearest(kind.shape, 20, 2)
    table = region_table(kind.image(labels, None, seeds), distance2=d2.astype(dtype), threads=3)
    present = np.isin(np.arange(1, 21), labels)
    expected = np.sqrt(ndimage.maximum(d2, labels, np.arange(1, 21)[present]))
    np.testing.assert_array_equal(table["max_distance"].compressed(), expected)


def test_public_functions_take_volumes():
    labels, _, seeds = nearest((8, 9, 10), 12, 4)
    volume = LabelVolume(labels, None, seeds)
    assert vorotool.region_table(labels)["volume"].tolist() == [row["volume"] for row in expected_rows(labels)]
    np.testing.assert_array_equal(vorotool.voronoi_diagram(volume), expected_diagram(labels))
    measures = measure_regions(volume)
    assert vorotool.region_table(volume, measures=measures) == region_table(volume)
    assert volume.table().keys() == dict(region_table(volume)).keys()
    assert volume.to_pandas()["label"].tolist() == region_table(volume)["label"].tolist()
    graph = volume.to_networkx()
    assert sorted(tuple(sorted(edge)) for edge in graph.edges) == [pair for pair, _ in expected_borders(labels)]
    assert graph.nodes[1]["volume"] == int((labels == 1).sum())
    np.testing.assert_array_equal(np.asarray(volume), labels)


# ---- the diagram --------------------------------------------------------------------------------------


@kinds
@pytest.mark.parametrize("dtype", DTYPES)
def test_diagram_can_be_streamed(kind, dtype):
    labels = np.random.default_rng(8).integers(0, 6, (23, 31) if kind is IMAGES else (11, 7, 9)).astype(dtype)
    whole, count = voronoi_diagram(labels), len(labels)
    for height in (1, 2, 7, count):
        bands = []
        for top in range(0, count, height):
            end = min(count, top + height)
            above, below = labels[top - 1] if top else None, labels[end] if end < count else None
            bands.append(voronoi_diagram(labels[top:end], above=above, below=below))
        np.testing.assert_array_equal(np.concatenate(bands), whole)


@kinds
def test_diagram_into_a_given_array(kind):
    shape = (1,) * (len(kind.shape) - 1) + (2,)
    labels = np.array([1, 2], dtype=np.uint8).reshape(shape)
    out = np.full(shape, 7, dtype=np.uint8)
    assert voronoi_diagram(labels, out=out) is out
    assert out.ravel().tolist() == [1, 0]
    for options, message in (
        ({"out": np.zeros((2, 1), dtype=np.uint8)}, "out must be a C-contiguous uint8 array"),
        ({"above": np.zeros(3, dtype=np.uint8)}, "has shape"),
        ({"below": np.zeros(shape[1:], dtype=np.int32)}, "has type uint32"),
    ):
        with pytest.raises(InputError, match=message):
            voronoi_diagram(labels, **options)


# ---- colors ------------------------------------------------------------------------------------------


@given(label_arrays)
@settings(max_examples=60, deadline=None)
def test_neighbors_never_share_a_color(labels):
    image = kind_of(labels).image(labels)  # an array may look like a color image
    colors = color_regions(image)
    assert colors[0] == 0
    assert (colors[np.unique(labels[labels > 0])] > 0).all()
    for (a, b), _ in expected_borders(labels):
        assert colors[a] != colors[b]
    found, again = region_colors(image, measures=measure_regions(image))
    assert colors[found].tolist() == again.tolist()


def test_a_huge_label_needs_no_huge_array():
    image = LabelImage(np.array([[1, 2**32 - 1]], dtype=np.uint32))
    with pytest.raises(LimitError, match="4294967295"):
        color_regions(image)
    assert region_colors(image)[1].tolist() in ([1, 2], [2, 1])


# ---- bad and odd input --------------------------------------------------------------------------------


@kinds
def test_other_integer_types_and_layouts(kind):
    labels = np.random.default_rng(2).integers(0, 4, kind.shape)
    expected = expected_borders(labels)
    frozen = labels.astype(np.uint16)
    frozen.flags.writeable = False
    for other in (
        labels,
        labels.astype(">u2"),
        labels.astype(np.uint64),
        np.asfortranarray(labels.astype(np.int32)),
        labels.repeat(2, axis=-1)[..., ::2].astype(np.int16),
        np.ma.masked_array(labels.astype(np.uint8), mask=False),
        frozen,
    ):
        assert borders_of(measure_regions(kind.image(other))) == expected
        np.testing.assert_array_equal(voronoi_diagram(kind.image(other)), expected_diagram(labels))


@kinds
@pytest.mark.parametrize("dtype", [np.int8, np.int16, np.int32, np.int64])
def test_negative_labels_are_refused(kind, dtype):
    image = kind.image(np.array([1, -4], dtype=dtype).reshape((1,) * (len(kind.shape) - 1) + (2,)))
    for function in (measure_regions, region_table, neighbor_table, color_regions):
        with pytest.raises(InputError, match="label -4"):
            function(image)


@kinds
def test_a_label_without_site_is_named(kind):
    seeds = SeedSet([0], [0], [1]) if kind is IMAGES else VolumeSeeds(np.array([[0, 0, 0]]), np.array([1]))
    labels = np.array([[1, 1], [1, 7]], dtype=np.uint8).reshape((1,) * (len(kind.shape) - 2) + (2, 2))
    for function in (region_table, neighbor_table):
        with pytest.raises(InputError, match=r"row 1, column 1\) has label 7"):
            function(kind.image(labels, None, seeds))


def test_what_does_not_fit():
    volume = LabelVolume(np.array([[[1]]], dtype=np.uint8))
    with pytest.raises(UsageError, match="threads is -1"):
        measure_regions(volume, threads=-1)
    with pytest.raises(InputError, match="distance2 must be an array of integers or float64 of shape"):
        region_table(volume, distance2=np.zeros((2, 2), dtype=np.uint32))
    with pytest.raises(InputError, match="label 4294967296"):
        measure_regions(LabelVolume(np.array([[[2**32]]])))
    with pytest.raises(InputError, match="expected truth values or integers"):
        vorotool.region_table(np.zeros((4, 5, 6)))
    with pytest.raises(InputError, match="expected labels, a 3-D array of integers"):
        vorotool.region_table(Volume(np.zeros((4, 5, 6))))
    with pytest.raises(InputError, match="slabs is empty"):
        measure_parts([])
    with pytest.raises(InputError, match="slabs must have one height and width"):
        measure_parts([np.zeros((1, 2, 3), np.uint8), np.zeros((1, 3, 2), np.uint8)])


# ---- regions that are measured slab by slab ----
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
