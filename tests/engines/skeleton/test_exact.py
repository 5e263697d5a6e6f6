"""Skeletons: known shapes, random ones through the checker, and what must not change them."""

import warnings
from dataclasses import replace
from math import sqrt
from pathlib import Path

import numpy as np
import pytest

import vorotool
from fuzz.skeletons import failure
from support.families.skeleton_shapes import under_symmetries
from support.few import few
from vorotool.engines.offsets.verify_offsets import verify_offsets
from vorotool.engines.skeleton.shortened_edges import element_diagram, exact_for, gap_deviation
from vorotool.errors import InputError, UsageError, VerificationError, VorotoolWarning
from vorotool.types.box import default_frame
from vorotool.types.skeleton.skeleton import EXTERIOR, INTERIOR

DATA = Path(__file__).parents[3] / "data"


def skeleton_of(shape, **options):
    """Compute a skeleton and check it; what is repaired is not told."""
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        made = vorotool.skeleton_exact(shape, **options)
    vorotool.verify_skeleton(made)
    return made


def places(skeleton, digits=9):
    return sorted((round(x, digits), round(y, digits), round(r, digits)) for (x, y), r in zip(
        skeleton.vertices.tolist(), skeleton.radius.tolist(), strict=True))  # fmt: skip


# ---- shapes whose skeletons are known ----


def test_a_square_has_its_diagonals():
    square = skeleton_of([[0, 0], [4, 0], [4, 4], [0, 4]])
    assert places(square) == [(0, 0, 0), (0, 4, 0), (2, 2, 2), (4, 0, 0), (4, 4, 0)]
    assert square.length.tolist() == [sqrt(8)] * 4
    assert square.polygon.tolist() == [0] * 4
    assert square.side.tolist() == [INTERIOR] * 4
    assert len(np.unique(square.branch)) == 4


# ---- outside, and open lines ----


def test_outside_ends_on_the_frame():
    two = [[[0, 0], [2, 0], [2, 2], [0, 2]], [[6, 0], [8, 0], [8, 2], [6, 2]]]
    made = skeleton_of(two, side="exterior")
    assert made.frame == pytest.approx((-0.8, -0.8, 9.6, 3.6))
    assert np.count_nonzero(made.on_frame) == 2
    assert (made.vertices[:, 0] == 4).all()
    assert (made.side == EXTERIOR).all()
    assert (made.polygon == -1).all()
    cut = skeleton_of(two, side="exterior", frame=(3, 0.5, 2, 1))
    assert places(cut) == [(4, 0.5, 2), (4, 1.5, 2)]
    assert len(skeleton_of(two, side="exterior", frame=(100, 100, 1, 1))) == 0


def test_a_parabola_is_cut_into_pieces():
    made = skeleton_of([{"line": [[-10, 0], [10, 0]]}, {"line": [[0, 2]]}], side="exterior", frame=(-4, 0, 8, 1.25))
    assert np.count_nonzero(made.is_parabola) == 1
    x = sorted(made.vertices[:, 0].tolist())
    assert x == pytest.approx([-1, 1], abs=1e-12)  # y = (x^2 + 4) / 4
    cut = skeleton_of([{"line": [[-10, 0], [10, 0]]}, {"line": [[0, 2]]}], side="exterior", frame=(-4, 1.25, 8, 9))
    assert len(cut) == 2


def test_no_polygons_at_all():
    with pytest.warns(VorotoolWarning, match="no polygons"):
        assert len(vorotool.skeleton_exact([])) == 0


# ---- random shapes ----


@pytest.mark.parametrize(
    "name", few(["shape.json", "two-shapes.json", "ne_110m_lakes.geojson", "great-lakes.geojson"], 2)
)
def test_shapes_of_data_under_the_symmetries_of_the_square(name):
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        assert [failure(turned) for turned in under_symmetries(vorotool.read(DATA / name))] == [None] * 8


# ---- relations ----


# ---- the whole diagram, and gaps ----


def test_a_gap_moves_a_bisector_by_its_square_over_16_r():
    """The paper calls its skeleton exact; at a reflex corner it is off by s^2 / (16 r)."""
    shape = [[0, 0], [80, 0], [80, 30], [50, 30], [50, 20], [30, 20], [30, 30], [0, 30]]
    exact = skeleton_of(shape)
    under_the_wall = (exact.vertices[:, 0] > 30) & (exact.vertices[:, 0] < 50)
    assert (exact.vertices[under_the_wall, 1] == 10).all()
    for gap in (0.5, 1.0, 2.0):
        made = skeleton_of(shape, gap=gap)
        in_the_gap = np.abs(made.vertices[:, 0] - (30 + gap / 2)) < 1e-6
        shift = gap**2 / (16 * 10)
        assert (made.vertices[in_the_gap, 1] - 10).tolist() == pytest.approx([shift], rel=1e-6)
        assert gap_deviation(made, exact) > 0.99 * shift


def test_a_gap_leaves_the_corners_out():
    shape = vorotool.read(DATA / "two-shapes.json")
    exact, complete = skeleton_of(shape), skeleton_of(shape, gap=4)
    open_ends = skeleton_of(shape, gap=4, complete=False)
    ends = [np.count_nonzero((made.radius == 0) & (made.degree == 1)) for made in (exact, complete, open_ends)]
    assert ends[0] == ends[1] > 0
    assert ends[2] == 0
    assert len(complete) == len(open_ends) + ends[1]
    assert np.isnan(complete.error_bound).all()


def test_an_edge_that_a_gap_would_remove_is_named():
    with pytest.raises(InputError, match=r"polygon 1, shell, edge 2 from \(8\.0, 0\.0\) to \(8\.0, 3\.0\) is 3 long"):
        vorotool.skeleton_exact([[0, 0], [8, 0], [8, 3], [0, 9]], gap=1.5)


def test_the_exact_one_of_elements():
    shape = vorotool.read(DATA / "two-shapes.json")
    plain = vorotool.skeleton_exact(shape)
    again = exact_for(element_diagram(shape, 4), "interior")
    assert np.array_equal(plain.vertices, again.vertices)


def test_strict_refuses_repairs_and_other_sides_are_refused():
    with pytest.raises(UsageError, match="interior"):
        vorotool.skeleton_exact([[0, 0], [1, 0], [0, 1]], side="inner")
    with pytest.raises(InputError, match="crosses"):
        vorotool.skeleton_exact([[0, 0], [4, 4], [4, 0], [0, 4]], strict=True)


def test_the_frame_of_nothing_and_of_a_place():
    assert default_frame(vorotool.skeleton_exact({"line": [[3, 4]]}, side="exterior").polygons) == (2, 3, 2, 2)


def test_a_corner_of_nearly_180_degrees_is_joined_too():
    shape = [[0, 0], [10, -0.5], [20, 0], [20, 10], [0, 10]]
    for made in (skeleton_of(shape), skeleton_of(shape, gap=1)):
        corners = made.vertices[made.radius == 0]
        assert sorted(map(tuple, corners.tolist())) == sorted(map(tuple, shape))
    assert len(skeleton_of([[0, 0], [9, 0], [9, 9], [0, 9]], gap=1, side="exterior")) == 0


WITH_FAR_HOLES = {"shell": [[0, 0], [80, 0], [72, 60], [0, 56]], "holes": [[[20, 20], [20, 44], [50, 2**32]]]}


def quietly(make, *arguments, **options):
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):  # the hole is cut off
        return make([WITH_FAR_HOLES], *arguments, **options)


@pytest.mark.parametrize("features", ["separate", "together"])
@pytest.mark.parametrize("side", ["interior", "both"])
@pytest.mark.parametrize("gap", [0, 1])
def test_skeletons_are_right(features, side, gap):
    skeleton = quietly(vorotool.skeleton_exact, features=features, side=side, gap=gap)
    vorotool.verify_skeleton(skeleton)
    radius = skeleton.radius.copy()
    radius[radius.argmax()] += 2.0**-15 if gap == 0 else 8.0  # 64 times what 2^31 is rounded by; two steps
    with pytest.raises(VerificationError):
        vorotool.verify_skeleton(replace(skeleton, radius=radius))


@pytest.mark.parametrize("features", ["separate", "together"])
@pytest.mark.parametrize("distances", [[-1], [1, -1]])
def test_offsets_are_right(features, distances):
    offsets = quietly(vorotool.offset, distances, features=features)
    verify_offsets(offsets, distances=distances)
