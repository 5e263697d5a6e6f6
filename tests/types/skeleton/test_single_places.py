"""Skeletons that are one place, as those of round shapes are after pruning: lines without points in every format."""

import json
from itertools import pairwise

import numpy as np
import pytest
import shapely

from support.few import few
from vorotool import extend_ends, prune, read, skeleton_exact, smooth, write
from vorotool.numeric.ragged import with_length

ROUND, LONG = shapely.Point(3, 4).buffer(2, quad_segs=6), shapely.box(10, 0, 18, 2)
SETS = {"first": [ROUND, LONG], "last": [LONG, ROUND], "between": [LONG, ROUND, LONG], "alone": [ROUND, ROUND]}


@pytest.fixture(params=SETS)
def skeleton(request):
    return prune(skeleton_exact(SETS[request.param]), scale=1.5)


def test_lines_are_empty_where_there_is_one_place(skeleton):
    is_round = skeleton.length == 0
    assert is_round.any()
    for value in (skeleton, smooth(skeleton, 0.1)):
        shapes = value.to_shapely()
        assert shapely.is_empty(shapes).tolist() == is_round.tolist()
        assert shapely.is_valid(shapes).all()
    assert (shapely.length(extend_ends(skeleton).to_shapely()) > 0).sum() == (~is_round).sum()


@pytest.mark.parametrize("fmt", few(["geojson", "gpkg", "graphml", "jsonl", "wkt", "shp", "fgb"], 3))
def test_files_have_every_branch(skeleton, fmt, tmp_path):
    path, is_round = tmp_path / f"skeleton.{fmt}", skeleton.length == 0
    write(skeleton, path)
    if fmt == "wkt":
        found = shapely.is_empty(shapely.from_wkt(path.read_text().splitlines()))
    elif fmt == "jsonl":
        found = [json.loads(line)["geometry"] is None for line in path.read_text().splitlines()]
    elif fmt == "graphml":
        networkx = pytest.importorskip("networkx")
        edges = networkx.read_graphml(path, force_multigraph=True).edges(data="geometry")
        found = [shapely.from_wkt(text).is_empty for _, _, text in edges]
    else:
        found = [shape is None for shape in pytest.importorskip("geopandas").read_file(path).geometry]
    assert sorted(found) == sorted(is_round.tolist())
    if fmt != "graphml":
        assert list(found) == is_round.tolist()


@pytest.mark.parametrize("fmt", ["json", "npz", "csv"])
def test_arrays_have_the_place(skeleton, fmt, tmp_path):
    write(skeleton, tmp_path / f"skeleton.{fmt}")
    if fmt == "csv":
        rows = np.genfromtxt(tmp_path / "skeleton.csv", delimiter=",", names=True, dtype=None, encoding=None)
        assert (np.atleast_1d(rows["x0"] == rows["x1"]) == (skeleton.length == 0)).all()
    else:
        again = read(tmp_path / f"skeleton.{fmt}")
        np.testing.assert_array_equal(again.vertices, skeleton.vertices)


@pytest.mark.parametrize("seed", range(4))
def test_what_has_a_length_is_what_brute_force_says(seed):
    random = np.random.default_rng(seed)
    lines = [random.integers(0, 2, (random.integers(1, 5), 2)).astype(float) for _ in range(60)]
    start = np.concatenate([[0], np.cumsum([len(line) for line in lines])])
    points, left, has_length = with_length(np.concatenate(lines), start)
    expected = [len(np.unique(line, axis=0)) > 1 for line in lines]
    assert has_length.tolist() == expected
    kept = [line for line, is_kept in zip(lines, expected, strict=True) if is_kept]
    assert [points[a:b].tolist() for a, b in pairwise(left)] == [line.tolist() for line in kept]
