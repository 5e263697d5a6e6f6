"""The rings that readers of polygons and lines collect."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import accumulate
from typing import Any

import numpy as np

from vorotool.errors import InputError
from vorotool.formats.parsing.reader_options import ReadOptions, position_array, shortened
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet, set_of_rings


@dataclass
class RingCollector:
    """Rings of JSON positions, as they were parsed: anything may stand where a position is due."""

    options: ReadOptions
    name: str
    feature_place: Callable[[int], str]  # gives the words for the place of a feature (0-based)
    flat_only: bool = False  # positions must not have more than two numbers
    takes_points: bool = False  # points are wanted, too, as lines of one vertex
    positions: list[Any] = field(default_factory=list)
    sizes: list[int] = field(default_factory=list)
    kinds: list[int] = field(default_factory=list)
    polygons: list[int] = field(default_factory=list)
    features: list[int] = field(default_factory=list)  # of each polygon

    def add_polygon(self, feature: int, rings: Any) -> None:
        """Take a list of a shell and holes; empty ones are left out."""
        self._check_list(rings, feature, "the polygon", "[[[x, y], …], …]")
        if rings and self._add_ring(feature, rings[0], SHELL):
            for hole in rings[1:]:
                self._add_ring(feature, hole, HOLE)
            self.features.append(feature)

    def add_line(self, feature: int, line: Any) -> None:
        """Take the positions of an open line; an empty one is left out."""
        if self._add_ring(feature, line, LINE):
            self.features.append(feature)

    def add_point(self, feature: int, position: Any) -> None:
        """Take the position of a point; an empty one is left out."""
        self.add_line(feature, [position] if position else position)

    def finish(self, **described: Any) -> PolygonSet:
        """Make the polygons, once all are collected."""
        self.options.check_vertices(self.name, len(self.positions))
        longest = max((len(p) for p in self.positions if type(p) is list), default=2)
        if longest > 2 and self.flat_only:
            at = next(i for i, p in enumerate(self.positions) if type(p) is list and len(p) > 2)
            position = self.positions[at]
            raise InputError(f"{self._place(at)}: {shortened(position)} has {len(position)} numbers; write [x, y]")
        xy = position_array(self.positions, self._place)
        if longest > 2:
            self.options.note_heights(self.name)
        return set_of_rings(xy, self.sizes, self.kinds, self.polygons, **{"feature": self.features, **described})

    def _add_ring(self, feature: int, ring: Any, kind: int) -> bool:
        what = ("the shell", "a hole", "the line")[kind]
        self._check_list(ring, feature, what, "[[x, y], …]")
        if ring:
            self.positions.extend(ring)
            self.sizes.append(len(ring))
            self.kinds.append(kind)
            self.polygons.append(len(self.features))
        return bool(ring)

    def _check_list(self, value: Any, feature: int, what: str, form: str) -> None:
        if not isinstance(value, list):
            raise InputError(f"{self.feature_place(feature)}: {what} is {shortened(value)}; write {form}")

    def _place(self, position: int) -> str:
        ends = list(accumulate(self.sizes))
        ring = int(np.searchsorted(ends, position, side="right"))
        polygon = self.polygons[ring]
        feature = self.features[polygon]
        words = [self.feature_place(feature)]
        if self.features.count(feature) > 1:
            words.append(f"part {polygon - self.features.index(feature) + 1}")
        if self.kinds[ring] == HOLE:
            words.append(f"hole {ring - self.polygons.index(polygon)}")
        return ", ".join([*words, f"vertex {position - (ends[ring] - self.sizes[ring]) + 1}"])
