"""Measure alpha shapes beside their peers, in one run: `make bench`.

Seconds, the least of several runs, for uniform points. `family` is the triangulation, the radii of all edges and the
sorted spectrum, from points; `each r` the edges of one further shape. GUDHI gives the values of all simplices;
`alphashape` and shapely's concave hull give one shape. A peer that is not installed is left out.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import numpy as np

sys.path.pop(0)  # this file is not the peer of its name
sys.path.insert(0, str(Path(__file__).parents[1]))
import vorotool
from benchmarks.timing import best, options, print_head
from support.families import point_families


def gudhi_values(points: np.ndarray, _r: float) -> object:
    """Values of all simplices; in doubles, which is its fastest way."""
    import gudhi

    return gudhi.AlphaComplex(points=points, precision="fast").create_simplex_tree().num_simplices()


def alphashape_polygon(points: np.ndarray, r: float) -> object:
    """One shape, by the package alphashape."""
    import alphashape

    return alphashape.alphashape(points, 1 / r)


def shapely_concave_hull(points: np.ndarray, _r: float) -> object:
    """Another kind of hull, by GEOS."""
    import shapely

    return shapely.concave_hull(shapely.multipoints(points), ratio=0.02)


PEERS: dict[str, tuple[Callable[[np.ndarray, float], object], str, int]] = {
    "gudhi": (gudhi_values, "all values", 10**6),
    "alphashape": (alphashape_polygon, "one r", 10**5),
    "shapely": (shapely_concave_hull, "concave hull", 10**6),
}
"""What a peer runs, what that gives, and the most points that it is run on."""


def measure(n: int, threads: list[int], runs: int, peers: list[str]) -> str:
    """One row of the table."""
    points = point_families.uniform(np.random.default_rng(n), n)
    row, family = f"| {n:,} |", vorotool.alpha_complex(points)
    radii = family.spectrum[len(family.spectrum) // 2] * np.array([0.5, 1.0, 2.0])
    whole = 0.0
    for count in threads:
        whole = best(lambda count=count: vorotool.alpha_complex(points, threads=count), runs)
        each = [best(lambda r=r, count=count: vorotool.alpha_edges(family, r, threads=count), 2 * runs) for r in radii]
        row += f" {whole:.4f} | {1000 * max(each):.2f} ms |"
    row += f" {best(lambda: vorotool.alpha_curves(family), 1):.3f} |"
    for peer in peers:
        function, _, most = PEERS[peer]
        if n > most:
            row += " – |"
            continue
        taken = best(lambda function=function: function(points, float(radii[1])), 1)
        row += f" {taken:.3f} ({taken / whole:,.1f} ×) |"
    return row


def main() -> None:
    """Print the table."""
    arguments = options("points", [10_000, 100_000, 1_000_000], runs=5).parse_args()
    peers = [] if arguments.no_peers else [name for name in PEERS if find_spec(name)]
    threads = sorted({1, arguments.threads})
    print("seconds; in brackets: how many times ours on the most threads\n")
    ours = [name for t in threads for name in (f"family, {t} threads", f"each r, {t} threads")]
    print_head("n", *ours, "curves", *(f"{name}, {PEERS[name][1]}" for name in peers))
    for n in arguments.points:
        print(measure(n, threads, arguments.runs, peers), flush=True)


if __name__ == "__main__":
    main()
