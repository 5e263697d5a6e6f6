"""Skeletons of what an image cuts: against images that go on, and closed forms."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import shapely
from scipy import ndimage

from support.few import few
from support.oracles.rotation_oracle import Pair, Rotation, fault
from vorotool import outlines, skeleton_exact, verify_skeleton
from vorotool.convert.polygons import as_polygons
from vorotool.errors import InputError, UsageError, VerificationError, VorotoolWarning


def opened(mask, **options):
    height, width = np.asarray(mask).shape
    return skeleton_exact(outlines(np.asarray(mask), **options), border=(-0.5, -0.5, width, height))


def going_on(mask, **options):
    """The arcs in the image of the skeleton of an image whose outermost pixels go on far beyond it."""
    height, width = mask.shape
    far = 2 * (height + width)
    made = skeleton_exact(outlines(np.pad(mask, far, mode="edge"), **options))
    lines = shapely.transform(made.to_shapely(by="branch", flatten=1e-6), lambda xy: xy - far)
    window = shapely.box(-0.5, -0.5, width - 0.5, height - 0.5)
    parts = shapely.intersection(lines, window)
    return shapely.union_all(parts[shapely.length(parts) > 1e-9])


def blobs(seed, height=11, width=13, sigma=1.2):
    noise = ndimage.gaussian_filter(np.random.default_rng(seed).random((height, width)), sigma)
    return noise > np.median(noise)


def quietly(make, *arguments, **options):
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        return make(*arguments, **options)


@pytest.mark.parametrize("seed", few(range(6), 1))
@pytest.mark.parametrize("options", [{"connectivity": 4}, {"connectivity": 8}, {"outline": "contour"}])
def test_as_if_the_image_went_on(seed, options):
    mask = blobs(seed)
    if options.get("outline"):
        options = {**options, "border": "open"}
    made = quietly(opened, mask, **options)
    verify_skeleton(made)
    expected = going_on(mask, **{key: value for key, value in options.items() if key != "border"})
    if not len(made):
        assert expected.length < 1e-6
        return
    lines = shapely.union_all(made.to_shapely(by="branch", flatten=1e-6))
    assert shapely.hausdorff_distance(lines, expected) < 1e-4
    assert lines.length == pytest.approx(expected.length, abs=1e-3)


@pytest.mark.parametrize("seed", few(range(10), 3))
def test_labels_each_by_itself(seed):
    labels = np.random.default_rng(seed).integers(0, 4, (4, 5)).repeat(4, axis=0).repeat(4, axis=1)
    made = quietly(opened, labels, mode="labels")
    verify_skeleton(made)
    height, width = labels.shape
    ids = np.array(made.polygons.ids)
    for label in np.unique(labels[labels > 0]):
        alone = quietly(
            skeleton_exact, outlines(labels * (labels == label), mode="labels"), border=(-0.5, -0.5, width, height)
        )
        own = made.length[ids[made.polygon] == label]
        assert sorted(own) == pytest.approx(sorted(alone.length), rel=1e-12)


@pytest.mark.parametrize("seed", few(range(20)))
def test_polygons_that_are_cut(seed):
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.random(12)) * 2 * np.pi
    star = shapely.make_valid(
        shapely.Polygon(np.column_stack([np.cos(angle), np.sin(angle)]) * rng.uniform(4, 12, (12, 1)))
    )
    cut = shapely.set_precision(shapely.intersection(star, shapely.box(-5, -4, 5, 6)), 2.0**-12)
    made = quietly(skeleton_exact, cut, border=(-5, -4, 10, 10))
    verify_skeleton(made)
    assert ((made.vertices >= [-5, -4]) & (made.vertices <= [5, 6])).all()


def test_what_is_refused():
    square = [[0, 0], [4, 0], [4, 4], [0, 4]]
    with pytest.raises(InputError, match=r"\(4.0, 0.0\) is beyond the border"):
        skeleton_exact(square, border=(0, 0, 3, 4))
    for more in ({"side": "both"}, {"features": "together"}, {"gap": 0.1}):
        with pytest.raises(UsageError, match="an open border applies to the interior"):
            skeleton_exact(square, border=(0, 0, 4, 4), **more)
    with pytest.raises(UsageError, match="the border is"):
        skeleton_exact(square, border=(0, 0, 0, 4))


def test_faults_are_found():
    mask = np.zeros((20, 24), dtype=bool)
    mask[5:9] = mask[:, 10:14] = True
    made = opened(mask)
    verify_skeleton(made)
    kept = made.branch != made.branch[np.flatnonzero(made.on_frame[made.arcs].any(axis=1))[0]]
    less = replace(
        made,
        **{name: getattr(made, name)[kept] for name in ("arcs", "control", "sites", "polygon", "side", "length")},
        branch=np.unique(made.branch[kept], return_inverse=True)[1],
        error_bound=made.error_bound[kept],
    )
    used, arcs = np.unique(less.arcs, return_inverse=True)
    less = replace(less, arcs=arcs.reshape(-1, 2), vertices=made.vertices[used], radius=made.radius[used])
    with pytest.raises(VerificationError):
        verify_skeleton(less)


# ---- rotated shapes: see `support.oracles.rotation_oracle` ----
COMB = as_polygons(
    [[0, 0], [30, 0], [30, 6], [26, 6], [26, 12], [24, 12], [24, 6], [6, 6], [6, 9], [4, 9], [4, 6], [0, 6]]
)


def test_larger_moves_and_other_radii_are_found():
    pair = Pair(COMB, Rotation(10))
    assert fault(pair, {}) is None
    right = pair.second
    away = np.array([100 * pair.move, 0])
    for changed in ({"vertices": right.vertices + away}, {"radius": right.radius * (1 + 1e-6)}):
        pair.second = replace(right, **changed)
        assert fault(pair, {}) is not None


@pytest.mark.filterwarnings("ignore:1 polygon has its vertices at one or two")
def test_features_that_overlap_are_compared_one_by_one():
    """What is nearest to a place inside a feature is its own border, though another one runs between."""
    pair = Pair(as_polygons([COMB.xy, [[3, -2], [9, -2], [9, 20]], [[7, 1], [8, 2]]]), Rotation(10))
    assert fault(pair, {}) is None
    right = pair.second
    for feature in (0, 1):
        radius = right.radius.copy()
        radius[np.unique(right.arcs[right.polygon == feature])] *= 1 + 1e-6
        pair.second = replace(right, radius=radius)
        assert fault(pair, {}) is not None


def test_a_quarter_turn_moves_nothing():
    """Whole numbers stay whole."""
    pair = Pair(COMB, Rotation(90), step=1.0)
    assert np.array_equal(np.sort(pair.first.radius), np.sort(pair.second.radius))
    assert np.sort(pair.first.length).tolist() == np.sort(pair.second.length).tolist()
