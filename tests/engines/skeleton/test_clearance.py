"""Where the clearance grows, shrinks and stays along the arcs of skeletons: against discs in numbers of many digits."""

from decimal import Decimal

import numpy as np
import pytest

import vorotool
from support.families.skeleton_shapes import FAMILIES, TOUCHING, regular, small
from support.few import few
from support.oracles.tangent_discs import FIRST, Site, precision, sign, tangent_circles
from vorotool.engines.skeleton.clearance import clearance_course, maxima

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
