"""A check of the digital triangulation by another way than the one that makes it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.convert.spacings import asked_sides
from vorotool.engines.tessellation.frames import as_seeds, asked_frame, band_limits, default_frame
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.engines.tessellation.verify_tessellation import verify_labels
from vorotool.errors import VerificationError
from vorotool.types.arguments import check_value
from vorotool.types.mesh.triangulation import DigitalTriangulation
from vorotool.types.pixels import Frame

if TYPE_CHECKING:
    from vorotool.typing import SeedsLike, Spacing


def verify_digital_triangulation(
    found: DigitalTriangulation,
    source: SeedsLike,
    *,
    shape: tuple[int, int] | None = None,
    window: tuple[int, int, int, int] | None = None,
    image: bool | None = None,
    spacing: Spacing | None = None,
    threads: int = 0,
) -> None:
    """Check a digital triangulation against the definitions of section 2.1, band by band.

    The labels of every band are checked by an independent search for the nearest seed; then each pixel is compared
    with its neighbors.

    Parameters
    ----------
    found : DigitalTriangulation
        From any source.
    source : what `tessellate` accepts
        The source of the triangulation, but not a label image.
    shape, window : tuple of int, optional
        As in `digital_triangulation`.
    image : bool, optional
        As in `digital_triangulation`.
    spacing : float, (height, width) or "auto", optional
        As in `digital_triangulation`.
    threads : int
        Number of threads; 0 uses all.

    Raises
    ------
    VerificationError
        If an edge or triangle is missing or false; the message names the first.

    Examples
    --------
    >>> from vorotool.engines.digital.triangulation import digital_triangulation
    >>> seeds = [[1, 1], [6, 1], [2, 6]]
    >>> verify_digital_triangulation(digital_triangulation(seeds), seeds)
    """
    check_value(found, "found", "DigitalTriangulation")
    frame = asked_frame(shape, window)
    sides = asked_sides(source, spacing)
    seeds = as_seeds(source, "source", image=image, frame=frame, sides=sides)
    edges, triangles = np.empty((0, 2), np.int64), np.empty((0, 3), np.int64)
    if len(seeds):
        frame = frame or default_frame(seeds)
        sweep = Tessellator(seeds, frame, sides=sides, threads=threads)
        for first, count in band_limits(frame):
            lap = min(first, 1)
            labels = sweep.labels(first - lap, count + lap)
            band = Frame(frame.x, frame.y + first - lap, frame.width, count + lap)
            verify_labels(labels, sweep.seeds, band, sides=sides, threads=threads)
            edges = np.concatenate([edges, _edges(labels)])
            triangles = np.concatenate([triangles, _triangles(labels)])
    for name, rows, right in (("edge", found.edges, edges), ("triangle", found.triangles, triangles)):
        _compare(name, found.labels[rows], np.unique(right, axis=0))


def _edges(labels: NDArray[Any]) -> NDArray[np.int64]:
    """Pairs of different labels side by side, or one above the other."""
    pairs = [(labels[:, :-1], labels[:, 1:]), (labels[:-1], labels[1:])]
    return _distinct(np.concatenate([_columns(pair) for pair in pairs]))


def _triangles(labels: NDArray[Any]) -> NDArray[np.int64]:
    """Triples of different labels: of a pixel and a neighbor in its row and one in its column."""
    a, b, c, d = labels[:-1, :-1], labels[:-1, 1:], labels[1:, :-1], labels[1:, 1:]
    return _distinct(np.concatenate([_columns(three) for three in ((a, b, c), (b, a, d), (c, a, d), (d, b, c))]))


def _columns(arrays: tuple[NDArray[Any], ...]) -> NDArray[np.int64]:
    """Rows of labels that are not all alike."""
    changing = np.logical_or.reduce([array != arrays[0] for array in arrays[1:]])
    return np.stack([array[changing].astype(np.int64) for array in arrays], axis=1)


def _distinct(rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Sorted rows of labels that all differ and are not 0, each once."""
    rows = np.sort(rows, axis=1)
    return np.unique(rows[(np.diff(rows, axis=1) != 0).all(axis=1) & (rows[:, 0] != 0)], axis=0)


def _compare(name: str, given: NDArray[np.int64], right: NDArray[np.int64]) -> None:
    rows = [tuple(row) for row in np.sort(given, axis=1).tolist()]
    wanted = {tuple(row) for row in right.tolist()}
    if len(set(rows)) < len(rows):
        raise VerificationError(f"an {name} occurs twice" if name == "edge" else f"a {name} occurs twice")
    for what, members in (("is missing", wanted - set(rows)), ("should not be there", set(rows) - wanted)):
        if members:
            labels = "-".join(str(label) for label in min(members))
            raise VerificationError(f"{name} {labels} {what} ({len(members)} such {name}s)")
