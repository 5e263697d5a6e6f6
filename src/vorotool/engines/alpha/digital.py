"""Edges and the triangles beside them, for alpha shapes of a digital triangulation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.types.mesh.digital_triangulation import DigitalTriangulation
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.points.point_set import known_of_points


def linked_digital(found: DigitalTriangulation) -> tuple[Triangulation, NDArray[np.int32], NDArray[np.int32]]:
    """Link edges of a digital triangulation, those of its triangles too, with the triangles on their two sides."""
    points = found.points
    turn = _core.kernel.orient2d(np.ascontiguousarray(points[found.triangles]))
    triangles = np.ascontiguousarray(found.triangles[turn > 0])
    edges = np.unique(np.concatenate([np.sort(found.edges, axis=1), found.sides]), axis=0).astype(np.int32)
    count = len(points)
    keys = edges[:, 0].astype(np.int64) * count + edges[:, 1]
    sides = np.full((len(edges), 2), -1, dtype=np.int32)
    for k in range(3):
        a, b = triangles[:, (k + 1) % 3].astype(np.int64), triangles[:, (k + 2) % 3].astype(np.int64)
        edge = np.searchsorted(keys, np.minimum(a, b) * count + np.maximum(a, b))
        left = np.where(a < b, 0, 1)
        for t, (e, side) in enumerate(zip(edge.tolist(), left.tolist(), strict=True)):
            held = int(sides[e, side])
            if held < 0 or _is_nearer(points, triangles, held, int(triangles[t, k])):
                sides[e, side] = t
    mesh = Triangulation(
        points,
        triangles,
        np.full(triangles.shape, -1, dtype=np.int32),
        edges,
        np.empty(0, np.int32),
        np.arange(count, dtype=np.int32),
        **known_of_points(found),
    )
    return mesh, edges, sides


def _is_nearer(points: NDArray[np.float64], triangles: NDArray[np.int32], held: int, corner: int) -> bool:
    """Whether a corner is strictly inside the circle of the triangle that an edge has so far."""
    four = np.ascontiguousarray(points[[*triangles[held], corner]][None])
    return bool(_core.kernel.incircle(four)[0] > 0)
