"""Measure triangulations in space beside their peers, in one run: `make bench`.

Nanoseconds a point, the least of several runs one after the other: the first waits for the system to find memory, which
on virtual machines may take as long as all else. Ratios are what to compare, since machines differ. `delaunay` is the
function of the library; `alpha` what all alpha values and `table` what the table of the points take beyond it, on the
most threads. Peers give tetrahedra: scipy (Qhull), GUDHI, and CGAL, which is given its own points; some are left out
where they would take minutes. A peer that is not installed is left out. Bytes a point are those that a process of its
own takes at its peak, above what it had with the points, or the triangulation, loaded.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
import vorotool
from benchmarks.timing import best, in_own_process, options, peak_of, print_head
from vorotool.engines.delaunay.tetrahedralization import space_table


def lattice(_rng: np.random.Generator, n: int) -> np.ndarray:
    """A cube of a lattice, in order."""
    side = round(n ** (1 / 3))
    return np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3).astype(np.float64)


def sphere(rng: np.random.Generator, n: int) -> np.ndarray:
    """Points that would be on a sphere, but for rounding."""
    points = rng.normal(size=(n, 3))
    return points / np.sqrt((points**2).sum(axis=1, keepdims=True))


def clustered(rng: np.random.Generator, n: int) -> np.ndarray:
    """Clouds of a thousand points."""
    return rng.random((n // 1000 + 1, 3))[np.arange(n) // 1000] + rng.normal(0, 1e-3, (n, 3))


INPUTS: dict[str, Callable[[np.random.Generator, int], np.ndarray]] = {
    "uniform": lambda rng, n: rng.random((n, 3)),
    "lattice": lattice,
    "sphere": sphere,
    "clustered": clustered,
}


def scipy_tetrahedra(points: np.ndarray) -> object:
    """Qhull, by scipy."""
    from scipy.spatial import Delaunay

    return Delaunay(points).simplices


def gudhi_tetrahedra(points: np.ndarray) -> object:
    """CGAL, by GUDHI, without the values of the simplices."""
    import gudhi

    made = gudhi.AlphaComplex(points=points, precision="safe")
    return made.create_simplex_tree(default_filtration_value=True)


def cgal_tetrahedra(points: np.ndarray) -> Callable[[], object]:
    """CGAL, by its Python package, whose own points are made beforehand."""
    from CGAL.CGAL_Kernel import Point_3
    from CGAL.CGAL_Triangulation_3 import Delaunay_triangulation_3

    given = [Point_3(x, y, z) for x, y, z in points.tolist()]
    return lambda: Delaunay_triangulation_3(given)


PEERS: dict[str, tuple[str, int]] = {"CGAL": ("CGAL", 10**6), "scipy": ("scipy", 10**5), "GUDHI": ("gudhi", 10**5)}
"""What is imported of each, and the most points that it gets."""
MOST_SECONDS = 20.0
SLOW: set[tuple[str, str]] = set()
"""Peers that took longer than that: they get no more points of a family."""


def call_of(who: str, points: np.ndarray, threads: int = 1) -> Callable[[], object]:
    """What is timed."""
    if who == "CGAL":
        return cgal_tetrahedra(points)
    peers = {"scipy": scipy_tetrahedra, "GUDHI": gudhi_tetrahedra}
    return lambda: peers[who](points) if who in peers else vorotool.delaunay(points, threads=threads)


def memory(who: str, points: np.ndarray) -> int:
    """Bytes that a triangulation takes beside its points."""
    call_of(who, np.random.default_rng(0).random((10, 3)))()  # imports what it needs
    return peak_of(call_of(who, points))


RESULTS: dict[str, Callable[[vorotool.Tetrahedralization, int], object]] = {
    "alpha": lambda mesh, threads: vorotool.alpha_complex(mesh, threads=threads),
    "table": lambda mesh, _threads: space_table(mesh),
}
"""What is made of a triangulation."""


def memory_beyond(what: str, points: np.ndarray) -> int:
    """Bytes that a result of a triangulation takes beside it."""
    RESULTS[what](vorotool.delaunay(np.random.default_rng(0).random((10, 3))), 1)
    mesh = vorotool.delaunay(points)
    return peak_of(lambda: RESULTS[what](mesh, 1))


def beyond(what: str, points: np.ndarray, threads: int, runs: int) -> str:
    """Cells of the table for a result; triangulations do not keep it."""
    mesh = vorotool.delaunay(points, threads=threads)
    least = best(lambda: RESULTS[what](mesh, threads), runs)
    return f" {1e9 * least / len(points):,.0f} | {in_own_process(memory_beyond, what, points) / len(points):,.0f} |"


def peer_time(name: str, peer: str, points: np.ndarray, runs: int) -> float:
    """Seconds; one run where that takes long, and no peer gets more points of this family then."""
    run = call_of(peer, points)
    once = best(run, 1)
    if once > MOST_SECONDS:
        SLOW.add((name, peer))
        return once
    return min(once, best(run, runs - 1)) if runs > 1 else once


def measure(name: str, n: int, arguments: argparse.Namespace, peers: list[str]) -> str:
    """One row of the table."""
    points = np.ascontiguousarray(INPUTS[name](np.random.default_rng(n), n))
    n = len(points)
    row, whole = f"| {name} | {n:,} |", 0.0
    for threads in sorted({1, arguments.threads}):
        whole = 1e9 * best(call_of("vorotool", points, threads), arguments.runs) / n
        row += f" {whole:,.0f} |"
    row += f" {in_own_process(memory, 'vorotool', points) / n:,.0f} |"
    row += "".join(beyond(what, points, arguments.threads, arguments.runs) for what in RESULTS)
    for peer in peers:
        if n > PEERS[peer][1] or (name, peer) in SLOW:
            row += " – | – |"
            continue
        taken = 1e9 * peer_time(name, peer, points, arguments.runs) / n
        row += f" {taken:,.0f} ({taken / whole:,.1f} ×) | {in_own_process(memory, peer, points) / n:,.0f} |"
    return row


def main() -> None:
    """Print the table."""
    arguments = options("points", [10_000, 100_000, 1_000_000], runs=2).parse_args()
    peers = [] if arguments.no_peers else [name for name, (module, _) in PEERS.items() if find_spec(module)]
    print("nanoseconds a point; in brackets: how many times ours on the most threads; B: bytes a point\n")
    ours = [f"delaunay, {each} threads" for each in sorted({1, arguments.threads})]
    print_head(
        "points",
        "n",
        *ours,
        "B",
        *(name for what in RESULTS for name in (what, "B")),
        *(name for peer in peers for name in (peer, "B")),
    )
    for n in arguments.points:
        for name in INPUTS:
            print(measure(name, n, arguments, peers), flush=True)


if __name__ == "__main__":
    main()
