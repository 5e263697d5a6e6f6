// A segment Voronoi diagram that comes from Python.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>

#include "bindings/support/arrays.hpp"
#include "core/segment_voronoi/build/diagram.hpp"

namespace vorotool::bindings {

// Its arrays are kept, and go together in length.
class SegmentDiagram {
 public:
  using View = core::segment_voronoi::build::DiagramView;
  using IndexPair = core::base::IndexPair;

  SegmentDiagram(const IndexRows& points, const IndexRows& segments, const Places& vertices,
                 const Vector<const double>& radius, const Indices& vertex_start, const Indices& vertex_sites,
                 const IndexRows& edges, const IndexRows& edge_sites,
                 const std::optional<IndexRows>& segment_faces)
      : kept_(keep(points, segments, vertices, radius, vertex_start, vertex_sites, edges, edge_sites,
                   segment_faces)),
        view_{{rows<core::kernel::LatticePoint>(points), rows<IndexPair>(segments), {}},
              rows<core::kernel::Point>(vertices),
              bindings::view(radius),
              rows<IndexPair>(edges),
              rows<IndexPair>(edge_sites),
              bindings::view(vertex_start),
              bindings::view(vertex_sites)} {
    if (segment_faces) view_.faces = rows<IndexPair>(*segment_faces);
    if (view_.vertices.size() != view_.radius.size() || view_.edge_sites.size() != view_.edges.size() ||
        view_.vertex_start.size() != view_.radius.size() + 1 ||
        (segment_faces && view_.faces.size() != view_.segments.size())) {
      throw std::invalid_argument("the arrays of a diagram have lengths that do not go together");
    }
  }

  // For a checker, which trusts no index.
  const View& unchecked() const { return view_; }

  // All indices are in range, but those of faces, which are counted elsewhere.
  const View& view() const {
    if (!is_checked_) check();
    is_checked_ = true;
    return view_;
  }

  // The same, where faces are looked at.
  const View& view_with_faces() const {
    if (view_.faces.size() != view_.segments.size())
      throw std::invalid_argument("each segment must have two faces");
    return view();
  }

 private:
  void check() const {
    static constexpr const char* outside = "an index of the diagram is out of range";
    core::base::check_range(view_.segments, 0, view_.points.size(), outside);
    core::base::check_range(view_.edges, -1, view_.radius.size(), outside);
    core::base::check_range(view_.edge_sites, 0, view_.site_count(), outside);
    core::base::check_range(view_.vertex_sites, 0, view_.site_count(), outside);
    core::base::check_range(view_.vertex_start, 0, view_.vertex_sites.size() + 1, outside);
    if (!std::ranges::is_sorted(view_.vertex_start)) throw std::invalid_argument(outside);
  }

  std::shared_ptr<const void> kept_;
  View view_;
  mutable bool is_checked_ = false;
};

}  // namespace vorotool::bindings
