"""A skeleton as a graph: nodes with places and radii, edges with lengths, radii and polylines."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError
from vorotool.numeric.checks import is_choice
from vorotool.numeric.curves.flatten import chained
from vorotool.numeric.numbers import distinct, shown_number
from vorotool.plain import plain
from vorotool.types.features import Lines, Rows, of_polygons
from vorotool.types.identity import names_of, part_table
from vorotool.types.skeleton.skeleton import KINDS, SIDES, Skeleton
from vorotool.types.skeleton.tables import branch_columns
from vorotool.types.table import Lookup, Table

BY = ("branch", "arc")


@plain(eq=False)
class SkeletonGraph:
    """Nodes and edges of a skeleton; several edges may join the same nodes, and one may join a node with itself."""

    skeleton: Skeleton
    nodes: NDArray[np.int64]  # (n,) int64 array: its vertices that are nodes, ascending
    source: NDArray[np.int64]  # (e,) int64 array: the vertices at the ends of each edge
    target: NDArray[np.int64]  # (e,) int64 array: the vertices at the ends of each edge
    polygon: NDArray[np.int32]  # (e,) int32 array: the polygon of each edge; -1 outside
    # `branch` or `arc`, `side`, `kind`, `length`, `r_min`, `r_max`, `r_mean`; of branches `type` and `tortuosity`, too
    columns: dict[str, Any]
    # (k, 2) float64 array: places along the edges, from source to target, the ends included
    points: NDArray[np.float64]
    start: NDArray[np.int64]  # (e + 1,) int64 array: where those of each edge begin

    @property
    def edges(self) -> Table:
        """The columns, with those that name polygons and those that are wanted of these."""
        polygons = self.skeleton.polygons
        return part_table({**names_of(polygons, self.polygon), **self.columns}, polygons, self.polygon)


def skeleton_graph(skeleton: Skeleton, *, by: str = "branch", flatten: float | None = None) -> SkeletonGraph:
    """Return the graph of a skeleton."""
    if not is_choice(by, BY):
        raise UsageError(f"by is {shown_number(by)}: use {' or '.join(BY)}")
    points, start = skeleton.as_given.flattened(flatten)
    first = np.flatnonzero(np.diff(skeleton.branch, prepend=-1))
    if by == "arc":
        first = np.arange(len(skeleton))
    last = np.append(first[1:], len(skeleton))[: len(first)] - 1
    source, target = skeleton.arcs[first, 0].astype(np.int64), skeleton.arcs[last, 1].astype(np.int64)
    return SkeletonGraph(
        skeleton,
        distinct(np.concatenate([source, target])),
        source,
        target,
        skeleton.polygon[first],
        _branches(skeleton, first) if by == "branch" else _arcs(skeleton),
        *chained(points, start, first),
    )


def skeleton_features(skeleton: Skeleton, what: str | None, flatten: float | None) -> Rows:
    """Return each branch as a line, or each arc."""
    graph = skeleton_graph(skeleton, by="branch" if what in (None, "skeleton", "diagram") else what, flatten=flatten)
    geometry = Lines(graph.points, graph.start)
    return of_polygons(graph.columns, skeleton.polygons, graph.polygon, geometry=geometry, is_part=True)


def _branches(skeleton: Skeleton, first: NDArray[np.int64]) -> dict[str, Any]:
    columns = branch_columns(skeleton, threads=1)
    del columns["chord"]
    return {"branch": columns.pop("branch"), "side": _sides(skeleton, first), **columns}


def _arcs(skeleton: Skeleton) -> dict[str, Any]:
    least, most, integral = skeleton.arc_radii
    radius = skeleton.radius[skeleton.arcs[:, 0]]
    mean = np.divide(integral, skeleton.length, out=radius, where=skeleton.length > 0)
    return {
        "arc": np.arange(len(skeleton)),
        "branch": skeleton.branch,
        "side": _sides(skeleton, np.arange(len(skeleton))),
        "kind": Lookup(list(KINDS), skeleton.is_parabola.astype(np.int32)),
        "length": skeleton.length,
        "r_min": least,
        "r_max": most,
        "r_mean": mean,
    }


def _sides(skeleton: Skeleton, arcs: NDArray[np.int64]) -> Lookup:
    side = skeleton.side[arcs]
    return Lookup([*SIDES, None], np.where(side < 0, len(SIDES), side).astype(np.int32))
