"""Measure the Hausdorff distance beside shapely's, densified, in one run: `make bench`.

Seconds of both for pairs of a zigzag line of so many edges and one around it, and by how much each is off: ours from
bounds by bisection, where edges are few; shapely's from ours. It sees vertices only, unless edges are divided: into as
many parts as are needed for 1e-3 of the distance. Our accuracy would need some 10^12 parts.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import shapely

sys.path.insert(0, str(Path(__file__).parents[1]))
import vorotool
from benchmarks.timing import options, timed
from support.oracles.distance_oracle import directed_bounds
from vorotool.types.polygons.polygon_set import LINE, PolygonSet

MOST_CHECKED, MOST_OF_PEERS = 300, 3000
"""Edges."""


def zigzag_and_its_hull(count: int) -> tuple[np.ndarray, np.ndarray]:
    """A line of so many edges up and down, and one along its lower and its upper ends: edges go through between."""
    random = np.random.default_rng(1)
    x, y = 10 * np.arange(count + 1.0), 50.0 * (np.arange(count + 1) % 2)
    line = np.stack([x, y], axis=1) + random.random((count + 1, 2))
    around = np.concatenate([line[::2], line[1::2][::-1]]) + random.random((count + 1, 2))
    return line, around


def line(xy: np.ndarray) -> PolygonSet:
    """The same as our input."""
    return PolygonSet(xy, [0, len(xy)], [LINE], [0])


def densified(a: shapely.LineString, b: shapely.LineString, right: float) -> tuple[float, float, float]:
    """Seconds, value and parts of an edge from which on shapely is within 1e-3."""
    for parts in 2 ** np.arange(12):
        seconds, found = timed(lambda: shapely.hausdorff_distance(a, b, densify=1 / parts), 1)  # noqa: B023 - called here
        if abs(found - right) <= 1e-3 * right:
            break
    return seconds, found, parts


def row(count: int, threads: int, runs: int, *, has_peers: bool) -> None:
    """Print the figures of one size."""
    a, b = zigzag_and_its_hull(count)
    seconds, ours = timed(lambda: vorotool.hausdorff(line(a), line(b), threads=threads), runs)
    closest, _ = timed(lambda: vorotool.distance(line(a), line(b), threads=threads), runs)
    shown = f"{count:9,} edges  hausdorff {seconds:9.4f} s  smallest {closest:9.4f} s"
    if count <= MOST_CHECKED:
        pair = shapely.LineString(a), shapely.LineString(b)
        bounds = [directed_bounds([one], [other], tolerance=1e-12) for one, other in (pair, pair[::-1])]
        low, high = (max(side) for side in zip(*bounds, strict=True))
        shown += f"  off by {max(low - ours.distance, ours.distance - high, 0):.1e}"
    if has_peers and count <= MOST_OF_PEERS:
        pair = shapely.LineString(a), shapely.LineString(b)
        plain, vertices = timed(lambda: shapely.hausdorff_distance(*pair), runs)
        dense, found, parts = densified(*pair, ours.distance)
        shown += f"  shapely {plain:9.4f} s off by {abs(vertices - ours.distance):.1e}"
        shown += f", in {parts} parts {dense:9.4f} s off by {abs(found - ours.distance):.1e}"
    print(shown, flush=True)


def main() -> None:
    """Print a row a size."""
    given = options("edges", [10, 100, 1000, 10**5, 10**6], 3).parse_args()
    for count in given.edges:
        row(count, given.threads, given.runs, has_peers=not given.no_peers)


if __name__ == "__main__":
    main()
