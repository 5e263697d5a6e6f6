"""Why a digital triangulation differs from the exact one."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.delaunay.voronoi_edges import voronoi_lengths
from vorotool.numeric.curves.inverse_functions import hypotenuse
from vorotool.types.mesh.digital_triangulation import DigitalTriangulation
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.pixel_frame import Frame

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
