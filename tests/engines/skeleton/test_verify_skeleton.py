"""The checker of skeletons finds what is wrong."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import vorotool
from vorotool.engines.skeleton.exact import shape_diagram
from vorotool.engines.skeleton.verify_skeleton import verify_exterior
from vorotool.errors import VerificationError
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
CORNERS = np.flatnonzero(RIGHT.radius == 0)
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
