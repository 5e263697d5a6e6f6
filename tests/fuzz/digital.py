"""Repair the digital triangulation of many seed sets and certify it: `--sets 500 --seed 1`.

Images of 64 to 1024 pixels a side, 1 to m²/20 seeds: uniform, in clusters, on coarse lattices, on lines and circles.
The repaired mesh must pass the shipped checker, have every site, and be the exact triangulation, array by array. Says
how many sets needed each step of the repair.
"""

from dataclasses import asdict

import numpy as np

from fuzz.runner import Cases, Comparison, Verdict
from vorotool import VorotoolError, delaunay, repair_digital, verify_triangulation

SIDES = (64, 128, 256, 512, 1024)
ARRAYS = ("triangles", "neighbors", "edges", "hull", "first")


def uniform(rng, m, n):
    return rng.integers(0, m, (n, 2))


def clustered(rng, m, n):
    centers = rng.integers(0, m, (4, 2))
    return np.rint(centers[rng.integers(0, 4, n)] + rng.normal(0, m / 12, (n, 2)))


def lattice(rng, m, n):
    """Cocircular seeds in plenty, some of them moved by a pixel."""
    step = max(4, m // int(np.sqrt(n) + 1))
    return step * rng.integers(0, m // step, (n, 2)) + (rng.random((n, 2)) < 0.1)


def lines(rng, m, n):
    """Seeds on a few lines: thin cells, and flat triangles where they are cut."""
    start, step = rng.integers(0, m, (3, 2)), rng.integers(-3, 4, (3, 2))
    line = rng.integers(0, 3, n)
    return start[line] + step[line] * rng.integers(-m, m, (n, 1))


def circles(rng, m, n):
    angle, radius = rng.uniform(0, 2 * np.pi, n), m * rng.choice([0.2, 0.35, 0.49], n)
    return np.rint(m / 2 + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))


FAMILIES = (uniform, uniform, clustered, lattice, lines, circles)


def draw(rng):
    """A side, and distinct seeds inside."""
    m = int(rng.choice(SIDES))
    most = m * m // 20
    n = int(rng.integers(1, most + 1)) if rng.random() < 0.5 else int(2 ** rng.uniform(0, np.log2(most)))
    family = FAMILIES[rng.integers(0, len(FAMILIES))]
    seeds = np.asarray(family(rng, m, n), dtype=np.int64)
    inside = seeds[((seeds >= 0) & (seeds < m)).all(axis=1)]
    # Labels decide ties: in raster order these would all fall to one side, and spare the repair its hard cases.
    return family.__name__, m, rng.permutation(np.unique(inside, axis=0))


def failure(m, seeds, needed):
    """What is wrong with the repaired triangulation, if anything."""
    mesh, repair = repair_digital(seeds, shape=(m, m))
    try:
        verify_triangulation(mesh)
    except VorotoolError as error:
        return f"the checker says: {error}"
    exact = delaunay(seeds)
    for name in ARRAYS:
        if not np.array_equal(getattr(mesh, name), getattr(exact, name)):
            return f"{name} are not those of the exact triangulation"
    if len(np.unique(mesh.edges)) != (len(seeds) if len(seeds) > 1 else 0):
        return "a site was dropped"
    needed[f"route: {repair.route}"] += 1
    needed.update(name for name, count in asdict(repair).items() if name not in ("route", "fault") and count)
    return None


def check(case: int, cases: Cases) -> Verdict:
    """Repair the triangulation of some seeds."""
    name, m, seeds = draw(cases.random(case))
    if len(seeds) == 0:
        seeds = np.array([[m // 2, m // 2]])
    cases.counts["sites"] += len(seeds)
    return name, failure(m, seeds, cases.counts), f"{len(seeds)} seeds in {m} x {m}"


COMPARISON = Comparison(500, check, "set")
