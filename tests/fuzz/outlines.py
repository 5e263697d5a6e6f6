"""Outlines of random label images, all kinds, and their skeletons through the checker: `--cases 20000 --seed 1`."""

import warnings

import numpy as np

from fuzz.runner import of_families
from support.oracles.outline_oracle import numbered_objects, pixel_sides, random_labels, ring_areas, unit_sides
from vorotool import VorotoolError, VorotoolWarning, outlines, planar_graph, skeleton_exact, verify_skeleton


def failure(labels: np.ndarray, random: np.random.Generator) -> str | None:
    """What is wrong with the outlines or the skeleton of an image, if anything."""
    connectivity = int(random.choice([4, 8]))
    kind = str(random.choice(["crack", "contour"]))
    simplify = [None, 0.5, 0.8, 1.5, 4.0, 12.0][int(random.integers(6))]
    if not labels.any():
        return None
    try:
        warnings.simplefilter("error", VorotoolWarning)
        given = outlines(labels, mode="labels", connectivity=connectivity, outline=kind)
        if kind == "crack":
            objects, values = numbered_objects(labels, connectivity)
            assert given.ids == values
            assert np.array_equal(unit_sides(given), pixel_sides(objects))
            assert np.array_equal(ring_areas(given)[1], np.bincount(objects.ravel())[1:])
        made = outlines(labels, mode="labels", connectivity=connectivity, outline=kind, simplify=simplify)
        assert faces_of(planar_graph(made, strict=True)) == faces_of(planar_graph(given, strict=True))
        verify_skeleton(skeleton_exact(made, side=str(random.choice(["interior", "exterior", "both"]))))
    except (VorotoolError, VorotoolWarning, AssertionError) as error:
        return f"{kind}, {connectivity}, simplify {simplify}: {type(error).__name__} {error}"
    return None


def faces_of(graph: object) -> list[tuple[int, ...]]:
    """The polygons of each face."""
    return sorted(tuple(graph.polygons_of(face).tolist()) for face in range(graph.faces))


COMPARISON = of_families(20_000, [random_labels], failure)
