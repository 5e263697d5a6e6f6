"""The digital triangulation beside the exact one: what differs, and why (section 2.1)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from math import ceil
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.delaunay.cocircular_ties import CocircularTies
from vorotool.engines.delaunay.delaunay import delaunay
from vorotool.engines.digital.causes import SHORT, Causes, Members, members_of
from vorotool.engines.digital.triangulation import digital_triangulation, one_seed_a_label
from vorotool.engines.label_images.regions import measure_regions
from vorotool.engines.tessellation.frames import as_seeds, asked_frame, default_frame, require_memory
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import Message, option
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.progress import Progress
from vorotool.plain import plain
from vorotool.types.mesh.digital_comparison import DigitalComparison
from vorotool.types.pixel_frame import MAX_PIXELS, Frame
from vorotool.types.points.label_image import LabelImage
from vorotool.types.table import Table

if TYPE_CHECKING:
    from vorotool.typing import SeedsLike

COVERED = 0.75
"""Share of what is missing that a suggested frame or scale would show."""


def compare_digital(
    source: SeedsLike,
    *,
    shape: tuple[int, int] | None = None,
    window: tuple[int, int, int, int] | None = None,
    image: bool | None = None,
    strict: bool = False,
    threads: int = 0,
    max_pixels: int = MAX_PIXELS,
    progress: Progress = None,
) -> DigitalComparison:
    """Compare the digital triangulation of the paper's rule with the exact one of the same seeds.

    Parameters
    ----------
    source : what `tessellate` accepts
        Each label must have one seed.
    shape, window : tuple of int, optional
        As in `tessellate`.
    image : bool, optional
        As in `tessellate`.
    strict : bool
        Refuse several seeds at one place.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    max_pixels : int
        Larger frames are refused before memory is allocated.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    DigitalComparison
        Precision, recall and differences. The cause of each is the first of these that holds: ``cocircular`` (a tie:
        nothing is wrong) · ``no_region`` (a site that is nearest to no pixel) · ``off_frame`` (the Voronoi vertex, or
        all of the Voronoi edge but a short part, lies beyond the outermost pixel centers) · ``four_labels`` (where four
        labels meet at a corner every triple is a triangle, and no diagonal an edge) · ``split_region`` (a region that
        is not 4-connected) · ``short_edge`` (a Voronoi edge shorter than 1.5 pixels) · ``other``.

    Raises
    ------
    InputError
        If several seeds share a label.
    LimitError
        If the frame has more than `max_pixels` pixels.

    Examples
    --------
    >>> comparison = compare_digital([[1, 1], [6, 1], [2, 6]], shape=(8, 8))
    >>> comparison.triangle_precision, comparison.differences.rows
    (1.0, 0)
    """
    frame = asked_frame(shape, window)
    seeds = as_seeds(source, "source", image=image, max_pixels=max_pixels, frame=frame)
    one_seed_a_label(seeds)
    if not len(seeds):
        return DigitalComparison(1.0, 1.0, 1.0, 1.0, _table([], np.empty(0, np.int64)), {}, "")
    frame = frame or default_frame(seeds)
    require_memory(frame, max_pixels)
    threads = checked_threads(threads)
    sweep = Tessellator(seeds, frame, threads=threads, strict=strict, progress=progress)
    labeled = LabelImage(sweep.labels(), frame, sweep.seeds)
    measures = measure_regions(labeled, threads=threads, progress=progress)
    digital = digital_triangulation(labeled, threads=threads, progress=progress)
    components = np.zeros(len(digital.points), np.int64)
    components[np.searchsorted(digital.labels, measures.labels)] = measures.columns["components"]
    mesh = delaunay(digital.points, threads=threads, progress=progress)
    causes = Causes(digital, mesh, frame, components > 0, components > 1)
    ties = CocircularTies(mesh)
    edges = _compare("edge", mesh.edges, ties.unique_edges, digital.edges, ties.has_edge, causes)
    triangles = _compare(
        "triangle", mesh.triangles, ties.unique_triangles, digital.triangles, ties.has_triangle, causes
    )
    differences = edges.differences + triangles.differences
    counts = Counter(f"{d.kind} {d.difference} {d.cause}" for d in differences)
    return DigitalComparison(
        edges.precision,
        edges.recall,
        triangles.precision,
        triangles.recall,
        _table(differences, digital.labels),
        dict(sorted(counts.items())),
        Message("; ".join((*_wider_frame(differences, causes, frame), *_larger_scale(differences)))),
    )


@plain
class Difference:
    """An edge or a triangle that one triangulation has and the other has not."""

    kind: str
    difference: str
    members: Members
    cause: str
    voronoi_length: float | None


@plain
class Comparison:
    """Of all edges, or of all triangles."""

    precision: float
    recall: float
    differences: list[Difference]


def _compare(
    kind: str,
    exact: NDArray[np.int32],
    unique: NDArray[np.bool_],
    found: NDArray[np.int32],
    is_right: Callable[[Members], bool],
    causes: Causes,
) -> Comparison:
    """Compare lists of edges or triangles; `unique` tells which exact ones have no alternative."""
    wanted, known = members_of(exact), members_of(found)
    differences = []
    have = set(known)
    missing = [(m, u) for m, u in zip(wanted, unique.tolist(), strict=True) if m not in have]
    for members, must in missing:
        cause = causes.of_missing(members) if must else ("cocircular", 0.0)
        differences.append(Difference(kind, "missing" if must else "tie", members, *cause))
    have = set(wanted)
    wrong = 0
    for members in known:
        if members in have:
            continue
        right = is_right(members)
        wrong += not right
        cause = ("cocircular", 0.0) if right else causes.of_false(members)
        differences.append(Difference(kind, "tie" if right else "false", members, *cause))
    needed = int(unique.sum())
    lost = sum(must for _, must in missing)
    return Comparison(_share(len(known) - wrong, len(known)), _share(needed - lost, needed), differences)


def _share(part: int, whole: int) -> float:
    return part / whole if whole else 1.0


def _table(differences: list[Difference], labels: NDArray[np.int64]) -> Table:
    corners = np.array([(*d.members, -1)[:3] for d in differences], dtype=np.int64).reshape(-1, 3)
    lengths = np.array([np.inf if d.voronoi_length is None else d.voronoi_length for d in differences])
    unknown = ~np.isfinite(lengths)
    return Table(
        {
            "kind": [d.kind for d in differences],
            "difference": [d.difference for d in differences],
            "label_a": labels[corners[:, 0]],
            "label_b": labels[corners[:, 1]],
            "label_c": np.ma.array(labels[corners[:, 2]], mask=corners[:, 2] < 0),
            "cause": [d.cause for d in differences],
            "voronoi_length": np.ma.array(np.where(unknown, 0.0, lengths), mask=unknown),
        }
    )


def _wider_frame(differences: list[Difference], causes: Causes, frame: Frame) -> list[str]:
    """Padding that takes the Voronoi vertices off the frame in, but for the farthest."""
    off = [d.members for d in differences if d.kind == "triangle" and d.cause == "off_frame"]
    if not off:
        return []
    beyond = sorted(causes.beyond[members] for members in off)
    # Thin triangles on the hull have centers without end: nobody wants a frame of more than three times the size.
    padding = ceil(min(beyond[ceil(COVERED * len(beyond)) - 1], max(frame.shape)))
    numbers = (frame.x - padding, frame.y - padding, frame.width + 2 * padding, frame.height + 2 * padding)
    window = option(f"--window {','.join(map(str, numbers))}", f"window={numbers}")
    held = sum(distance <= padding for distance in beyond)
    return [f"{window} (padding {padding}) holds {held} of {len(off)} Voronoi vertices off the frame"]


def _larger_scale(differences: list[Difference]) -> list[str]:
    """Scale at which the short Voronoi edges are long enough, but for the shortest."""
    lengths = sorted(
        (d.voronoi_length for d in differences if d.cause == "short_edge" and d.voronoi_length), reverse=True
    )
    if not lengths:
        return []
    chosen = lengths[ceil(COVERED * len(lengths)) - 1]
    held = sum(length >= chosen for length in lengths)
    return [
        f"at {ceil(SHORT / chosen)} times the scale {held} of {len(lengths)} short Voronoi edges have {SHORT} pixels"
    ]
