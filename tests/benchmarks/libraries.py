"""Why some things are done here that libraries do, too: time, and what differs. `make bench`, or by name:

libraries.py csv png pnm graphml contours simplify pool
"""

from __future__ import annotations

import argparse
import io
import os
import signal
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor, as_completed
from contextlib import suppress
from pathlib import Path
from typing import Any

import networkx
import numpy as np
import pandas
import shapely
from PIL import Image
from skimage.measure import find_contours
from timing import timed

import vorotool
from vorotool.batch.workers import Outcome, Task, local_results
from vorotool.engines.label_images.outlines import simplified_polygons
from vorotool.formats.images.png_writer import write_png
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.points.delimited import read_text
from vorotool.formats.results.graphml import write_graphml
from vorotool.types.polygons.shapely_geometry import to_shapely

RNG = np.random.default_rng(1)


def compare(what: str, ours: Any, theirs: Any, library: str) -> tuple[Any, Any]:
    """Print seconds of both; give what they made."""
    (seconds, made), (others, peer) = timed(ours, 3), timed(theirs, 3)
    print(f"{what:44} vorotool {seconds:7.3f} s   {library:28} {others:7.3f} s   {others / seconds:6.1f} times")
    return made, peer


def written(write: Callable[[io.BytesIO], object]) -> int:
    """How many bytes are written."""
    out = io.BytesIO()
    write(out)
    return len(out.getvalue())


def labels(size: int) -> Any:
    """An image of some thousand regions."""
    seeds = RNG.random((size, 2)) * size
    return vorotool.tessellate(seeds.round(), shape=(size, size))


def csv() -> None:
    """A million points."""
    table = pandas.DataFrame(RNG.random((1_000_000, 2)), columns=["x", "y"])
    data = table.to_csv(index=False).encode()
    source = Source("a.csv", data)
    found, peer = compare(
        "CSV, 1,000,000 points",
        lambda: read_text(source, ReadOptions()),
        lambda: pandas.read_csv(io.BytesIO(data)),
        "pandas",
    )
    print(
        "   coordinates that differ from the text:",
        int((found.xy != table.to_numpy()).sum()),
        "and",
        int((peer.to_numpy() != table.to_numpy()).sum()),
    )
    try:
        read_text(Source("a.csv", b"x,y\n1,2\n3,4;5\n"), ReadOptions())
    except vorotool.InputError as error:
        print("  ", error)


def png() -> None:
    """Labels of 16 bits."""
    image = labels(4096).labels

    def theirs(level: int) -> int:
        return written(lambda out: Image.fromarray(image).save(out, "PNG", compress_level=level))

    for level in (1, 6):
        sizes = compare(
            "PNG, 4096 x 4096 labels",
            lambda: written(lambda out: write_png(out, [image], image.shape)),
            lambda level=level: theirs(level),
            f"Pillow, level {level}",
        )
        print("   bytes:", *(f"{size:,}" for size in sizes))


def pnm() -> None:
    """Values as stored."""
    for data in (b"P2 3 1 9 1 5 9", b"P6 1 1 300 \x00\x01\x00\x02\x01\x2c"):
        with tempfile.NamedTemporaryFile(suffix=".pnm") as file:
            Path(file.name).write_bytes(data)
            print(
                f"{data!r}: vorotool",
                vorotool.read(file.name).values.tolist(),
                "Pillow",
                np.asarray(Image.open(io.BytesIO(data))).tolist(),
            )


def graphml() -> None:
    """The branches of many shapes."""
    skeleton = vorotool.skeleton_exact(vorotool.outlines(labels(1000).labels, mode="labels"))
    graph = skeleton.to_networkx()
    for *_, values in graph.edges(data=True):
        for name, value in list(values.items()):
            values[name] = str(value) if not isinstance(value, int | float | str) else value
    compare(
        f"GraphML, {graph.number_of_edges():,} edges",
        lambda: written(lambda out: write_graphml(out, skeleton)),
        lambda: written(lambda out: networkx.write_graphml(graph, out)),
        "networkx, without converting",
    )


def contours() -> None:
    """Of a mask, and of labels."""
    image = labels(1000).labels
    mask = image % 3 == 0
    padded = np.pad(mask, 1).astype(float)
    compare(
        "contours, mask of 1000 x 1000",
        lambda: vorotool.outlines(mask, outline="contour"),
        lambda: find_contours(padded, 0.5),
        "scikit-image",
    )
    few = image[:200, :200]

    def each() -> list[Any]:
        return [find_contours(np.pad(few == label, 1).astype(float), 0.5) for label in np.unique(few)]

    compare(
        f"contours, {len(np.unique(few))} labels of 200 x 200",
        lambda: vorotool.outlines(few, mode="labels", outline="contour"),
        each,
        "scikit-image, label by label",
    )


def simplify() -> None:
    """Borders of regions, by the distance that they move."""
    polygons = vorotool.outlines(labels(1000).labels, mode="labels")
    shapes = to_shapely(polygons)
    for tolerance in (1.0, 2.0):
        made, peer = compare(
            f"simplified borders, tolerance {tolerance}",
            lambda tolerance=tolerance: simplified_polygons(polygons, tolerance),
            lambda tolerance=tolerance: shapely.coverage_simplify(shapes, tolerance),
            "shapely.coverage_simplify",
        )
        for name, found in (("vorotool", to_shapely(made)), ("shapely", peer)):
            moved = shapely.hausdorff_distance(shapely.boundary(shapes), shapely.boundary(found)).max()
            print(f"   {name}: moved by {moved:.2f} at the most, {shapely.get_num_coordinates(found).sum():,} vertices")


def work(task: Task) -> Outcome:
    """Do nothing for a while; of source 3 kill the process."""
    time.sleep(0.1)
    if task.source == "3":
        os.kill(os.getpid(), signal.SIGKILL)
    return Outcome()


def pool() -> None:
    """A worker that dies."""
    from libraries import work as process  # by a name that workers know, too

    tasks = [Task(str(number), ()) for number in range(8)]
    outcomes = list(local_results(process, iter(enumerate(tasks)), jobs=2))
    ours, theirs = sum(not outcome.code for _, outcome in outcomes), 0
    with ProcessPoolExecutor(2) as executor:
        for future in as_completed([executor.submit(process, task) for task in tasks]):
            with suppress(BrokenExecutor):
                future.result()
                theirs += 1
    print(f"of 8 tasks, one of which kills its process, are done: vorotool {ours}, ProcessPoolExecutor {theirs}")


CASES = {case.__name__: case for case in (csv, png, pnm, graphml, contours, simplify, pool)}


def main() -> None:
    """Compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help=" ".join(CASES))
    for name in parser.parse_args().names or CASES:
        CASES[name]()


if __name__ == "__main__":
    main()
