"""Skeletons with some of their arcs, or with some of their polygons."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.polygons.shapely_geometry import RingArrays
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton

PER_ARC = ("arcs", "control", "sites", "polygon", "side", "branch", "length", "error_bound")


def with_arcs(skeleton: Skeleton, kept: NDArray[np.bool_]) -> Skeleton:
    """Leave out arcs, and the nodes where then none ends; branches, which are left or left out, keep their order."""
    if kept.all():
        return skeleton
    columns: dict[str, Any] = {name: getattr(skeleton, name)[kept] for name in PER_ARC}
    nodes, ends = np.unique(columns["arcs"], return_inverse=True)
    _, branch = np.unique(columns["branch"], return_inverse=True)
    columns |= {"arcs": ends.reshape(-1, 2).astype(np.int32), "branch": branch.astype(np.int32)}
    return replace(skeleton, **columns, vertices=skeleton.vertices[nodes], radius=skeleton.radius[nodes])


def with_polygons(skeleton: Skeleton, chosen: NDArray[np.int64]) -> Skeleton:
    """Give what is inside some polygons, with the sites of these polygons."""
    polygons = skeleton.polygons
    if len(chosen) == len(polygons) and skeleton.site_table.ends is None:
        return with_arcs(skeleton, skeleton.polygon >= 0)
    number = np.full(len(polygons) + 1, -1, dtype=np.int32)  # the last one is for -1
    number[chosen] = np.arange(len(chosen))
    made = with_arcs(skeleton, number[skeleton.polygon] >= 0)
    table = skeleton.site_table
    is_inside = number[table.polygon] >= 0
    if table.ends is not None:
        is_inside &= np.isnan(table.ends[:, 0, 0])
    sites = np.flatnonzero(is_inside)
    place = np.full(len(table), -1, dtype=np.int32)
    place[sites] = np.arange(len(sites))
    own = table.taken(sites)
    return replace(
        made,
        sites=place[made.sites],
        polygon=number[made.polygon],
        site_table=replace(own, polygon=number[own.polygon]),
        polygons=_chosen(polygons, chosen),
    )


def outside_of(skeleton: Skeleton) -> Skeleton:
    """Give what is outside of all polygons, with the sites that this is made of."""
    made, table = with_arcs(skeleton, skeleton.polygon < 0), skeleton.site_table
    if table.ends is None:
        return made
    sites = np.flatnonzero(~np.isnan(table.ends[:, 0, 0]))
    place = np.full(len(table), -1, dtype=np.int32)
    place[sites] = np.arange(len(sites))
    return replace(made, sites=place[made.sites], site_table=table.taken(sites))


def _chosen(polygons: PolygonSet, chosen: NDArray[np.int64]) -> PolygonSet:
    return RingArrays.of(polygons).taken(chosen)[0].polygons(polygons, chosen)


def with_straight_arcs(
    skeleton: Skeleton,
    places: NDArray[np.float64],
    radius: NDArray[np.float64],
    ends: NDArray[np.integer],
    sites: NDArray[np.integer],
    like: NDArray[np.integer],
) -> Skeleton:
    """Add nodes, and inside polygons straight arcs behind all others: a branch each, like another arc elsewise."""
    count = len(ends)
    vertices = np.concatenate([skeleton.vertices, places])
    way = vertices[ends[:, 1]] - vertices[ends[:, 0]]
    return replace(
        skeleton,
        vertices=vertices,
        radius=np.concatenate([skeleton.radius, radius]),
        arcs=np.concatenate([skeleton.arcs, ends]),
        control=np.concatenate([skeleton.control, np.full((count, 2), np.nan)]),
        sites=np.concatenate([skeleton.sites, sites]),
        polygon=np.concatenate([skeleton.polygon, skeleton.polygon[like]]),
        side=np.concatenate([skeleton.side, np.full(count, INTERIOR, dtype=np.int8)]),
        branch=np.concatenate([skeleton.branch, skeleton.branch.max(initial=-1) + 1 + np.arange(count)]),
        length=np.concatenate([skeleton.length, np.sqrt((way * way).sum(axis=1))]),
        error_bound=np.concatenate([skeleton.error_bound, skeleton.error_bound[like]]),
    )
