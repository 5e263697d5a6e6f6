"""Polygons cut at their necks: areas, borders, the pieces, and corners as given."""

import json
from dataclasses import replace

import numpy as np
import pytest
import shapely

import vorotool
from engines.necks.test_necks import DUMBBELL
from vorotool import (
    VerificationError,
    necks,
    parts,
    read,
    rebuild,
    skeleton_exact,
    verify_necks,
    verify_parts,
    write,
)


def test_dumbbell_is_cut_in_two():
    pieces = parts(DUMBBELL)
    assert pieces.area.tolist() == [17.5, 31.5]
    assert pieces.width.tolist() == [4.0, 5.0]
    assert pieces.between.tolist() == [[0, 1]]
    assert pieces.polygons.ring(0).tolist() == [
        *([0, 0], [4, 0], [4, 1.5], [5.5, 1.5], [5.5, 2.5], [4, 2.5], [4, 4], [0, 4]),
    ]
    assert (pieces.cuts.tolist(), pieces.neighbors) == ([1, 1], [[1], [0]])
    verify_parts(pieces)


@pytest.mark.filterwarnings("ignore")
def test_holes_of_one_place_are_feet_too():
    for hole in ([[3, 3]], [[3, 3], [6, 6]]):
        pieces = parts({"shell": [[0, 0], [10, 0], [10, 10], [0, 10]], "holes": [hole]}, neck=1)
        assert len(pieces) > 1
        assert pieces.area.sum() == pytest.approx(100)
        verify_parts(pieces)
    whole = parts({"shell": [[0, 0], [10, 0], [10, 10], [0, 10]], "holes": [[[3, 3]]]}, neck=0)
    assert whole.polygons.ring(1).tolist() == [[3, 3]]


def test_a_piece_whose_ring_would_touch_itself_has_a_hole():
    """Both cuts from a hole go to one vertex of the shell: what is left around the hole touches itself there."""
    shape = {"shell": [[0, 0], [10, 9], [20, 0], [20, 30], [0, 30]], "holes": [[[6, 15], [8, 12], [12, 12], [14, 15]]]}
    pieces = parts(shape, neck=1)
    verify_parts(pieces)
    assert shapely.is_valid(pieces.to_shapely()).all()


def test_pieces_say_what_their_polygon_says():
    given = vorotool.PolygonSet(
        [*DUMBBELL, [20, 0], [24, 0], [22, 4]], [0, 12, 15], [0, 0], [0, 1], ids=["a", "b"], properties={"area": [5, 6]}
    )
    pieces = parts(given)
    assert (pieces.polygons.ids, pieces.source.tolist()) == (["a", "a", "b"], [0, 0, 1])
    assert pieces.described().properties["area"] == [5, 5, 6]
    assert pieces.described().properties["voro_area"] == [17.5, 31.5, 8.0]
    assert pieces.table()["id"].tolist() == ["a", "a", "b"]
    assert vorotool.skeleton_exact(pieces.polygons).polygons.ids == ["a", "a", "b"]


@pytest.mark.filterwarnings("ignore")
def test_nothing_inside_has_no_parts():
    assert repr(parts([{"line": [[0, 0], [4, 4]]}])) == "Parts: 0 pieces of 1 polygon"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda made: {"radius": made.radius * 2}, "nearer than"),
        (lambda made: {"center": made.center[::-1]}, "the boundary is|nothing touches|is not in it"),
        (lambda made: {"between": np.array([[0, 0]])}, "listed between"),
        (lambda made: {"polygons": replace(made.polygons, xy=made.polygons.xy[::-1])}, "has an area of"),
        (
            lambda made: {"polygons": replace(made.polygons, xy=moved(made.polygons.xy))},
            "neither on a cut nor on the boundary",
        ),
    ],
)
def test_faults_are_found(change, message):
    made = parts(DUMBBELL)
    with pytest.raises(VerificationError, match=message):
        verify_parts(replace(made, **change(made)))


def moved(xy):
    """The first corner pulled inwards."""
    xy = xy.copy()
    xy[0] += 0.25
    return xy


def test_a_piece_that_is_missing_is_found():
    made = parts([DUMBBELL, [[20, 0], [24, 0], [22, 4]]])
    kept = made.polygons
    fewer = vorotool.PolygonSet(kept.xy[:16], kept.ring_starts[:3], kept.ring_kind[:2], kept.ring_polygon[:2])
    with pytest.raises(VerificationError, match="sum to"):
        verify_parts(
            replace(made, polygons=fewer, source=made.source[:2], radius=made.radius[:2], center=made.center[:2])
        )


FAR = [[500000.1, 3.3], [500010.7, 3.3], [500010.7, 9.9]]
SLANTED_DUMBBELL = [
    [0.1, 0],
    [4.3, 0],
    [4.3, 1.1],
    [6.7, 1.2],
    [6.6, 0],
    [10.3, 0],
    [10.1, 4],
    [6.3, 4.7],
    [6.3, 3],
    [4.1, 3.3],
]
SLANTED_DUMBBELL += [[4.1, 4.7], [0.3, 4.1]]
HOLED = {
    "shell": [[20.1, 0.1], [29.9, 0.1], [29.9, 9.9], [20.1, 9.7]],
    "holes": [[[21.1, 1.1], [21.1, 8.7], [28.7, 1.3]]],
}
TOUCHING = [[[30.1, 0.3], [33.7, 0.3], [33.7, 4.1]], [[33.7, 4.1], [37.3, 4.1], [33.7, 0.3]]]


def vertices(polygons):
    rings = [
        ring for each in polygons for ring in ([each["shell"], *each["holes"]] if isinstance(each, dict) else [each])
    ]
    return np.concatenate([np.array(ring) for ring in rings])


def assert_as_given(places, polygons, least):
    given = vertices(polygons)
    near = shapely.STRtree(shapely.points(given)).query(shapely.points(places), predicate="dwithin", distance=1e-3)[0]
    doubles, near = set(map(tuple, given.tolist())), np.unique(near)
    assert len(near) >= least
    assert all(tuple(place) in doubles for place in places[near].tolist())


def written(value, path):
    write(value, path)
    return [shapely.geometry.shape(each["geometry"]) for each in json.loads(path.read_text())["features"]]


@pytest.mark.parametrize("features", ["separate", "together"])
@pytest.mark.parametrize("others", [[], [FAR]])
def test_of_parts_and_cuts(features, others, tmp_path):
    polygons = [SLANTED_DUMBBELL, HOLED, *TOUCHING, *others]
    pieces = parts(polygons, neck=1, features=features)
    verify_parts(pieces)
    assert len(pieces) > len(polygons)
    assert_as_given(pieces.polygons.xy, polygons, 20)
    if features == "separate":
        whole = [
            shapely.Polygon(*each.values()) if isinstance(each, dict) else shapely.Polygon(each) for each in polygons
        ]
        summed = np.bincount(pieces.source, pieces.area)
        np.testing.assert_allclose(summed, shapely.area(whole), rtol=1e-13, atol=1e-13 * FAR[0][0] * bool(others))
    shapes = written(pieces, tmp_path / "parts.geojson")
    assert shapely.is_valid(shapes).all()
    np.testing.assert_array_equal(shapely.get_coordinates(pieces.to_shapely()), shapely.get_coordinates(shapes))
    cuts = necks(polygons, features=features)
    verify_necks(cuts)
    assert_as_given(cuts.feet.reshape(-1, 2), polygons, 2)
    ends = set(map(tuple, pieces.polygons.xy.tolist()))
    assert {tuple(foot) for foot in pieces.necks.feet.reshape(-1, 2).tolist()} <= ends


@pytest.mark.parametrize("features", ["separate", "together"])
@pytest.mark.parametrize("others", [[], [FAR]])
def test_of_shapes(features, others, tmp_path):
    polygons = [SLANTED_DUMBBELL, HOLED, *others]
    skeleton = skeleton_exact(polygons, features=features)
    write(skeleton, tmp_path / "skeleton.json")
    for each in (skeleton, read(tmp_path / "skeleton.json")):
        shapes = written(rebuild(each), tmp_path / "shape.geojson")
        own = set(map(tuple, np.concatenate([shapely.get_coordinates(shape) for shape in shapes]).tolist()))
        assert own == set(map(tuple, vertices(polygons).tolist()))
