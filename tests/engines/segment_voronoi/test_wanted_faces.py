"""Diagrams of which one side is left out: what is made of the other one is the same."""

import warnings

import numpy as np
import pytest

import vorotool
from support.families.skeleton_shapes import FAMILIES, TOUCHING
from vorotool.engines.arrangement.planar_graph import planar_graph
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi, unwanted_sides


def contours(random):
    """Polygons with vertices inside straight edges, at which cells have no area."""
    image = np.kron(random.integers(0, 2, (6, 8)), np.ones((3, 3), dtype=int))
    return vorotool.outlines(image, outline="contour")


SHAPES = (*FAMILIES, *TOUCHING, contours)


def graphs(family):
    with warnings.catch_warnings(action="ignore"):
        for seed in range(12):
            graph = planar_graph(family(np.random.default_rng(seed)))
            is_joined = np.isin(np.arange(len(graph.points)), graph.segments).all()
            if graph.is_inside.any() and is_joined:
                yield graph


@pytest.mark.parametrize("family", SHAPES, ids=lambda family: family.__name__)
def test_what_is_left_is_of_the_whole_diagram_and_in_its_order(family):
    for graph in graphs(family):
        whole = segment_voronoi(graph.points, graph.segments)
        part = segment_voronoi(graph.points, graph.segments, unwanted=unwanted_sides(graph, graph.is_inside))
        known = {tuple(whole.sites_of(v).tolist()): v for v in range(len(whole))}
        at = [known[tuple(part.sites_of(v).tolist())] for v in range(len(part))]
        assert at == sorted(at)
        assert np.array_equal(whole.vertices[at], part.vertices)
        assert np.array_equal(whole.radius[at], part.radius)
        assert (whole.radius[np.setdiff1d(np.arange(len(whole)), at)] > 0).all()
        number = np.append(at, -1)
        edges = {tuple(row): k for k, row in enumerate(np.hstack([whole.edges, whole.edge_sites]).tolist())}
        own = np.hstack([number[part.edges], part.edge_sites]).tolist()
        places = [edges[tuple(row)] for row in own]
        assert places == sorted(places)
