"""Offsets beside the buffers of shapely, and shapes rebuilt from skeletons: `--cases 1000 --seed 1`."""

import numpy as np
import shapely

from fuzz.runner import of_families
from support.families.skeleton_shapes import FAMILIES, TOUCHING
from support.oracles.offset_oracle import check_offsets, check_rebuilt
from vorotool import VorotoolError, offset, rebuild, skeleton_exact, verify_offsets
from vorotool.engines.skeleton.exact import ShapeDiagram, shape_diagram

SHAPES = (*FAMILIES, *TOUCHING)
DISTANCES = 5


def distances_of(shapes: ShapeDiagram, random: np.random.Generator) -> list[float]:
    """Of any size, at and beside the radius of a vertex of the diagram, and in whole steps: where there are ties."""
    places = shapes.graph.coordinates()  # of a shape without polygons as well
    extent = float(np.ptp(places, axis=0).max()) if len(places) else 0.0
    extent = extent or 1.0
    radii = shapes.graph.scale * shapes.diagram.radius
    known = radii[(radii > extent * 1e-6) & (radii < extent)]
    tie = float(random.choice(known)) if len(known) else extent / 4
    step = 0.5 if extent / 1000 < 0.5 < extent and tie != 0.5 else extent / 8
    sizes = [*(extent * 10 ** random.uniform(-3, -0.5, 2)), tie, tie * (1 + 10.0 ** -random.integers(3, 12)), step]
    signs = [1, -1, *random.choice([-1, 1], 3)]
    return list(dict.fromkeys(float(sign * size) for sign, size in zip(signs, sizes, strict=True)))


def failure(shape: object, random: np.random.Generator, some: slice = slice(None)) -> str | None:
    """What is wrong with some or all offsets of a shape, or with what is rebuilt from its skeleton, if anything."""
    shapes = shape_diagram(shape, threads=1)
    distances = distances_of(shapes, random)[some]
    try:
        made = offset(shapes, distances, threads=1)
        verify_offsets(made, distances=distances, threads=1)
        check_offsets(made, distances)
        verify_offsets(offset(shape, distances, threads=1), distances=distances, threads=1)
        skeleton = skeleton_exact(shape, threads=1)
        check_rebuilt(rebuild(skeleton), skeleton.polygons)
    except (VorotoolError, AssertionError, shapely.GEOSException) as error:
        return f"{type(error).__name__} at {distances}: {error}"
    return None


COMPARISON = of_families(1000, SHAPES, failure)
