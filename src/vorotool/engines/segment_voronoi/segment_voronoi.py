"""The Voronoi diagram of points and open line segments: exact topology (paper, section 3.2)."""

from __future__ import annotations

from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import InputError, LimitError, VerificationError, VorotoolError
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.lazy import shapely
from vorotool.numeric.parallel import Progress, Run
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.segment_voronoi import LATTICE_LIMIT, SegmentVoronoiDiagram

MOST_SITES = 2**28 - 1
"""Of n sites there are at most 2 n - 2 vertices, each with four corner numbers in 31 bits."""
NEITHER = 3
"""Value of `unwanted_sides` for a site of which neither side is wanted."""


def segment_voronoi(
    points: Any,
    segments: Any,
    *,
    unwanted: NDArray[np.uint8] | None = None,
    within: tuple[int, int, int, int] | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> SegmentVoronoiDiagram:
    """Compute the Voronoi diagram of the points and open segments of a planar straight-line graph."""
    rows = np.asarray(points), np.asarray(segments)
    count = sum(len(array) for array in rows if array.ndim)
    if count > MOST_SITES:
        raise LimitError(f"there are {count} points and segments, more than {MOST_SITES}: simplify or split the input")
    places, ends = _on_lattice(rows[0], "points"), _on_lattice(rows[1], "segments")
    threads = checked_threads(threads)
    try:
        core = _core.segment_voronoi.SegmentVoronoi(places, ends, threads, progress, within)
    except ValueError as error:
        raise InputError(f"{error}: place the input on the lattice first") from None
    except RuntimeError as error:
        raise _explained(str(error), places, ends) from None
    return SegmentVoronoiDiagram(places, ends, **core.take_arrays(unwanted, threads, progress), counts=core.counts)


def segment_voronoi_of_groups(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    group: NDArray[np.int64],
    *,
    within: tuple[int, int, int, int] | None = None,
    **run: Unpack[Run],
) -> SegmentVoronoiDiagram:
    """Compute the diagrams of groups of points and segments, each as if there were no others, one after the other."""
    count = len(points)
    order = np.argsort(group, kind="stable")  # in each group points first
    starts = np.flatnonzero(np.diff(group[order], prepend=-1))
    number = np.empty(len(order), dtype=np.int32)
    number[order] = np.arange(len(order)) - np.repeat(starts, np.diff(starts, append=len(order)))
    parts = []
    for own in np.split(order, starts[1:]):
        inner = int(np.searchsorted(own, count))
        ends = number[segments[own[inner:] - count]]
        parts.append(segment_voronoi(points[own[:inner]], ends, within=within, **run))
    return _joined(points, segments, parts, order.astype(np.int32))


def _joined(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    parts: list[SegmentVoronoiDiagram],
    order: NDArray[np.int32],
) -> SegmentVoronoiDiagram:
    """Put diagrams together whose sites, one after the other, have the numbers in `order`."""

    def shifted(name: str, sizes: list[int]) -> NDArray[np.int32]:
        values = [getattr(part, name) for part in parts]
        first = np.repeat(np.cumsum(sizes) - sizes, [len(rows) for rows in values])
        return np.concatenate(values) + first.astype(np.int32).reshape(-1, *[1] * (values[0].ndim - 1))

    sites = [len(part.points) + len(part.segments) for part in parts]
    rings = np.concatenate([np.diff(part.vertex_starts) for part in parts])
    edges = np.concatenate([part.edges for part in parts])
    return SegmentVoronoiDiagram(
        points,
        segments,
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.radius for part in parts]),
        np.concatenate([[0], np.cumsum(rings)]).astype(np.int32),
        order[shifted("vertex_sites", sites)],
        np.where(edges < 0, edges, shifted("edges", [len(part) for part in parts])),
        order[shifted("edge_sites", sites)],
    )


def unwanted_sides(graph: PlanarGraph, is_wanted: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Tell on which sides of its points and segments a planar graph has faces that are not wanted."""
    core = _core.kernel.PlanarGraph(graph.points, graph.segments, graph.segment_faces)
    return _core.segment_voronoi.unwanted_sides(core, is_wanted.view(np.uint8))


def core_diagram(
    diagram: SegmentVoronoiDiagram, segment_faces: NDArray[np.int32] | None = None
) -> _core.segment_voronoi.Diagram:
    """The arrays of a diagram, for the core, and left and right of each segment the face of its graph."""
    names = ("points", "segments", "vertices", "radius", "vertex_starts", "vertex_sites", "edges", "edge_sites")
    return _core.segment_voronoi.Diagram(
        **{name: getattr(diagram, name) for name in names}, segment_faces=segment_faces
    )


def _explained(symptom: str, points: NDArray[np.int32], segments: NDArray[np.int32]) -> VorotoolError:
    """Describe the fault of a graph that has no diagram."""
    fault = _fault_of(points, segments)
    if fault is not None:
        return InputError(f"{fault}: place the input on the lattice first")
    return VerificationError(f"internal error in vorotool: {symptom}; please report it with the input")


def _fault_of(points: NDArray[np.int32], segments: NDArray[np.int32]) -> str | None:
    """Where segments have more in common than an end."""
    lines = shapely.linestrings(points[segments])
    tree = shapely.STRtree(lines)
    places, at = tree.query(shapely.points(points), predicate="intersects")
    inside = np.flatnonzero((segments[at] != places[:, None]).all(axis=1))
    if inside.size:
        return f"point {places[inside[0]]} lies inside segment {at[inside[0]]}"
    first, second = tree.query(lines, predicate="intersects")
    common = (segments[first][:, :, None] == segments[second][:, None, :]).sum(axis=(1, 2))
    faults = np.flatnonzero((first < second) & (common != 1))
    if not faults.size:
        return None
    return f"segments {first[faults[0]]} and {second[faults[0]]} cross, or have the same ends"


def _on_lattice(array: NDArray[Any], name: str) -> NDArray[np.int32]:
    """Pairs of integers on the lattice."""
    if array.size == 0:
        return np.empty((0, 2), np.int32)
    if array.ndim != 2 or array.shape[1] != 2:
        raise InputError(f"{name} must have shape (…, 2), but has shape {array.shape}")
    if array.dtype.kind not in "iu":
        raise InputError(f"{name} must be integers, but have type {array.dtype}")
    largest = max(int(array.max()), -int(array.min()))
    if largest > LATTICE_LIMIT:
        raise InputError(f"{name} hold {largest}, beyond {LATTICE_LIMIT}: place the input on the lattice first")
    return np.array(array, dtype=np.int32, order="C")  # a copy: no kernel reads memory that others may change


def verify_segment_voronoi(diagram: SegmentVoronoiDiagram, *, threads: int = 0, progress: Progress = None) -> None:
    """Check a segment Voronoi diagram exactly, from its arrays alone."""
    fault = _core.segment_voronoi.find_fault(core_diagram(diagram), checked_threads(threads), progress)
    if fault is not None:
        raise VerificationError(fault)
