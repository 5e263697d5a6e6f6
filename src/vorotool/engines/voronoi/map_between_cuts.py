"""The Voronoi map between cuts, from what is given to its arcs and rings."""

from __future__ import annotations

from vorotool.convert.sites import Sites
from vorotool.engines.voronoi.cut_arguments import GivenCuts, frame_of
from vorotool.engines.voronoi.cut_map import CutMap, cut_map
from vorotool.engines.voronoi.joint_graph import joint_graph
from vorotool.engines.voronoi.local_diagrams import local_diagrams
from vorotool.engines.voronoi.regions import regions_of
from vorotool.errors import InputError
from vorotool.numeric.parallel import Progress
from vorotool.types.box import Extent


def map_between_cuts(
    given: Sites,
    cuts: GivenCuts,
    frame: Extent | None,
    limit: float | None,
    *,
    threads: int = 0,
    progress: Progress = None,
) -> CutMap:
    """Make the diagrams of all regions that a frame, a clip and enclosures leave, in one map."""
    frame = cuts.frame_for(given.polygons, frame, limit)
    joint = joint_graph(
        given.polygons, cuts.sides_near(frame), cuts.clip, cuts.enclosures, threads=threads, progress=progress
    )
    if cuts.clip is not None and not joint.clips:
        raise InputError("the clip has no area: give polygons that have one")
    regions = regions_of(joint, given.site, given.count)
    local = local_diagrams(
        joint.sites, given.site, given.count, regions, limit=limit, threads=threads, progress=progress
    )
    return cut_map(local, regions.edges, joint.graph, frame_of(regions.edges, frame, cuts.clip))
