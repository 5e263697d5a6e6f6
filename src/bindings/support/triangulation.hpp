// A triangulation that comes from Python, and points that go there.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>

#include "bindings/support/arrays.hpp"
#include "core/delaunay/triangulation.hpp"

namespace vorotool::bindings {

inline std::span<const std::int32_t> rows_of(const IndexRows& array, std::size_t columns) {
  if (array.shape(1) != columns)
    throw std::invalid_argument("an array of indices has a wrong number of columns");
  return view(array);
}

// Its arrays are kept, and go together in length; the core trusts no index.
class Triangulation {
 public:
  Triangulation(const Places& points, const IndexRows& triangles, const IndexRows& neighbors,
                const IndexRows& edges, const Indices& hull, const Indices& first)
      : kept_(keep(points, triangles, neighbors, edges, hull, first)),
        view_{rows<core::kernel::Point>(points),
              rows_of(triangles, 3),
              rows_of(neighbors, 3),
              rows_of(edges, 2),
              bindings::view(hull),
              bindings::view(first)} {
    if (view_.first.size() != view_.points.size() || view_.neighbors.size() != view_.triangles.size()) {
      throw std::invalid_argument("the arrays of a triangulation have lengths that do not go together");
    }
  }

  const core::delaunay::TriangulationArrays& view() const { return view_; }

 private:
  std::shared_ptr<const void> kept_;
  core::delaunay::TriangulationArrays view_;
};

// (n, 2) doubles that take over the points.
inline Array<double> points_to_numpy(core::base::LargeArray<core::kernel::Point>&& points) {
  const std::size_t rows = points.size();
  core::kernel::Point* data = points.release();
  return {reinterpret_cast<double*>(data), {rows, 2}, nanobind::capsule(data, [](void* p) noexcept {
            core::base::LargeArray<core::kernel::Point>::free(static_cast<core::kernel::Point*>(p));
          })};
}

}  // namespace vorotool::bindings
