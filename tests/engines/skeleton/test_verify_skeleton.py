"""The checker of skeletons finds what is wrong."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import vorotool
from support.families.skeleton_shapes import FAMILIES, small
from support.few import few
from vorotool import VerificationError, skeleton_approx, verify_skeleton
from vorotool.convert.polygons import as_polygons
from vorotool.engines.skeleton.exact import shape_diagram
from vorotool.engines.skeleton.verify_skeleton import verify_exterior
from vorotool.types.skeleton.skeleton import EXTERIOR

SHAPES = vorotool.read(Path(__file__).parents[3] / "data" / "two-shapes.json")
RIGHT = vorotool.skeleton_exact(SHAPES, side="both")
PER_ARC = ("arcs", "control", "sites", "polygon", "side", "branch", "length", "error_bound")


def changed(name, change):
    values = getattr(RIGHT, name).copy()
    change(values)
    return replace(RIGHT, **{name: values})


def kept(rows):
    """Without some arcs and the nodes that nothing ends at then; branches numbered again."""
    arcs = {name: getattr(RIGHT, name)[rows] for name in PER_ARC}
    nodes, arcs["arcs"] = np.unique(arcs["arcs"], return_inverse=True)
    arcs["arcs"] = arcs["arcs"].reshape(-1, 2).astype(np.int32)
    arcs["branch"] = np.unique(arcs["branch"], return_inverse=True)[1]
    return replace(RIGHT, vertices=RIGHT.vertices[nodes], radius=RIGHT.radius[nodes], **arcs)


def without_branch(number):
    return kept(RIGHT.branch != number)


def test_what_is_right_passes():
    vorotool.verify_skeleton(RIGHT)


def add(index, value):
    def change(values):
        values[index] += value

    return change


def put(index, value):
    def change(values):
        values[index] = value

    return change


END = int(RIGHT.branch[np.flatnonzero((RIGHT.radius[RIGHT.arcs[:, 0]] == 0) & (RIGHT.polygon == 0))[0]])
RING = int(np.bincount(RIGHT.branch[RIGHT.polygon == 1]).argmax())
JUNCTION = int(np.flatnonzero(RIGHT.degree == 3)[0])
PARABOLA = int(np.flatnonzero(RIGHT.is_parabola)[0])
WRONG = {
    "a node is elsewhere": (changed("vertices", add((JUNCTION, 0), 1e-6)), "node"),
    "a radius is wrong": (changed("radius", add(JUNCTION, 1e-9)), "but its radius is"),
    "a control point is wrong": (changed("control", add((PARABOLA, 1), 1e-6)), "from site"),
    "a parabola is a line": (changed("control", put(PARABOLA, np.nan)), "from site"),
    "another site": (changed("sites", put((0, 0), 7)), "from site"),
    "an index too large": (changed("arcs", put((0, 1), 10_000)), "beyond"),
    "another polygon": (changed("polygon", put(0, 1)), "listed in polygon 1"),
    "outside is inside": (changed("side", put(0, EXTERIOR)), "is outside"),
    "branches are mixed": (changed("branch", add(slice(1, None), 5)), "branch of arc 1"),
    "an end is missing": (without_branch(END), "in the corner|could continue"),
    "a cycle is open": (without_branch(RING), "branch|ends|cycles|connected"),
    "a polygon has none": (kept(RIGHT.polygon != 1), "arcs end in the corner"),
    "a frame that is not": (replace(RIGHT, frame=None), "is not a corner"),
    "other polygons": (
        replace(RIGHT, polygons=replace(RIGHT.polygons, xy=RIGHT.polygons.xy + 1)),
        "but its radius is",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_found(name):
    skeleton, words = WRONG[name]
    with pytest.raises(VerificationError, match=words):
        vorotool.verify_skeleton(skeleton)


def test_merged_corners_are_found():
    two = vorotool.skeleton_exact([[[0, 0], [2, 0], [2, 2], [0, 2]], [[2, 2], [4, 2], [4, 4], [2, 4]]])
    same = np.flatnonzero((two.vertices == [2, 2]).all(axis=1))
    assert len(same) == 2
    arcs = np.where(two.arcs == same[1], same[0], two.arcs)
    numbers = np.delete(np.arange(len(two.vertices)), same[1])
    merged = replace(
        two,
        arcs=np.searchsorted(numbers, arcs),
        vertices=two.vertices[numbers],
        radius=two.radius[numbers],
    )
    with pytest.raises(VerificationError):
        vorotool.verify_skeleton(merged)


def test_a_nearer_site_is_found():
    """Two squares, and arcs that would be right without the second one."""
    square = [[0, 0], [8, 0], [8, 8], [0, 8]]
    alone = vorotool.skeleton_exact([square])
    beside = vorotool.skeleton_exact([{"shell": square}, {"line": [[4, 5], [4, 7]]}])
    mixed = replace(
        alone,
        polygons=beside.polygons,
        site_table=beside.site_table,
        sites=np.where(alone.sites >= 4, alone.sites + 2, 0),
        features="together",
    )
    with pytest.raises(VerificationError, match="a site is"):
        vorotool.verify_skeleton(mixed)


def test_a_diagram_without_an_edge_outside_is_found():
    shapes = shape_diagram(SHAPES)
    verify_exterior(shapes)
    diagram = shapes.diagram
    numbers, faces = _kept(shapes)
    lost = numbers[(faces == 0) & (diagram.edges[numbers] >= 0).all(axis=1)][0]
    broken = replace(
        diagram, edges=np.delete(diagram.edges, lost, axis=0), edge_sites=np.delete(diagram.edge_sites, lost, axis=0)
    )
    with pytest.raises(VerificationError, match=r"connected parts|cycles"):
        verify_exterior(replace(shapes, diagram=broken))


def _kept(shapes):
    from vorotool.engines.skeleton.exact import kept_edges

    return kept_edges(shapes)


SAMPLED = {
    "room": [[0, 0], [8, 0], [8, 3], [4, 1], [0, 3]],
    "ring": [{"shell": [[0, 0], [9, 0], [9, 7], [0, 7]], "holes": [[[2, 2], [6, 2], [4, 5]]]}],
    "two": [[[0, 0], [4, 0], [4, 4], [0, 4]], [[2, 2], [7, 2], [7, 5], [2, 6]]],
    "far": [[[5e5 + 40 * np.cos(k), 4e6 + 30 * np.sin(k)] for k in np.arange(24) * np.pi / 12]],
}
OPTIONS = ({"step": 0.4}, {"step": 0.4, "sampling": "symmetric", "complete": True}, {"tolerance": 0.02})

pytestmark = pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")


SIDES, FEATURES = ["interior", "exterior", "both"], ["separate", "together"]
PAIRS_FIRST = [
    (name, side, FEATURES[(k + i + turn) % 2])
    for turn in range(2)
    for k, name in enumerate(SAMPLED)
    for i, side in enumerate(SIDES)
]


@pytest.mark.parametrize(("name", "side", "features"), few(PAIRS_FIRST, len(SAMPLED) * len(SIDES)))
def test_approximate_skeletons_pass_whatever_their_side(name, side, features):
    for options in OPTIONS:
        verify_skeleton(skeleton_approx(SAMPLED[name], side=side, features=features, **options))


@pytest.mark.parametrize("family", few(FAMILIES, 4), ids=lambda family: family.__name__)
def test_those_of_random_shapes_pass(family):
    for case in (0, 3):
        shape = small(family, 11 * case)
        size = float(np.ptp(as_polygons(shape).xy, axis=0).max()) or 1.0
        options = dict(OPTIONS[case % 2], side=("interior", "both")[case > 1])
        verify_skeleton(skeleton_approx(shape, **(options | {"step": size / 15})))


@pytest.mark.parametrize("connectivity", [4, 8])
def test_where_pixels_hang_together_cycles_through_corners_are_no_fault(connectivity):
    mask = np.zeros((14, 14), dtype=np.uint8)
    for row, column in ((1, 4), (4, 1), (4, 7), (7, 4)):
        mask[row : row + 3, column : column + 3] = 1
    outlines = vorotool.outlines(mask, connectivity=connectivity)
    for side in ("interior", "both"):
        verify_skeleton(skeleton_approx(outlines, step=0.5, complete=True, side=side))


def test_pruned_ones_pass():
    whole = skeleton_approx(SAMPLED["ring"], tolerance=0.01)
    for threshold in ({"angle": 100}, {"scale": 1.3}, {"length": 1}):
        verify_skeleton(vorotool.prune(whole, **threshold))


def with_arrays(skeleton, name, at, value):
    """The skeleton with another value in a column."""
    column = getattr(skeleton, name).copy()
    column[at] = value
    return replace(skeleton, **{name: column})


@pytest.mark.parametrize("features", few(["separate", "together"], 1))
@pytest.mark.parametrize("options", few(OPTIONS, 2), ids=str)
@pytest.mark.parametrize("name", SAMPLED)
def test_changed_ones_are_refused(name, options, features):
    made = skeleton_approx(SAMPLED[name], features=features, **options)
    size, rng = float(np.ptp(made.polygons.xy, axis=0).max()), np.random.default_rng(1)
    for node in rng.choice(np.flatnonzero(made.radius > 0), 2).tolist():
        for factor in (0.999, 1.001):
            with pytest.raises(VerificationError, match="from the shapes, but its radius is"):
                verify_skeleton(with_arrays(made, "radius", node, factor * made.radius[node]))
        turn = rng.random() * 2 * np.pi
        place = made.vertices[node] + size / 50 * np.array([np.cos(turn), np.sin(turn)])
        with pytest.raises(VerificationError):
            verify_skeleton(with_arrays(made, "vertices", node, place))
    arc = int(rng.integers(len(made)))
    with pytest.raises(VerificationError, match=f"arc {arc} is outside, in polygon"):
        verify_skeleton(with_arrays(made, "side", arc, 1))
    with pytest.raises(VerificationError, match=f"arc {arc} is a parabola"):
        verify_skeleton(with_arrays(made, "control", arc, made.vertices[0]))


@pytest.mark.parametrize("options", OPTIONS, ids=str)
@pytest.mark.parametrize("name", ["room", "ring", "two"])
def test_bounds_that_are_too_small_are_refused(name, options):
    made = skeleton_approx(SAMPLED[name], **options)
    with pytest.raises(VerificationError, match="beyond its bound"):
        verify_skeleton(replace(made, error_bound=made.error_bound / 16))


def with_arc(skeleton, ends):
    """The skeleton with one more straight arc, about which nothing is proved; each arc is a branch."""
    names = ("control", "sites", "polygon", "side", "length")
    columns = {name: np.concatenate([getattr(skeleton, name), getattr(skeleton, name)[:1]]) for name in names}
    count = len(skeleton) + 1
    return replace(
        skeleton,
        **columns,
        arcs=np.concatenate([skeleton.arcs, np.array([ends], dtype=np.int32)]),
        branch=np.arange(count, dtype=np.int32),
        error_bound=np.full(count, np.nan),
    )


def test_arcs_in_another_polygon_across_edges_and_around_nothing_are_refused(monkeypatch):
    made = skeleton_approx(SAMPLED["two"], step=0.4)
    with pytest.raises(VerificationError, match="is not in polygon 1"):
        verify_skeleton(with_arrays(made, "polygon", 0, 1))
    monkeypatch.setattr("vorotool.engines.skeleton.verify_skeleton.check_branches", lambda _: None)
    made = skeleton_approx(SAMPLED["room"], step=0.4)
    first = int(np.flatnonzero((made.radius[made.arcs] > 0.5).all(axis=1))[0])
    with pytest.raises(VerificationError, match="in polygon 0 has 1 independent cycles, but at most 0"):
        verify_skeleton(with_arc(made, made.arcs[first]))
    legs = [[0, 0], [10, 0], [10, 8], [8, 8], [8, 2], [6, 2], [6, 8], [4, 8], [4, 2], [2, 2], [2, 8], [0, 8]]
    made = skeleton_approx(legs, step=0.4)
    outer = [int(np.square(made.vertices - place).sum(axis=1).argmin()) for place in ([1, 5], [9, 5])]
    with pytest.raises(VerificationError, match="meets edge"):
        verify_skeleton(with_arc(made, outer))
