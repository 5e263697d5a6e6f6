"""Measures, tables, diagram and colors of label volumes, against plain loops and SciPy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy import ndimage

import vorotool
from vorotool.engines.label_images.measured_regions import measure_parts
from vorotool.engines.label_images.regions import measure_regions, neighbor_table, region_colors, region_table
from vorotool.errors import InputError, UsageError
from vorotool.types.pixels import pixel_sides
from vorotool.types.volumes.volume import LabelVolume, Volume, VolumeSeeds, VoxelFrame

DTYPES = (np.uint8, np.uint16, np.uint32, np.int32)
COLUMNS = [
    *("label", "x", "y", "z", "volume", "surface", "neighbors", "nearest_label", "nearest_distance"),
    *("touches_frame", "max_distance", "components"),
    *("bbox_x", "bbox_y", "bbox_z", "bbox_w", "bbox_h", "bbox_d"),
]

label_volumes = hnp.arrays(
    st.sampled_from(DTYPES),
    hnp.array_shapes(min_dims=3, max_dims=3, max_side=9),
    elements=st.integers(0, 4),
)


# ---- oracles ------------------------------------------------------------------------------------------


def faces(labels):
    """For x, y and z: pairs of labels on the two sides of every face of a voxel, the outside as -1."""
    padded = np.pad(labels.astype(np.int64), 1, constant_values=-1)
    for axis in (2, 1, 0):
        inner = tuple(slice(None) if other == axis else slice(1, -1) for other in range(3))
        ends = np.moveaxis(padded[inner], axis, 0)
        pairs = np.stack([ends[:-1].ravel(), ends[1:].ravel()], axis=1)
        yield np.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1)


def expected_rows(labels):
    apart = list(faces(labels))
    for label in np.unique(labels[labels > 0]):
        mask = labels == label
        places = np.nonzero(mask)[::-1]
        beside = np.concatenate([pairs[(pairs == label).any(axis=1)].ravel() for pairs in apart])
        yield {
            "label": int(label),
            "volume": int(mask.sum()),
            "surface": sum(int((pairs == label).any(axis=1).sum()) for pairs in apart),
            "neighbors": len(set(beside.tolist()) - {-1, 0, int(label)}),
            "components": int(ndimage.label(mask)[1]),
            "touches_frame": int(
                any(p.min() == 0 or p.max() == side - 1 for p, side in zip(places, mask.shape[::-1], strict=True))
            ),
            **{name: p.mean() for name, p in zip("xyz", places, strict=True)},
            **{f"bbox_{name}": int(p.min()) for name, p in zip("xyz", places, strict=True)},
            **{f"bbox_{name}": int(np.ptp(p)) + 1 for name, p in zip("whd", places, strict=True)},
        }


def expected_borders(labels):
    counts: dict[tuple[int, int], list[int]] = {}
    for axis, pairs in enumerate(faces(labels)):
        for a, b in pairs[pairs[:, 0] > 0].tolist():
            counts.setdefault((a, b), [0, 0, 0])[axis] += 1
    return sorted(counts.items())


def borders_of(measures):
    pairs = measures.labels[measures.borders].tolist()
    return [((a, b), count) for (a, b), count in zip(pairs, measures.border_faces.tolist(), strict=True)]


def expected_diagram(labels):
    padded = np.pad(labels.astype(np.int64), 1)
    largest = np.max([np.roll(padded, step, axis) for axis in range(3) for step in (1, -1)], axis=0)
    return ((labels > 0) & (largest[1:-1, 1:-1, 1:-1] > labels)).astype(np.uint8)


def check(labels, **options):
    table = region_table(LabelVolume(labels), **options)
    expected = list(expected_rows(labels))
    assert list(table) == COLUMNS
    assert table["label"].tolist() == [row["label"] for row in expected]
    for name in expected[0] if expected else ():
        if name in "xyz":
            np.testing.assert_allclose(table[name], [row[name] for row in expected], rtol=1e-13)
        else:
            assert table[name].dtype.kind == "i"
            assert table[name].tolist() == [row[name] for row in expected], name
    assert borders_of(measure_regions(LabelVolume(labels), **options)) == expected_borders(labels)


def nearest(shape, count, seed, units=(1, 1, 1)):
    """A tessellation by brute force: labels, squared distances, seeds; units along z, y, x."""
    random = np.random.default_rng(seed)
    places = np.stack([random.integers(0, side, count) for side in shape[::-1]], axis=1)
    z, y, x = np.indices(shape)
    d2 = sum(
        (unit * (axis[..., None] - places[:, k])) ** 2
        for k, (axis, unit) in enumerate(zip((x, y, z), units[::-1], strict=True))
    )
    return (d2.argmin(axis=3) + 1).astype(np.uint16), d2.min(axis=3), VolumeSeeds(places, np.arange(1, count + 1))


# ---- measures and tables ------------------------------------------------------------------------------


@given(label_volumes)
@settings(max_examples=40, deadline=None)
def test_measures_agree_with_plain_loops(labels):
    check(labels, threads=2)
    np.testing.assert_array_equal(vorotool.voronoi_diagram(LabelVolume(labels)), expected_diagram(labels))


@pytest.mark.parametrize("pattern", ["comb", "shells", "chequers", "spiral"])
def test_components_that_meet_late(pattern):
    labels = np.zeros((9, 11, 13), dtype=np.uint16)
    z, y, x = np.indices(labels.shape)
    if pattern == "comb":
        labels[:, ::2, ::2] = 1
        labels[-1] = 1
    elif pattern == "shells":
        labels[:] = np.maximum(np.maximum(abs(z - 4), abs(y - 5)), abs(x - 6)) % 3
    elif pattern == "chequers":
        labels[:] = (x + y + z) % 2 + 1
    else:
        labels[:, 1::2, :] = 1
        labels[::4, ::2, 0] = labels[2::4, ::2, -1] = 1
    check(labels)
    check(labels[::-1])


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_slabs_leave_no_trace(threads):
    """Slices of 2^21 voxels make pieces of one slice; regions run through many of them."""
    small = np.random.default_rng(1).integers(0, 3, (7, 8, 8)).astype(np.uint8)
    whole = measure_regions(small.repeat(256, axis=1).repeat(1024, axis=2), threads=threads)
    one = measure_regions(small)
    assert whole.cells.tolist() == (one.cells * 2**18).tolist()
    assert whole.components.tolist() == one.components.tolist()
    scale = np.array([256, 1024, 2**18])
    assert whole.faces.tolist() == (one.faces * scale).tolist()
    assert whole.border_faces.tolist() == (one.border_faces * scale).tolist()
    assert whole.low.tolist() == (one.low * (1024, 256, 1)).tolist()
    assert whole.high.tolist() == (one.high * (1024, 256, 1) + (1023, 255, 0)).tolist()


def test_one_slice_is_an_image():
    labels = np.random.default_rng(5).integers(0, 5, (20, 30)).astype(np.uint8)
    flat, volume = measure_regions(labels), measure_regions(labels[None])
    assert volume.cells.tolist() == flat.cells.tolist()
    assert volume.faces[:, :2].sum(axis=1).tolist() == flat.faces.sum(axis=1).tolist()
    assert volume.faces[:, 2].tolist() == (2 * volume.cells).tolist()
    assert volume.components.tolist() == flat.components.tolist()
    np.testing.assert_array_equal(volume.borders, flat.borders)
    assert volume.border_faces.sum(axis=1).tolist() == flat.border_faces.sum(axis=1).tolist()
    np.testing.assert_array_equal(vorotool.voronoi_diagram(labels[None])[0], vorotool.voronoi_diagram(labels))


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


def test_every_site_has_a_row_with_seeds():
    seeds = VolumeSeeds(
        np.array([[2, 0, 0], [2, 0, 0], [900, 0, 0]]),
        np.array([3, 5, 8]),
        object_volume=np.array([1, 2, 3]),
        properties={"name": ["a", "b", "c"], "volume": ["v", "w", "x"]},
    )
    volume = LabelVolume(np.full((1, 1, 6), 3, dtype=np.uint8), VoxelFrame(0, 0, 0, 6, 1, 1), seeds)
    distance2 = ((np.arange(6) - 2) ** 2)[None, None]
    table = vorotool.region_table(volume, distance2=distance2)
    assert table["label"].tolist() == [3, 5, 8]
    assert table["voro_volume"].tolist() == [6, 0, 0]
    assert table["nearest_label"].tolist() == [5, 3, 3]
    assert table["nearest_distance"].tolist() == [0.0, 0.0, 898.0]
    assert table["max_distance"].tolist() == [3.0, None, None]
    for name in ("touches_frame", *COLUMNS[-6:]):
        assert table[name].tolist()[1:] == [None, None]
    assert list(table)[-3:] == ["object_volume", "name", "volume"]
    assert "name" not in vorotool.region_table(volume, properties=False)
    half = vorotool.region_table(volume, distance2=distance2, distance_scale=2)
    assert half["max_distance"][0] == 1.5


# ---- the library --------------------------------------------------------------------------------------


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


@given(label_volumes)
@settings(max_examples=15, deadline=None)
def test_neighbors_never_share_a_color(labels):
    colors = vorotool.color_regions(LabelVolume(labels))  # an array may look like a color image
    assert colors[0] == 0
    assert (colors[np.unique(labels[labels > 0])] > 0).all()
    for (a, b), _ in expected_borders(labels):
        assert colors[a] != colors[b]
    found, again = region_colors(LabelVolume(labels), measures=measure_regions(LabelVolume(labels)))
    assert colors[found].tolist() == again.tolist()


@pytest.mark.parametrize("dtype", DTYPES)
def test_diagram_can_be_streamed(dtype):
    labels = np.random.default_rng(8).integers(0, 6, (11, 7, 9)).astype(dtype)
    whole = vorotool.voronoi_diagram(labels)
    for depth in (1, 2, 5, 11):
        slabs = []
        for first in range(0, 11, depth):
            end = min(11, first + depth)
            before = labels[first - 1] if first else None
            after = labels[end] if end < 11 else None
            slabs.append(vorotool.voronoi_diagram(labels[first:end], above=before, below=after))
        np.testing.assert_array_equal(np.concatenate(slabs), whole)


def test_diagram_into_a_given_array():
    labels = np.array([[[1, 2]]], dtype=np.uint8)
    out = np.full((1, 1, 2), 7, dtype=np.uint8)
    assert vorotool.voronoi_diagram(labels, out=out) is out
    assert out.tolist() == [[[1, 0]]]
    with pytest.raises(InputError, match="out must be a C-contiguous uint8 array"):
        vorotool.voronoi_diagram(labels, out=np.zeros((1, 2), dtype=np.uint8))
    with pytest.raises(InputError, match="the slice before has shape"):
        vorotool.voronoi_diagram(labels, above=np.zeros(3, dtype=np.uint8))


# ---- bad and odd input --------------------------------------------------------------------------------


def test_other_integer_types_and_layouts():
    labels = np.random.default_rng(2).integers(0, 4, (5, 9, 12))
    expected = expected_borders(labels)
    for other in (
        labels,
        labels.astype(">u2"),
        labels.astype(np.uint64),
        np.asfortranarray(labels.astype(np.int32)),
        labels.repeat(2, axis=2)[:, :, ::2].astype(np.int16),
        np.ma.masked_array(labels.astype(np.uint8), mask=False),
    ):
        assert borders_of(measure_regions(LabelVolume(other))) == expected
        np.testing.assert_array_equal(vorotool.voronoi_diagram(LabelVolume(other)), expected_diagram(labels))
    frozen = labels.astype(np.uint16)
    frozen.flags.writeable = False
    assert borders_of(measure_regions(frozen)) == expected


@pytest.mark.parametrize("dtype", [np.int8, np.int16, np.int32, np.int64])
def test_negative_labels_are_refused(dtype):
    labels = np.array([[[1, -4]]], dtype=dtype)
    for function in (measure_regions, region_table, neighbor_table, vorotool.color_regions):
        with pytest.raises(InputError, match="a voxel has label -4"):
            function(labels)


def test_a_label_without_site_is_named():
    seeds = VolumeSeeds(np.array([[0, 0, 0]]), np.array([1]))
    volume = LabelVolume(np.array([[[1, 1], [1, 7]]], dtype=np.uint8), None, seeds)
    for function in (region_table, neighbor_table):
        with pytest.raises(InputError, match=r"voxel \(slice 0, row 1, column 1\) has label 7"):
            function(volume)


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


def test_what_progress_raises_stops_the_work():
    labels = np.random.default_rng(1).integers(1, 60_000, (40, 300, 1000)).astype(np.uint16)
    seen = []

    def stop(fraction):
        seen.append(fraction)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        measure_regions(labels, threads=2, progress=stop)
    assert len(seen) == 1
    assert 0 <= seen[0] <= 1
