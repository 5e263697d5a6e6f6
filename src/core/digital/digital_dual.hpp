// The dual of a digital tessellation with connected regions: a triangle a corner, and the labels around the
// frame.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/delaunay/vertex_links.hpp"

namespace vorotool::core::digital {

struct DigitalDual {
  std::vector<std::array<delaunay::Vertex, 3>> triangles;  // counter-clockwise around their corners
  std::vector<delaunay::Vertex> ring;  // along the frame, counter-clockwise, each unlike the next
  std::uint64_t three_label_corners = 0;
  std::uint64_t four_label_corners = 0;
};

// Reads the dual off an image of labels 1, 2, ...: vertex[label - 1] is at vertices[vertex]. Where four
// labels meet there are two triangles; their diagonal is the Delaunay one.
DigitalDual find_dual(std::span<const std::uint32_t> image, std::size_t width,
                      std::span<const delaunay::Vertex> vertex,
                      std::span<const delaunay::RingVertex> vertices, const base::Monitor& monitor);

// Takes out the sites that have two neighbors only: their two triangles are the same, once each way round.
// Others may have two neighbors only after that. Returns how many were taken out.
std::uint64_t remove_twins(DigitalDual& dual, std::size_t vertices);

}  // namespace vorotool::core::digital
