"""What the core is given as one: its arrays stay, and indices that would read elsewhere are refused."""

import gc
import weakref

import numpy as np
import pytest

from vorotool import _core, skeleton_exact
from vorotool.engines.segment_voronoi.segment_voronoi import core_diagram, segment_voronoi
from vorotool.engines.skeleton.parts import core_skeleton
from vorotool.types.skeleton.skeleton import CRITERIA

TRIANGLE = [[0, 0], [4, 0], [0, 4]]
SIDES = [[0, 1], [1, 2], [2, 0]]


def rows(values):
    return np.array(values, dtype=np.int32)


def graph_of(points=TRIANGLE, segments=SIDES, faces=((1, 0),) * 3):
    return _core.kernel.PlanarGraph(rows(points), rows(segments), rows(faces))


def test_arrays_stay_that_nobody_else_has():
    arrays = [rows(TRIANGLE), rows(SIDES), rows([[1, 0]] * 3)]
    held = [weakref.ref(array) for array in arrays]
    graph = _core.kernel.PlanarGraph(*arrays)
    del arrays
    gc.collect()
    assert all(array() is not None for array in held)
    assert _core.sampled_skeleton.sample_by_step(graph, 100.0, 9, 1, None)[0].tolist() == TRIANGLE
    del graph
    assert all(array() is None for array in held)


def test_samples_stay_as_long_as_their_diagram():
    graph = graph_of()
    made = _core.sampled_skeleton.sample_by_step(graph, 1.0, 100, 1, None)
    diagram = _core.sampled_skeleton.SampledDiagram(graph, *made, rows([]), None, 1, None)
    expected = diagram.walked_pieces.tolist(), diagram.counts
    del graph, made
    gc.collect()
    assert (diagram.walked_pieces.tolist(), diagram.counts) == expected
    groups = rows([0, 1])
    arguments = (groups, None, False, False, 0.0, (0, 0), 0.0, 0.0, 1.0, 1, None)
    with pytest.raises(ValueError, match="unbounded"):
        diagram.skeleton(*arguments)
    assert len(diagram.skeleton(rows([-1, 1]), *arguments[1:])["arcs"])


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"segments": [[0, 1], [1, 3], [2, 0]]}, "an end of a segment"),
        ({"segments": [[0, 1], [1, -1], [2, 0]]}, "an end of a segment"),
        ({"points": [[0, 0], [4, 0], [0, 1 << 30]]}, "coordinate 1073741824 is beyond the lattice"),
        ({"points": [[0, 0, 0]]}, "number of columns"),
        ({"faces": [[1, 0]]}, "two faces"),
    ],
)
def test_a_graph_that_is_none_is_refused(changed, message):
    with pytest.raises(ValueError, match=message):
        graph_of(**changed)


def test_only_a_checker_takes_a_diagram_with_wrong_indices():
    diagram = segment_voronoi(TRIANGLE, SIDES)
    for name, value in (("edges", 99), ("edge_sites", -1), ("vertex_sites", 6), ("vertex_starts", 99), ("segments", 3)):
        changed = getattr(diagram, name).copy()
        changed[-1] = value
        object.__setattr__(diagram, name, changed)
        core = core_diagram(diagram, rows([[1, 0]] * 3))
        assert isinstance(_core.segment_voronoi.find_fault(core, 1, None), str)
        with pytest.raises(ValueError, match="out of range"):
            _core.skeleton.skeleton_edges(core, 1, None)
        diagram = segment_voronoi(TRIANGLE, SIDES)
    assert len(_core.skeleton.skeleton_edges(core_diagram(diagram, rows([[1, 0]] * 3)), 1, None)[0])
    with pytest.raises(ValueError, match="two faces"):
        _core.skeleton.skeleton_edges(core_diagram(diagram), 1, None)


def test_a_part_of_a_skeleton_has_its_own_nodes():
    skeleton = skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]])
    angle, group = _core.pruning.Criterion.angle, np.zeros(len(skeleton), dtype=np.int32)

    def pruned(arcs, nodes, **options):
        core = core_skeleton(skeleton, **options)
        return _core.pruning.prune_skeleton(core, arcs, nodes, angle, 0.0, group, None)["original"].tolist()

    assert sorted(pruned(slice(None), slice(None))) == [0, 1, 2, 3, 4]
    assert len(pruned(slice(0, 0), slice(0, 0))) == 0
    for arcs, nodes in ((slice(None), slice(1, None)), (slice(0, 1), slice(0, 0)), (slice(None, None, 2), slice(None))):
        with pytest.raises(ValueError, match=r"range|part"):
            pruned(arcs, nodes)
    with pytest.raises(ValueError, match="ends of sites"):
        pruned(slice(None), slice(None), has_sites=False)
    assert [criterion.name for criterion in _core.pruning.Criterion] == list(CRITERIA)
