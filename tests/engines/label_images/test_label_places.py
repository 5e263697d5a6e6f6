"""Names and colors of regions, compared with a distance transform and with neighborhoods."""

import numpy as np
import pytest
import shapely
from scipy import ndimage
from skimage.measure import find_contours

import vorotool
from support.few import few
from support.oracles.outline_oracle import (
    all_masks,
    numbered_objects,
    pixel_sides,
    random_labels,
    ring_areas,
    unit_sides,
)
from vorotool import tessellate
from vorotool.engines.label_images.outlines import gray_level, outlines
from vorotool.engines.label_images.regions import label_places, measure_regions, name_places, object_colors
from vorotool.engines.tessellation.seeding import seeds_from_raster
from vorotool.errors import LimitError, UsageError
from vorotool.types.images import LabelImage
from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.polygons.polygon_set import HOLE
from vorotool.types.polygons.shapely_geometry import to_shapely


def blocks(seed):
    rng = np.random.default_rng(seed)
    return rng.integers(0, 5, (6, 8)).repeat(rng.integers(3, 9), axis=0).repeat(rng.integers(3, 9), axis=1)


@pytest.mark.parametrize("seed", range(8))
def test_no_pixel_is_deeper_inside(seed):
    image = blocks(seed)
    labels, places, radius = label_places(LabelImage(image))
    assert labels.tolist() == np.unique(image[image > 0]).tolist()
    for label, (column, row), found in zip(labels.tolist(), places.tolist(), radius.tolist(), strict=True):
        region = np.pad(image == label, 1)
        inner = ndimage.binary_erosion(region)
        outermost = (region & ~inner)[1:-1, 1:-1]
        everywhere = ndimage.distance_transform_edt(~outermost) * (image == label)
        assert image[row, column] == label
        assert found == everywhere[row, column] == everywhere.max()


def test_the_middle_of_a_bar_and_the_larger_of_two_pieces():
    image = np.zeros((12, 30), np.uint16)
    image[1:6, 2:25] = 9
    image[8:11, 3:6] = 9
    labels, places, radius = label_places(LabelImage(image))
    assert (labels.tolist(), places.tolist(), radius.tolist()) == ([9], [[13, 3]], [2.0])


def test_thin_regions_and_none():
    assert label_places(LabelImage(np.array([[4, 4, 4, 0]])))[1].tolist() == [[1, 0]]
    assert len(label_places(LabelImage(np.zeros((3, 3), np.uint8)))[0]) == 0


def test_objects_are_named_where_they_are():
    """Pixels of objects, centroids that share a pixel, and an object that has no pixel of its own."""
    mask = np.zeros((30, 40), np.uint8)
    mask[2:7, 3:8] = 255
    mask[20:29, 30:33] = 255
    made = tessellate(seeds_from_raster(mask))
    assert name_places(made)[1].tolist() == [[5, 4], [31, 24]]
    assert label_places(made)[1].tolist() != [[5, 4], [31, 24]]
    near = SeedSet(np.array([9, 11, 60]), np.array([8, 8, 60]), np.array([4, 2, 9]), scale=2, frame=Frame(0, 0, 40, 40))
    labels, places = name_places(tessellate(near))
    assert labels.tolist() == [2, 4, 9]
    assert places[[0, 2]].tolist() == [[6, 4], [30, 30]]
    points = tessellate([[5, 5], [30, 20]], shape=(30, 40))
    assert name_places(points)[1].tolist() == label_places(points)[1].tolist()


def scattered(seed, largest=2**32 - 1):
    rng = np.random.default_rng(seed)
    image = np.zeros((60, 70), np.uint32)
    for label in rng.integers(1, largest, 25):
        x, y, w, h = rng.integers(0, 60), rng.integers(0, 50), rng.integers(1, 9), rng.integers(1, 9)
        image[y : y + h, x : x + w] = label
    return image


@pytest.mark.parametrize("seed", range(6))
def test_neighbors_differ_across_the_background(seed):
    image = scattered(seed)
    labels, colors = object_colors(LabelImage(image))
    assert labels.tolist() == np.unique(image)[1:].tolist()
    of = dict(zip(labels.tolist(), colors.tolist(), strict=True))
    influence = vorotool.tessellate(vorotool.seeds_from_raster(image, mode="labels"))
    measures = measure_regions(influence)
    pairs = measures.labels[measures.borders]
    assert len(pairs)
    assert all(of[a] != of[b] for a, b in pairs.tolist())
    assert len(set(colors.tolist())) > 1


# ---- Outlines of masks and label images against pixel sides one by one, scikit-image's contours, and areas ----
RANDOM = [random_labels(np.random.default_rng(seed)) for seed in range(24)]
IMAGES = [all_masks(3, 4), all_masks(4, 3), *(image for image in RANDOM if image.any())]


def check_crack(made, labels, connectivity):
    """Sides, areas and directions of rings, their first vertices; with 4-connectivity that they are valid polygons."""
    objects, _ = numbered_objects(labels, connectivity)
    assert np.array_equal(unit_sides(made), pixel_sides(objects))
    rings, areas = ring_areas(made)
    assert np.array_equal(areas, np.bincount(objects.ravel())[1:])
    assert np.array_equal(rings < 0, made.ring_kind == HOLE)
    place = made.xy[:, 1] * 1000 + made.xy[:, 0]
    assert np.array_equal(place[made.ring_starts[:-1]], np.minimum.reduceat(place, made.ring_starts[:-1]))
    if connectivity == 4:
        assert shapely.is_valid(to_shapely(made)).all()


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("index", few([0, 1], 1))
def test_crack_outlines_of_all_small_masks(index, connectivity):
    """All masks of 3 x 4 pixels and of 4 x 3, in one image."""
    mask = IMAGES[index]
    made = outlines(mask, mode="components", connectivity=connectivity)
    assert made.ids == list(range(1, len(made) + 1))
    check_crack(made, mask, connectivity)
    if connectivity == 8:  # the background falls into holes and what is around all
        outside, _ = numbered_objects(np.pad(1 - mask, 1, constant_values=1), 4)
        assert np.count_nonzero(made.ring_kind == HOLE) == outside.max() - 1


def test_a_view_with_strides():
    image = np.zeros((6, 8), dtype=np.uint8)
    image[::2, ::2] = 1
    assert ring_areas(outlines(image[::2, ::2], mode="labels"))[1].tolist() == [12]


# ---- contours ----


def as_sets(rings):
    """Rings as sets of vertices, each with its neighbors' mean: which way they run does not matter."""
    return sorted(sorted(map(tuple, np.round(ring, 9).tolist())) for ring in rings)


def skimage_rings(values, level, connectivity, fill):
    padded = np.pad(values.astype(float), 1, constant_values=fill)
    found = find_contours(padded, level, fully_connected="high" if connectivity == 8 else "low")
    return [ring[:-1, ::-1] - 1 for ring in found]


def straightened(ring):
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    return ring[before[:, 0] * after[:, 1] != before[:, 1] * after[:, 0]]


@pytest.mark.parametrize("connectivity", [4, 8])
def test_contours_of_masks_are_those_of_scikit_image(connectivity):
    for image in (all_masks(3, 3), *RANDOM):
        mask = image == image.max()
        made = outlines(mask, outline="contour", connectivity=connectivity)
        expected = [straightened(ring) for ring in skimage_rings(mask, 0.5, connectivity, 0)]
        assert as_sets(map(made.ring, range(len(made.ring_kind)))) == as_sets(expected)
        assert made.connectivity is None
        rings, areas = ring_areas(made)
        assert np.array_equal(rings < 0, made.ring_kind == HOLE)
        assert (areas > 0).all()


@pytest.mark.parametrize("connectivity", [4, 8])
@pytest.mark.parametrize("invert", [False, True])
@pytest.mark.parametrize("dtype", [np.uint8, np.float64])
def test_contours_of_grey_values_are_those_of_scikit_image(connectivity, invert, dtype):
    """In a frame that is copied from the image's own border, so that both go straight to it."""
    for seed in range(10):
        random = np.random.default_rng(seed)
        values = random.integers(0, 40, random.integers(2, 20, 2)).astype(dtype)
        threshold = 20 if dtype == np.uint8 else 20.5
        made = outlines(values, outline="contour", threshold=threshold, invert=invert, connectivity=connectivity)
        level = gray_level(values, threshold)
        sign = -1 if invert else 1
        found = find_contours(
            sign * values.astype(float), sign * level, fully_connected="high" if connectivity == 8 else "low"
        )
        inner = sorted(tuple(v) for ring in found for v in np.round(ring[:, ::-1], 9).tolist())
        mine = np.round(made.xy, 9)
        border = ((mine == -0.5) | (mine == np.array(values.shape[::-1]) - 0.5)).any(axis=1)
        assert sorted(map(tuple, mine[~border].tolist())) == sorted(set(inner))
        vorotool.planar_graph(made, strict=True)
        mask = values <= threshold if invert else values > threshold
        assert len(made) == numbered_objects(mask.astype(np.uint8), connectivity)[0].max()


@pytest.mark.parametrize("connectivity", [4, 8])
def test_contours_of_labels_meet_without_crossing(connectivity):
    for image in RANDOM:
        if not image.any():
            continue
        made = outlines(image, mode="labels", outline="contour", connectivity=connectivity)
        graph = vorotool.planar_graph(made, strict=True)
        assert max(len(graph.polygons_of(face)) for face in range(graph.faces)) <= 1
        assert set(made.ids) == set(np.unique(image[image > 0]).tolist())


# ---- fewer vertices ----


@pytest.mark.parametrize("outline", ["crack", "contour"])
@pytest.mark.parametrize("connectivity", [4, 8])
def test_simplified_outlines_keep_faces_and_borders(outline, connectivity):
    for image in RANDOM[::8]:
        if not image.any():
            continue
        options = {"mode": "labels", "outline": outline, "connectivity": connectivity}
        given = outlines(image, **options)
        faces = faces_of(vorotool.planar_graph(given, strict=True))
        for tolerance in (0.5, 0.8, 2, 10):
            made = outlines(image, simplify=tolerance, **options)
            assert faces_of(vorotool.planar_graph(made, strict=True)) == faces
            assert (made.ids, made.connectivity) == (given.ids, given.connectivity)
            assert len(made.xy) <= len(given.xy)
            assert np.array_equal(np.sign(ring_areas(made)[0]), np.sign(ring_areas(given)[0]))
            assert farthest(given, made) <= tolerance * (1 + 1e-12)


def faces_of(graph):
    return sorted(tuple(graph.polygons_of(face).tolist()) for face in range(graph.faces))


def farthest(given, made):
    """How far vertices of rings are from the simplified rings."""
    most = 0.0
    for ring in range(len(given.ring_kind)):
        lines = shapely.linearrings(made.ring(ring))
        most = max(most, float(shapely.distance(shapely.points(given.ring(ring)), lines).max()))
    return most


def test_lines_keep_their_ends():
    line = vorotool.PolygonSet([[0, 0], [1, 0.1], [2, 0], [2, 0], [2, 5], [2.1, 6], [2, 9]], [0, 3, 7], [2, 2], [0, 1])
    made = vorotool.engines.label_images.outlines.simplified_polygons(line, 0.5)
    assert [ring.tolist() for ring in map(made.ring, (0, 1))] == [[[0, 0], [2, 0]], [[2, 0], [2, 9]]]
    dot = vorotool.PolygonSet([[0, 0], [5, 5], [9, 9.1], [9, 13]], [0, 1, 4], [2, 2], [0, 1])
    again = vorotool.engines.label_images.outlines.simplified_polygons(dot, 1)
    assert [ring.tolist() for ring in map(again.ring, (0, 1))] == [[[0, 0]], [[5, 5], [9, 9.1], [9, 13]]]


# ---- what is refused ----


def test_options_that_are_none():
    mask = np.eye(3, dtype=bool)
    for options, words in (
        ({"outline": "smooth"}, "crack, contour"),
        ({"mode": "pixels"}, "components, labels"),
        ({"connectivity": 6}, "4 or 8"),
        ({"simplify": -1.0}, "0 or more"),
    ):
        with pytest.raises(UsageError, match=words):
            outlines(mask, **options)


def test_too_many_vertices_are_refused_before_they_are_made():
    with pytest.raises(LimitError, match="14 vertices, more than max_sites=10"):
        outlines(np.eye(4, dtype=bool) | np.eye(4, k=1, dtype=bool), max_sites=10)


@pytest.mark.parametrize("connectivity", [4, 8])
def test_bands_of_lines_are_joined(connectivity):
    """In a wide image each line is a band of its own; a narrow one is done at once."""
    narrow = np.random.default_rng(connectivity).integers(0, 3, (40, 60)).astype(np.uint8)
    narrow[:, -7:-5] = 1  # a crack through all bands, with holes beside it
    wide = np.zeros((40, 1 << 19), dtype=np.uint8)
    wide[:, :60] = narrow
    expected = outlines(narrow, connectivity=connectivity, mode="labels")
    for threads in (1, 2):
        made = outlines(wide, connectivity=connectivity, mode="labels", threads=threads)
        for name in ("xy", "ring_starts", "ring_kind", "ring_polygon"):
            assert np.array_equal(getattr(made, name), getattr(expected, name))
        assert made.ids == expected.ids
