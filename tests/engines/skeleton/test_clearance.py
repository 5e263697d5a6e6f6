"""Where the clearance grows, shrinks and stays along the arcs of skeletons: against discs in numbers of many digits."""

import warnings
from decimal import Decimal

import networkx as nx
import numpy as np
import pytest

import vorotool
from support.approximations import verify_approximate
from support.families.skeleton_shapes import FAMILIES, TOUCHING, regular, small
from support.few import few
from support.oracles.tangent_discs import FIRST, Site, precision, sign, tangent_circles
from vorotool import verify_skeleton
from vorotool.convert.polygons import as_polygons
from vorotool.engines.sampled_skeleton import per_feature
from vorotool.engines.sampled_skeleton.approximate import SamplingOptions, Wanted
from vorotool.engines.sampled_skeleton.per_feature import approximation
from vorotool.engines.skeleton.clearance import clearance_course, maxima
from vorotool.engines.skeleton.diagrams import all_edges, diagram_of_all
from vorotool.engines.skeleton.parts import contraction
from vorotool.engines.skeleton.verify_skeleton import check_branches
from vorotool.errors import VorotoolWarning

_, TIE = FIRST


def sites_on_lattice(skeleton):
    ends = np.rint((skeleton.site_ends - skeleton.origin) / skeleton.scale).astype(int).tolist()
    return [Site(tuple(a), tuple(b)) for a, b in ends]


def node_disc(skeleton, sites, node, arcs):
    """The disc of a node as its sites have it; None where they are too few."""
    around = sorted(set(skeleton.sites[arcs].ravel().tolist()))
    place = (skeleton.vertices[node] - skeleton.origin) / skeleton.scale
    for third in around[2:]:
        found = tangent_circles([sites[around[0]], sites[around[1]], sites[third]])
        away = [max(abs(float(d.x) - place[0]), abs(float(d.y) - place[1])) for d in found]
        if away and min(away) < 1e-6 * (1 + np.abs(place).max()):
            return found[int(np.argmin(away))]
    return None


def apex(a, b):
    """Half-way between two sites of which one is a point; None between lines, or a line and a point on it."""
    if not a.is_point:
        a, b = b, a
    if not a.is_point or (not b.is_point and b.height(a.a) == 0):
        return None
    if b.is_point:
        return tuple(Decimal(p + q) / 2 for p, q in zip(a.a, b.a, strict=True))
    u = b.along
    t = Decimal(b.height(a.a)) / (u[0] ** 2 + u[1] ** 2)
    return a.a[0] + t * u[1] / 2, a.a[1] - t * u[0] / 2


def expected_slope(first, last, sites):
    middle = apex(*sites)
    if middle is not None:
        x, y = middle
        if sign((first.x - x) * (last.x - x) + (first.y - y) * (last.y - y), TIE, True) < 0:
            return [-1, -1]
    way = sign(last.r - first.r, TIE, True)
    return [way, -way]


def check(skeleton):
    course = clearance_course(skeleton, threads=1)
    sites = sites_on_lattice(skeleton)
    arcs_at = [np.flatnonzero((skeleton.arcs == node).any(axis=1)) for node in range(len(skeleton.vertices))]
    compared = 0
    with precision(160):
        discs = [node_disc(skeleton, sites, node, arcs) for node, arcs in enumerate(arcs_at)]
        for arc, (source, target) in enumerate(skeleton.arcs.tolist()):
            if discs[source] is None or discs[target] is None or skeleton.radius[[source, target]].min() == 0:
                continue
            expected = expected_slope(discs[source], discs[target], [sites[k] for k in skeleton.sites[arc].tolist()])
            assert course.slope[arc].tolist() == expected, arc
            compared += 1
    inside = (course.slope == -1).all(axis=1)
    assert (np.isnan(course.least) == ~inside).all()
    return compared


@pytest.mark.parametrize("family", few([*FAMILIES, *TOUCHING], 6), ids=lambda family: family.__name__)
@pytest.mark.filterwarnings("ignore::vorotool.VorotoolWarning")
def test_signs_are_those_of_exact_discs(family):
    compared = 0
    for seed in range(5):
        skeleton = vorotool.skeleton_exact(small(family, 10 * seed, most=30), side=("interior", "both")[seed % 2])
        compared += check(skeleton)
    assert compared


@pytest.mark.parametrize("count", [4, 6, 8, 16])
def test_regular_polygons_and_annuli(count):
    ring = regular(count)
    assert maxima(vorotool.skeleton_exact(ring), clearance_course(vorotool.skeleton_exact(ring))).any()
    annulus = vorotool.skeleton_exact({"shell": ring, "holes": [ring[::-1] / 2]})
    check(annulus)


def rectangle(width, height):
    return np.array([[0, 0], [width, 0], [width, height], [0, height]], dtype=float)


def test_shortened_edges_and_an_empty_skeleton():
    gap = vorotool.skeleton_exact(rectangle(7, 3), gap=0.1)
    assert set(clearance_course(gap).slope.ravel().tolist()) <= {-1, 0, 1}
    with pytest.warns(vorotool.VorotoolWarning):
        empty = vorotool.skeleton_exact([{"line": [[0, 0], [1, 0]]}])
    assert clearance_course(empty).slope.shape == (0, 2)
    assert len(maxima(empty, clearance_course(empty))) == 0


# ---- No arc of a skeleton joins two nodes that doubles do not tell apart ----
OFFSETS = ((0.0, 0.0), (1e3, 2e3), (5e5, 4e6))
METHODS = {
    "exact": vorotool.skeleton_exact,
    "step": lambda shape, **how: vorotool.skeleton_approx(shape, step=_size(shape) / 20, **how),
    "tolerance": lambda shape, **how: vorotool.skeleton_approx(shape, tolerance=_size(shape) / 100, **how),
}


def _size(shape):
    return float(np.ptp(as_polygons(shape).xy, axis=0).max()) or 1.0


def polygon(count, radius, offset):
    """Regular, with as many corners."""
    angle = np.arange(count) * 2 * np.pi / count
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]) + offset


def equal_ends(skeleton):
    source, target = skeleton.vertices[skeleton.arcs].swapaxes(0, 1)
    return (source == target).all(axis=1)


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.__name__)
@pytest.mark.parametrize("method", few(METHODS, 1))
def test_random_shapes_have_none_wherever_they_are(method, family):
    for case in range(2):
        shape = family(np.random.default_rng([case, 7]))
        with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
            made = METHODS[method](shape, side=("interior", "both")[case % 2])
        assert not equal_ends(made).any()
        check_branches(made)


@pytest.mark.parametrize("gap", [0.0, 0.01])
def test_skeletons_with_a_gap_and_whole_diagrams_have_none(gap):
    for offset in OFFSETS:
        shape = as_polygons(polygon(24, 3.7, offset))
        assert not equal_ends(vorotool.skeleton_exact(shape, gap=gap, side="both")).any()
        assert not equal_ends(all_edges(diagram_of_all(shape, gap, features="together"))).any()


ULPS = {
    "five corners, a step of two": (1e5, [[1, 0], [0, 0], [1, 2], [2, 2]]),
    "crossing": (1e5, [[3, 1], [3, 4], [0, 3], [0, 0], [1, 0], [4, 4]]),
    "thin": (1e7, [[14, 9], [12, 16], [15, 10], [16, 11], [0, 5]]),
    "star": (1e3, [[0, 1], [4, 7], [3, 4], [6, 1], [5, 6]]),
    "blunt": (1e6, [[-2, 0], [-2, -1], [-1, -2]]),
    "turned": (1e7, [[-2, 1], [-2, 0], [-2, -1], [0, -2], [1, -2]]),
}
"""Coordinates in ulp of a base: arcs lead to corners that doubles cannot tell from the nodes before them."""


@pytest.mark.parametrize("name", ULPS)
@pytest.mark.parametrize("side", ["interior", "both"])
def test_shapes_of_a_few_ulp_pass_the_checker(side, name):
    base, ring = ULPS[name]
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        made = vorotool.skeleton_exact(base + np.spacing(base) * np.array(ring), side=side)
    assert not equal_ends(made).any()
    verify_skeleton(made)
    at_corner = (made.vertices[:, None] == made.polygons.xy).all(axis=2).any(axis=1)
    assert (at_corner & (made.radius > 0)).any()


@pytest.mark.parametrize("seed", range(12))
def test_contracted_graphs_are_those_that_networkx_contracts(seed):
    rng = np.random.default_rng(seed)
    holes = [np.add([[0, 0], [2, 0], [2, 2], [0, 2]], corner).tolist() for corner in ([3, 3], [10, 4], [5, 10])]
    shell = rng.integers(-1, 2, (16, 2)) + polygon(16, 12, (8.0, 8.0)).round()
    whole = vorotool.skeleton_exact([{"shell": shell.tolist(), "holes": holes}])
    coarse = vorotool.Skeleton(**{**vars_of(whole), "vertices": np.round(whole.vertices / 3)})
    merged = equal_ends(coarse)
    assert merged.any()
    found = contraction(coarse)
    check_branches(found.skeleton)
    same = nx.Graph(coarse.arcs[merged].tolist())
    owner = {node: min(part) for part in nx.connected_components(same) for node in part}
    ends = [[owner.get(node, node) for node in pair] for pair in coarse.arcs[~merged].tolist()]
    kept, made = nx.MultiGraph(ends), nx.MultiGraph(found.skeleton.arcs.tolist())
    assert sorted(map(tuple, coarse.vertices[list(kept)])) == sorted(map(tuple, found.skeleton.vertices))
    assert sorted(dict(kept.degree).values()) == sorted(dict(made.degree).values())
    assert nx.number_connected_components(kept) == nx.number_connected_components(made)
    assert kept.number_of_edges() == made.number_of_edges() == len(found.original)
    for arc, (old, is_reversed) in enumerate(zip(found.original, found.is_reversed, strict=True)):
        step = -1 if is_reversed else 1
        assert found.number[old] == arc
        assert found.skeleton.sites[arc].tolist() == coarse.sites[old][::step].tolist()
        ends = found.skeleton.vertices[found.skeleton.arcs[arc]]
        assert ends.tolist() == coarse.vertices[coarse.arcs[old]][::step].tolist()
        assert found.skeleton.length[arc] == coarse.length[old]
    for old in np.flatnonzero(merged):
        place = coarse.vertices[coarse.arcs[old, 0]]
        assert (found.skeleton.vertices[found.skeleton.arcs[found.number[old]]] == place).all(axis=1).any()


def vars_of(skeleton):
    return {name: getattr(skeleton, name) for name in skeleton.__dataclass_fields__}


@pytest.mark.parametrize("features", ["separate", "together"])
@pytest.mark.parametrize("side", ["interior", "both"])
def test_what_approximations_were_made_of_goes_with_them(side, features, monkeypatch):
    shapes = as_polygons([polygon(64, 10.0, (5e5, 4e6)), polygon(3, 1.0, (5e5 + 20, 4e6))])
    for options in (SamplingOptions(step=0.3), SamplingOptions(tolerance=0.01)):
        found = approximation(shapes, options, Wanted(side), features=features)
        monkeypatch.setattr(per_feature, "contraction", lambda _: None)
        before = approximation(shapes, options, Wanted(side), features=features)
        monkeypatch.undo()
        assert equal_ends(before.skeleton).any() or options.step is not None
        assert len(found.skeleton) == np.count_nonzero(~equal_ends(before.skeleton))
        assert found.skeleton.length.sum() == pytest.approx(before.skeleton.length.sum(), rel=1e-12)
        places, middle = found.places, found.skeleton.vertices[found.skeleton.arcs].mean(axis=1)
        sampled = (found.seeds >= 0).all(axis=1)
        left, right = (np.hypot(*(middle - places[found.seeds[:, hand]]).T) for hand in (0, 1))
        assert left[sampled] == pytest.approx(right[sampled], abs=1e-8)
        for part, numbers in zip(found.parts, found.arcs, strict=True):
            verify_approximate(part, step=options.step)
            assert (part.skeleton.polygon == found.skeleton.polygon[numbers]).all()
