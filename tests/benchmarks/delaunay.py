"""Measure the triangulation beside its peers, in one run: `make bench`.

Nanoseconds a point, the least of several runs; ratios are what to compare, since machines differ. `mesh` makes the
structure, `arrays` writes triangles, neighbors and edges from it; `delaunay` is the function of the library, which
checks its input too. Peers give triangles: scipy (Qhull) with neighbors, shapely (GEOS), `triangle` (Shewchuk) and
CGAL, which is given its own points: making them from an array takes longer still. A peer that is not installed is left
out. MB are those that a process of its own takes at its peak, above what it had with the points loaded.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
import vorotool
from benchmarks.timing import best, in_own_process, options, peak_of, print_head
from support.families import point_families
from vorotool import _core


def grid(rng: np.random.Generator, n: int) -> np.ndarray:
    """A square grid in order, as rasters give it."""
    side = round(n**0.5)
    return np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2).astype(np.float64)


INPUTS: dict[str, Callable[[np.random.Generator, int], np.ndarray]] = {
    "uniform": point_families.uniform,
    "grid": grid,
    "clustered": point_families.clustered,
    "far outlier": lambda rng, n: np.concatenate([rng.random((n - 1, 2)), [[1e7, 1e7]]]),
}


def scipy_triangles(points: np.ndarray) -> object:
    """Qhull, by scipy."""
    from scipy.spatial import Delaunay

    return Delaunay(points).simplices


def shapely_triangles(points: np.ndarray) -> object:
    """GEOS, by shapely."""
    import shapely

    return shapely.delaunay_triangles(shapely.multipoints(points))


def triangle_triangles(points: np.ndarray) -> object:
    """Triangle, by its Python package; without checks of the input."""
    import triangle

    return triangle.triangulate({"vertices": points}, "Q")["triangles"]


def cgal_points(points: np.ndarray) -> object:
    """The list that CGAL's package takes."""
    from CGAL.CGAL_Kernel import Point_2

    return [Point_2(x, y) for x, y in points.tolist()]


def cgal_triangles(points: object) -> object:
    """CGAL, by its Python package."""
    from CGAL.CGAL_Triangulation_2 import Delaunay_triangulation_2

    triangulation = Delaunay_triangulation_2()
    triangulation.insert(points)
    return triangulation


PEERS = {
    "scipy": scipy_triangles,
    "shapely": shapely_triangles,
    "triangle": triangle_triangles,
    "CGAL": cgal_triangles,
}
PREPARED = {"CGAL": cgal_points}


def memory(who: str, points: np.ndarray) -> float:
    """Peak memory of triangulating points, in MB."""
    triangulate, prepare = PEERS.get(who, vorotool.delaunay), PREPARED.get(who, np.asarray)
    triangulate(prepare(np.random.default_rng(0).random((10, 2))))  # imports what it needs
    given = prepare(points)
    return peak_of(lambda: triangulate(given)) / 1e6


def nanoseconds(function: Callable[[], object], n: int, runs: int) -> float:
    """Least nanoseconds a point of several runs."""
    return 1e9 * best(function, runs) / n


def measure(name: str, n: int, threads: int, runs: int, peers: list[str]) -> str:
    """One row of the table."""
    points = np.ascontiguousarray(INPUTS[name](np.random.default_rng(n), n))
    n = len(points)
    row = f"| {name} | {n:,} |"
    for count in sorted({1, threads}):
        mesh = _core.delaunay.DelaunayTriangulation(points, count, None)
        made = nanoseconds(lambda count=count: _core.delaunay.DelaunayTriangulation(points, count, None), n, runs)
        written = nanoseconds(lambda mesh=mesh, count=count: mesh.arrays(count, None), n, runs)
        whole = nanoseconds(lambda count=count: vorotool.delaunay(points, threads=count), n, runs)
        row += f" {made:.0f} + {written:.0f} | {whole:.0f} |"
    row += f" {in_own_process(memory, 'vorotool', points):.0f} |"
    for peer in peers:
        given = PREPARED.get(peer, np.asarray)(points)
        taken = nanoseconds(lambda peer=peer, given=given: PEERS[peer](given), n, 1 if n >= 10**6 else 2)
        row += f" {taken:,.0f} ({taken / whole:,.1f} ×) | {in_own_process(memory, peer, points):.0f} |"
    return row


def main() -> None:
    """Print the table."""
    arguments = options("points", [10_000, 100_000, 1_000_000], runs=5).parse_args()
    peers = [] if arguments.no_peers else [name for name in PEERS if find_spec(name)]
    threads = sorted({1, arguments.threads})
    print("nanoseconds a point; in brackets: how many times ours on the most threads\n")
    ours = [name for t in threads for name in (f"mesh + arrays, {t} threads", f"delaunay, {t} threads")]
    print_head("points", "n", *ours, "MB", *(name for peer in peers for name in (peer, "MB")))
    for n in arguments.points:
        for name in INPUTS:
            print(measure(name, n, arguments.threads, arguments.runs, peers), flush=True)


if __name__ == "__main__":
    main()
