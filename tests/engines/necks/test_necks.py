"""Necks: closed forms, brute force in fractions, and what must not change them."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

import vorotool
from vorotool import UsageError, VerificationError, necks, skeleton_exact, verify_necks

DUMBBELL = [[0, 0], [4, 0], [4, 1.5], [7, 1.5], [7, 0], [12, 0], [12, 6], [7, 6], [7, 2.5], [4, 2.5], [4, 4], [0, 4]]


def rooms(*parts):
    """Rectangles in a row, each of a length and a height, around y = 0."""
    x, upper = 0.0, []
    for length, height in parts:
        upper += [[x, height / 2], [x + length, height / 2]]
        x += length
    return [*upper, *([x, -y] for x, y in reversed(upper))]


def test_dumbbell_of_rectangles():
    found = necks(DUMBBELL)
    assert found.feet.tolist() == [[[5.5, 1.5], [5.5, 2.5]]]
    assert (found.xy.tolist(), found.width.tolist()) == ([[5.5, 2.0]], [1.0])
    assert (found.beside.tolist(), found.ratio.tolist()) == ([[2.0, 2.5]], [0.25])
    table = found.table()
    assert [table[name][0] for name in ("kind_a", "ring_a", "index_a", "kind_b", "index_b")] == [
        "edge",
        0,
        2,
        "edge",
        8,
    ]


def test_of_equally_narrow_necks_the_first_counts_as_narrower():
    found = necks(rooms((10, 10), (5, 2), (6, 6), (5, 2), (12, 12)))
    assert found.width.tolist() == [2, 2]
    assert found.beside.tolist() == [[5, 6], [3, 6]]


def test_a_skeleton_gives_the_same_and_others_are_refused():
    skeleton = skeleton_exact(DUMBBELL)
    assert necks(skeleton) == necks(DUMBBELL)
    for wrong in (
        vorotool.prune(skeleton, angle=100),
        skeleton_exact(DUMBBELL, side="both"),
        skeleton_exact(DUMBBELL, gap=0.1),
        vorotool.skeleton_approx(DUMBBELL, step=0.5),
    ):
        with pytest.raises(UsageError, match="whole skeleton inside polygons"):
            necks(wrong)


@pytest.mark.filterwarnings("ignore")
def test_nothing_inside_has_no_necks():
    found = necks([{"line": [[0, 0], [4, 4]]}])
    assert (len(found), repr(found)) == (0, "Necks: 0 necks of 1 polygon")
    verify_necks(found)


def test_where_pixels_hang_together_at_a_corner_there_is_no_neck():
    image = np.zeros((6, 6), dtype=np.uint8)
    image[:3, :3] = image[3:, 3:] = 1
    assert len(necks(vorotool.outlines(image, connectivity=8))) == 0


def bend(radius, width, facets, *, rooms=False):
    """A quarter of a ring of constant width, with or without a room at each end."""
    turn = np.linspace(0, np.pi / 2, facets + 1)
    way = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    ring = np.concatenate([way * (radius + width / 2), way[::-1] * (radius - width / 2)])
    shape = shapely.Polygon(ring)
    if rooms:
        boxes = shapely.box(radius - 3, -6, radius + 3, 0.5), shapely.box(-7, radius - 4, 0.5, radius + 4)
        shape = shapely.union_all([shape, *boxes])
    return shape


@pytest.mark.parametrize("facets", [5, 12, 40])
def test_bends_of_constant_width_have_no_necks_but_rooms_at_their_ends_make_one(facets):
    plain = bend(20.0, 2.0, facets)
    everything = necks(plain, neck=1)
    assert len(everything) >= facets - 2
    assert everything.ratio.min() > 0.96
    assert len(necks(plain)) == 0
    between = necks(bend(20.0, 2.0, facets, rooms=True))
    assert len(between) == 1
    assert between.beside[0] == pytest.approx([3, 3.5], rel=0.2)


def test_listed_necks_are_those_of_at_most_the_ratio():
    line = np.random.default_rng(4).uniform(0, 100, (6, 2))
    shape = shapely.LineString(line).buffer(4, quad_segs=3) | shapely.MultiPoint(line[:3]).buffer(7.3)
    whole = necks(shape, neck=1)
    assert len(whole) > len(necks(shape, neck=0.6)) > 0
    for neck in (0.3, 0.6, 0.95, 0.99):
        assert necks(shape, neck=neck) == whole.taken(whole.ratio <= neck)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("feet", np.full((1, 2, 2), 1.0), "its foot"),
        ("width", np.array([3.0]), "its feet are"),
        ("xy", np.array([[5.0, 2.0]]), "not in the middle"),
        ("beside", np.array([[3.0, 2.0]]), "the clearances are"),
    ],
)
def test_faults_are_found(name, value, message):
    found = necks(DUMBBELL)
    with pytest.raises(VerificationError, match=message):
        verify_necks(replace(found, **{name: value}))


def test_a_cut_across_what_is_nearer_is_found():
    found = necks(DUMBBELL)
    table = found.skeleton.site_table
    sites = [np.flatnonzero((table.kind == 1) & (table.index == index))[0] for index in (0, 10)]
    feet = np.array([[[2.0, 0.0], [2.0, 4.0]]])
    moved = replace(found, feet=feet, sites=np.array([sites]), xy=feet.mean(axis=1), width=np.array([4.0]))
    verify_necks(moved)  # as wide as the room
    feet = np.array([[[1.0, 0.0], [1.0, 4.0]]])
    with pytest.raises(VerificationError, match="the boundary is 1"):
        verify_necks(replace(moved, feet=feet, xy=feet.mean(axis=1)))
