"""Seconds of the largest disc inside polygons beside shapely, and how much smaller than the largest the peers' are.

``discs.py [--edges N …]``. Peers take a tolerance, here as parts of the larger side; ours takes none. A peer that has
not ended after a while is given up.
"""

import sys
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import shapely
import shapely.ops

sys.path.insert(0, str(Path(__file__).parents[1]))
import vorotool
from benchmarks.timing import options, print_head, star, timed

TOLERANCES = (1e-3, 1e-6)
PATIENCE = 120.0
"""Seconds that a peer may take."""


def road(edges):
    """A bent strip 2000 long and 10 wide: almost everywhere discs are nearly as large."""
    along = np.linspace(0, 2000, edges // 2)
    bend = 100 * np.sin(along / 300)
    return np.concatenate([np.stack([along, bend], axis=1), np.stack([along, bend + 10], axis=1)[::-1]])


def by_shapely(polygon, tolerance):
    """The radius of GEOS."""
    return shapely.maximum_inscribed_circle(polygon, tolerance=tolerance).length


def by_polylabel(polygon, tolerance):
    """The radius around the place that Mapbox's way finds."""
    return shapely.ops.polylabel(polygon, tolerance).distance(polygon.exterior)


def _measured(given, function, polygon, tolerance, runs):
    given.put(timed(lambda: function(polygon, tolerance), runs))


def patiently(function, polygon, tolerance, runs):
    """Seconds and the radius; None if it does not end."""
    processes = get_context("spawn")
    found = processes.Queue()
    process = processes.Process(target=_measured, args=(found, function, polygon, tolerance, runs))
    process.start()
    process.join(PATIENCE)
    if process.is_alive():
        process.terminate()
        process.join()
        return None
    return found.get()


def main():
    """Print a row a shape and a way."""
    given = options("edges", [1000, 10_000, 100_000], 3).parse_args()
    print_head("shape", "edges", "way", "tolerance", "s", "too small by")
    for shape in (star, road):
        for edges in given.edges:
            xy = shape(edges)
            polygon, extent = shapely.Polygon(xy), float(np.ptp(xy, axis=0).max())
            seconds, discs = timed(lambda xy=xy: vorotool.largest_discs(xy, threads=given.threads), given.runs)
            largest = float(discs.radius[0])
            print(f"| {shape.__name__} | {edges} | vorotool | – | {seconds:.3f} | – |", flush=True)
            for function in () if given.no_peers else (by_shapely, by_polylabel):
                for part in TOLERANCES:
                    found = patiently(function, polygon, part * extent, 1)
                    name = function.__name__.removeprefix("by_")
                    said = f"> {PATIENCE:g} | –" if found is None else f"{found[0]:.3f} | {1 - found[1] / largest:.1e}"
                    print(f"| {shape.__name__} | {edges} | {name} | {part:g} | {said} |", flush=True)


if __name__ == "__main__":
    main()
