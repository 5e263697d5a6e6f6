// A triangulation made of rings, as half-edges.
#pragma once

#include <span>

#include "core/half_edges.hpp"
#include "core/rings.hpp"

namespace vorotool::core {

// Edges are numbered by their earlier vertex, then by their place in its ring: all numbers exist. The
// half-edge from a vertex on the hull to the front of its ring goes counter-clockwise along the hull.
HalfEdges half_edges_of(std::span<const RingVertex> vertices);

// The half-edge from a vertex to the front of its ring; none if it has no neighbours.
HalfEdge front_edge(std::span<const RingVertex> vertices, const HalfEdges& edges, Vertex v);

}  // namespace vorotool::core
