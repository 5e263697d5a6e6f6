"""Ends of centerlines and of extended skeletons: closed forms, strokes and strips with known axes."""

import numpy as np
import pytest
import shapely

import vorotool
from support.families.skeleton_shapes import crossing, star, valid
from support.families.stems import lines_of, lost
from support.families.strips import strip
from support.few import few
from vorotool.engines.centerlines.extended_ends import TIP
from vorotool.engines.centerlines.twigs import with_pruned_twigs

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


DISC = [(40, 0), (28, 28), (8, 36), (8, 80), (-8, 80), (-8, 36), (-28, 28), (-40, 0), (-28, -28), (0, -40), (28, -28)]


def extended_of(shape):
    """The pruned skeleton of a shape or a mask, and the one that is led on, which is checked."""
    polygons = vorotool.outlines(shape) if isinstance(shape, np.ndarray) else shape
    pruned = vorotool.prune(vorotool.skeleton_exact(polygons), scale=1.5)
    extended = vorotool.extend_ends(pruned)
    vorotool.verify_extended(extended, pruned)
    return pruned, extended


def test_a_ball_beyond_a_narrow_neck_is_kept():
    ball = shapely.Point(0, 0).buffer(40) | shapely.Point(58, 0).buffer(20) | shapely.box(0, -1, 58, 1)
    pruned, extended = extended_of(ball)
    assert lines_of(extended.path).distance(shapely.Point(58, 0)) < 1
    assert lost(pruned, extended) == []


def test_the_checker_notices_a_branch_that_is_missing():
    pruned = vorotool.prune(vorotool.skeleton_exact(DISC), scale=1.5)
    few = vorotool.prune(pruned, scale=TIP)
    with pytest.raises(vorotool.VerificationError, match="a branch is missing: it continues for 36 from"):
        vorotool.verify_extended(vorotool.ExtendedSkeleton(few, np.full((1, 2, 2), np.nan)), pruned)


def oblique_stroke(step):
    """60 rows of 16 pixels, shifted by a step a row."""
    mask = np.zeros((60, 20 + 60), dtype=bool)
    for row in range(60):
        first = int(row * step) if step > 0 else int(60 + row * step)
        mask[row, first : first + 16] = True
    return mask


def line_of(mask, **options):
    return vorotool.centerline(vorotool.prune(vorotool.skeleton_exact(vorotool.outlines(mask)), scale=1.5), **options)


@pytest.mark.parametrize("step", [0, 0.1, 0.15, 0.2, 0.25, 0.5, 1, -0.1, -0.15, -0.2, -0.25, -0.5, -1])
def test_a_stroke_ends_in_the_middle_of_its_cut(step):
    mask = oblique_stroke(step)
    places = line_of(mask).flattened(0.01)[0]
    expected = sorted([np.flatnonzero(mask[row]).mean(), end] for row, end in ((0, -0.5), (59, 59.5)))
    assert sorted(places[[0, -1]].tolist()) == expected


def test_hooks_are_what_other_ends_have():
    assert line_of(oblique_stroke(1)).length[0] < line_of(oblique_stroke(1), ends="corner").length[0]


def skeletons(made):
    """The skeleton of a strip, and a pruned one."""
    whole = vorotool.skeleton_exact(made.ring)
    return whole, vorotool.prune(whole, scale=1.3)


@pytest.mark.parametrize("seed", few(range(40), 10))
def test_strips_end_in_the_middle_of_their_ends(seed):
    random, made = np.random.default_rng([2, seed]), None
    while made is None:  # where the sides of a strip meet it is none
        made = strip(random)
    width, true = made.width, made.axis[[0, -1]]
    for skeleton in skeletons(made):
        line = vorotool.centerline(skeleton).flattened(width / 1000)[0]
        assert max(np.hypot(*(line[[0, -1]] - end).T).min() for end in true) < 0.01 * width, made.kind
        assert shapely.LineString(line).hausdorff_distance(shapely.LineString(made.axis)) < 0.15 * width, made.kind
    extended = vorotool.extend_ends(skeleton)
    vorotool.verify_extended(extended, skeleton)
    ends = extended.ends[~np.isnan(extended.ends[:, :, 0])]
    assert max(np.hypot(*(ends - end).T).min() for end in true) < 0.01 * width, made.kind


@pytest.mark.parametrize("begin", [0.3, 1.2, 2.9, 4.4])
def test_a_bent_stroke_of_pixels_ends_in_the_middle(begin):
    y, x = np.mgrid[:200, :200] - 100.0
    angle = (np.arctan2(y, x) - begin) % (2 * np.pi)
    mask = (np.abs(np.hypot(x, y) - 70) < 8) & (angle < 3)
    found = vorotool.centerline(vorotool.skeleton_exact(vorotool.outlines(mask))).flattened(0.1)[0][[0, -1]]
    for end in (begin, begin + 3):
        assert np.hypot(*(found - 100 - 70 * np.array([np.cos(end), np.sin(end)])).T).min() < 1.5


pytestmark = pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")


def regular(count, offset):
    angle = np.arange(count) * 2 * np.pi / count
    return np.column_stack([10 * np.cos(angle), 10 * np.sin(angle)]) + offset


SHAPES = {
    **{f"{count} at {at}": regular(count, at) for count in (3, 4, 6, 32) for at in (0.0, 5e5)},
    **{
        f"{family.__name__} {k}": family(np.random.default_rng([k, 5]))
        for family in (star, crossing, valid)
        for k in range(2)
    },
}


ENDS = ["none", "corner", "middle"]
ONE_END = [(name, ENDS[(k + turn) % 3]) for turn in range(3) for k, name in enumerate(SHAPES)]


@pytest.mark.parametrize(("name", "ends"), few(ONE_END, 5))
def test_no_line_has_two_equal_points(name, ends):
    whole = vorotool.skeleton_exact(SHAPES[name])
    size = float(np.ptp(whole.polygons.xy, axis=0).max())
    for threshold in ({"scale": 1.5}, {"angle": 179}, {"chord": 2 * size}, {"length": size}):
        pruned = vorotool.prune(whole, **threshold)
        lines = vorotool.centerline(pruned, ends=ends)
        assert (shapely.length(lines.to_shapely()) > 0).all()
        assert len(lines) <= len(np.unique(pruned.polygon))


CRITERIA = [
    *({"scale": value} for value in (1.1, 1.2, 1.3, 1.42, 2.0)),
    *({"angle": value} for value in (30, 60, 90, 100, 120)),
    *({"length": value} for value in (1, 2, 2.5, 2.9)),
    *({"chord": value} for value in (1, 2, 3, 3.5)),
    *({"ratio": value} for value in (1, 1.3, 1.42, 1.6)),
]


def ends(skeleton):
    line = vorotool.centerline(skeleton).flattened(0.01)[0]
    return np.array(sorted(line[[0, -1]].round(9).tolist()))


def bar(left, right):
    """20 by 4, with ends at these degrees."""
    shifts = [4 / np.tan(np.radians(angle)) for angle in (left, right)]
    return [[0, 0], [20, 0], [20 + shifts[1], 4], [shifts[0], 4]]


@pytest.mark.parametrize(
    "polygon",
    few(
        [
            [[0, 0], [20, 0], [20, 2], [18, 4], [0, 4]],
            *(bar(left, right) for left, right in ((60, 90), (76, 104), (76, 90), (76, 76), (104, 60), (120, 90))),
        ],
        3,
    ),
    ids=str,
)
def test_ends_are_those_of_the_whole_skeleton(polygon):
    whole = vorotool.skeleton_exact([polygon])
    expected = ends(whole)
    for criterion in CRITERIA:
        assert ends(vorotool.prune(whole, **criterion)) == pytest.approx(expected, abs=0.1), criterion


def slot(edges):
    """16 by 4, with half-round ends of as many edges."""
    turns = np.linspace(-np.pi / 2, np.pi / 2, edges + 1)
    half = 2 * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    return [*np.add(half, [12, 0]).tolist(), *(-half).tolist()]


@pytest.mark.parametrize("edges", few([5, 8, 32], 2))
def test_a_slot_is_gone_through_along_the_middle(edges):
    whole = vorotool.skeleton_exact([slot(edges)])
    for criterion in ({"length": 2}, {"length": 1.99}, {"scale": 1.2}, {"angle": 60}, *CRITERIA):
        line = vorotool.centerline(vorotool.prune(whole, **criterion)).flattened(0.01)[0]
        assert np.abs(line[:, 1]).max() < 1e-7, criterion
        assert np.ptp(line[:, 0]) == pytest.approx(16, abs=0.2), criterion


def convex_polygon(random):
    """A convex hull, three times as long as wide."""
    hull = shapely.MultiPoint(random.integers(0, 4096, (int(random.integers(4, 40)), 2)) * [3, 1]).convex_hull
    return list(hull.exterior.coords)[:-1]


def drawn(skeleton):
    return shapely.MultiLineString(list(skeleton.vertices[skeleton.arcs]))


def test_what_is_added_is_what_was_pruned():
    random = np.random.default_rng(11)
    added = 0
    for _ in range(25):
        whole = vorotool.skeleton_exact([convex_polygon(random)])
        for criterion in ({"scale": 1.2}, {"angle": 100}, {"length": 500}, {"ratio": 1.5}, {"chord": 300}):
            pruned = vorotool.prune(whole, **criterion)
            if not pruned.length.sum():
                continue
            made = with_pruned_twigs(pruned)
            added += len(made) - len(pruned)
            far = shapely.distance(shapely.points(made.vertices), drawn(whole)).max()
            if not {"angle", "chord"} & set(criterion):  # these leave parts of twigs
                far = drawn(made).hausdorff_distance(drawn(whole))
            assert far < 1e-3
    assert added > 400
