"""Corners of parts, cuts and rebuilt shapes at vertices of polygons have the doubles of these."""

import json

import numpy as np
import pytest
import shapely

from vorotool import necks, parts, read, rebuild, skeleton_exact, verify_necks, verify_parts, write

FAR = [[500000.1, 3.3], [500010.7, 3.3], [500010.7, 9.9]]
DUMBBELL = [
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
DUMBBELL += [[4.1, 4.7], [0.3, 4.1]]
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
    polygons = [DUMBBELL, HOLED, *TOUCHING, *others]
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
    polygons = [DUMBBELL, HOLED, *others]
    skeleton = skeleton_exact(polygons, features=features)
    write(skeleton, tmp_path / "skeleton.json")
    for each in (skeleton, read(tmp_path / "skeleton.json")):
        shapes = written(rebuild(each), tmp_path / "shape.geojson")
        own = set(map(tuple, np.concatenate([shapely.get_coordinates(shape) for shape in shapes]).tolist()))
        assert own == set(map(tuple, vertices(polygons).tolist()))
