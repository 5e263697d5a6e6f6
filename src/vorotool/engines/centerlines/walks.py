"""Walks from the leaves of a skeleton back along its branches: the direction in which a branch ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.types.skeleton.skeleton import Skeleton

Floats = NDArray[np.float64]
Numbers = NDArray[np.intp]
Booleans = NDArray[np.bool_]

BACK = (0.0625, 0.125, 0.1875, 1.0)
"""In radii of the leaf: how far back directions are taken from. Nearer there are the corners of ends that are round."""


class Walks:
    """Walks from leaves to the first node that is no end of two arcs, or one radius far."""

    def __init__(self, skeleton: Skeleton, leaves: Numbers) -> None:
        self.skeleton, self.leaves = skeleton, leaves
        ends = skeleton.arcs.astype(np.intp)
        joined = np.zeros(len(skeleton.vertices), dtype=np.intp)  # the sum of the numbers of the arcs at each node
        np.add.at(joined, ends.reshape(-1), np.repeat(np.arange(len(ends)), 2))
        self.arcs = joined[leaves]
        self.at_target = ends[self.arcs, 1] == leaves
        at = self._places(ends, joined, np.outer(skeleton.radius[leaves], BACK).tolist())
        measures = skeleton.measures(at[:, 0].astype(np.intp))
        distance = np.minimum(at[:, 2], measures.length)
        parameter = measures.parameter(np.where(at[:, 1] > 0, distance, measures.length - distance))
        self.back = measures.place(parameter).reshape(len(leaves), len(BACK), 2).swapaxes(0, 1)

    def _places(self, ends: Numbers, joined: Numbers, wanted: list[list[float]]) -> Floats:
        """(4 k, 3) the arcs that places are on, whether these are gone through from their sources, and how far."""
        both, source = ends.sum(axis=1).tolist(), ends[:, 0].tolist()
        lengths, degree, others = self.skeleton.length.tolist(), self.skeleton.degree.tolist(), joined.tolist()
        found: list[tuple[int, bool, float]] = []
        for leaf, first, reaches in zip(self.leaves.tolist(), self.arcs.tolist(), wanted, strict=True):
            node, arc, far = leaf, first, 0.0
            for reach in reaches:
                while far + lengths[arc] < reach and degree[both[arc] - node] == 2:
                    far += lengths[arc]
                    node = both[arc] - node
                    arc = others[node] - arc
                found.append((arc, source[arc] == node, reach - far))
        return np.array(found, dtype=np.float64).reshape(-1, 3)

    def directions(self, *, is_smooth: bool) -> Floats:
        """(k, 2) where branches look at leaves, of any length."""
        straight = self.skeleton.vertices[self.leaves] - self.back[-1]
        if not is_smooth:
            return np.asarray(straight)
        ways = -np.diff(self.back, axis=0)
        size = np.sqrt((ways * ways).sum(axis=2))
        is_long = (size > 0).all(axis=0)
        last, before, far = ways / np.where(is_long, size, 1)[:, :, None]
        # at 0.09375, 0.15625 and 0.59375 radii: the smaller bend of both, none if they differ in sign
        bends = _cross(before, last) / 0.0625, _cross(far, last) / 0.5
        bend = np.where(bends[0] * bends[1] > 0, np.minimum(*np.abs(bends)) * np.sign(bends[0]), 0.0)
        turned = last + 0.09375 * bend[:, None] * np.stack([-last[:, 1], last[:, 0]], axis=1)
        directions: Floats = np.where(is_long[:, None], turned, straight)
        return directions


def _cross(u: Floats, v: Floats) -> Floats:
    crossed: Floats = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return crossed
