"""The digital triangulation beside the exact one: what differs, and why (section 2.1)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from functools import cached_property
from math import ceil
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.delaunay.delaunay import delaunay
from vorotool.engines.digital.triangulation import digital_triangulation, one_seed_a_label
from vorotool.engines.label_images.regions import measure_regions
from vorotool.engines.tessellation.frames import as_seeds, asked_frame, default_frame, require_memory
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import Message, option
from vorotool.frozen import frozen
from vorotool.numeric.arrays import connected_roots
from vorotool.numeric.checks import MAX_PIXELS, checked_threads
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.numeric.parallel import Progress
from vorotool.types.images import LabelImage
from vorotool.types.mesh.triangulation import DigitalComparison, DigitalTriangulation, Triangulation
from vorotool.types.pixels import Frame
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
    components[np.searchsorted(digital.labels, measures.labels)] = measures.components
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


@frozen
class Difference:
    """An edge or a triangle that one triangulation has and the other has not."""

    kind: str
    difference: str
    members: Members
    cause: str
    voronoi_length: float | None


@frozen
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


SHORT = 1.5
"""Pixels. The centers of the four pixels around a corner lie within √2 of each other: a Voronoi edge that is no longer
can pass between them unseen. The rest is for edges that end just beside the pixels that would show them."""

Members = tuple[int, ...]
"""Indices of the two sites of an edge, or the three of a triangle, increasing."""

Cause = tuple[str, float | None]
"""Its name, and the length of the Voronoi edge that explains it, where there is one."""


def members_of(rows: NDArray[np.int32]) -> list[Members]:
    """Rows of indices as tuples, each in increasing order."""
    return [tuple(row) for row in np.sort(rows, axis=1).tolist()]


def sides_of(triangle: Members) -> tuple[tuple[int, int], ...]:
    """Edges of a triangle."""
    a, b, c = triangle
    return (a, b), (a, c), (b, c)


class Causes:
    """Explains single differences."""

    def __init__(
        self,
        digital: DigitalTriangulation,
        exact: Triangulation,
        frame: Frame,
        has_region: NDArray[np.bool_],
        split: NDArray[np.bool_],
    ) -> None:
        self._digital, self._exact = digital, exact
        self._has_region, self._split = has_region, split
        low = np.array([frame.x, frame.y], dtype=np.float64)
        high = low + np.array([frame.width - 1, frame.height - 1])  # corners lie between the outermost pixel centers
        centers = self._centers = exact.circumcenters
        beyond = np.maximum(low - centers, centers - high).max(axis=1, initial=-np.inf)
        edges, triangles = members_of(exact.edges), members_of(exact.triangles)
        self.beyond: dict[Members, float] = dict(zip(triangles, beyond.tolist(), strict=True))
        """How far each Voronoi vertex lies beyond the frame, in pixels."""
        whole, inside = voronoi_lengths(exact, centers, low, high) if triangles else (np.full(len(edges), np.inf),) * 2
        self._whole: dict[Members, float] = dict(zip(edges, whole.tolist(), strict=True))
        self._inside: dict[Members, float] = dict(zip(edges, inside.tolist(), strict=True))

    def of_missing(self, members: Members) -> Cause:
        """Tell why an edge or a triangle of every exact triangulation was not found."""
        sides = [members] if len(members) == 2 else list(sides_of(members))
        inside, whole = min((self._inside[side], self._whole[side]) for side in sides)
        if not self._has_region[list(members)].all():
            return "no_region", inside
        if inside == 0 or inside < SHORT <= whole or self.beyond.get(members, 0) > 0:
            return "off_frame", inside
        if members in self._sides_at_four:
            return "four_labels", inside
        return self._in_sight(members, inside)

    def of_false(self, members: Members) -> Cause:
        """Tell why an edge or a triangle was found that no exact triangulation has."""
        if members in self._triangles_at_four:
            return "four_labels", None
        sides = [members] if len(members) == 2 else list(sides_of(members))
        return self._in_sight(
            members, min((self._gap(side) for side in sides if side not in self._whole), default=None)
        )

    def _in_sight(self, members: Members, length: float | None) -> Cause:
        if self._split[list(members)].any():
            return "split_region", length
        return ("short_edge" if length is not None and length < SHORT else "other"), length

    def _gap(self, edge: Members) -> float:
        """Distance between the nearest vertices of two Voronoi cells that do not touch."""
        one, other = (self._vertices(v) for v in edge)
        return float(hypotenuse(*(one[:, None] - other[None]).T).min(initial=np.inf))

    @cached_property
    def _triangles_at_four(self) -> set[Members]:
        return set(members_of(self._digital.triangles[self._digital.at_four]))

    @cached_property
    def _sides_at_four(self) -> set[Members]:
        return {side for triangle in self._triangles_at_four for side in sides_of(triangle)}

    @cached_property
    def _star(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Triangles of all sites one after the other, and where each one's begin."""
        corners = self._exact.triangles.ravel()
        order = np.argsort(corners, kind="stable")
        return np.searchsorted(corners[order], np.arange(len(self._exact.points) + 1)), order // 3

    def _vertices(self, v: int) -> NDArray[np.float64]:
        """(k, 2) vertices of a Voronoi cell."""
        start, triangles = self._star
        return self._centers[triangles[start[v] : start[v + 1]]]


class CocircularTies:
    """The polygons of cocircular points, which may be triangulated in any way."""

    def __init__(self, mesh: Triangulation) -> None:
        one, corner = np.nonzero(mesh.neighbors > np.arange(len(mesh))[:, None])
        other = mesh.neighbors[one, corner]
        a, b = (mesh.triangles[one, (corner + k) % 3] for k in (1, 2))
        apex = mesh.triangles[other].sum(axis=1, dtype=np.int64) - a - b
        quads = np.concatenate([mesh.triangles[one], apex[:, None]], axis=1)
        tie = _core.kernel.incircle(np.ascontiguousarray(mesh.points[quads])) == 0
        polygon = connected_roots(np.stack([one[tie], other[tie]], axis=1), len(mesh))
        self.unique_triangles = np.bincount(polygon, minlength=len(mesh))[polygon] == 1
        diagonals = np.sort(np.stack([a, b], axis=1)[tie], axis=1)
        self._edges, self._triangles = (
            {tuple(row) for row in np.sort(rows, axis=1).tolist()} for rows in (mesh.edges, mesh.triangles)
        )
        inner = {tuple(row) for row in diagonals.tolist()}
        self.unique_edges = np.array([tuple(row) not in inner for row in mesh.edges.tolist()], dtype=bool)
        self._polygons: dict[int, set[int]] = {}
        for number in np.flatnonzero(~self.unique_triangles).tolist():
            for v in mesh.triangles[number].tolist():
                self._polygons.setdefault(v, set()).add(int(polygon[number]))

    def has_edge(self, edge: tuple[int, ...]) -> bool:
        """Whether some Delaunay triangulation has an edge; indices in increasing order."""
        return edge in self._edges or bool(self._shared(edge))

    def has_triangle(self, triangle: tuple[int, ...]) -> bool:
        """Whether some Delaunay triangulation has a triangle; indices in increasing order."""
        return triangle in self._triangles or bool(self._shared(triangle))

    def _shared(self, vertices: tuple[int, ...]) -> set[int]:
        return set.intersection(*(self._polygons.get(v, set()) for v in vertices))


def voronoi_lengths(
    mesh: Triangulation, centers: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Length of the Voronoi edge of every edge of a triangulation, and of its part inside a rectangle."""
    triangle, corner = np.nonzero(mesh.neighbors < np.arange(len(mesh))[:, None])  # each edge once
    other = mesh.neighbors[triangle, corner]
    a, b = (mesh.triangles[triangle, (corner + k) % 3] for k in (1, 2))
    on_hull = other < 0
    start = centers[triangle]
    along = mesh.points[b] - mesh.points[a]
    outward = np.stack([along[:, 1], -along[:, 0]], axis=1) / hypotenuse(along[:, 0], along[:, 1])[:, None]
    # Far enough to cross the whole rectangle from wherever the ray begins.
    reach = np.abs(start - low).sum(axis=1) + np.abs(start - high).sum(axis=1) + 1
    step = np.where(on_hull[:, None], outward * reach[:, None], centers[other] - start)
    size = hypotenuse(step[:, 0], step[:, 1])
    order = _order_of(mesh, a, b)
    return np.where(on_hull, np.inf, size)[order], (_share_inside(start, step, low, high) * size)[order]


def _order_of(mesh: Triangulation, a: NDArray[np.int32], b: NDArray[np.int32]) -> NDArray[np.intp]:
    """Where each edge of the mesh is among the pairs of ends."""
    count = len(mesh.points)
    ends = np.minimum(a, b).astype(np.int64) * count + np.maximum(a, b)
    sorter = np.argsort(ends, kind="stable")
    wanted = mesh.edges[:, 0].astype(np.int64) * count + mesh.edges[:, 1]
    return sorter[np.searchsorted(ends[sorter], wanted)]


def _share_inside(
    start: NDArray[np.float64], step: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Share of each segment that lies in a rectangle (Liang and Barsky 1984)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (low - start) / step, (high - start) / step
    within = (start >= low) & (start <= high)
    parallel = step == 0
    enters = np.where(parallel, np.where(within, -np.inf, np.inf), np.minimum(one, other)).max(axis=1)
    leaves = np.where(parallel, np.where(within, np.inf, -np.inf), np.maximum(one, other)).min(axis=1)
    return np.maximum(0.0, np.minimum(leaves, 1.0) - np.maximum(enters, 0.0))
