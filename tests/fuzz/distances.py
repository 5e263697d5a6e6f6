"""Hausdorff and smallest distances against bounds by brute force, and against shapely: `--cases 10000 --seed 1`."""

import shapely

from fuzz.runner import Cases, Comparison, Verdict
from support.families.shape_pairs import FAMILIES
from support.oracles.distance_oracle import directed_bounds, smallest
from vorotool import VorotoolError, distance, hausdorff, verify_distances

ROUNDING = 1e-11
"""Of lengths up to 10: that of brute force."""


def failure(a, b, *, is_verified=False):
    """What is wrong with the distances between two lists of shapely geometry, if anything."""
    for boundary in (False, True):
        found, closest = hausdorff(a, b, boundary=boundary), distance(a, b, boundary=boundary)
        wrong = _wrong_way("a to b", found.from_a.distance, a, b, boundary)
        wrong = wrong or _wrong_way("b to a", found.from_b.distance, b, a, boundary)
        least = smallest(a, b, boundary=boundary)
        if wrong is None and not abs(closest.smallest.distance - least) <= ROUNDING:
            wrong = f"the smallest distance is {closest.smallest.distance}, not {least}"
        if wrong is None and boundary:
            wrong = _less_than_shapely(found.distance, a, b)
        if wrong is None and is_verified:
            try:
                verify_distances(found)
                verify_distances(closest)
            except VorotoolError as error:
                wrong = str(error)
        if wrong is not None:
            return f"boundary {boundary}: {wrong}: {[each.wkt for each in a]} {[each.wkt for each in b]}"
    return None


def _wrong_way(name, found, a, b, boundary):
    low, high = directed_bounds(a, b, boundary=boundary)
    if low - ROUNDING <= found <= high + ROUNDING:
        return None
    return f"{name} is {found}, not from {low} to {high}"


def _less_than_shapely(found, a, b):
    """Of lines shapely measures from vertices and places between, which gives less."""
    if any(shapely.get_type_id(each) != 1 for each in (*a, *b)):
        return None
    theirs = shapely.hausdorff_distance(shapely.MultiLineString(a), shapely.MultiLineString(b), densify=0.05)
    return None if theirs <= found + ROUNDING else f"it is {found}, but shapely finds {theirs}"


def check(case: int, cases: Cases) -> Verdict:
    """Measure a pair of shapes; some are given to the checker too."""
    random, family = cases.random(case), FAMILIES[case % len(FAMILIES)]
    return family.__name__, failure(*family(random), is_verified=case % 10 < len(FAMILIES) // 10 + 1), ""


COMPARISON = Comparison(10_000, check)
