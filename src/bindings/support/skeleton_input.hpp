// A skeleton that comes from Python.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>

#include "bindings/support/arrays.hpp"
#include "core/base/indices.hpp"
#include "core/skeleton/skeleton_view.hpp"

namespace vorotool::bindings {

// Its arrays are kept, and its indices in range.
class SkeletonInput {
 public:
  using View = core::skeleton::SkeletonView;
  using IndexPair = core::base::IndexPair;

  // Ends of sites, four numbers each.
  SkeletonInput(const Places& vertices, const Vector<const double>& radius, const IndexRows& arcs,
                const Places& control, const IndexRows& sites, const Vector<const double>& length,
                const std::optional<Places>& site_ends, const Vector<const std::uint8_t>& is_anchored,
                bool has_gap, double reach)
      : kept_(keep(vertices, radius, arcs, control, sites, length, site_ends, is_anchored)),
        has_sites_(site_ends),
        view_{rows<core::kernel::Point>(vertices),
              bindings::view(radius),
              rows<IndexPair>(arcs),
              rows<core::kernel::Point>(control),
              rows<IndexPair>(sites),
              bindings::view(length),
              {},
              bindings::view(is_anchored),
              has_gap,
              reach} {
    const std::size_t nodes = view_.vertices.size(), count = view_.arcs.size();
    if (view_.radius.size() != nodes || view_.is_anchored.size() != nodes || view_.control.size() != count ||
        view_.sites.size() != count || view_.length.size() != count) {
      throw std::invalid_argument("the arrays of a skeleton have lengths that do not go together");
    }
    core::base::check_range(view_.arcs, 0, nodes, outside);
    if (!site_ends) return;
    view_.site_ends = rows<std::array<core::kernel::Point, 2>>(*site_ends);
    core::base::check_range(view_.sites, 0, view_.site_ends.size(), outside);
  }

  const View& view(bool needs_sites = true) const {
    if (needs_sites && !has_sites_) throw std::invalid_argument("the ends of sites are needed");
    return view_;
  }

  static constexpr const char* outside = "an index of the skeleton is out of range";

 private:
  std::shared_ptr<const void> kept_;
  bool has_sites_;
  View view_;
};

}  // namespace vorotool::bindings
