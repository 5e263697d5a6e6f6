"""Digital triangulations and their repair, of square and rectangular pixels."""

import re
import warnings
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

import vorotool
from support.families.families import distinct_pixels, random_case
from support.few import few
from support.oracles.delaunay_oracle import circle, cross
from support.oracles.digital_oracle import edge_is_delaunay, paper_rule, parts
from support.readers.written import assert_same
from vorotool import (
    InputError,
    LabelImage,
    LimitError,
    SeedSet,
    UsageError,
    VerificationError,
    VorotoolWarning,
    compare_digital,
    delaunay,
    digital_triangulation,
    repair_digital,
    verify_digital_triangulation,
    verify_triangulation,
)
from vorotool.engines.digital import triangulation as engine
from vorotool.engines.digital.comparison import CocircularTies, voronoi_lengths
from vorotool.engines.tessellation import frames as digital
from vorotool.types.pixels import pixel_sides

ARRAYS = ("points", "triangles", "neighbors", "edges", "hull", "first")
small_images = st.tuples(st.integers(1, 9), st.integers(1, 9), st.integers(1, 9), st.integers(0, 2**32 - 1))


def as_sets(found):
    labels = found.labels
    edges = {tuple(labels[e].tolist()) for e in found.edges}
    return edges, {tuple(sorted(labels[t].tolist())) for t in found.triangles}


# ---- the paper's rule -----------------------------------------------------------------------------------


@given(small_images)
def test_the_rule_pixel_by_pixel(case):
    height, width, labels, seed = case
    image = np.random.default_rng(seed).integers(0, labels + 1, (height, width)).astype(np.uint8)
    assert as_sets(digital_triangulation(LabelImage(image))) == paper_rule(image)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.uint32, np.int32])
def test_types_of_labels(dtype):
    image = np.array([[1, 1, 2], [3, 100, 100]], dtype=dtype)
    assert as_sets(digital_triangulation(LabelImage(image))) == paper_rule(image)


@pytest.mark.parametrize("pixels", [1, 700, 5000])
def test_bands_and_threads_change_nothing(pixels, monkeypatch):
    seeds = distinct_pixels(2, 150, 400)
    whole = digital_triangulation(LabelImage(vorotool.tessellate(seeds, shape=(150, 150)).labels))
    monkeypatch.setattr(digital, "BAND_PIXELS", pixels)
    for threads in (1, 3):
        found = digital_triangulation(seeds, shape=(150, 150), threads=threads)
        assert_same(("edges", "triangles", "at_four"), found, whole)
        assert found.four_label_corners == whole.four_label_corners
        assert found.three_label_corners == whole.three_label_corners


def test_what_cannot_be_read():
    with pytest.raises(UsageError, match="shape or window, not both"):
        digital_triangulation([[0, 0]], shape=(2, 2), window=(0, 0, 2, 2))
    with pytest.raises(InputError, match="use window="):
        digital_triangulation([[-1, 0]])
    image = LabelImage(np.array([[1, 3]], dtype=np.uint8), seeds=SeedSet([0], [0], [1]))
    with pytest.raises(InputError, match="label 3, which is not one of the 1 sites"):
        digital_triangulation(image)
    with pytest.raises(InputError, match=r"triangles must have shape"):
        vorotool.DigitalTriangulation([[0, 0]], [], [[0, 1]], [False], [1])
    with pytest.raises(InputError, match="at_four must have shape"):
        vorotool.DigitalTriangulation([[0, 0]], [], [[0, 0, 0]], [], [1])


@pytest.mark.parametrize("case", few(range(40), 15))
def test_the_checker_agrees(case, monkeypatch):
    _, x, y, labels, scale, window = random_case(np.random.default_rng(case), 40)
    seeds = SeedSet(x, y, labels, scale=scale)
    monkeypatch.setattr(digital, "BAND_PIXELS", 300)
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
        verify_digital_triangulation(digital_triangulation(seeds, window=window), seeds, window=window)


def test_the_checker_sees_faults():
    seeds = distinct_pixels(4, 60, 40)
    found = digital_triangulation(seeds, shape=(60, 60))
    a, b, c = np.sort(found.labels[found.triangles[3]]).tolist()
    faults = {
        f"triangle {a}-{b}-{c} is missing .1 such triangles": {
            "triangles": np.delete(found.triangles, 3, 0),
            "at_four": np.delete(found.at_four, 3),
        },
        "edge 1-.* is missing": {"edges": found.edges[1:]},
        "edge 1-.* should not be there .1 such edges": {
            "edges": np.concatenate([found.edges, [[0, far_label(found)]]])
        },
        "an edge occurs twice": {"edges": np.concatenate([found.edges, found.edges[:1, ::-1]])},
        r"edge .* is missing .\d+ such edges": {"labels": found.labels + 1},
    }
    for message, change in faults.items():
        with pytest.raises(VerificationError, match=message):
            verify_digital_triangulation(replace(found, **change), seeds, shape=(60, 60))


def far_label(found):
    """A region that does not touch the first."""
    return next(i for i in range(1, len(found.points)) if [0, i] not in found.edges.tolist())


# ---- the repair -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", few(range(120), 12))
def test_any_seeds_have_the_exact_triangulation(case):
    """Between pixels, outside the frame, duplicates, lines: the repair may have to insert them all, and says so."""
    rng = np.random.default_rng(case)
    _, x, y, _, scale, window = random_case(rng, 40)
    seeds = SeedSet(x, y, np.arange(1, len(x) + 1), scale=scale)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", VorotoolWarning)
        mesh, repair = repair_digital(seeds, window=window)
        expected = delaunay(seeds)
    verify_triangulation(mesh)
    assert_same(ARRAYS, mesh, expected)
    assert any("could not be repaired" in str(w.message) for w in caught) == (repair.route == "rebuilt")


@pytest.mark.parametrize(
    "seeds", [[[3, 2]], [[3, 2], [0, 1]], [[0, 0], [2, 1], [4, 2]], [[1, 0], [1, 5], [1, 3], [1, 4]]]
)
def test_chains(seeds):
    mesh, repair = repair_digital(seeds)
    assert_same(ARRAYS, mesh, delaunay(seeds))
    assert (repair.route, len(mesh)) == ("chain", 0)


def test_a_failed_certificate_is_said(monkeypatch):
    faults = iter(["triangle 0 is not counter-clockwise"])
    monkeypatch.setattr(engine._core.delaunay, "find_fault", lambda *_, **__: next(faults))
    with pytest.warns(
        VorotoolWarning, match=r"the certificate failed .triangle 0 is not .*: all 4 sites were inserted"
    ):
        mesh, repair = repair_digital([[0, 0], [5, 1], [2, 6], [3, 3]])
    monkeypatch.undo()
    assert (repair.route, repair.inserted) == ("rebuilt", 4)
    assert_same(ARRAYS, mesh, delaunay([[0, 0], [5, 1], [2, 6], [3, 3]]))


def test_regions_that_are_no_points_are_refused():
    blobs = vorotool.read("data/blobs.png")
    with pytest.raises(InputError, match=r"label 1 has .* seeds"):
        repair_digital(blobs)
    with pytest.raises(LimitError, match="max_pixels=10"):
        repair_digital([[0, 0], [5, 5]], max_pixels=10)
    with pytest.raises(InputError, match="lie on another seed"):
        repair_digital([[0, 0], [5, 5], [5, 5]], strict=True)


SPACINGS = [(1.5, 0.325), (2, 3), (Fraction(1, 3), 1), 0.25]
SHAPE = (40, 30)


def points_of(seed, count=25):
    return np.unique(np.random.default_rng(seed).integers(0, 30, (count, 2)), axis=0)


@pytest.mark.parametrize("spacing", SPACINGS)
@pytest.mark.parametrize("seed", range(4))
def test_edges_are_those_of_neighboring_regions(seed, spacing):
    points = points_of(seed)
    found = digital_triangulation(points, shape=SHAPE, spacing=spacing)
    image = vorotool.tessellate(points, shape=SHAPE, spacing=spacing)
    borders = vorotool.neighbor_table(image)
    assert found.labels[found.edges].tolist() == np.stack([borders["label_a"], borders["label_b"]], axis=1).tolist()
    assert np.allclose(found.edge_lengths(), borders["centroid_distance"])
    height, width = map(float, pixel_sides(spacing).lengths)
    assert np.allclose(found.points, points * (width, height))
    again = digital_triangulation(image)
    assert np.array_equal(again.points, found.points)
    assert np.array_equal(again.triangles, found.triangles)
    verify_digital_triangulation(found, points, shape=SHAPE, spacing=spacing)
    with pytest.raises(VerificationError):
        verify_digital_triangulation(replace(found, edges=found.edges[1:]), points, shape=SHAPE, spacing=spacing)


@pytest.mark.parametrize("spacing", SPACINGS)
@pytest.mark.parametrize("seed", range(4))
def test_the_repair_gives_the_triangulation_of_the_places_in_the_unit(seed, spacing):
    points, sides = points_of(seed), pixel_sides(spacing)
    mesh, repair = repair_digital(points, shape=SHAPE, spacing=spacing)
    exact = vorotool.delaunay(points * (sides.x, sides.y))
    assert np.array_equal(mesh.triangles, exact.triangles)
    assert np.array_equal(mesh.edges, exact.edges)
    assert np.array_equal(mesh.points, exact.points * sides.step.numerator / sides.step.denominator)
    assert (repair.route, repair.fault) == ("repaired", None)


def test_a_label_image_has_its_own_spacing():
    image = vorotool.tessellate(points_of(1), shape=SHAPE, spacing=(1, 2))
    assert digital_triangulation(image, spacing=(1, 2)) == digital_triangulation(image)
    with pytest.raises(UsageError, match=r"label image, \(1, 2\): leave it out"):
        digital_triangulation(image, spacing=2)


# ---- test_comparison.py ----
def rational(seeds):
    return [(Fraction(int(x)), Fraction(int(y))) for x, y in seeds]


def triangle_is_delaunay(sites, triangle):
    """Whether some, and whether every Delaunay triangulation has it: empty circle; nothing else on it."""
    corners = [sites[v] for v in triangle]
    if cross(*corners) == 0:
        return False, False
    center, square = circle(*corners)
    others = [p for k, p in enumerate(sites) if k not in triangle]
    distances = [(x - center[0]) ** 2 + (y - center[1]) ** 2 for x, y in others]
    return all(d >= square for d in distances), all(d > square for d in distances)


@pytest.mark.parametrize("seed", few(range(30), 4))
def test_ties_by_the_definition(seed):
    m = (4, 5, 6, 9, 40)[seed % 5]  # small lattices: nearly everything is cocircular
    seeds = distinct_pixels(seed, m, min(m * m, 9))
    sites = rational(seeds)
    mesh = delaunay(seeds)
    ties = CocircularTies(mesh)
    for edge in combinations(range(len(sites)), 2):
        assert ties.has_edge(edge) == edge_is_delaunay(sites, *edge)[0], edge
    for triangle in combinations(range(len(sites)), 3):
        assert ties.has_triangle(triangle) == triangle_is_delaunay(sites, triangle)[0], triangle
    for edge, unique in zip(mesh.edges.tolist(), ties.unique_edges, strict=True):
        assert unique == edge_is_delaunay(sites, *edge)[1], edge
    for triangle, unique in zip(mesh.triangles.tolist(), ties.unique_triangles, strict=True):
        assert unique == triangle_is_delaunay(sites, triangle)[1], triangle


@pytest.mark.parametrize("seed", few(range(12), 4))
def test_precision_and_recall_by_the_definition(seed):
    m = (6, 9, 14, 20)[seed % 4]
    seeds = distinct_pixels(seed, m, 10)
    sites = rational(seeds)
    image = vorotool.tessellate(seeds, shape=(m, m)).labels
    found = [{tuple(v - 1 for v in members) for members in kind} for kind in paper_rule(image)]
    comparison = compare_digital(seeds, shape=(m, m))
    for kind, size, test in (("edge", 2, edge_is_delaunay), ("triangle", 3, None)):
        members = list(combinations(range(10), size))
        verdict = {t: test(sites, *t) if test else triangle_is_delaunay(sites, t) for t in members}
        some, every = ({t for t in members if verdict[t][k]} for k in (0, 1))
        have = found[size - 2]
        assert getattr(comparison, f"{kind}_precision") == (len(have & some) / len(have) if have else 1.0)
        assert getattr(comparison, f"{kind}_recall") == (len(have & every) / len(every) if every else 1.0)
        table = comparison.differences
        rows = {"missing": set(), "false": set(), "tie": set()}
        for i in range(table.rows):
            if table["kind"][i] == kind:
                labels = [table[f"label_{name}"][i] - 1 for name in "abc"[:size]]
                rows[table["difference"][i]].add(tuple(sorted(labels)))
                assert table["cause"][i] != "split_region" or any(parts(image, v + 1) > 1 for v in labels)
        assert rows["missing"] == every - have
        assert rows["false"] == have - some
        assert not rows["tie"] & (every | (have - some))


def test_every_difference_has_a_cause():
    counts = Counter()
    for seed in range(30):
        counts.update(compare_digital(distinct_pixels(seed, 64, 150), shape=(64, 64)).counts)
    causes = {name.split()[2] for name in counts}
    assert causes == {"off_frame", "four_labels", "short_edge", "split_region", "cocircular"}


def test_a_suggested_window_shows_more():
    seeds = distinct_pixels(7, 100, 60)
    comparison = compare_digital(seeds, shape=(100, 100))
    window = tuple(map(int, re.match(r"window=\((.*?)\)", comparison.suggestion)[1].split(",")))
    assert comparison.suggestion.typed.startswith(f"--window {','.join(map(str, window))} ")
    wider = compare_digital(seeds, window=window)
    assert wider.triangle_recall > comparison.triangle_recall
    held, of = (int(word) for word in comparison.suggestion.split("holds ")[1].split()[:3:2])
    off = comparison.counts["triangle missing off_frame"]
    assert (of, held) == (off, off - wider.counts.get("triangle missing off_frame", 0))


def test_lengths_of_voronoi_edges():
    seeds = distinct_pixels(3, 50, 40).astype(float)
    mesh = delaunay(seeds)
    centers = mesh.circumcenters
    low, high = np.array([0.0, 0.0]), np.array([49.0, 49.0])
    whole, inside = voronoi_lengths(mesh, centers, low, high)
    place = {frozenset(e): i for i, e in enumerate(mesh.edges.tolist())}
    box = shapely.box(*low, *high)
    for t, row in enumerate(mesh.neighbors.tolist()):
        for k, u in enumerate(row):
            a, b = (mesh.triangles[t][(k + j) % 3] for j in (1, 2))
            i = place[frozenset((int(a), int(b)))]
            if u < 0:
                dx, dy = seeds[b] - seeds[a]
                end = centers[t] + 1e4 * np.array([dy, -dx])
                assert np.isinf(whole[i])
            else:
                end = centers[u]
                assert whole[i] == pytest.approx(np.hypot(*(centers[u] - centers[t])))
            line = shapely.LineString([centers[t], end])
            assert inside[i] == pytest.approx(line.intersection(box).length, abs=1e-6)


def test_what_cannot_be_compared():
    with pytest.raises(InputError, match="label 1 has "):
        compare_digital(vorotool.read("data/blobs.png"))
    with pytest.raises(LimitError):
        compare_digital([[0, 0], [9, 9]], max_pixels=5)
