// The sites of a segment Voronoi diagram as closed sets, and which of them are near a place.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/segment_voronoi/build/diagram.hpp"
#include "core/segment_voronoi/build/incident_segments.hpp"
#include "core/spatial/obb_tree.hpp"

namespace vorotool::core::segment_voronoi::verify {

// All sites as closed sets: the segments, and the points where none ends.
class ClosedSites {
 public:
  ClosedSites(const build::DiagramView& arrays, const build::IncidentSegments& incident, unsigned threads,
              const base::Monitor& monitor);

  // Calls visit(site number), see ObbTree.
  template <class Visit>
  void near(double x, double y, double reach, const Visit& visit) const {
    tree_.near(x, y, reach, [&](std::uint32_t item) { return visit(numbers_[item]); });
  }

 private:
  std::vector<std::int32_t> numbers_;
  spatial::ObbTree tree_;
};

}  // namespace vorotool::core::segment_voronoi::verify
