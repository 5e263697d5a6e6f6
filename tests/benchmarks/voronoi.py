"""Measure Voronoi cells of a generated town beside its peers, in one run: `make bench`.

Seconds of `voronoi`, arrays in and arrays out, on several threads; microseconds for each segment of the walls; how many
times as long as the skeleton outside of the same houses, which makes the same segment Voronoi diagram; and seconds from
polygons to polygons, as momepy's `morphological_tessellation` gives them, where it is installed. MB are those that a
process of its own takes at its peak, above what it had with the houses loaded.

Cells are wrong where a place is given to a house that is 2 cm farther than another (of 100 000 places), and where a
house sticks out of its own cell; areas of peers are beside ours. Peers are run on 10^5 houses at most.
"""

from __future__ import annotations

import argparse
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import shapely

sys.path.insert(0, str(Path(__file__).parents[1]))
import vorotool
from benchmarks.timing import best, in_own_process, options, peak_of, print_head, timed
from support.families.town import polygons_of, town
from vorotool.types.polygons.polygon_set import SHELL, PolygonSet, set_of_rings

PLACES = 10**5
MOST_OF_PEERS = 10**5
STICKS_OUT = 1e-6
"""Of the area of a house: less than this is the lattice."""
FLATTEN = 0.01
"""Metres that polylines may be off by; places are wrong from twice as much on."""


def polygon_set(count: int) -> PolygonSet:
    """The houses as arrays."""
    xy, start = town(count)
    return set_of_rings(xy, np.diff(start), np.full(count, SHELL), np.arange(count))


def frame_of(xy: np.ndarray) -> tuple[float, float, float, float]:
    """Bounds, and a block around them."""
    low, high = xy.min(axis=0) - 100, xy.max(axis=0) + 100
    return (*low.tolist(), *(high - low).tolist())


def our_polygons(houses: Any, frame: tuple[float, float, float, float], threads: int) -> np.ndarray:
    """From polygons to polygons."""
    return vorotool.voronoi(houses, frame=frame, threads=threads).to_shapely(flatten=FLATTEN)


def momepy_polygons(houses: Any, frame: tuple[float, float, float, float]) -> np.ndarray:
    """The same by momepy, a cell a house in order; None where it has none."""
    import geopandas
    import momepy

    x, y, w, h = frame
    series = geopandas.GeoSeries(houses)
    made = momepy.morphological_tessellation(series, clip=shapely.box(x, y, x + w, y + h))
    return made.geometry.reindex(series.index).to_numpy()


def memory(what: str, count: int, threads: int) -> float:
    """MB of one run in this process."""
    houses = polygon_set(count) if what == "arrays" else polygons_of(*town(count))
    frame = frame_of(town(count)[0])
    if what == "arrays":
        return peak_of(lambda: vorotool.voronoi(houses, frame=frame, threads=threads)) / 1e6
    return peak_of(lambda: momepy_polygons(houses, frame)) / 1e6


def wrong_places(cells: np.ndarray, houses: np.ndarray, frame: tuple[float, float, float, float]) -> float:
    """The share of random places that are in the cell of another house than the nearest one."""
    x, y, w, h = frame
    points = shapely.points(np.array([x, y]) + np.random.default_rng(1).random((PLACES, 2)) * [w, h])
    place, cell = shapely.STRtree(cells).query(points, predicate="within")
    own = shapely.distance(houses[cell], points[place])
    tree = shapely.STRtree(houses)
    nearest, least = tree.query_nearest(points, return_distance=True, all_matches=False)
    distance = np.empty(PLACES)
    distance[nearest[0]] = least
    wrong = np.zeros(PLACES, dtype=bool)
    wrong[place[own > distance[place] + 2 * FLATTEN]] = True
    return float(wrong.mean())


def wrongness(cells: np.ndarray, houses: np.ndarray, frame: tuple[float, float, float, float]) -> str:
    """The columns of what is wrong."""
    outside = shapely.area(shapely.difference(houses, cells)) > STICKS_OUT * shapely.area(houses)
    return f"{100 * wrong_places(cells, houses, frame):.2f} | {100 * outside.mean():.1f} |"


def measure(count: int, threads: int, runs: int) -> str:
    """The row of so many houses."""
    given = polygon_set(count)
    frame = frame_of(given.xy)
    seconds = [best(lambda t=t: vorotool.voronoi(given, frame=frame, threads=t), runs) for t in sorted({1, threads})]
    skeleton = best(lambda: vorotool.skeleton_exact(given, side="exterior", frame=frame, threads=threads), runs)
    each = 1e6 * seconds[-1] / len(given.xy)
    return (
        f"| {count:,} | {len(given.xy):,} | {' / '.join(f'{value:.3g}' for value in seconds)} | {each:.2f} | "
        f"{seconds[-1] / skeleton:.2f} | {in_own_process(memory, 'arrays', count, threads):,.0f} |"
    )


def beside(count: int, threads: int, runs: int) -> str:
    """The row of cells as polygons, ours and momepy's."""
    houses = polygons_of(*town(count))
    frame = frame_of(town(count)[0])
    ours, cells = timed(lambda: our_polygons(houses, frame, threads), runs)
    row = f"| {count:,} | {ours:.3g} | {wrongness(cells, houses, frame)}"
    if not find_spec("momepy"):
        return row + " | | | | |"
    theirs, peers = timed(lambda: momepy_polygons(houses, frame), 1)
    off = np.abs(shapely.area(peers) / shapely.area(cells) - 1)[~shapely.is_missing(peers)]
    areas = f"{100 * np.median(off):.2f}, {100 * off.max():.1f}"
    used = in_own_process(memory, "momepy", count, threads)
    return f"{row} {theirs:.3g} ({theirs / ours:.0f} ×) | {used:,.0f} | {areas} | {wrongness(peers, houses, frame)}"


def main() -> None:
    """Print the tables."""
    parser = options("houses", [10**3, 10**4, 10**5, 10**6], runs=3)
    parser.add_argument("--table", choices=["arrays", "polygons"], nargs="+", default=["arrays", "polygons"])
    arguments: argparse.Namespace = parser.parse_args()
    if "arrays" in arguments.table:
        threads = " / ".join(map(str, sorted({1, arguments.threads})))
        columns = (f"seconds, {threads} threads", "µs a segment", "× of the skeleton outside")
        print_head("houses", "segments", *columns, "MB")
        for count in arguments.houses:
            runs = arguments.runs if count < 10**6 else 1
            print(in_own_process(measure, count, arguments.threads, runs), flush=True)
    if "polygons" in arguments.table and not arguments.no_peers:
        print("\npolygons in and out; in %: places in a wrong cell, houses that stick out, areas off (median, most)\n")
        wrong = ("places", "stick out")
        print_head("houses", "seconds", *wrong, "momepy", "MB", "areas off", *wrong)
        for count in arguments.houses:
            if count <= MOST_OF_PEERS:
                print(in_own_process(beside, count, arguments.threads, arguments.runs), flush=True)


if __name__ == "__main__":
    main()
