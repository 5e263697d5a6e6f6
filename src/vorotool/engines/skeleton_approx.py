"""Approximate skeletons from the Voronoi diagram of boundary samples (paper, section 3.1)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.label_arrays import Progress
from vorotool.engines.placed_rings import PlacedShapes, placed_shapes
from vorotool.engines.planar_graph import planar_graph
from vorotool.engines.skeleton_exact import (
    Frame,
    check_skeleton_options,
    default_frame,
    face_groups,
    joined_groups,
    on_lattice,
    skeleton_of_arrays,
    warn_empty,
)
from vorotool.errors import LimitError, UsageError
from vorotool.geometry.checks import checked_threads
from vorotool.geometry.edge_samples import EdgeSamples
from vorotool.geometry.planar_graph import PlanarGraph
from vorotool.geometry.skeleton import Skeleton

SAMPLINGS = ("paper", "symmetric")
MOST_SEEDS = 2**28
"""As many as the triangulation takes."""

ROUNDING_ULPS = 2
"""Of the largest coordinate: by how much nodes move when they are rounded to input units."""


def skeleton_approx(
    polygons: Any,
    *,
    step: float | None = None,
    tolerance: float | None = None,
    sampling: str | None = None,
    side: str = "interior",
    complete: bool | None = None,
    frame: Frame | None = None,
    strict: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Skeleton:
    """Approximate the skeleton of polygons by the Voronoi diagram of samples, with a certified error of every arc.

    The edges are sampled, and each seed has the labels of the edges that it is on. Of the Voronoi diagram of the seeds,
    the edges between seeds with a label in common are deleted, and those that the polygons cross. All that is decided
    exactly. No point of an arc is farther from the exact skeleton than its `error_bound`.

    Parameters
    ----------
    polygons : PolygonSet, shapely geometry, (n, 2) array-like, or a list of these
        See :func:`vorotool.geometry.polygon_conversion.as_polygons`.
    step : float
        Between samples, in input units.
    tolerance : float
        Instead of a step: edges are sampled as finely as it takes for all error bounds to be at most this. The bounds
        are from approximate to exact; where corners of nearly 180 degrees have nearly invisible branches, the exact
        skeleton may be farther away.
    sampling : {"paper", "symmetric"}
        Every edge from its first end, the last gap being between h/2 and 3h/2, as the paper prints it (by default with
        a step); or the same distances from each corner on all of its edges (always with a tolerance).
    side : {"interior", "exterior", "both"}
        Inside polygons, outside all of them, or both.
    complete : bool, optional
        Join corners under 180 degrees by a line along the bisector to the first arc; by default with a tolerance.
    frame : (x, y, w, h), optional
        Rectangle that arcs outside are cut by; by default the bounds and a tenth of their larger side around them.
    strict : bool
        Refuse polygons that would be repaired.
    threads : int
        0 uses all.
    progress : callable, optional
        Called with the fraction done of each step.

    Returns
    -------
    Skeleton
        Of straight arcs. Radii are clearances: distances from the polygons. Error bounds are NaN where nothing is
        proved, which is so in a few places where edges are much nearer to each other than samples.

    Raises
    ------
    InputError
        If a coordinate is not finite, or `strict` and something would be repaired.
    UsageError
        If the step or the tolerance is none, or both or neither is given; of the other options likewise.
    LimitError
        If there are too many seeds, or the tolerance cannot be met.

    Warns
    -----
    VorotoolWarning
        If polygons were repaired, or none has an inside and that is asked for.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 3.1.

    Examples
    --------
    >>> skeleton = skeleton_approx([[0, 0], [8, 0], [8, 3], [0, 3]], step=0.5)
    >>> bool(skeleton.error_bound.max() < 0.2), round(float(skeleton.radius.max()), 6)
    (True, 1.5)
    """
    options = SamplingOptions(step, tolerance, sampling)
    check_skeleton_options(side, 0, frame)
    complete = (tolerance is not None) if complete is None else complete
    common: dict[str, Any] = {"threads": checked_threads(threads), "progress": progress}
    graph = planar_graph(polygons, strict=strict, **common)
    placed = placed_shapes(graph, threads=threads)
    if options.tolerance is not None:
        from vorotool.engines.skeleton_tolerance import skeleton_within

        shapes = skeleton_within(graph, placed, options.tolerance, side=side, frame=frame, complete=complete, **common)
        return shapes.skeleton
    shapes_sampled = sampled_graph(graph, placed, options, **common)
    return approximate_skeleton(shapes_sampled, side=side, frame=frame, complete=complete, **common).skeleton


@dataclass(frozen=True)
class SamplingOptions:
    """A step or a tolerance, and how edges are sampled.

    Raises
    ------
    UsageError
        If these are none, or do not go together.
    """

    step: float | None = None
    tolerance: float | None = None
    sampling: str | None = None

    def __post_init__(self) -> None:
        if (self.step is None) == (self.tolerance is None):
            raise UsageError("give a step or a tolerance, and not both")
        for name in ("step", "tolerance"):
            value = getattr(self, name)
            if value is not None and not 0 < value < np.inf:
                raise UsageError(f"the {name} is {value}: use a length above 0")
        if self.sampling is not None and self.sampling not in SAMPLINGS:
            raise UsageError(f"the sampling is {self.sampling!r}: use {' or '.join(SAMPLINGS)}")
        if self.tolerance is not None and self.sampling == "paper":
            raise UsageError("a tolerance is met by symmetric sampling: leave the sampling out")

    @property
    def is_symmetric(self) -> bool:
        """Whether samples are symmetric about corners."""
        return self.tolerance is not None or self.sampling == "symmetric"


@dataclass(frozen=True, eq=False)
class SampledShapes:
    """Polygons made a planar graph, seeds on it, and their Voronoi diagram.

    Parameters
    ----------
    graph : PlanarGraph
        Of the polygons.
    placed : PlacedShapes
        The rings as the graph has them, and what the sites are there.
    samples : EdgeSamples
        The seeds.
    diagram : compiled object
        Their Voronoi diagram, with what is to be deleted.
    """

    graph: PlanarGraph
    placed: PlacedShapes
    samples: EdgeSamples
    diagram: Any


@dataclass(frozen=True, eq=False)
class ApproximateSkeleton:
    """A skeleton and what it was made of.

    Parameters
    ----------
    skeleton : Skeleton
        Of straight arcs.
    seeds : (a, 2) int32 array
        The seeds left and right of each arc; -1 of lines that lead to corners.
    shapes : SampledShapes
        Of which it is.
    open_corners : int
        Corners under 180 degrees that could not be joined.
    parts : (p,) int32 array
        Into how many parts each piece of an edge should be divided for a tolerance.
    """

    skeleton: Skeleton
    seeds: NDArray[np.int32]
    shapes: SampledShapes
    open_corners: int
    parts: NDArray[np.int32]


def sampled_shapes(
    polygons: Any,
    *,
    step: float,
    sampling: str | None = None,
    strict: bool = False,
    most: int = MOST_SEEDS,
    threads: int = 0,
    progress: Progress = None,
) -> SampledShapes:
    """Place polygons, sample them, and compute the Voronoi diagram; arguments and errors as of `skeleton_approx`.

    Examples
    --------
    >>> len(sampled_shapes([[0, 0], [4, 0], [4, 4], [0, 4]], step=1).samples)
    16
    """
    options = SamplingOptions(step, None, sampling)
    threads = checked_threads(threads)
    graph = planar_graph(polygons, strict=strict, threads=threads, progress=progress)
    placed = placed_shapes(graph, threads=threads)
    return sampled_graph(graph, placed, options, most=most, threads=threads, progress=progress)


def sampled_graph(
    graph: PlanarGraph,
    placed: PlacedShapes,
    options: SamplingOptions,
    *,
    most: int = MOST_SEEDS,
    threads: int = 0,
    progress: Progress = None,
) -> SampledShapes:
    """Sample a graph by a step, and compute the Voronoi diagram of the seeds."""
    assert options.step is not None
    step = options.step / graph.scale
    try:
        if options.is_symmetric:
            steps = _core.corner_steps(*graph_arrays(graph), step, True, most)
            made = _core.sample_from_corners(*graph_arrays(graph), steps, most, threads, progress)
        else:
            made = _core.sample_by_step(*graph_arrays(graph), step, most, threads, progress)
    except _core.TooManySeedsError as error:
        raise LimitError(
            f"a step of {options.step:g} gives {error} seeds, more than {most}: use a larger one"
        ) from None
    return diagram_of_samples(graph, placed, made, threads=threads, progress=progress)


def graph_arrays(graph: PlanarGraph) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
    """Points, segments and faces as the core takes them."""
    return graph.points, graph.segments, graph.segment_faces


def diagram_of_samples(
    graph: PlanarGraph, placed: PlacedShapes, made: tuple[Any, Any, Any], *, threads: int, progress: Progress
) -> SampledShapes:
    """Compute the Voronoi diagram of seeds."""
    samples = EdgeSamples(*made, graph, placed.sites, placed.polygons)
    diagram = _core.SampledDiagram(*graph_arrays(graph), *made, threads, progress)
    return SampledShapes(graph, placed, samples, diagram)


def approximate_skeleton(
    shapes: SampledShapes,
    *,
    side: str = "interior",
    frame: Frame | None = None,
    complete: bool = False,
    tolerance: float = 0.0,
    threads: int = 0,
    progress: Progress = None,
) -> ApproximateSkeleton:
    """Delete what is not the skeleton's from the diagram of samples, and bound the errors of the arcs.

    Arguments are as of `skeleton_approx`; with a tolerance, what should be sampled more finely is in the result.
    """
    check_skeleton_options(side, 0, frame)
    graph, placed = shapes.graph, shapes.placed
    if side != "exterior" and not graph.is_inside.any():
        warn_empty(placed.polygons)
    clip = None if side == "interior" else (frame or default_frame(placed.polygons))
    made: dict[str, Any] = shapes.diagram.skeleton(
        face_groups(placed, side),
        None if clip is None else (len(placed.polygons), on_lattice(clip, graph)),
        False,
        complete,
        tolerance / graph.scale,
        joined_groups(placed),
        *graph.origin,
        graph.scale,
        checked_threads(threads),
        progress,
    )
    seeds, parts, open_corners = made.pop("seeds"), made.pop("parts"), made.pop("open_corners")
    largest = np.abs(graph.origin).max() + graph.scale * 2.0**30
    bound = made["error_bound"] + ROUNDING_ULPS * np.spacing(largest)
    made["error_bound"] = np.where(np.isinf(bound), np.nan, bound)
    return ApproximateSkeleton(skeleton_of_arrays(made, placed, clip), seeds, shapes, open_corners, parts)


def whole_sampled_diagram(
    shapes: SampledShapes, *, frame: Frame | None = None, threads: int = 0, progress: Progress = None
) -> Skeleton:
    """Give all edges of the Voronoi diagram of samples as arcs, cut by a frame; they have no side and no bounds.

    Examples
    --------
    >>> len(whole_sampled_diagram(sampled_shapes([[0, 0], [2, 0], [0, 2]], step=1)))
    11
    """
    check_skeleton_options("both", 0, frame)
    graph, placed = shapes.graph, shapes.placed
    clip = frame or default_frame(placed.polygons)
    made: dict[str, Any] = shapes.diagram.skeleton(
        np.zeros(graph.faces, dtype=np.int32),
        (0, on_lattice(clip, graph)),
        True,
        False,
        0.0,
        (0, 0),
        *graph.origin,
        graph.scale,
        checked_threads(threads),
        progress,
    )
    for name in ("seeds", "parts", "open_corners"):
        made.pop(name)
    made["group"][:] = len(placed.polygons)
    whole = skeleton_of_arrays(made, placed, clip)
    whole.side[:] = -1
    return whole
