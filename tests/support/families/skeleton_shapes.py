"""Random polygons and lines, most of them broken: inputs of the skeleton tests."""

from dataclasses import replace
from itertools import count
from pathlib import Path

import numpy as np

from support.families.segment_families import cells_of_a_map, draw, symmetries
from vorotool.convert.polygons import as_polygons
from vorotool.engines.label_images.outlines import outlines

DATA = sorted(path for end in ("json", "geojson") for path in (Path(__file__).parents[3] / "data").glob(f"*.{end}"))
"""Polygons that come with the project; each of these files is one."""

RINGS = (
    "star_smooth",
    "star_rough",
    "star_small",
    "rectilinear",
    "jittered_grid",
    "comb",
    "comb_tapered",
    "spiral",
    "koch",
    "regular",
    "chains",
)
"""Families of graphs that are one ring."""


def star(rng):
    """Around the origin, with spikes; whole coordinates up to 10^9."""
    corners = rng.integers(3, 25)
    angle = np.sort(rng.random(corners)) * 2 * np.pi
    radius = rng.random(corners) * 10 ** rng.integers(1, 10)
    return np.round(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1))


def crossing(rng):
    """Vertices anywhere in a small square: edges cross, overlap and touch."""
    return rng.integers(0, rng.integers(3, 50), (rng.integers(3, 12), 2)).astype(float)


def fractions(rng):
    """No coordinate is on a coarse lattice."""
    return rng.random((rng.integers(3, 12), 2)) - 0.5


def several(rng):
    """Polygons that overlap."""
    return [crossing(rng) for _ in range(rng.integers(1, 4))]


def with_lines(rng):
    """Open lines, single places, and a polygon."""
    lines = [{"line": rng.integers(0, 12, (rng.integers(1, 5), 2)).tolist()} for _ in range(rng.integers(1, 5))]
    return [*lines, {"shell": crossing(rng).tolist()}]


def tiles(rng):
    """Unit squares on a grid: they share corners and edges, and many places tie."""
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    return [{"shell": (square + rng.integers(0, 4, 2)).tolist()} for _ in range(rng.integers(1, 8))]


def holed(rng):
    """A square with holes that may touch or overlap."""
    corners = rng.integers(0, 9, (rng.integers(1, 5), 2))
    holes = [np.add(corner, [[0, 0], [0, 2], [2, 1]]).tolist() for corner in corners]
    return [{"shell": [[0, 0], [10, 0], [10, 10], [0, 10]], "holes": holes}]


def valid(rng):
    """A ring that needs no repair."""
    points, _ = draw(RINGS[int(rng.integers(len(RINGS)))], int(rng.integers(3, 60)), rng)
    return points.astype(float)


def partition(rng):
    """Cells of a map."""
    return cells_of_a_map(rng, int(rng.integers(6, 60)))


def straight(rng):
    """A ring with vertices between its corners, on the edges exactly."""
    ring = 4.0 * rng.integers(0, 30, (rng.integers(3, 9), 2))
    following = np.roll(ring, -1, axis=0)
    return np.stack([ring, (3 * ring + following) / 4, (ring + following) / 2], axis=1).reshape(-1, 2)


def mask(rng):
    """Outlines of random pixels, which hang together at corners."""
    return outlines(rng.random(rng.integers(2, 14, 2)) < rng.random(), connectivity=int(rng.choice([4, 8])))


def labels(rng):
    """Polygons of a label image: they share edges, and have straight vertices where others end."""
    image = rng.integers(0, rng.integers(2, 5), rng.integers(2, 14, 2))
    return outlines(image, mode="labels", connectivity=int(rng.choice([4, 8])))


FAMILIES = (star, crossing, fractions, several, with_lines, tiles, holed, valid, partition)
TOUCHING = (straight, mask, labels)
"""Polygons with straight vertices, many of which touch."""


def small(family, seed, most=20):
    """The first shape of a family, from a seed on, with no more corners than that."""
    shapes = (family(np.random.default_rng(k)) for k in count(seed))
    return next(shape for shape in shapes if len(as_polygons(shape).xy) <= most)


def under_symmetries(shape):
    """A shape under the 8 symmetries of the square."""
    polygons = as_polygons(shape)
    for xy in symmetries(polygons.xy):
        yield replace(polygons, xy=xy)


def regular(corners, radius=1000.0):
    """A regular polygon."""
    angle = 2 * np.pi * np.arange(corners) / corners
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
