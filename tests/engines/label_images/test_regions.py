from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy import ndimage

from vorotool.engines.label_images import regions
from vorotool.errors import InputError, LimitError
from vorotool.types.images import LabelImage
from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet

DTYPES = (np.uint8, np.uint16, np.uint32, np.int32)
COLUMNS = [
    *("label", "x", "y", "area", "perimeter", "neighbors", "nearest_label", "nearest_distance"),
    *("touches_frame", "max_distance", "components", "bbox_x", "bbox_y", "bbox_w", "bbox_h"),
]

label_images = hnp.arrays(
    st.sampled_from(DTYPES),
    hnp.array_shapes(min_dims=2, max_dims=2, max_side=40),
    elements=st.integers(0, 5),
)


# ---- oracles ------------------------------------------------------------------------------------------


def sides(labels):
    """Pairs of labels on the two sides of every pixel side, the outside of the image as -1."""
    padded = np.pad(labels.astype(np.int64), 1, constant_values=-1)
    across = np.stack([padded[1:-1, :-1].ravel(), padded[1:-1, 1:].ravel()], axis=1)
    down = np.stack([padded[:-1, 1:-1].ravel(), padded[1:, 1:-1].ravel()], axis=1)
    return np.concatenate([across, down])


def expected_measures(labels):
    pairs = sides(labels)
    apart = pairs[pairs[:, 0] != pairs[:, 1]]
    rows = []
    for label in np.unique(labels[labels > 0]):
        mask = labels == label
        y, x = np.nonzero(mask)
        neighbors = set(apart[(apart == label).any(axis=1)].ravel().tolist()) - {-1, 0, int(label)}
        rows.append(
            {
                "label": int(label),
                "area": int(mask.sum()),
                "perimeter": int((apart == label).any(axis=1).sum()),
                "neighbors": len(neighbors),
                "components": int(ndimage.label(mask)[1]),
                "x": x.mean(),
                "y": y.mean(),
                "bbox_x": x.min(),
                "bbox_y": y.min(),
                "bbox_w": np.ptp(x) + 1,
                "bbox_h": np.ptp(y) + 1,
                "touches_frame": int(
                    x.min() == 0 or y.min() == 0 or x.max() == labels.shape[1] - 1 or y.max() == labels.shape[0] - 1
                ),
            }
        )
    return rows


def expected_borders(labels):
    pairs = np.sort(sides(labels), axis=1)
    pairs = pairs[(pairs[:, 0] > 0) & (pairs[:, 0] != pairs[:, 1])]
    found, counts = np.unique(pairs, axis=0, return_counts=True)
    return [(int(a), int(b), int(c)) for (a, b), c in zip(found, counts, strict=True)]


def borders_of(labels, **options):
    table = regions.neighbor_table(LabelImage(labels), **options)
    return list(zip(*(table[name].tolist() for name in ("label_a", "label_b", "border_length")), strict=True))


def expected_diagram(labels):
    marked = np.zeros(labels.shape, dtype=np.uint8)
    height, width = labels.shape
    for r in range(height):
        for c in range(width):
            for dr, dc in ((0, 1), (1, 0), (0, -1), (-1, 0)):
                inside = 0 <= r + dr < height and 0 <= c + dc < width
                if inside and 0 < labels[r, c] < labels[r + dr, c + dc]:
                    marked[r, c] = 1
    return marked


def nearest_label_image(shape, count, seed):
    """A tessellation by brute force, connected regions as a rule."""
    random = np.random.default_rng(seed)
    x, y = random.integers(0, shape[1], count), random.integers(0, shape[0], count)
    rows, columns = np.indices(shape)
    d2 = (rows[..., None] - y) ** 2 + (columns[..., None] - x) ** 2
    return (d2.argmin(axis=2) + 1).astype(np.uint16), d2.min(axis=2), SeedSet(x, y, np.arange(1, count + 1))


# ---- measures and tables ------------------------------------------------------------------------------


@given(label_images)
@settings(max_examples=20, deadline=None)
def test_measures_agree_with_plain_loops(labels):
    table = regions.region_table(LabelImage(labels), threads=2)
    expected = expected_measures(labels)
    assert list(table) == COLUMNS
    assert len(table["label"]) == len(expected)
    for name in expected[0] if expected else ():
        if name in "xy":
            np.testing.assert_allclose(table[name], [row[name] for row in expected], rtol=1e-13)
        else:
            assert table[name].tolist() == [row[name] for row in expected], name


@given(label_images)
@settings(max_examples=30, deadline=None)
def test_borders_agree_with_plain_loops(labels):
    assert borders_of(labels) == expected_borders(labels)


@given(label_images)
@settings(max_examples=30, deadline=None)
def test_diagram_agrees_with_the_definition(labels):
    np.testing.assert_array_equal(regions.voronoi_diagram(LabelImage(labels)), expected_diagram(labels))


@pytest.mark.parametrize("threads", [1, 2, 3, 4, 5])
def test_bands_leave_no_trace(threads):
    """Rows of 2^19 pixels make pieces of one row; regions run through many of them."""
    labels = np.random.default_rng(1).integers(0, 3, (37, 64)).astype(np.uint8).repeat(8192, axis=1)
    whole = regions.measure_regions(LabelImage(labels), threads=threads)
    small = labels[:, ::8192]
    table = regions.region_table(LabelImage(small))
    assert whole.cells.tolist() == (8192 * table["area"]).tolist()
    assert whole.components.tolist() == table["components"].tolist()
    ends = np.pad(small.astype(int), ((0, 0), (1, 1)))
    across = {k: sum(int(((row == k) != (row_next == k)).sum()) for row, row_next in pairwise(ends.T)) for k in (1, 2)}
    downs = {k: p - across[k] for k, p in zip((1, 2), table["perimeter"].tolist(), strict=True)}
    assert whole.faces.sum(axis=1).tolist() == [across[k] + 8192 * downs[k] for k in (1, 2)]
    reference = regions.measure_regions(LabelImage(labels), threads=1)
    assert whole.border_faces.tolist() == reference.border_faces.tolist()
    for name in ("cells", "components", "faces", "sums", "low", "high"):
        assert getattr(whole, name).tolist() == getattr(reference, name).tolist()


@pytest.mark.parametrize("pattern", ["comb", "rings", "chequers"])
def test_components_that_meet_late(pattern):
    labels = np.zeros((41, 41), dtype=np.uint16)
    if pattern == "comb":
        labels[:, ::2] = 1
        labels[-1] = 1
    elif pattern == "rings":
        rows, columns = np.indices(labels.shape)
        labels[:] = np.maximum(abs(rows - 20), abs(columns - 20)) % 3
    else:
        labels[:] = np.indices(labels.shape).sum(axis=0) % 2 + 1
    table = regions.region_table(LabelImage(labels))
    assert table["components"].tolist() == [row["components"] for row in expected_measures(labels)]


def test_every_site_has_a_row_with_seeds():
    seeds = SeedSet(
        np.array([2, 2, 900]), np.array([0, 0, 0]), np.array([3, 5, 8]), properties={"name": ["a", "b", "c"]}
    )
    image = LabelImage(np.full((1, 6), 3, dtype=np.uint8), Frame(0, 0, 6, 1), seeds)
    distance2 = (np.arange(6, dtype=np.uint32)[None] - np.uint32(2)).astype(np.int32) ** 2
    table = regions.region_table(image, distance2=distance2)
    assert table["label"].tolist() == [3, 5, 8]
    assert table["area"].tolist() == [6, 0, 0]
    assert table["nearest_label"].tolist() == [5, 3, 3]
    assert table["nearest_distance"].tolist() == [0.0, 0.0, 898.0]
    assert table["max_distance"].tolist() == [3.0, None, None]
    for name in ("touches_frame", "bbox_x", "bbox_y", "bbox_w", "bbox_h"):
        assert table[name].tolist()[1:] == [None, None]
    assert table["name"].tolist() == ["a", "b", "c"]
    assert "name" not in regions.region_table(image, properties=False)


def test_a_clash_of_names_and_object_area():
    seeds = SeedSet(
        np.array([0]),
        np.array([0]),
        np.array([1]),
        object_area=np.array([4]),
        properties={"area": ["mine"]},
    )
    table = regions.region_table(LabelImage(np.ones((2, 2), dtype=np.uint8), Frame(0, 0, 2, 2), seeds))
    assert list(table)[-2:] == ["object_area", "area"]
    assert table["voro_area"].tolist() == [4]


@pytest.mark.parametrize("dtype", [np.uint32, np.uint64, np.int64])
def test_max_distance_by_region(dtype):
    labels, d2, seeds = nearest_label_image((50, 61), 20, 2)
    image = LabelImage(labels, None, seeds)
    table = regions.region_table(image, distance2=d2.astype(dtype), threads=3)
    expected = np.sqrt(ndimage.maximum(d2, labels, np.arange(1, 21)))
    present = np.isin(np.arange(1, 21), labels)
    np.testing.assert_array_equal(table["max_distance"].compressed(), expected[present])
    half = regions.region_table(image, distance2=d2.astype(dtype), distance_scale=2)
    np.testing.assert_array_equal(half["max_distance"] * 2, table["max_distance"])


# ---- the diagram in bands -----------------------------------------------------------------------------


@pytest.mark.parametrize("dtype", DTYPES)
def test_diagram_can_be_streamed(dtype):
    labels = np.random.default_rng(8).integers(0, 6, (23, 31)).astype(dtype)
    whole = regions.voronoi_diagram(labels)
    for height in (1, 2, 7, 23):
        bands = []
        for top in range(0, 23, height):
            end = min(23, top + height)
            above = labels[top - 1] if top else None
            below = labels[end] if end < 23 else None
            bands.append(regions.voronoi_diagram(labels[top:end], above=above, below=below))
        np.testing.assert_array_equal(np.concatenate(bands), whole)


def test_diagram_into_a_given_array():
    labels = np.array([[1, 2]], dtype=np.uint8)
    out = np.full((1, 2), 7, dtype=np.uint8)
    assert regions.voronoi_diagram(labels, out=out) is out
    assert out.tolist() == [[1, 0]]
    with pytest.raises(InputError, match="out must be a C-contiguous uint8 array"):
        regions.voronoi_diagram(labels, out=np.zeros((2, 1), dtype=np.uint8))
    with pytest.raises(InputError, match="the row above has shape"):
        regions.voronoi_diagram(labels, above=np.zeros(3, dtype=np.uint8))
    with pytest.raises(InputError, match="the row below has type uint32"):
        regions.voronoi_diagram(labels, below=np.zeros(2, dtype=np.int32))


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_diagram_does_not_depend_on_threads(threads):
    labels = np.random.default_rng(8).integers(0, 6, (3000, 1500)).astype(np.uint16)
    np.testing.assert_array_equal(
        regions.voronoi_diagram(labels, threads=threads), regions.voronoi_diagram(labels, threads=1)
    )


# ---- colors ------------------------------------------------------------------------------------------


@given(label_images)
@settings(max_examples=50, deadline=None)
def test_neighbors_never_share_a_color(labels):
    colors = regions.color_regions(LabelImage(labels))
    assert colors[0] == 0
    pairs = sides(labels)
    pairs = pairs[(pairs > 0).all(axis=1) & (pairs[:, 0] != pairs[:, 1])]
    assert (colors[pairs[:, 0]] != colors[pairs[:, 1]]).all()


def test_a_huge_label_needs_no_huge_array():
    image = LabelImage(np.array([[1, 2**32 - 1]], dtype=np.uint32))
    with pytest.raises(LimitError, match="the largest label is 4294967295"):
        regions.color_regions(image)
    assert regions.region_colors(image)[1].tolist() in ([1, 2], [2, 1])


# ---- bad input ----------------------------------------------------------------------------------------


def test_a_label_without_site_is_named():
    seeds = SeedSet(np.array([0]), np.array([0]), np.array([1]))
    image = LabelImage(np.array([[1, 1], [1, 7]], dtype=np.uint8), Frame(0, 0, 2, 2), seeds)
    for function in (regions.region_table, regions.neighbor_table):
        with pytest.raises(InputError, match=r"pixel \(row 1, column 1\) has label 7"):
            function(image)


@pytest.mark.parametrize("dtype", [np.int8, np.int16, np.int32, np.int64])
def test_negative_labels_are_refused(dtype):
    with pytest.raises(InputError, match="label -4"):
        regions.measure_regions(LabelImage(np.array([[1, -4]], dtype=dtype)))


def test_other_integer_types_and_layouts():
    labels = np.random.default_rng(2).integers(0, 4, (9, 12))
    expected = borders_of(labels.astype(np.uint8))
    for other in (
        labels,
        labels.astype(">u2"),
        labels.astype(np.uint64),
        np.asfortranarray(labels.astype(np.int32)),
        labels.repeat(2, axis=1)[:, ::2].astype(np.int16),
    ):
        assert borders_of(other) == expected
    frozen = labels.astype(np.uint16)
    frozen.flags.writeable = False
    assert borders_of(frozen) == expected


def test_what_progress_raises_stops_the_work():
    labels = np.random.default_rng(1).integers(1, 60_000, (1500, 2000)).astype(np.uint16)
    seen = []

    def stop(fraction):
        seen.append(fraction)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        regions.measure_regions(LabelImage(labels), threads=2, progress=stop)
    assert len(seen) == 1
    assert 0 <= seen[0] <= 1
