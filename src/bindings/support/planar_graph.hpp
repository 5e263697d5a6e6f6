// A planar graph that comes from Python.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "bindings/support/arrays.hpp"
#include "core/kernel/planar_graph_view.hpp"

namespace vorotool::bindings {

inline void check_coordinates(std::span<const std::int32_t> values) {
  for (const std::int32_t value : values) {
    if (std::abs(std::int64_t{value}) > core::kernel::lattice_limit) {
      throw std::invalid_argument("coordinate " + std::to_string(value) + " is beyond the lattice");
    }
  }
}

// Its arrays are kept. Points are on the lattice and the ends of segments in range; faces are counted elsewhere.
class PlanarGraph {
 public:
  PlanarGraph(const IndexRows& points, const IndexRows& segments, const IndexRows& segment_faces)
      : kept_(keep(points, segments, segment_faces)),
        view_{rows<core::kernel::LatticePoint>(points), rows<core::base::IndexPair>(segments),
              rows<core::base::IndexPair>(segment_faces)} {
    if (view_.faces.size() != view_.segments.size())
      throw std::invalid_argument("each segment must have two faces");
    check_coordinates(bindings::view(points));
    core::base::check_range(view_.segments, 0, view_.points.size(), "an end of a segment is out of range");
  }

  const core::kernel::PlanarGraphView& view() const { return view_; }

 private:
  std::shared_ptr<const void> kept_;
  core::kernel::PlanarGraphView view_;
};

}  // namespace vorotool::bindings
