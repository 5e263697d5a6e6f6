"""Voronoi diagrams of small sets of shapes, under symmetries and beside distances: `--cases 100000 --seed 1`.

Cases 8 k to 8 k + 7 are one drawing under the 8 symmetries of the square, on whole numbers; a fourth of the drawings
joins shapes into sites. Each map is checked by the shipped checker, and beside distances of shapely at random places
and close to borders, where the first of equally near sites must have the place; its polygons are a coverage of the
frame, and its areas add up to it. It must be the same, bit for bit, on another number of threads and but for the
factor when everything is twice as large, and, where nothing ties over an area, for sites in another order. Under
symmetries areas and neighbors stay, but for rounding. Where the lattice closes a needle of a polygon, which is then
left out with a warning, only the map itself is checked.
"""

import re
import warnings
from functools import lru_cache
from typing import Any

import numpy as np
import shapely

from fuzz.runner import Cases, Comparison, Verdict
from support.families.site_families import WHOLE, mixed_sites
from support.oracles.voronoi_oracle import assert_nearest
from vorotool import VoronoiMap, VorotoolError, verify_voronoi, voronoi

SAME = ("arcs", "sites", "ring_arcs", "ring_starts", "polygon_starts", "cell_starts")
PLACES = 40
ROUNDING = 1e-9
"""Of the frame: what areas may differ by under symmetries, as the lattice is another one."""
SHORT = 1e-6
"""Of the frame: borders below it may be there under one symmetry and not under another."""


def mixed(random: np.random.Generator, count: int) -> list[Any]:
    """Shapes with any coordinates, or on a grid."""
    return mixed_sites(random, count, [None, 10, 4][int(random.integers(3))])


FAMILIES = (*WHOLE, mixed)


def under_symmetry(shapes: list[Any], symmetry: int) -> list[Any]:
    """The shapes mirrored and turned."""
    signs = np.array([1 - 2 * (symmetry & 1), 1 - (symmetry & 2)])
    step = -1 if symmetry & 4 else 1
    return [shapely.transform(each, lambda xy: xy[:, ::step] * signs) for each in shapes]


def geometry_of(shapes: list[Any], by: list[int] | None) -> list[Any]:
    """Of each site."""
    if by is None:
        return shapes
    first = list(dict.fromkeys(by))
    return [
        shapely.GeometryCollection([each for each, value in zip(shapes, by, strict=True) if value == k]) for k in first
    ]


def unlike_the_first(cells: VoronoiMap, first: VoronoiMap) -> str | None:
    """What a symmetry changed."""
    area = cells.frame[2] * cells.frame[3]
    off = np.abs(cells.areas - first.areas).max(initial=0)
    if off > ROUNDING * area:
        return f"an area differs by {off} of {area}"
    short = SHORT * max(cells.frame[2:])
    lengths = [dict(_lengths(each)) for each in (cells, first)]
    for one, other in (lengths, lengths[::-1]):
        lost = [pair for pair, length in one.items() if length > 10 * short and pair not in other]
        if lost:
            return f"cells {lost[0]} are no neighbors under another symmetry"
    return None


def _lengths(cells: VoronoiMap) -> list[tuple[tuple[int, int], float]]:
    table = cells.neighbors
    pairs = zip(table["label_a"].tolist(), table["label_b"].tolist(), strict=True)
    return list(zip(pairs, table["border_length"].tolist(), strict=True))


def changed_bits(shapes: list[Any], by: list[int] | None, cells: VoronoiMap, rng: np.random.Generator) -> str | None:
    """What differs on other threads, twice as large, or in another order."""
    if voronoi(shapes, by=by, threads=3) != cells:
        return "three threads give something else"
    frame = tuple(2 * side for side in cells.frame)
    large = voronoi([shapely.transform(each, lambda xy: 2 * xy) for each in shapes], by=by, frame=frame, threads=1)
    if any(not np.array_equal(getattr(large, name), getattr(cells, name)) for name in SAME):
        return "twice as large it is another map"
    if not np.array_equal(large.vertices, 2 * cells.vertices) or not np.array_equal(large.areas, 4 * cells.areas):
        return "twice as large it has other places"
    order = rng.permutation(len(shapes))
    if by is None and _is_apart(shapes):
        other = voronoi([shapes[k] for k in order], threads=1)
        if [each.wkb for each in other.to_shapely()] != [cells.to_shapely()[k].wkb for k in order]:
            return f"the order {order.tolist()} gives other cells"
        if not np.array_equal(other.areas, cells.areas[order]):
            return f"the order {order.tolist()} gives other areas"
    return None


def _is_apart(shapes: list[Any]) -> bool:
    return len(shapes) < 2 or not any(shapely.intersects(each, shapes[:k]).any() for k, each in enumerate(shapes) if k)


def map_of(shapes: list[Any], by: list[int] | None) -> VoronoiMap | None:
    """The map of shapes; None where the lattice closes one, which is left out."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        cells = voronoi(shapes, by=by, threads=1)
    is_thin = any(re.search("bounds? nothing", str(each.message)) for each in told)
    verify_voronoi(cells, places=0 if is_thin else PLACES)
    return None if is_thin else cells


def failure(shapes: list[Any], by: list[int] | None, first: VoronoiMap | None, case: list[int]) -> str | None:
    """What is wrong with the map of these shapes, if anything."""
    cells = map_of(shapes, by)
    if cells is None:
        return None
    assert_nearest(geometry_of(shapes, by), cells, seed=case, count=PLACES)
    return unlike_the_first(cells, first) if first else changed_bits(shapes, by, cells, np.random.default_rng(case))


@lru_cache(maxsize=1)
def unturned(drawing: int, seed: int) -> tuple[str, list[Any], list[int] | None]:
    """The family of a drawing, its shapes, and which of them are one site."""
    random, draw = np.random.default_rng([seed, drawing]), FAMILIES[drawing % len(FAMILIES)]
    count = int(np.exp(random.uniform(0, np.log(30))))
    shapes = draw(random, count)
    return draw.__name__, shapes, random.integers(0, 1 + count // 2, count).tolist() if random.random() < 0.25 else None


@lru_cache(maxsize=1)
def first_map(drawing: int, seed: int) -> VoronoiMap | None:
    """The map of a drawing as it is drawn."""
    return map_of(*unturned(drawing, seed)[1:])


def check(case: int, cases: Cases) -> Verdict:
    """Judge the map of shapes under one of the symmetries, beside that of the shapes as they were drawn."""
    drawing, symmetry = divmod(case, 8)
    name, shapes, by = unturned(drawing, cases.arguments.seed)
    cases.counts["shapes"] += len(shapes)
    wrong = None
    try:
        first = first_map(drawing, cases.arguments.seed) if symmetry else None
        wrong = failure(under_symmetry(shapes, symmetry), by, first, cases.seed(case))
    except (VorotoolError, AssertionError, ValueError) as error:
        wrong = f"{type(error).__name__}: {' '.join(str(error).split())[:300]}"
    return name, wrong, f"{len(shapes)} shapes"


COMPARISON = Comparison(10**5, check)
