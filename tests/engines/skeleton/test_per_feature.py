"""Skeletons inside features: each is what it would be if there were no others."""

import warnings
from dataclasses import fields, replace

import numpy as np
import pytest
import shapely
from scipy.ndimage import gaussian_filter

import vorotool
from fuzz import features as fuzz
from fuzz.features import FAMILIES, as_set
from support.few import few
from support.oracles.outline_oracle import random_labels
from support.readers.written import ARCS, differing
from vorotool import _core
from vorotool.engines.arrangement.planar_graph import placed_vertices
from vorotool.engines.features import batches as feature_sheets
from vorotool.engines.features.batches import Features, sheets_of_boxes, sheets_of_cracks
from vorotool.engines.skeleton.diagrams import feature_elements, feature_skeleton
from vorotool.engines.skeleton.exact import shape_diagram, skeleton_of
from vorotool.errors import InputError, VerificationError, VorotoolWarning

OUTER = [[0, 0], [10, 0], [10, 10], [0, 10]]
INNER = [[3, 3], [7, 3], [7, 7], [3, 7]]


def all_differing(made, expected):
    tables = made.site_table, expected.site_table
    columns = [field.name for field in fields(tables[0])]
    return differing(made, expected) + [
        name for name in columns if not same(*(getattr(table, name) for table in tables))
    ]


def same(one, other):
    return np.array_equal(one, other, equal_nan=one is not None and one.dtype.kind == "f")


def masks():
    for seed in range(3):
        random = np.random.default_rng(seed)
        yield random_labels(random, 30) > 0
        yield gaussian_filter(random.standard_normal((60, 50)), 2.0) > 0.02
        yield random.random((30, 40)) < 0.4
    nested = np.zeros((60, 60), dtype=bool)
    for k in range(0, 28, 4):
        nested[k : 60 - k, k : 60 - k] = True
        nested[k + 2 : 58 - k, k + 2 : 58 - k] = False
    yield np.tile(nested, (2, 3))


@pytest.mark.parametrize("threads", [1, 2])
def test_objects_of_masks_that_do_not_touch_are_those_of_one_diagram(threads, monkeypatch):
    monkeypatch.setattr(feature_sheets, "BATCH", 60)
    for mask in masks():
        polygons = vorotool.outlines(mask, connectivity=8)
        made = feature_skeleton(polygons, threads=threads).skeleton
        assert all_differing(made, skeleton_of(shape_diagram(polygons))) == []


def test_what_lies_inside_has_its_skeleton_and_takes_none():
    made = vorotool.skeleton_exact([OUTER, INNER])
    lengths = np.bincount(made.polygon, made.length)
    assert lengths == pytest.approx([20 * 2**0.5, 8 * 2**0.5])
    together = vorotool.skeleton_exact([OUTER, INNER], features="together")
    assert set(together.polygon.tolist()) == {0}


def test_what_is_repaired_in_a_feature_is_counted_and_refused():
    bow = [[20, 0], [24, 4], [24, 0], [20, 4]]
    twice = [[[x, y + k] for x, y in bow] for k in (0, 10)]
    with pytest.warns(VorotoolWarning, match="2 crossings"):
        vorotool.skeleton_exact([OUTER, INNER, *twice])
    with pytest.raises(InputError, match=r"polygon 3, shell, edge 1 .* crosses polygon 3, shell, edge 3 \(2 such"):
        vorotool.skeleton_exact([OUTER, INNER, *twice], strict=True)


@pytest.mark.parametrize("connectivity", [4, 8])
def test_outlines_in_one_sheet_share_no_vertex(connectivity):
    for seed in range(8):
        image = random_labels(np.random.default_rng(seed), 50)
        polygons = vorotool.outlines(image, mode="labels", connectivity=connectivity)
        features = Features.of(polygons)
        sheet = sheets_of_cracks(features, placed_vertices(polygons).vertices)
        places = {}
        for vertex, feature in zip(map(tuple, polygons.xy.tolist()), features.of_vertex.tolist(), strict=True):
            assert places.setdefault((vertex, int(sheet[feature])), feature) == feature
        assert sheet.max(initial=0) < 8


def test_bounds_in_one_sheet_are_apart():
    for seed in range(40):
        rng = np.random.default_rng(seed)
        polygons = as_set(FAMILIES[seed % len(FAMILIES)](rng))
        features, vertices = Features.of(polygons), placed_vertices(polygons).vertices.astype(np.int64)
        reach = rng.integers(0, 1 << 20, len(features))
        sheet = sheets_of_boxes(features, vertices.astype(np.int32), reach=reach[:, None])
        low, high = (bound.reduceat(vertices, features.vertex_starts[:-1]) for bound in (np.minimum, np.maximum))
        wide = reach[:, None] + feature_sheets.APART
        meet = ((low - wide)[:, None] <= (high + wide)[None]).all(axis=2)
        assert not (meet & meet.T & (sheet[:, None] == sheet) & ~np.eye(len(features), dtype=bool)).any()


def test_many_boxes_over_each_other_are_divided_fast():
    """More than are tried one by one: piles, and small ones over and beside long ones."""
    rng = np.random.default_rng(1)
    count = 8000
    low = rng.integers(0, 1 << 20, (count, 2))
    size = (2.0 ** rng.uniform(0, 20, (count, 2))).astype(np.int64)
    sheet = _core.spatial.disjoint_sheets(np.hstack([low, low + size]), None)
    assert sorted(set(sheet.tolist())) == list(range(int(sheet.max()) + 1))
    boxes = shapely.box(*low.T, *(low + size).T)
    one, other = shapely.STRtree(boxes).query(boxes, predicate="intersects")
    assert not ((sheet[one] == sheet[other]) & (one != other)).any()


def test_a_point_outside_its_polygon_is_left_out_with_a_word():
    with pytest.warns(VorotoolWarning, match="1 dangling segment"):
        made = vorotool.skeleton_exact([{"shell": OUTER, "holes": [[[20, 20]]]}], side="both")
    assert made.polygons.xy.max() == 10


def test_a_broken_polygon_keeps_its_points_and_segments():
    bow = [[0, 0], [10, 10], [10, 0], [0, 10]]
    with pytest.warns(VorotoolWarning):
        made = vorotool.skeleton_exact([{"shell": bow, "holes": [[[9, 5]], [[8, 4.5], [8, 5.5]]]}])
    vorotool.verify_skeleton(made)
    assert sorted(vorotool.polygon_table(made)["holes"].tolist()) == [0, 2]


DISTANCES = [[-1.0, -0.3], [-1.0, 2.0], [3.0]]
EACH_ONCE = [(k, DISTANCES[(k + turn) % 3]) for turn in range(3) for k in range(len(FAMILIES))]


@pytest.mark.parametrize(("family", "distances"), few(EACH_ONCE, len(FAMILIES) // 2))
def test_offsets_inwards_are_of_each_feature(family, distances):
    shapes = as_set(FAMILIES[family](np.random.default_rng(family)))
    with warnings.catch_warnings(action="ignore"):
        made = vorotool.offset(shapes, distances)
    vorotool.verify_offsets(made, distances=distances)


def test_both_sides_of_features_that_overlap_are_read_back(tmp_path):
    shifted = [[x + 5, y + 3] for x, y in OUTER]
    for features in ("separate", "together"):
        with warnings.catch_warnings(action="ignore"):
            made = vorotool.skeleton_exact([OUTER, shifted], side="both", features=features)
        vorotool.write(made, tmp_path / "both.json")
        again = vorotool.read(tmp_path / "both.json")
        assert (again.features, all_differing(again, made)) == (features, [])
        vorotool.verify_skeleton(again)


SITES = {
    "a line": {"line": [[3, 5], [7, 6]]},
    "a line of one place": {"line": [[4, 5]]},
    "a shell of one vertex": {"shell": [[4, 5]]},
    "a shell of two vertices": {"shell": [[3, 5], [7, 6]]},
    "a shell of one place": {"shell": [[4, 5], [4, 5], [4, 5]]},
}


@pytest.mark.parametrize("site", SITES.values(), ids=SITES)
@pytest.mark.parametrize("side", ["interior", "both"])
@pytest.mark.filterwarnings("ignore:1 polygon has its vertices at one or two")
def test_points_and_lines_inside_another_feature_change_nothing_there(site, side):
    made = vorotool.skeleton_exact([OUTER, site], side=side, strict=True)
    vorotool.verify_skeleton(made)
    assert made.length[made.polygon == 0].sum() == pytest.approx(20 * 2**0.5)
    distances = [-1.0] if side == "interior" else [-1.0, 1.0]
    curves = vorotool.offset([OUTER, site], distances)
    vorotool.verify_offsets(curves, distances=distances)
    assert curves.area[curves.distance < 0].tolist() == [64]


def test_shells_without_an_inside_are_told_where_that_is_asked_for():
    with pytest.warns(VorotoolWarning, match="2 polygons have their vertices at one or two positions only"):
        made = vorotool.skeleton_exact([OUTER, {"shell": [[4, 5]]}, {"shell": [[40, 5], [45, 5]]}])
    assert set(made.polygon.tolist()) == {0}


EXACT = [name for name in ARCS if name not in ("polygon", "error_bound")]
LARGE = [[0, 0], [20, 0], [20, 20], [0, 20]]
SMALL = [[6, 6], [14, 6], [14, 14], [6, 14]]
ACROSS = [[-4, 8], [30, 8], [30, 11], [-4, 11]]


@pytest.mark.parametrize("family", [fuzz.tiles, fuzz.nested, fuzz.parts, fuzz.scattered])
@pytest.mark.parametrize("seed", few(range(4), 1))
@pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")
def test_features_of_any_family_are_what_they_are_alone(family, seed):
    polygons = fuzz.as_set(family(np.random.default_rng(seed)))
    count = int(polygons.feature.max())
    gap = 2.0**-20 * float(np.ptp(polygons.xy))
    made = feature_elements(polygons, gap, threads=2).skeleton
    for feature in range(min(count, 12)):
        given = fuzz.chosen(polygons, [feature, count])
        alone = feature_elements(given, gap, threads=1).skeleton
        assert fuzz.differing(fuzz.inside_of(made, feature, polygons), fuzz.inside_of(alone, 0, given)) is None


@pytest.mark.parametrize("complete", few([True, False], 1))
@pytest.mark.parametrize("family", [fuzz.tiles, fuzz.nested, fuzz.parts, fuzz.scattered])
@pytest.mark.filterwarnings("ignore::vorotool.errors.VorotoolWarning")
def test_batches_of_features_are_what_each_is_by_itself(family, complete):
    polygons = fuzz.as_set(family(np.random.default_rng(7)))
    gap = 2.0**-20 * float(np.ptp(polygons.xy))
    batches = feature_elements(polygons, gap, complete=complete).skeleton
    one_by_one = feature_elements(polygons, gap, complete=complete, look=lambda *_: None).skeleton
    assert differing(batches, one_by_one, EXACT) == []
    assert batches.features == one_by_one.features == "separate"


@pytest.mark.parametrize("side", ["interior", "exterior", "both"])
@pytest.mark.parametrize("complete", [True, False])
def test_the_checker_passes_features_over_each_other(side, complete):
    shapes = [LARGE, SMALL, ACROSS]
    made = vorotool.skeleton_exact(shapes, gap=0.25, side=side, complete=complete, strict=True)
    vorotool.verify_skeleton(made)
    assert set(made.polygon.tolist()) == {"interior": {0, 1, 2}, "exterior": {-1}, "both": {-1, 0, 1, 2}}[side]
    with pytest.warns(VorotoolWarning, match="crossings"):
        drawing = vorotool.skeleton_exact(shapes, gap=0.25, side=side, complete=complete, features="together")
    vorotool.verify_skeleton(drawing)


def test_the_checker_refuses_what_is_between_features():
    made = vorotool.skeleton_exact([LARGE, SMALL], gap=0.25, features="together")
    with pytest.raises(VerificationError, match="another feature"):
        vorotool.verify_skeleton(replace(made, features="separate"))
