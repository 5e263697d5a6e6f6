"""A check of skeletons that knows their arrays only, not how they were made."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np

from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.common import fail, first_wrong
from vorotool.engines.features.batches import BatchShapes, in_batches
from vorotool.engines.skeleton.exact import ShapeDiagram, kept_edges
from vorotool.engines.skeleton.parts import PER_ARC, outside_of, with_arcs, with_polygons
from vorotool.engines.skeleton.site_distances import SitePlaces
from vorotool.engines.skeleton.verify_border import (
    check_cut_regions,
    check_equal_distances,
    check_nothing_nearer,
    without_border,
)
from vorotool.engines.skeleton.verify_bounds import check_approximation
from vorotool.engines.skeleton.verify_regions import (
    SkeletonRegions,
    border_components,
    check_regions,
    with_corners_apart,
)
from vorotool.errors import VorotoolWarning
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.numbers import distinct
from vorotool.numeric.parallel import Progress
from vorotool.types.arguments import check_value
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton
from vorotool.types.skeleton.tables import connected_roots


def verify_skeleton(skeleton: Skeleton, *, threads: int = 0, progress: Progress = None) -> None:
    """Check a skeleton from its arrays alone.

    Nodes and the insides of arcs are as far from the sites on both sides as the radius tells, their feet are on the
    sites, and no site is nearer; no arc is between an edge and its end. For each region inside polygons, or inside a
    hole if the exterior is there: its skeleton is connected, has as many independent cycles as the complement has
    components less one, and one end in each corner under 180 degrees, which nothing else shares; the regions between
    the arcs and their feet sum to its area within 1e-9 of it and 8 ulp of the extent times its perimeter. Outside, all
    is connected with the frame. With an open border, what is left of the outlines is looked at: ends are in corners or
    on the border, and the regions sum to the areas with those between the border and its nearest places.
    Branches are chains that end where they should. Where pixels hang together at corners (`PolygonSet.connectivity`),
    arcs of one polygon, or outside, share a node there; all else is as if they did not.
    Unless features are together (`Skeleton.features`), each is looked at as if there were no others.

    An approximate skeleton, which has error bounds, is checked otherwise: places on its arcs are no farther from the
    exact skeleton, computed anew, than the bounds; radii are distances from the boundary; no arc meets this but in a
    corner, and each is in its polygon, or outside all; and there are no more cycles than parts of the boundary that
    they may go around. It need not be connected, and its sites are not compared.

    Parameters
    ----------
    skeleton : Skeleton
        From any source. With a gap only distances are checked.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.

    Raises
    ------
    VerificationError
        If a check fails; the message names the first fault.

    References
    ----------
    Melkemi and Vandorpe, "Voronoi Diagrams and Applications", section 3.2.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from vorotool import skeleton_exact
    >>> skeleton = skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]])
    >>> verify_skeleton(skeleton)
    >>> verify_skeleton(replace(skeleton, radius=skeleton.radius + 1))
    Traceback (most recent call last):
        ...
    vorotool.errors.VerificationError: node 0 at (0.0, 0.0) is 0.0 from site 7, but its radius is 1.0
    >>> from vorotool import skeleton_approx
    >>> verify_skeleton(skeleton_approx([[0, 0], [4, 0], [4, 2], [0, 2]], tolerance=0.1))
    """
    check_value(skeleton, "skeleton", "Skeleton")
    threads = checked_threads(threads)
    if not len(skeleton):
        return
    check_arrays(skeleton)
    check_branches(skeleton)
    if skeleton.gap:  # the lines that lead to the corners are no bisectors of the shortened edges
        skeleton = _without_portions(skeleton)
    elif skeleton.error_bound.any():
        with warnings.catch_warnings(action="ignore", category=VorotoolWarning):
            check_approximation(skeleton, threads, progress)
        return
    check_equal_distances(skeleton, SitePlaces(skeleton))
    with warnings.catch_warnings(
        action="ignore", category=VorotoolWarning
    ):  # what bounds nothing is still in the rings
        if skeleton.features == "together" or not len(skeleton.polygons):
            graph = planar_graph(skeleton.polygons, threads=threads, progress=progress)
            _check_in_graph(skeleton, graph, threads, progress)
        else:
            _check_sides(skeleton, threads, progress)


def _check_sides(skeleton: Skeleton, threads: int, progress: Progress) -> None:
    """Check what is inside each feature by itself, and what is outside in the arrangement of all."""
    inside = skeleton.side == INTERIOR
    if not inside.all():
        graph = planar_graph(skeleton.polygons, threads=threads, progress=progress)
        _check_in_graph(outside_of(skeleton), graph, threads, progress)
    if inside.any():
        _check_own(skeleton)
        own, whole = with_arcs(skeleton, inside), SitePlaces(skeleton)

        def check(shapes: BatchShapes, threads: int, poll: Progress) -> None:
            of_batch = with_polygons(own, shapes.batch.polygons)
            if len(of_batch):
                _check_in_graph(of_batch, shapes.graph, threads, poll, whole=whole)

        alone = bool(skeleton.gap)
        in_batches(skeleton.polygons, check, alone=alone, drops=False, threads=threads, progress=progress)


def _check_own(skeleton: Skeleton) -> None:
    """Raise if an arc inside is between sites of another feature, or shares a corner with arcs in another polygon."""
    polygons = skeleton.polygons
    assert polygons.feature is not None
    inside = np.flatnonzero(skeleton.side == INTERIOR)
    polygon = skeleton.polygon[inside]
    of_sites = polygons.feature[skeleton.site_table.polygon][skeleton.sites[inside]]
    at = first_wrong((of_sites != polygons.feature[polygon][:, None]).any(axis=1))
    if at is not None:
        fail(f"arc {inside[at]} is listed in polygon {polygon[at]}, but is between sites of another feature")
    owner = np.full(len(skeleton.vertices), -1)
    for end in (0, 1):
        owner[skeleton.arcs[inside, end]] = polygon
    for end in (0, 1):
        node = skeleton.arcs[inside, end]
        at = first_wrong((skeleton.radius[node] == 0) & (owner[node] != polygon))
        if at is not None:
            fail(f"node {node[at]} is a corner that arcs in different polygons share")


def _check_in_graph(
    skeleton: Skeleton, graph: PlanarGraph, threads: int, progress: Progress, *, whole: SitePlaces | None = None
) -> None:
    sites = SitePlaces(skeleton, whole)
    if skeleton.border == "open":
        graph_left = without_border(skeleton, graph)
        check_nothing_nearer(skeleton, sites, graph_left, threads, progress)
        check_cut_regions(skeleton, graph, graph_left, sites)
        return
    check_nothing_nearer(skeleton, sites, _elements(skeleton, graph, threads), threads, progress)
    if not skeleton.gap:
        check_regions(SkeletonRegions(with_corners_apart(skeleton), graph, sites))


def verify_exterior(shapes: ShapeDiagram, *, threads: int = 0) -> None:
    """Check the unbounded part of a skeleton before it is clipped, as a graph."""
    graph, diagram = shapes.graph, shapes.diagram
    edges, faces = kept_edges(shapes, threads=threads)
    edges = edges[faces == 0]
    if not len(edges):
        return
    ends = diagram.edges[edges].astype(np.int64)
    infinity = len(diagram)
    ends[ends < 0] = infinity
    corner = (ends < infinity) & (np.append(diagram.radius, 1.0)[ends] == 0)
    ends[corner] = infinity + 1 + np.arange(np.count_nonzero(corner))  # each arc has its own
    nodes = distinct(ends)
    roots = connected_roots(ends, int(ends.max()) + 1)[nodes]
    if len(distinct(roots)) > 1:
        fail(f"the skeleton outside has {len(distinct(roots))} connected parts, even with a node at infinity")
    lone = np.bincount(graph.segments.reshape(-1), minlength=len(graph.points)) == 0
    sites = distinct(diagram.edge_sites[edges])
    points = np.count_nonzero(lone[sites[sites < len(graph.points)]])
    expected = border_components(graph)[0] + points - 1
    cycles = len(edges) - len(nodes) + 1
    if cycles != expected:
        fail(f"the skeleton outside has {cycles} independent cycles, not {expected}")


def _without_portions(skeleton: Skeleton) -> Skeleton:
    kept = (skeleton.radius[skeleton.arcs] > 0).all(axis=1)
    return replace(skeleton, **{name: getattr(skeleton, name)[kept] for name in PER_ARC})


def _elements(skeleton: Skeleton, graph: PlanarGraph, threads: int) -> PlanarGraph:
    """The points and segments that nothing may be nearer than."""
    if not skeleton.gap:
        return graph
    from vorotool.engines.skeleton.shortened_edges import element_diagram

    return element_diagram(skeleton.polygons, skeleton.gap, threads=threads).graph


def check_arrays(skeleton: Skeleton) -> None:
    """Raise unless indices exist, nodes are finite and used, and sides go with polygons."""
    for name, limit in (("arcs", len(skeleton.vertices)), ("sites", len(skeleton.site_table))):
        at = first_wrong(((getattr(skeleton, name) < 0) | (getattr(skeleton, name) >= limit)).any(axis=1))
        if at is not None:
            fail(f"{name} of arc {at} are {getattr(skeleton, name)[at].tolist()}, beyond {limit - 1}")
    if not (np.isfinite(skeleton.vertices).all() and np.isfinite(skeleton.radius).all()):
        fail("a node is not finite")
    at = first_wrong((skeleton.degree == 0) | (skeleton.radius < 0))
    if at is not None:
        fail(f"node {at} has no arcs, or a negative radius")
    inside = skeleton.polygon >= 0
    at = first_wrong((inside != (skeleton.side == INTERIOR)) | (skeleton.polygon >= len(skeleton.polygons)))
    if at is not None:
        fail(
            f"arc {at} is {'inside' if skeleton.side[at] == INTERIOR else 'outside'}, in polygon {skeleton.polygon[at]}"
        )


def check_branches(skeleton: Skeleton) -> None:
    """Raise unless branches are chains that end where they should."""
    step = np.diff(skeleton.branch, prepend=-1)
    at = first_wrong((step < 0) | (step > 1))
    if at is not None:
        fail(f"the branch of arc {at} is {skeleton.branch[at]}, after {skeleton.branch[at - 1]}")
    joined = np.flatnonzero(step == 0)
    before, after = skeleton.arcs[joined - 1, 1], skeleton.arcs[joined, 0]
    at = first_wrong((before != after) | (skeleton.degree[after] != 2))
    if at is not None:
        fail(f"arc {joined[at]} does not start where the previous arc of its branch ends")
    first = np.flatnonzero(step)
    last = np.append(first[1:], len(skeleton)) - 1
    ends = np.stack([skeleton.arcs[first, 0], skeleton.arcs[last, 1]])
    at = first_wrong((skeleton.degree[ends] == 2).any(axis=0) & (ends[0] != ends[1]))
    if at is not None:
        fail(f"branch {at} ends at a node where it could continue")
