"""Offsets of shapes beside the buffers of shapely, and what their checker finds."""

from dataclasses import replace

import numpy as np
import pytest

import vorotool

ROOMS = [[0, 0], [4, 0], [4, 1], [6, 1], [6, 0], [10, 0], [10, 4], [6, 4], [6, 2], [4, 2], [4, 4], [0, 4]]
"""Two rooms and a door of width 1."""


def test_what_has_vanished_is_not_there():
    made = vorotool.offset([[0, 0], [4, 0], [4, 2], [0, 2]], [-1.5])
    assert len(made.area) == 0
    vorotool.verify_offsets(made, distances=[-1.5])


def without(made, shape):
    """Offsets without a shape."""
    rings = np.flatnonzero(made.shape_of_ring != shape)
    pieces = np.flatnonzero(np.isin(made.ring_of_piece, rings))
    lengths, counts = np.diff(made.ring_starts)[rings], np.delete(np.diff(made.shape_starts), shape)
    return replace(
        made,
        **{name: getattr(made, name)[pieces] for name in ("start", "end", "center", "site")},
        ring_starts=np.concatenate([[0], np.cumsum(lengths)]),
        shape_starts=np.concatenate([[0], np.cumsum(counts)]),
        distance=np.delete(made.distance, shape),
        polygon=np.delete(made.polygon, shape),
    )


def moved(made, name, row, by):
    """Offsets with one place moved."""
    places = getattr(made, name).copy()
    places[row] += by
    return replace(made, **{name: places})


def reversed_ring(made):
    """Offsets of one ring that runs the other way round."""
    order = slice(None, None, -1)
    return replace(made, start=made.end[order], end=made.start[order], site=made.site[order], center=made.center[order])


FAULTS = {
    "open": (1, lambda made: moved(made, "end", 2, 0.1), "does not begin there"),
    "edge": (1, lambda made: replace(made, site=np.roll(made.site, 1)), "neither a line along an edge"),
    "center": (1, lambda made: moved(made, "center", np.flatnonzero(made.is_arc)[0], 1e-9), "not its vertex"),
    "distance": (-0.25, lambda made: replace(made, distance=np.full(1, -0.2500001)), "too near"),
    "turned": (-0.25, reversed_ring, "has the wrong orientation"),
    "lost": (-1, lambda made: without(made, 1), "is in 0 shapes, not in one"),
    "twice": ([-1, -1.5], lambda made: replace(made, distance=np.full(4, -1.0)), "too near"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_the_checker_finds_faults(name):
    distance, spoil, words = FAULTS[name]
    made = vorotool.offset(ROOMS, distance)
    vorotool.verify_offsets(made)
    with pytest.raises(vorotool.VerificationError, match=words):
        vorotool.verify_offsets(spoil(made))


def test_the_checker_finds_what_is_nearer():
    made = vorotool.offset(ROOMS, -0.25)
    # the same curve, beside shapes with one more wall across it
    walled = vorotool.offset([{"shell": ROOMS}, {"line": [[2, 1], [2, 3]]}], -0.25, features="together")
    site = np.array([_same_site(made, walled, row) for row in made.site.tolist()])
    table, polygons = walled.site_table, walled.polygons
    mixed = replace(made, site=site, site_table=table, polygons=polygons, features="together")
    with pytest.raises(vorotool.VerificationError, match="is in"):
        vorotool.verify_offsets(mixed)


def _same_site(made, other, row):
    one, two = made.site_table, other.site_table
    same = (two.kind == one.kind[row]) & (two.polygon == 0) & (two.ring == 0) & (two.index == one.index[row])
    return int(np.flatnonzero(same)[0])


def test_the_checker_finds_holes_that_are_filled():
    walls = [[0, 0], [20, 0], [20, 20], [0, 20]]
    made = vorotool.offset({"shell": walls, "holes": [[[5, 5], [5, 15], [15, 15], [15, 5]]]}, 1)
    first = made.ring_starts[1]
    filled = replace(
        made,
        **{name: getattr(made, name)[:first] for name in ("start", "end", "center", "site")},
        ring_starts=made.ring_starts[:2],
        shape_starts=np.array([0, 1]),
    )
    with pytest.raises(vorotool.VerificationError, match="not in none"):
        vorotool.verify_offsets(filled)


@pytest.mark.parametrize("distances", [[1.5], [-1.0, 1.5]])
@pytest.mark.parametrize("features", ["separate", "together"])
@pytest.mark.parametrize("last", ["a square", "a bow"])
@pytest.mark.filterwarnings("ignore:repaired")
def test_parts_of_one_feature_that_merge_keep_its_properties(distances, features, last):
    """Two parts of a feature 2 apart, two features 2 apart, and one alone."""
    square = np.array([[0, 0], [4, 0], [4, 4], [0, 4]])
    shells = [square + np.array(corner) for corner in ((0, 0), (6, 0), (0, 20), (6, 20), (14, 0))]
    if last == "a bow":  # what needs a repair lets all rings be others in one drawing
        shells[-1] = shells[-1][[0, 2, 1, 3]]
    polygons = vorotool.PolygonSet(
        np.concatenate(shells),
        np.arange(0, 24, 4),
        np.zeros(5, dtype=np.int8),
        np.arange(5),
        ids=["a", "a", "b", "c", "d"],
        feature=np.array([0, 0, 1, 2, 3]),
        properties={"name": ["first", "first", "second", "third", "fourth"]},
    )
    made = vorotool.offset(polygons, distances, features=features)
    vorotool.verify_offsets(made, distances=distances)
    shapes = made.flattened(0.01)
    outer = np.flatnonzero(made.distance > 0).tolist()
    assert [shapes.properties["name"][k] for k in outer] == ["first", "fourth", None]
    assert [shapes.ids[k] for k in outer] == ["a", "d", None]
    assert made.polygon[outer].tolist()[::2] == [0, -1]
