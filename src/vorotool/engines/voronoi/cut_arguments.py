"""Clips and enclosures as they are given, and the bounds of what they share out."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from vorotool.convert.polygons import as_polygons
from vorotool.engines.voronoi.regions import CutEdges
from vorotool.errors import InputError
from vorotool.numeric.crs import crs_name, same_crs
from vorotool.plain import plain
from vorotool.types.box import Extent, Sides, bounds, default_frame, extent_sides
from vorotool.types.polygons.polygon_set import LINE, PolygonSet, set_of_rings

FARTHEST = 8.0
"""Margin of the frame at most, in extents of what is in it: the frame is on the lattice, whose step grows with it."""


@plain(eq=False)
class GivenCuts:
    """What cells are cut by, beside a frame."""

    clip: PolygonSet | None  # each in the coordinate reference system of the sites
    enclosures: PolygonSet | None  # each in the coordinate reference system of the sites

    @property
    def are_there(self) -> bool:
        """Whether there is one of them."""
        return self.clip is not None or self.enclosures is not None

    def frame_for(self, sites: PolygonSet, frame: Extent | None, limit: float | None) -> Extent | None:
        """Return the frame that was given, else that of an image; without a clip that around sites and enclosures."""
        if frame is None and sites.frame is not None:
            return sites.frame.extent
        if frame is not None or self.clip is not None:
            return frame
        if self.enclosures is None or not len(self.enclosures.xy):
            return default_frame(sites, limit)
        xy = np.concatenate([sites.xy, self.enclosures.xy])
        if limit is not None:
            low, high = bounds(xy)
            limit = min(limit, FARTHEST * float((high - low).max()))
        return default_frame(set_of_rings(xy, [len(xy)], [LINE], [0]), limit)

    def sides_near(self, frame: Extent | None) -> Sides | None:
        """Draw far sides of a frame near the clip, or leave out all: the step of the lattice grows with them."""
        if frame is None or self.clip is None or not len(self.clip.xy):
            return None if frame is None else extent_sides(frame)
        sides = np.array(extent_sides(frame)).reshape(2, 2)
        low, high = bounds(self.clip.xy)
        if (sides[0] <= low).all() and (high <= sides[1]).all():
            return None
        if (sides[0] < high).all() and (low < sides[1]).all():
            margin = (high - low).max()
            sides = np.array([np.maximum(sides[0], low - margin), np.minimum(sides[1], high + margin)])
        left, bottom, right, top = sides.ravel().tolist()
        return left, bottom, right, top


def given_cuts(clip: Any, enclosures: Any, crs: Any) -> GivenCuts:
    """Take polygons to clip by, and lines and polygons that enclose."""
    made = []
    for name, source in (("clip", clip), ("enclosures", enclosures)):
        given = None if source is None else as_polygons(source, name)
        if given is not None:
            given = _in_crs(given, crs, name)
        made.append(given)
    if made[0] is not None and made[0].is_line.all():
        raise InputError("the clip has no polygon: give polygons that have an area")
    return GivenCuts(*made)


def _in_crs(given: PolygonSet, crs: Any, name: str) -> PolygonSet:
    """The same in a system; what names none is taken to be in it."""
    if crs is None or given.crs is None:
        return given if crs is None or given.crs is crs else replace(given, crs=crs)
    if not same_crs(given.crs, crs):
        raise InputError(
            f"the {name} and the sites are in different coordinate reference systems, {crs_name(given.crs)} and "
            f"{crs_name(crs)}: reproject one of them"
        )
    return given


def frame_of(edges: CutEdges, frame: Extent | None, clip: PolygonSet | None) -> Extent:
    """Give the bounds of what is shared out; of nothing those of what was given."""
    places = edges.given
    if not len(places):
        if frame is not None:
            return frame
        assert clip is not None
        places = clip.xy
    low, high = bounds(places)
    x, y = low.tolist()
    w, h = (high - low).tolist()
    return (x, y, w, h)
