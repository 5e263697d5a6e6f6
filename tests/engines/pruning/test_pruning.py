"""Pruned skeletons and centerlines: beside brute force, nested, connected."""

from dataclasses import replace

import networkx
import numpy as np
import pytest
import shapely
from scipy import ndimage

import vorotool
from support.few import few
from support.readers.written import differing
from vorotool import join_junctions, prune, skeleton_exact, verify_joining
from vorotool.engines.pruning import pruning
from vorotool.engines.pruning.pruning import independent_parts
from vorotool.engines.skeleton.verify_skeleton import check_arrays, check_branches
from vorotool.errors import UsageError, VerificationError

COMB = [[0, 0], [30, 0], [30, 6], [26, 6], [26, 12], [24, 12], [24, 6], [6, 6], [6, 9], [4, 9], [4, 6], [0, 6]]


@pytest.mark.parametrize("criterion", ["angle", "chord", "scale", "length", "ratio"])
def test_what_is_left_is_a_connected_part(criterion):
    whole = vorotool.skeleton_exact(COMB)
    lengths = []
    for threshold in (1.5, 3.0, 20.0):
        left = vorotool.prune(whole, **{criterion: threshold})
        vorotool.verify_pruning(left, whole)
        assert networkx.is_connected(left.to_networkx())
        lengths.append(left.length.sum())
    assert lengths == sorted(lengths, reverse=True)
    assert lengths[0] <= whole.length.sum()


def test_one_criterion_is_needed():
    whole = vorotool.skeleton_exact(COMB)
    for options in ({}, {"angle": 20, "scale": 1.5}, {"angle": 200}, {"scale": 0.5}):
        with pytest.raises(UsageError):
            vorotool.prune(whole, **options)


@pytest.mark.parametrize(
    ("criterion", "threads"), [("angle", 1), ("chord", 2), ("scale", 1), ("scale", 2), ("length", 1), ("ratio", 2)]
)
def test_parts_have_what_the_whole_has(criterion, threads, monkeypatch):
    random = np.random.default_rng(5)
    polygons = vorotool.outlines(random.integers(0, 3, (24, 24)), mode="labels", connectivity=4)
    for side in ("interior", "exterior", "both"):
        whole = vorotool.skeleton_exact(polygons, side=side)
        group = np.where(whole.polygon < 0, len(polygons), whole.polygon)
        for threshold in (1.1, 1.5, 100.0):
            assert len(independent_parts(whole, group)) == 1
            expected = vorotool.prune(whole, **{criterion: threshold})
            with monkeypatch.context() as patch:
                patch.setattr(pruning, "PART", 50)
                assert side == "exterior" or len(independent_parts(whole, group)) > 5
                assert differing(vorotool.prune(whole, **{criterion: threshold}, threads=threads), expected) == []


# ---- Junctions that are made one: against Dijkstra's paths in networkx, and what has to stay ----
BRICK = [[0, 0], [5, 0], [5, 4], [0, 4]]


def blobs(seed, size=96):
    noise = np.random.default_rng(seed).random((size, size))
    return ndimage.gaussian_filter(noise, 3.0) > 0.5


def star(seed):
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.random(rng.integers(5, 40))) * 2 * np.pi
    far = rng.uniform(0.3, 1, len(angle))
    return np.column_stack([far * np.cos(angle), far * np.sin(angle)])


def skeletons():
    yield from (skeleton_exact(star(seed)) for seed in range(20))
    for seed in range(4):
        outline = vorotool.outlines(blobs(seed), connectivity=4 + 4 * (seed % 2))
        whole = skeleton_exact(outline)
        yield from (whole, prune(whole, scale=1.5))
    yield skeleton_exact([star(1), star(2) + 1.5, star(3) + np.array([3, 0])], side="both")
    yield vorotool.skeleton_approx(star(4), step=0.02)


SKELETONS = list(skeletons())


def groups(skeleton):
    """Merged junctions by size, with networkx's paths: sets of vertices."""
    graph = networkx.MultiGraph()
    free = (skeleton.degree > 2) & (skeleton.radius > 0) & ~skeleton.touches_frame
    for a, b, length in skeleton.to_networkx().edges(data="length"):
        if free[a] and free[b] and a != b:
            graph.add_edge(a, b, length=length)
    order = sorted(graph, key=lambda node: (-skeleton.radius[node], *skeleton.vertices[node]))
    found = {}
    for node in order:
        if node not in graph:
            continue
        far = networkx.single_source_dijkstra_path_length(graph, node, cutoff=skeleton.radius[node], weight="length")
        found[node] = {other for other, length in far.items() if length < skeleton.radius[node]}
        graph.remove_nodes_from(found[node])
    return found


@pytest.mark.parametrize("skeleton", few(SKELETONS, 12), ids=range(len(SKELETONS)))
def test_groups_are_those_of_paths(skeleton):
    joined = join_junctions(skeleton)
    verify_joining(joined, skeleton)
    if not len(joined):
        return
    check_arrays(joined)
    check_branches(joined)
    expected = groups(skeleton)
    gone = {node for center, taken in expected.items() for node in taken - {center}}
    left = np.flatnonzero(skeleton.degree > 2)
    left = left[~np.isin(left, list(gone))]
    places = {tuple(row) for row in joined.vertices[joined.degree > 2].tolist()}
    assert places == {tuple(row) for row in skeleton.vertices[left].tolist()}
    degree = {
        tuple(place): count for place, count in zip(joined.vertices.tolist(), joined.degree.tolist(), strict=True)
    }
    for center, taken in expected.items():
        total = skeleton.degree[list(taken)].sum() - 2 * (len(taken) - 1)
        assert degree[tuple(skeleton.vertices[center].tolist())] == total
    assert len(np.unique(joined.branch)) == len(np.unique(skeleton.branch)) - len(gone)


def test_how_far_straight_arcs_are():
    for skeleton in SKELETONS[:12]:
        joined = join_junctions(skeleton)
        axis = shapely.union_all(skeleton.to_shapely(by="branch", flatten=1e-5))
        for arc in np.flatnonzero(joined.error_bound > 0):
            a, b = joined.vertices[joined.arcs[arc]]
            places = shapely.points(a + np.linspace(0, 1, 9)[:, None] * (b - a))
            assert shapely.distance(places, axis).max() <= joined.error_bound[arc] + 2e-5
        r_min, r_max, integral = joined.arc_radii
        led = joined.error_bound > 0
        ends = joined.radius[joined.arcs[led]]
        assert (r_min[led] == ends.min(axis=1)).all()
        assert (r_max[led] == ends.max(axis=1)).all()
        assert integral[led] == pytest.approx(ends.mean(axis=1) * joined.length[led])


def test_each_feature_is_what_it_is_alone():
    shapes = [star(seed) + np.array([3 * seed, 0]) for seed in range(6)]
    joined = join_junctions(skeleton_exact(shapes))
    turned = join_junctions(skeleton_exact(shapes[::-1]))
    for number in range(6):
        rows = [
            sorted(map(tuple, np.column_stack([made.length, made.error_bound])[made.polygon == polygon].tolist()))
            for made, polygon in ((joined, number), (turned, 5 - number))
        ]
        assert rows[0] == rows[1]


def test_faults_are_found():
    made = skeleton_exact(BRICK)
    joined = join_junctions(made)
    moved = joined.vertices.copy()
    moved[joined.degree == 4] += 0.25
    with pytest.raises(VerificationError, match="not a part of an arc"):
        verify_joining(replace(joined, vertices=moved), made)
    with pytest.raises(VerificationError, match="junctions that it joins are not merged"):
        verify_joining(made, made)
    apart = replace(joined, arcs=np.where(joined.arcs == joined.arcs[-1, 1], joined.arcs[0, 0], joined.arcs))
    with pytest.raises(VerificationError, match=r"cycles|connected parts|ends"):
        verify_joining(apart, made)
    both = skeleton_exact([BRICK, [[100, 0], [104, 0], [100, 3]]])
    for verify in (verify_joining, vorotool.verify_pruning):
        with pytest.raises(VerificationError, match="another number of polygons: 1, not 2"):
            verify(made, both)
