#include "core/delaunay/vertex_triangles.hpp"

namespace vorotool::core::delaunay {

using base::check_range;

void check_indices(const TriangulationArrays& mesh) {
  check_range(mesh.triangles, 0, mesh.points.size(), "a triangle names a point that does not exist");
  check_range(mesh.neighbors, -1, mesh.triangles.size() / 3, "a neighbor is no triangle");
  check_range(mesh.edges, 0, mesh.points.size(), "an edge names a point that does not exist");
  check_range(mesh.hull, 0, mesh.points.size(), "the hull names a point that does not exist");
  check_range(mesh.first, 0, mesh.points.size(), "first names a point that does not exist");
}

VertexTriangles::VertexTriangles(const TriangulationArrays& mesh)
    : mesh_(mesh), triangles_(mesh.triangles.size() / 3), first_(mesh.points.size(), -1) {
  check_indices(mesh);
  order_.reserve(mesh.points.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::int32_t v = mesh.triangles[i];
    std::int32_t& first = first_[static_cast<std::size_t>(v)];
    if (first < 0) order_.push_back(v);
    // The side from v to the corner after it is opposite to the corner before it.
    if (first < 0 || mesh.neighbors[preceding(i)] < 0) first = static_cast<std::int32_t>(i / 3);
  }
}

}  // namespace vorotool::core::delaunay
