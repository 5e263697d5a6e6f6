"""Skeletons that are led on to the ends of strokes: closed forms, and made strokes with known axes."""

import numpy as np
import pytest
import shapely

import vorotool

SIZE = 128


def rectangle(length, width, angle=0.0):
    way, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    corners = [(-length, -width), (length, -width), (length, width), (-length, width)]
    return np.array([a / 2 * way + b / 2 * across for a, b in corners]), np.array([-way, way]) * length / 2


def mask(shape):
    rows, columns = np.mgrid[:SIZE, :SIZE]
    return shapely.contains_xy(shape, columns, rows)


def led_on_to(extended):
    return extended.ends[~np.isnan(extended.ends[:, :, 0])]


def stroke(random, cap, *, is_curved):
    """A stroke, and its true ends."""
    width, length = random.uniform(4, 16), random.uniform(50, 85)
    middle, angle = SIZE / 2 + random.uniform(-1, 1, 2), random.uniform(0, 2 * np.pi)
    way = np.array([np.cos(angle), np.sin(angle)])
    places = middle + np.outer(np.linspace(-length / 2, length / 2, 80), way)
    if is_curved:
        radius = random.uniform(3, 8) * width
        turn = angle + np.linspace(-length, length, 80) / (2 * radius)
        places = middle + radius * (np.stack([np.cos(turn), np.sin(turn)], axis=1) - way)
    out = np.stack([places[0] - places[1], places[-1] - places[-2]])
    out /= np.hypot(*out.T)[:, None]
    shape = shapely.LineString(places).buffer(width / 2, cap_style=cap, quad_segs=32)
    return shape, places[[0, -1]] + (out * width / 2 if cap == "round" else 0)


@pytest.mark.parametrize("angle", [0.0, 0.4, 1.1])
def test_rectangles_end_in_the_middle_of_their_ends(angle):
    corners, ends = rectangle(12, 3, angle)
    whole = vorotool.skeleton_exact(corners)
    for skeleton in (whole, vorotool.prune(whole, scale=1.5), vorotool.prune(whole, ratio=2)):
        extended = vorotool.extend_ends(skeleton)
        found = led_on_to(extended)
        np.testing.assert_allclose(found[np.lexsort(found.T)], ends[np.lexsort(ends.T)], atol=1e-6)
        assert extended.length.sum() == pytest.approx(12, abs=1e-6)
        vorotool.verify_extended(extended)


@pytest.mark.parametrize("cap", ["flat", "round"])
@pytest.mark.parametrize("is_curved", [False, True])
def test_strokes_of_masks_reach_their_ends(cap, is_curved):
    random, off, one_way = np.random.default_rng(3), [], []
    for _ in range(6):
        shape, true = stroke(random, cap, is_curved=is_curved)
        skeleton = vorotool.prune(vorotool.skeleton_exact(vorotool.outlines(mask(shape))), scale=1.5)
        extended = vorotool.extend_ends(skeleton)
        vorotool.verify_extended(extended)
        found = led_on_to(extended)
        one_way.append(len(found) == 2)
        off += [np.hypot(*(found - place).T).min() for place in true]
    assert all(one_way)
    assert np.mean(off) < (0.75 if is_curved else 0.6)  # what leads on is straight
    assert np.quantile(off, 0.9) < 1.25


@pytest.mark.parametrize("is_curved", [False, True])
def test_the_stroke_is_drawn_again(is_curved):
    """With its mean width and butt caps the line covers the mask but for pixels along its outline."""
    random = np.random.default_rng(8)
    for _ in range(6):
        shape, _ = stroke(random, "flat", is_curved=is_curved)
        pixels = mask(shape)
        skeleton = vorotool.prune(vorotool.skeleton_exact(vorotool.outlines(pixels)), scale=1.5)
        extended = vorotool.extend_ends(skeleton)
        (line,) = extended.to_shapely(flatten=0.1)
        again = mask(line.buffer(extended.width_mean[0] / 2, cap_style="flat"))
        outline = shape.length
        assert np.count_nonzero(again != pixels) < 0.5 * outline


def test_the_checker_finds_faults():
    extended = vorotool.extend_ends(vorotool.skeleton_exact([[0, 0], [6, 0], [6, 2], [3, 1.8], [0, 2]]))
    vorotool.verify_extended(extended)
    ends = extended.ends.copy()
    ends[0, 0] = [0.0, 1.5]
    wrong = vorotool.ExtendedSkeleton(extended.path, ends + 0.25)
    with pytest.raises(vorotool.VerificationError, match="which is not on the boundary"):
        vorotool.verify_extended(wrong)
    with pytest.raises(vorotool.InputError, match=r"ends must have shape \(1, 2, 2\)"):
        vorotool.ExtendedSkeleton(extended.path, ends[:0])
