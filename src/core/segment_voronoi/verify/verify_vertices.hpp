// Whether a vertex of a segment Voronoi diagram is one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/segment_voronoi/build/incident_segments.hpp"
#include "core/segment_voronoi/discs/exact_disc.hpp"
#include "core/segment_voronoi/verify/verify_segment_voronoi.hpp"
#include "core/spatial/obb_tree.hpp"

namespace vorotool::core::segment_voronoi::verify {

// All sites as closed sets: the segments, and the points where none ends.
class ClosedSites {
 public:
  ClosedSites(const build::RingedDiagram& arrays, const build::IncidentSegments& incident, unsigned threads,
              const base::Monitor& monitor);

  // Calls visit(site number), see SiteHierarchy.
  template <class Visit>
  void near(double x, double y, double reach, const Visit& visit) const {
    tree_.near(x, y, reach, [&](std::uint32_t item) { return visit(numbers_[item]); });
  }

 private:
  std::vector<std::int32_t> numbers_;
  spatial::SiteHierarchy tree_;
};

// What is wrong with a vertex whose ring of sites has at least three, all distinct. Nothing if it is the
// centre of a disc that exactly the sites of the ring touch, in the order of the ring, and none enters, and
// its values are right to `value_error_bound`.
//
// Floating point with error bounds decides nearly everything; exact numbers decide the rest.
std::optional<std::string> find_vertex_fault(const build::RingedDiagram& arrays,
                                             const build::IncidentSegments& incident,
                                             const ClosedSites& index, std::size_t vertex);

// The disc of a vertex without faults.
discs::ExactDisc exact_disc_of(const build::RingedDiagram& arrays, const build::IncidentSegments& incident,
                               std::size_t vertex);

}  // namespace vorotool::core::segment_voronoi::verify
