"""The comparison with Boost finds what differs."""

from dataclasses import replace

import numpy as np

from support.families.segment_families import coarse, draw
from support.oracles.boost_oracle import boost_edges, differences
from vorotool.engines.segment_voronoi.segment_voronoi import segment_voronoi

GRAPH = coarse(*draw("two_boxes", 20, 11), 1000)
OURS, BOOST = segment_voronoi(*GRAPH), boost_edges(*GRAPH)


def test_the_same_is_the_same():
    assert not differences(OURS, BOOST)
    assert (BOOST.ends < 0).any()
    assert (~BOOST.is_primary).any()
    assert len(np.setdiff1d(np.arange(len(GRAPH[0])), GRAPH[1])), "no lone points"


def test_each_vertex_that_is_elsewhere_is_found():
    for vertex in range(len(OURS)):
        moved = OURS.vertices.copy()
        moved[vertex] += 1e-4
        assert any(f"vertex ({vertex}," in fault for fault in differences(replace(OURS, vertices=moved), BOOST))


def test_each_edge_that_is_missing_or_has_another_site_is_found():
    for edge in range(len(OURS.edges)):
        less = replace(
            OURS, edges=np.delete(OURS.edges, edge, axis=0), edge_sites=np.delete(OURS.edge_sites, edge, axis=0)
        )
        assert differences(less, BOOST)
        sites = OURS.edge_sites.copy()
        sites[edge, 0] = (sites[edge, 0] + 1) % (len(GRAPH[0]) + len(GRAPH[1]))
        assert differences(replace(OURS, edge_sites=sites), BOOST)


def test_a_vertex_that_is_none_is_found():
    nowhere = np.append(BOOST.vertices, [[np.nan, 0]], axis=0)
    assert differences(OURS, replace(BOOST, vertices=nowhere)) == ["Boost has a vertex at [nan, 0.0]"]
