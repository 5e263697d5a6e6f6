"""Approximate skeletons from the Voronoi diagram of boundary samples (paper, section 3.1)."""

from __future__ import annotations

from dataclasses import field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.arrangement.repaired_polygons import PlacedShapes
from vorotool.engines.skeleton.exact import (
    check_skeleton_options,
    face_groups,
    joined_groups,
    of_one_arrangement,
    on_lattice,
    skeleton_of_arrays,
    warn_empty,
)
from vorotool.engines.skeleton.parts import without_equal_nodes
from vorotool.errors import LimitError, UsageError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import norms, owners
from vorotool.numeric.checks import checked_threads, is_choice
from vorotool.numeric.numbers import finite_double, shown_number
from vorotool.numeric.parallel import Progress
from vorotool.types.box import Extent, default_frame
from vorotool.types.identity import names_of, part_table, place_columns
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.segment_voronoi import SiteTable
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.table import Lookup, Table


@frozen(eq=False)
class BoundarySamples:
    """Seeds: the points of a planar graph, then those inside each of its segments, along it."""

    # (s, 2) float64 array: lattice coordinates: multiples of 2^-22, within 2^-21 of their segments
    seeds: NDArray[np.float64]
    segment: NDArray[np.int32]  # (s,) int32 array: the segment that each is inside of; -1 of points
    start: NDArray[np.int32]  # (m + 1,) int32 array: the first seed inside each segment
    graph: PlanarGraph
    sites: SiteTable  # what its points, and then its segments, are in `polygons`
    polygons: PolygonSet  # the shapes as they are used

    def __len__(self) -> int:
        return len(self.seeds)

    @property
    def xy(self) -> NDArray[np.float64]:
        """(s, 2) in input units, rounded once more."""
        return self.graph.coordinates(self.seeds)

    @property
    def site(self) -> NDArray[np.int32]:
        """(s,) row of `sites` of each seed: a vertex, or the edge that it is inside of."""
        points = len(self.graph.points)
        own = np.arange(len(self), dtype=np.int32)
        return np.where(self.segment < 0, own, self.segment + np.int32(points))

    @property
    def labels(self) -> NDArray[np.int32]:
        """(s, 2) the first two labels of each seed, numbers of segments from 1; 0 for none."""
        points, segments = len(self.graph.points), self.graph.segments
        labels = np.zeros((len(self), 2), dtype=np.int32)
        labels[points:, 0] = self.segment[points:] + 1
        end = segments.reshape(-1)
        label = np.repeat(np.arange(1, len(segments) + 1, dtype=np.int32), 2)
        order = np.argsort(end, kind="stable")
        end, label = end[order], label[order]
        nth = np.arange(len(end)) - np.searchsorted(end, end)
        labels[end[nth < 2], nth[nth < 2]] = label[nth < 2]
        return labels

    def gaps(self) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
        """Lengths of the pieces between seeds that follow each other, in input units, and the segment of each."""
        points, segments = len(self.graph.points), self.graph.segments
        count = np.diff(self.start)
        last = np.cumsum(count + 1) - 1  # of each segment, among the pieces
        before = np.insert(self.seeds[points:], self.start[:-1] - points, self.seeds[segments[:, 0]], axis=0)
        after = np.empty_like(before)
        inner = np.ones(len(after), dtype=bool)
        inner[last] = False
        after[inner], after[last] = self.seeds[points:], self.seeds[segments[:, 1]]
        lengths = self.graph.scale * norms(after - before)
        return lengths, owners(count + 1, dtype=np.int32)


def sample_table(samples: BoundarySamples) -> Table:
    """Return one row a seed."""
    site, labels, xy = samples.site, samples.labels, samples.xy
    sites = samples.sites
    return part_table(
        {
            "element": np.arange(len(samples)),
            "kind": Lookup(["vertex", "sample"], (samples.segment >= 0).astype(np.int32)),
            **names_of(samples.polygons, sites.polygon[site]),
            "ring": sites.ring[site],
            "vertex_index": sites.index[site],
            **place_columns(xy),
            "label_a": np.ma.array(labels[:, 0], mask=labels[:, 0] == 0),
            "label_b": np.ma.array(labels[:, 1], mask=labels[:, 1] == 0),
        },
        samples.polygons,
        sites.polygon[site],
    )


SAMPLINGS = ("paper", "symmetric")
MOST_SEEDS = 2**28
"""As many as the triangulation takes."""

ROUNDING_ULPS = 2
"""Of the largest coordinate: by how much nodes move when they are rounded to input units."""


@frozen
class SamplingOptions:
    """A step or a tolerance, and how edges are sampled."""

    step: float | None = None
    tolerance: float | None = None
    sampling: str | None = None

    def __post_init__(self) -> None:
        if (self.step is None) == (self.tolerance is None):
            raise UsageError("give either a step or a tolerance")
        for name in ("step", "tolerance"):
            value = getattr(self, name)
            if value is None:
                continue
            object.__setattr__(self, name, finite_double(value, f"the {name}"))
            if not getattr(self, name) > 0:
                raise UsageError(f"the {name} is {shown_number(value)}: use a length above 0")
        if not is_choice(self.sampling, (None, *SAMPLINGS)):
            raise UsageError(f"the sampling is {shown_number(self.sampling)}: use {' or '.join(SAMPLINGS)}")
        if self.tolerance is not None and self.sampling == "paper":
            raise UsageError("a tolerance implies symmetric sampling: leave out the sampling")

    @property
    def is_symmetric(self) -> bool:
        """Whether samples are symmetric about corners."""
        return self.tolerance is not None or self.sampling == "symmetric"


@frozen(eq=False)
class Wanted:
    """What of a skeleton is computed, and with how many seeds and threads."""

    side: str = "interior"
    frame: Extent | None = None
    complete: bool = False
    most: int = MOST_SEEDS
    threads: int = 0
    progress: Progress = None


@frozen(eq=False)
class SampleGroups:
    """Which seeds have a diagram together, and in which bounds its parts are put into order."""

    # (n,) int32 array: the group of each point of a graph, from 0; none if all have one diagram. Segments and their
    # ends are in one
    of_point: NDArray[np.int32] = field(default_factory=lambda: np.empty(0, dtype=np.int32))
    within: tuple[float, float, float, float] | None = None  # on the lattice: hold all seeds. By default their bounds

    def of_samples(self, samples: BoundarySamples) -> NDArray[np.int32] | None:
        """(s,) groups; None if all are one."""
        if not len(self.of_point):
            return None
        points = len(self.of_point)
        return np.concatenate([self.of_point, self.of_point[samples.graph.segments[samples.segment[points:], 0]]])


@frozen(eq=False)
class SampledShapes:
    """Polygons made a planar graph, seeds on it, and their Voronoi diagram."""

    graph: PlanarGraph  # of the polygons
    placed: PlacedShapes  # the rings as the graph has them, and what the sites are there
    samples: BoundarySamples
    diagram: Any  # their Voronoi diagram, with what is to be deleted
    groups: SampleGroups  # which of them have a diagram together


@frozen(eq=False)
class ApproximateSkeleton:
    """A skeleton and what it was made of."""

    skeleton: Skeleton  # of straight arcs
    # (a, 2) int32 array: the seeds left and right of each arc; -1 of lines that lead to corners
    seeds: NDArray[np.int32]
    shapes: SampledShapes  # of which it is
    open_corners: int  # corners under 180 degrees that could not be joined
    # (p,) int32 array: into how many parts each piece of an edge should be divided for a tolerance
    parts: NDArray[np.int32]


def sampled_graph(
    graph: PlanarGraph, placed: PlacedShapes, options: SamplingOptions, wanted: Wanted | None = None
) -> SampledShapes:
    """Sample a graph by a step, and compute the Voronoi diagram of the seeds."""
    wanted = wanted or Wanted()
    try:
        return diagram_by_step(graph, placed, options, SampleGroups(), wanted)
    except _core.sampled_skeleton.TooManySeedsError as error:
        raise LimitError(
            f"a step of {options.step:g} gives {error}, more than {wanted.most}: use a larger step"
        ) from None


def diagram_by_step(
    graph: PlanarGraph, placed: PlacedShapes, options: SamplingOptions, groups: SampleGroups, wanted: Wanted
) -> SampledShapes:
    """Sample a graph by a step, and compute the Voronoi diagrams; TooManySeedsError is the core's."""
    assert options.step is not None
    step = options.step / graph.scale
    if step < _core.sampled_skeleton.LEAST_SAMPLE_GAP:
        raise LimitError(
            f"a step of {options.step:g} is finer than the lattice that coordinates are rounded to: use at least "
            f"{_core.sampled_skeleton.LEAST_SAMPLE_GAP * graph.scale!r}"
        )
    core, limits = core_graph(graph), (wanted.most, wanted.threads, wanted.progress)
    if options.is_symmetric:
        steps = _core.sampled_skeleton.corner_steps(core, step, True, wanted.most)
        made = _core.sampled_skeleton.sample_from_corners(core, steps, *limits)
    else:
        made = _core.sampled_skeleton.sample_by_step(core, step, *limits)
    return diagram_of_samples(graph, placed, made, groups, wanted)


def core_graph(graph: PlanarGraph) -> _core.kernel.PlanarGraph:
    """Points, segments and faces, for the core."""
    return _core.kernel.PlanarGraph(graph.points, graph.segments, graph.segment_faces)


def diagram_of_samples(
    graph: PlanarGraph, placed: PlacedShapes, made: tuple[Any, Any, Any], groups: SampleGroups, wanted: Wanted
) -> SampledShapes:
    """Compute the Voronoi diagram of seeds, or of each group of them."""
    samples = BoundarySamples(*made, graph, placed.sites, placed.polygons)
    diagram = _core.sampled_skeleton.SampledDiagram(
        core_graph(graph), *made, groups.of_point, groups.within, wanted.threads, wanted.progress
    )
    return SampledShapes(graph, placed, samples, diagram, groups)


def approximate_skeleton(shapes: SampledShapes, wanted: Wanted | None = None) -> ApproximateSkeleton:
    """Delete what is not the skeleton's from the diagram of samples, and bound the errors of the arcs."""
    wanted = wanted or Wanted()
    check_skeleton_options(wanted.side, 0, wanted.frame)
    warn_without_inside(shapes.graph, shapes.placed, wanted.side)
    return told_together(skeleton_of_samples(shapes, wanted), wanted.side)


def warn_without_inside(graph: PlanarGraph, placed: PlacedShapes, side: str) -> None:
    """Say that there is no interior where it is asked for."""
    if side != "exterior" and not graph.is_inside.any():
        warn_empty(placed.polygons, side)


def told_together(found: ApproximateSkeleton, side: str) -> ApproximateSkeleton:
    """Say that features were taken together, where there are several, and their inside is of interest."""
    return found if side == "exterior" else replace(found, skeleton=of_one_arrangement(found.skeleton))


def skeleton_of_samples(shapes: SampledShapes, wanted: Wanted, tolerance: float = 0.0) -> ApproximateSkeleton:
    """Do what `approximate_skeleton` does, without a word about anything."""
    graph, placed, side = shapes.graph, shapes.placed, wanted.side
    clip = None if side == "interior" else (wanted.frame or default_frame(placed.polygons))
    clipped = None if clip is None else (len(placed.polygons), on_lattice(clip, graph))
    how = False, wanted.complete, tolerance / graph.scale, joined_groups(placed)
    made = _arrays(shapes, face_groups(placed, side), clipped, how, wanted)
    seeds, parts, open_corners = made.pop("seeds"), made.pop("parts"), made.pop("open_corners")
    largest = np.abs(graph.origin).max() + graph.scale * 2.0**30
    bound = made["error_bound"] + ROUNDING_ULPS * np.spacing(largest)
    made["error_bound"] = np.where(np.isinf(bound), np.nan, bound)
    skeleton = skeleton_of_arrays(made, graph, placed, clip)
    return ApproximateSkeleton(skeleton, seeds, shapes, open_corners, parts)


def _arrays(
    shapes: SampledShapes, groups: NDArray[np.int32], clipped: Any, how: tuple[Any, ...], wanted: Wanted
) -> dict[str, Any]:
    """Take the arcs in some faces out of a diagram: all or those of the skeleton, complete, within bounds, joined."""
    place = *shapes.graph.origin, shapes.graph.scale
    return shapes.diagram.skeleton(groups, clipped, *how, *place, wanted.threads, wanted.progress)


def whole_sampled_diagram(shapes: SampledShapes, *, frame: Extent | None = None, threads: int = 0) -> Skeleton:
    """Give all edges of the Voronoi diagram of samples as arcs, cut by a frame; they have no side and no bounds."""
    check_skeleton_options("both", 0, frame)
    graph, placed = shapes.graph, shapes.placed
    clip = frame or default_frame(placed.polygons)
    groups, wanted = np.zeros(graph.faces, dtype=np.int32), Wanted(threads=checked_threads(threads))
    made = _arrays(shapes, groups, (0, on_lattice(clip, graph)), (True, False, 0.0, (0, 0)), wanted)
    for name in ("seeds", "parts", "open_corners"):
        made.pop(name)
    made["group"][:] = len(placed.polygons)
    whole = skeleton_of_arrays(made, graph, placed, clip)
    return without_equal_nodes(replace(whole, side=np.full(len(whole), -1)))
