"""Seconds of whole skeletons: the library by parts, and the process from file to picture.

``skeleton_exact.py [SEGMENTS]``, by default 10^6.
"""

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.arrangement.repaired_polygons import placed_shapes
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi
from vorotool.engines.skeleton.exact import ShapeDiagram, skeleton_of

ROOT = Path(__file__).parents[2]
LAND = ROOT / "data" / "ne_50m_land.geojson"
RUNS = 5


def star(count):
    """A smooth star with whole coordinates."""
    angle = 2 * np.pi * np.arange(count) / count
    radius = 2**29 * (1 + 0.3 * np.sin(7 * angle) + 0.1 * np.cos(23 * angle)) / 1.5
    return np.round(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1))


def parts(shape, threads):
    """Seconds of each step."""
    begin = time.perf_counter()
    graph = planar_graph(shape, threads=threads)
    placed_at = time.perf_counter()
    diagram = segment_voronoi(graph.points, graph.segments, threads=threads)
    made_at = time.perf_counter()
    skeleton = skeleton_of(ShapeDiagram(graph, diagram, placed_shapes(graph)), threads=threads)
    end = time.perf_counter()
    return len(graph), len(skeleton), (placed_at - begin, made_at - placed_at, end - made_at)


def whole_process():
    """Least seconds of the command, land to SVG."""
    command = [Path(sys.executable).parent / "vorotool", "skeleton-exact", LAND, "-q", "-o"]
    with tempfile.TemporaryDirectory() as folder:
        seconds = []
        for _ in range(RUNS):
            begin = time.perf_counter()
            subprocess.run([*command, f"{folder}/land.svg"], check=True)
            seconds.append(time.perf_counter() - begin)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return min(seconds), (used.ru_utime + used.ru_stime) / RUNS


def main():
    count = int(float(sys.argv[1])) if len(sys.argv) > 1 else 10**6
    shape = star(count)
    print("skeleton_exact, ns a segment: planar graph / diagram / skeleton / all")
    total = {}
    for threads in (1, 2):
        segments, arcs, seconds = parts(shape, threads)
        total[threads] = sum(seconds)
        each = " / ".join(f"{1e9 * value / segments:6.0f}" for value in (*seconds, sum(seconds)))
        print(f"  {threads} threads, {segments} segments, {arcs} arcs: {each}")
    print(f"  two threads take {total[2] / total[1]:.2f} of the time of one (at most 0.75)")
    wall, processor = whole_process()
    print(f"whole process, {LAND.name} to SVG: {wall:.2f} s, {processor:.2f} s of processor time (at most 0.7 s)")


if __name__ == "__main__":
    main()
