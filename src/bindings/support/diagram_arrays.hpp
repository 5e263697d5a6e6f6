// The arrays of a segment Voronoi diagram as they come in from Python.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "bindings/support/arrays.hpp"
#include "core/segment_voronoi/build/diagram.hpp"
#include "core/skeleton/bisector_arc.hpp"

namespace vorotool::bindings {

using core::kernel::LatticePoint;
using core::kernel::Point;
using Pair = std::array<std::int32_t, 2>;
using IndexRows = Matrix<const std::int32_t>;
using Places = Matrix<const double>;

static_assert(sizeof(LatticePoint) == 2 * sizeof(std::int32_t) && sizeof(Point) == 2 * sizeof(double));

// The arrays of a diagram, kept while the core works on views of them.
struct DiagramArrays {
  IndexRows points, segments;
  Places vertices;
  Vector<const double> radius;
  IndexRows edges, edge_sites;

  core::segment_voronoi::build::DiagramView diagram() const {
    const core::segment_voronoi::build::DiagramView d{{rows<LatticePoint>(points), rows<Pair>(segments), {}},
                                                      rows<Point>(vertices),
                                                      view(radius),
                                                      rows<Pair>(edges),
                                                      rows<Pair>(edge_sites),
                                                      {},
                                                      {}};
    check(d);
    return d;
  }

 private:
  static void check(const core::segment_voronoi::build::DiagramView& d) {
    if (d.vertices.size() != d.radius.size() || d.edges.size() != d.edge_sites.size()) {
      throw std::invalid_argument("the arrays of a diagram have lengths that do not go together");
    }
    check_range(d.segments, 0, d.points.size());
    check_range(d.edges, -1, d.radius.size());
    check_range(d.edge_sites, 0, d.points.size() + d.segments.size());
  }
  static void check_range(std::span<const Pair> pairs, std::int32_t least, std::size_t count) {
    for (const Pair& pair : pairs) {
      for (const std::int32_t index : pair) {
        if (index < least || (index >= 0 && static_cast<std::size_t>(index) >= count)) {
          throw std::invalid_argument("an index of the diagram is out of range");
        }
      }
    }
  }
};

}  // namespace vorotool::bindings
