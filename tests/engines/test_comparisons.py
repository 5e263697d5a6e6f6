"""A few cases of each comparison of `make fuzz`: with brute force, other libraries, and of results with each other."""

import warnings
from importlib import import_module

import numpy as np
import pytest

from support.families.skeleton_shapes import small
from support.few import few

CASES = {
    **{
        "delaunay": 84,
        "cells": 42,
        "alphashape": 42,
        "alphashape_space": 30,
        "planar_graph": 90,
        "digital": 6,
        "distances": 12,
    },
    **{"ends": 9, "features": 36, "outlines": 12, "thickness": 2, "rotation": 4, "predicates": 4},
    **{"segment_voronoi": 100, "skeletons": 48, "voronoi": 40, "voronoi_cuts": 24, "tessellate": 4, "spacing": 4},
    **{"volumes": 4},
}
"""How many `make test` runs; `make test-all` runs three times as many."""

SMALL = {"offsets": (10, 4), "pruning": (14, 5), "skeleton_approx": (14, 5), "necks": (40, 5), "discs": (20, 6)}
"""Oracles that take time are for shapes of at most so many corners, and `make test` draws so many of the families."""


def pieces():
    """Numbers of cases that are run together."""
    for name, count in CASES.items():
        step = min(count, 12)
        yield from few([(name, first, first + step) for first in range(0, 3 * count, step)], -(-count // step))


def families():
    """Families of the comparisons whose shapes are to be small."""
    for name, (_, count) in SMALL.items():
        module = import_module(f"fuzz.{name}")
        drawn = getattr(module, "SHAPES", module.FAMILIES)
        yield from few([(name, family, seed) for seed in (5, 0) for family in drawn], count)


@pytest.mark.parametrize(("name", "first", "end"), [*pieces()])
@pytest.mark.filterwarnings("ignore")
def test_cases(name, first, end, monkeypatch):
    monkeypatch.setenv("VOROTOOL_SIMD", "portable")  # which some set
    comparison = import_module(f"fuzz.{name}").COMPARISON
    cases = comparison.cases(["--seed", "5"])
    verdicts = {case: comparison.check(case, cases) for case in range(first, end)}
    assert {case: verdict for case, verdict in verdicts.items() if verdict[1] is not None} == {}


@pytest.mark.parametrize(("name", "family", "seed"), [*families()], ids=lambda each: getattr(each, "__name__", each))
def test_small_shapes(name, family, seed):
    with warnings.catch_warnings(action="ignore"):
        shape = small(family, seed, most=SMALL[name][0])
        assert import_module(f"fuzz.{name}").failure(shape, np.random.default_rng(seed)) is None
