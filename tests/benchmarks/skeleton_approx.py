"""Seconds and memory of approximate skeletons, end to end, and beside what else makes them at equal accuracy.

``skeleton_approx.py [SEEDS]``, by default 10^6. Peers sample a star at one step, and their largest error is measured:
the distance of places on their lines from the exact skeleton. Ours is to be as accurate: that is its tolerance.
"""

import sys
import time
import warnings
from functools import partial
from pathlib import Path

import numpy as np
import shapely

sys.path.insert(0, str(Path(__file__).parents[1]))
import vorotool
from benchmarks.timing import in_own_process, peak, star, timed
from vorotool.engines.skeleton.verify_bounds import distances_to, places_on_arcs

RUNS = 3
seconds = partial(timed, runs=RUNS)
"""Of several runs the least, and what the last one gave."""
EDGES = 1000
PEER_EDGES, PEER_STEPS = 200, (4.0, 1.0)


def whole(seeds, threads):
    """Seconds of a skeleton of so many seeds, those of all processors, and megabytes of the whole process after one."""
    shape = star(EDGES)
    step = shapely.length(shapely.Polygon(shape)) / seeds
    skeleton = vorotool.skeleton_approx(shape, step=step, threads=threads)
    memory, arcs = peak() / 2**20, len(skeleton)
    del skeleton
    begin = time.process_time()
    took, _ = seconds(lambda: vorotool.skeleton_approx(shape, step=step, threads=threads) and None)
    return took, (time.process_time() - begin) / RUNS, memory, arcs


def by_shapely(polygon, step):
    """Voronoi edges of samples that are inside: what recipes do."""
    samples = shapely.get_coordinates(shapely.segmentize(polygon.exterior, step))
    edges = shapely.get_parts(shapely.voronoi_polygons(shapely.multipoints(samples), only_edges=True))
    shapely.prepare(polygon)
    return shapely.multilinestrings(edges[shapely.contains(polygon, edges)])


def by_centerline(polygon, step):
    """Its edges that are inside."""
    from centerline.geometry import Centerline

    return Centerline(polygon, interpolation_distance=step).geometry


def by_pygeoops(polygon, step):
    """With all branches, and not simplified."""
    import pygeoops

    return pygeoops.centerline(polygon, step, 0, 0)


PEERS = {"centerline": by_centerline, "pygeoops": by_pygeoops, "shapely": by_shapely}


def places_of(lines):
    """Vertices, and the middles between."""
    points, line = shapely.get_coordinates(shapely.get_parts(lines), return_index=True)
    middles = ((points[1:] + points[:-1]) / 2)[line[1:] == line[:-1]]
    return np.concatenate([points, middles])


def error_of(skeleton, exact):
    """The largest distance of places on a skeleton from the exact one."""
    return distances_to(exact, places_on_arcs(skeleton, np.linspace(0, 1, 5)).reshape(-1, 2)).max()


def main():
    seeds = int(float(sys.argv[1])) if len(sys.argv) > 1 else 10**6
    warnings.simplefilter("ignore")
    print(f"skeleton_approx, {seeds} seeds on {EDGES} edges, from arrays to the skeleton with its bounds:")
    for threads in (1, 2):
        took, processor, memory, arcs = in_own_process(whole, seeds, threads)
        print(f"  {threads} threads: {took:.2f} s, {processor:.2f} s of processor time, {arcs} arcs, {memory:.0f} MB")
    print("  (at most 1.2 s on two threads, and 400 MB)")
    shape = star(PEER_EDGES)
    polygon, exact = shapely.Polygon(shape), vorotool.skeleton_exact(shape)
    print(f"beside peers, {PEER_EDGES} edges, 2000 wide: seconds and largest error; ours, one thread, as accurate:")
    for step in PEER_STEPS:
        for name, make in PEERS.items():
            peer, lines = seconds(lambda make=make, step=step: make(polygon, step))
            wrong = distances_to(exact, places_of(lines)).max()
            own, skeleton = seconds(lambda wrong=wrong: vorotool.skeleton_approx(shape, tolerance=wrong, threads=1))
            same, _ = seconds(lambda step=step: vorotool.skeleton_approx(shape, step=step, threads=1))
            ours = f"{own:.3f} s, {error_of(skeleton, exact):.3g}: 1/{peer / own:.0f}"
            print(
                f"  {name:10} step {step:g}: {peer:.3f} s, {wrong:.3g}; ours {ours}; "
                f"with the same step {same:.3f} s: 1/{peer / same:.0f}"
            )


if __name__ == "__main__":
    main()
