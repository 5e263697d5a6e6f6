"""Polygons that are written, read back with shapely: `--sets 10000 --seed 1`.

Every product with polygons, as GeoJSON, WKT and GeoPackage, with all decimals, 3 and 0, of points and polygons whose
results lie close to themselves: lattices of tenths, thirds and thousandths of a degree, cocircular points, fours that
are nearly so, terraces in UTM whose walls are equal up to rounding, and pieces of real land.
"""

import json
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from shapely import affinity

import vorotool
from fuzz.runner import Cases, Comparison, Verdict
from vorotool import VorotoolError

FORMATS = ("geojson", "wkt", "gpkg")
DECIMALS = (None, 3, 0)
LAND = Path(__file__).parents[2] / "data" / "great-lakes.geojson"


# ---- points --------------------------------------------------------------------------------------
def uniform(rng: np.random.Generator) -> np.ndarray:
    return rng.uniform(0, 10.0 ** rng.integers(-1, 5), (int(rng.integers(3, 60)), 2))


def lattice(rng: np.random.Generator) -> np.ndarray:
    step = rng.choice([0.1, 1 / 3, 0.001, 1.0])
    places = rng.permutation(np.stack(np.meshgrid(np.arange(9), np.arange(8)), -1).reshape(-1, 2))
    return places[: int(rng.integers(3, 60))] * step + rng.choice([0.0, 0.7, 179.3, 5e5], 2)


def cocircular(rng: np.random.Generator) -> np.ndarray:
    turn = rng.uniform(0, 2 * np.pi, 30)
    return np.stack([np.cos(turn), np.sin(turn)], 1) * rng.choice([1.0, 3.0], (30, 1)) + rng.choice([0, 10, 1e6])


def nearly_cocircular(rng: np.random.Generator) -> np.ndarray:
    size = 10.0 ** rng.integers(-1, 3)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * size
    noise = rng.normal(size=(8, 4, 2)) * size * 10.0 ** rng.integers(-16, -8)
    return (rng.uniform(0, 10 * size, (8, 1, 2)) + square + noise).reshape(-1, 2) + rng.choice([0, 5.3e6])


def hundredths(rng: np.random.Generator) -> np.ndarray:
    return np.round(rng.uniform(0, 10, (int(rng.integers(3, 12)), 2)), int(rng.integers(0, 3)))


# ---- polygons ------------------------------------------------------------------------------------
def terraces(rng: np.random.Generator) -> list[Any]:
    """Rows of houses whose common walls are computed once from either side."""
    houses = []
    for _ in range(int(rng.integers(1, 4))):
        turn, corner = rng.uniform(0, np.pi), rng.uniform(0, 80, 2) + np.array([5e5, 5.3e6]) * rng.integers(0, 2)
        ahead, aside = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
        at = corner
        for _ in range(int(rng.integers(2, 7))):
            width, depth = rng.uniform(4, 9), 10 if rng.random() < 0.6 else rng.uniform(7, 12)
            ring = [at, at + width * ahead, at + width * ahead + depth * aside, at + depth * aside]
            houses.append(shapely.Polygon(ring))
            at = at + width * ahead
    return houses


def blobs(rng: np.random.Generator) -> list[Any]:
    shapes = []
    for _ in range(int(rng.integers(1, 6))):
        n = int(rng.integers(3, 14))
        turn = np.sort(rng.uniform(0, 2 * np.pi, n))
        radius = rng.uniform(0.3, 1, n)[:, None] * 10.0 ** rng.integers(0, 3)
        shapes.append(shapely.Polygon(np.stack([np.cos(turn), np.sin(turn)], 1) * radius + rng.uniform(0, 30, 2)))
    return [shape for shape in shapes if shape.is_valid and shape.area > 0]


def land(rng: np.random.Generator) -> list[Any]:
    features = json.loads(LAND.read_text())["features"]
    whole = shapely.from_geojson(json.dumps(features[rng.integers(len(features))]["geometry"]))
    x, y = shapely.get_coordinates(whole)[rng.integers(shapely.get_num_coordinates(whole))]
    cut = shapely.intersection(whole, shapely.box(x - 0.4, y - 0.4, x + 0.4, y + 0.4))
    parts = [part for part in shapely.get_parts(cut) if part.geom_type == "Polygon" and part.area > 1e-6]
    return [affinity.scale(part, 1e5, 1e5, origin=(x, y)) for part in parts] if rng.random() < 0.5 else parts


POINTS: list[Callable[[np.random.Generator], np.ndarray]] = [
    *(uniform, lattice, cocircular, nearly_cocircular, hundredths),
]
SHAPES: list[Callable[[np.random.Generator], list[Any]]] = [terraces, blobs, land]


# ---- products ------------------------------------------------------------------------------------
Made = tuple[str, Any, str | None, float | None]
"""A name, a value, the part that is written, and the area of a coverage (NaN: any) or None."""


def of_points(points: np.ndarray, rng: np.random.Generator) -> Iterator[Made]:
    low, high = np.floor(points.min(axis=0)) - 1, np.ceil(points.max(axis=0)) + 1
    frame = (*low, *(high - low))
    whole = float((high - low).prod())
    yield "cells", vorotool.voronoi_cells(points, frame=frame), None, whole
    yield "voronoi", vorotool.voronoi(points, frame=frame), None, whole
    family = vorotool.alpha_complex(points)
    if len(family.spectrum):
        shape = vorotool.alpha_shape(family, r=float(rng.choice(family.spectrum)) * rng.choice([1.0, 1.3]))
        yield "alpha", shape, "polygons", None


def of_shapes(shapes: list[Any], rng: np.random.Generator) -> Iterator[Made]:
    reach = float(np.ptp(shapely.get_coordinates(shapes), axis=0).max()) / 10
    left, bottom, right, top = shapely.total_bounds(shapes)
    frame = (np.floor(left) - 3, np.floor(bottom) - 3, np.ceil(right - left) + 7, np.ceil(top - bottom) + 7)
    yield "voronoi", vorotool.voronoi(shapes, frame=frame), None, frame[2] * frame[3]
    yield "limited", vorotool.voronoi(shapes, max_distance=reach * rng.uniform(0.1, 2)), None, np.nan
    yield "offsets", vorotool.offset(shapes, [-reach / 20, reach * rng.uniform(0.1, 1)]), None, None
    yield "discs", vorotool.largest_discs(shapes), None, None
    yield "parts", vorotool.parts(shapes, neck=0.8), None, None


# ---- what is read back ---------------------------------------------------------------------------
def read_back(path: Path, fmt: str) -> np.ndarray:
    """Give the geometry in a file, as another library reads it."""
    if fmt == "wkt":
        return shapely.from_wkt(path.read_text().splitlines())
    if fmt == "geojson":
        geometry = [each["geometry"] for each in json.loads(path.read_text())["features"]]
        return np.array([None if g is None else shapely.from_geojson(json.dumps(g)) for g in geometry], dtype=object)
    import pyogrio

    _, _, geometry, _ = pyogrio.raw.read(path)
    return shapely.from_wkb(geometry)


def fault(path: Path, fmt: str, decimals: int | None, area: float | None) -> str | None:
    """What is wrong with the polygons in a file, if anything."""
    shapes = read_back(path, fmt)
    shapes = shapes[~(shapely.is_missing(shapes) | shapely.is_empty(shapes))]
    bad = np.flatnonzero(~shapely.is_valid(shapes))
    if bad.size:
        return f"{bad.size} invalid: {shapely.is_valid_reason(shapes[bad[0]])}"
    xy = shapely.get_coordinates(shapes)
    if decimals is not None and (np.round(xy, decimals) != xy).any():
        return "more decimals"
    union = shapely.union_all(shapes)
    if area is None:
        return None
    if not shapely.coverage_is_valid(shapes):
        return "no coverage"
    expected = union.area if np.isnan(area) else area
    total = shapely.area(shapes).sum()
    far = abs(total - expected) > 1e-9 * expected
    return f"areas sum to {total}, not {expected}" if far else None


def check(case: int, cases: Cases) -> Verdict:
    """Write all results of some points or polygons, and read them back."""
    rng, families = cases.random(case), [*POINTS, *SHAPES]
    family: Any = families[case % len(families)]
    wrong = []
    try:
        given = family(rng)
        made = of_points(given, rng) if family in POINTS else of_shapes(given, rng) if given else iter(())
        for name, value, what, area in made:
            fmt, decimals = FORMATS[int(rng.integers(3))], DECIMALS[int(rng.integers(3))]
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / f"a.{fmt}"
                vorotool.write(value, path, what=what, decimals=decimals)
                found = fault(path, fmt, decimals, area)
            cases.counts[name] += 1
            wrong += [f"{name} as {fmt} with {decimals} decimals: {found}"] * (found is not None)
    except VorotoolError as error:
        wrong.append(f"{type(error).__name__}: {error}")
    return family.__name__, "; ".join(wrong) or None, ""


COMPARISON = Comparison(300, check, "set")
