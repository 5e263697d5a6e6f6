"""The largest discs beside shapely's, sampled axes, and the checker: `--cases 1000 --seed 1`."""

import numpy as np
import shapely

from fuzz.runner import of_families
from support.families.skeleton_shapes import FAMILIES, TOUCHING
from vorotool import Skeleton, VorotoolError, largest_empty_discs, points_along, skeleton_exact, verify_discs
from vorotool.engines.from_skeleton.largest_discs import discs_of_skeleton
from vorotool.types.polygons.shapely_geometry import to_shapely

SHAPES = (*FAMILIES, *TOUCHING)
COUNT = 6
STEPS = 500


def sampled(skeleton: Skeleton, step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places along the axis, its nodes among them, their radii and features."""
    along = points_along(skeleton, every=step)
    feature = skeleton.polygons.feature
    of_node = np.zeros(len(skeleton.vertices), dtype=int)
    of_node[skeleton.arcs.ravel()] = np.repeat(feature[skeleton.polygon], 2)
    return (
        np.concatenate([along.xy, skeleton.vertices]),
        np.concatenate([along.radius, skeleton.radius]),
        np.concatenate([feature[along.polygon], of_node]),
    )


def check_greedy(skeleton: Skeleton, count: int = COUNT) -> None:
    """Each disc is at least as large as all at sampled places that are disjoint from those before it."""
    discs = discs_of_skeleton(skeleton, count=count, threads=1)
    verify_discs(discs)
    if not len(skeleton):
        return
    extent = float(np.ptp(skeleton.polygons.xy, axis=0).max())
    step = extent / STEPS
    xy, radius, feature = sampled(skeleton, step)
    for own in np.unique(feature):
        places, sizes = xy[feature == own], radius[feature == own]
        found = np.flatnonzero(skeleton.polygons.feature[discs.polygon] == own)
        for rank in range(count):
            free = np.ones(len(places), dtype=bool)
            for before in found[:rank]:
                away = np.hypot(*(places - discs.xy[before]).T)
                free &= away >= sizes + discs.radius[before]
            most = sizes[free].max(initial=0)
            got = discs.radius[found[rank]] if rank < len(found) else 0.0
            assert most <= got + 1e-9 * extent, f"rank {rank + 1} of feature {own}: {got}, but {most} fits"
            # the radius changes by no more than the way between samples, or none of the axis is left but its ends
            assert got <= most + step or most == 0, f"rank {rank + 1} of feature {own}: {got}, but only {most} fits"


def check_with_shapely(skeleton: Skeleton) -> None:
    """The largest disc of features that are single valid polygons."""
    polygons = skeleton.polygons
    if len(polygons) != 1 or not len(skeleton) or polygons.is_line.any():
        return
    (shape,) = to_shapely(polygons)
    if not shape.is_valid:
        return
    tolerance = 1e-3 * float(np.ptp(polygons.xy, axis=0).max())
    theirs = shapely.maximum_inscribed_circle(shape, tolerance=tolerance).length
    ours = float(discs_of_skeleton(skeleton, threads=1).radius[0])
    assert ours * (1 + 1e-9) >= theirs, f"shapely has {theirs}, larger than {ours}"
    assert ours <= theirs + 2 * tolerance, f"shapely has {theirs}, much smaller than {ours}"


def check_local(skeleton: Skeleton) -> None:
    """All that cannot grow; the largest is one of them."""
    local = discs_of_skeleton(skeleton, local=True, threads=1)
    verify_discs(local)
    largest = discs_of_skeleton(skeleton, threads=1)
    np.testing.assert_allclose(local.radius[local.rank == 1], largest.radius, rtol=2**-47, err_msg="the largest")


def check_empty(skeleton: Skeleton, random: np.random.Generator) -> None:
    """Between shapes, in the default frame, another one or a triangle."""
    xy = skeleton.polygons.xy
    low, sides = xy.min(axis=0), np.maximum(np.ptp(xy, axis=0), 1)
    corner = low + sides * random.uniform(-0.2, 0.3, 2)
    box = (*corner.tolist(), *(sides * random.uniform(0.3, 1.2, 2)).tolist())
    triangle = (low + sides * random.uniform(-0.2, 1.2, (3, 2))).tolist()
    within = (None, box, [triangle])[int(random.integers(3))]
    verify_discs(largest_empty_discs(skeleton.polygons, within=within, count=int(random.choice([1, 4])), threads=1))


def failure(shape: object, random: np.random.Generator) -> str | None:
    """What is wrong with the discs of a shape, if anything."""
    try:
        skeleton = skeleton_exact(shape, threads=1)
        check_greedy(skeleton)
        check_local(skeleton)
        check_with_shapely(skeleton)
        if len(skeleton.polygons.xy):
            check_empty(skeleton, random)
    except (VorotoolError, AssertionError, shapely.GEOSException) as error:
        return f"{type(error).__name__}: {error}"
    return None


COMPARISON = of_families(1000, SHAPES, failure)
