#include "core/skeleton/edges.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "core/base/disjoint_sets.hpp"
#include "core/base/indices.hpp"
#include "core/base/large_array.hpp"
#include "core/base/parallel.hpp"
#include "core/segment_voronoi/build/wanted_faces.hpp"

namespace vorotool::core::skeleton {

using base::at;
using base::IndexPair;
using segment_voronoi::build::DiagramView;

namespace {

constexpr std::int32_t unknown = -1, deleted = -2;
constexpr std::size_t edges_a_piece = 1 << 15;  // some 0.5 ms

class FaceFinder {
 public:
  explicit FaceFinder(const DiagramView& diagram)
      : diagram_(diagram), point_face_(segment_voronoi::build::point_faces(diagram)) {}

  // The face of an edge as far as its own sites and ends tell.
  std::int32_t face(std::size_t edge) const {
    const auto [left, right] = diagram_.edge_sites[edge];
    const auto [source, target] = diagram_.edges[edge];
    if (is_own_end(left, right) || is_own_end(right, left)) return deleted;
    if (source < 0 || target < 0) return 0;
    for (const std::int32_t site : {left, right}) {
      if (diagram_.is_point(site) && point_face_[at(site)] != unknown) return point_face_[at(site)];
    }
    if (diagram_.radius[at(source)] == 0) return face_right_of(left, common_end(left, right));
    if (diagram_.radius[at(target)] == 0) return face_right_of(right, common_end(left, right));
    return unknown;
  }

 private:
  bool is_own_end(std::int32_t site, std::int32_t other) const {
    return diagram_.is_point(site) && !diagram_.is_point(other) && diagram_.is_end(site, other);
  }

  std::int32_t common_end(std::int32_t one, std::int32_t other) const {
    const IndexPair &a = diagram_.ends(one), &b = diagram_.ends(other);
    return a[0] == b[0] || a[0] == b[1] ? a[0] : a[1];
  }

  // As seen from an end of the segment along it.
  std::int32_t face_right_of(std::int32_t segment, std::int32_t end) const {
    return diagram_.faces[diagram_.segment_of(segment)][diagram_.ends(segment)[0] == end ? 1 : 0];
  }

  const DiagramView& diagram_;
  std::vector<std::int32_t> point_face_;
};

// Edges between segments, and between points without segments, are in the face of the edges that they meet at
// vertices which are no corners: a path inside a face leads to each of them.
void spread_faces(const DiagramView& diagram, base::LargeArray<std::int32_t>& face) {
  std::vector<std::int32_t> of_vertex(diagram.radius.size(), unknown);
  std::vector<std::size_t> left_over;
  for (std::size_t e = 0; e < face.size(); ++e) {
    if (face[e] == unknown) left_over.push_back(e);
    if (face[e] < 0) continue;
    for (const std::int32_t v : diagram.edges[e]) {
      if (v >= 0 && diagram.radius[at(v)] > 0) of_vertex[at(v)] = face[e];
    }
  }
  base::DisjointSets<std::int32_t> together(diagram.radius.size());
  for (const std::size_t e : left_over) together.join(diagram.edges[e][0], diagram.edges[e][1]);
  for (std::size_t v = 0; v < of_vertex.size(); ++v) {
    if (of_vertex[v] != unknown) of_vertex[at(together.find(static_cast<std::int32_t>(v)))] = of_vertex[v];
  }
  for (const std::size_t e : left_over) {
    face[e] = of_vertex[at(together.find(diagram.edges[e][0]))];
    if (face[e] == unknown) {
      throw std::invalid_argument("edge " + std::to_string(e) + " is joined to nothing that has a face");
    }
  }
}

}  // namespace

SkeletonEdges skeleton_edges(const DiagramView& diagram, unsigned threads, const base::Monitor& monitor) {
  const std::size_t count = diagram.edges.size();
  const FaceFinder finder(diagram);
  base::LargeArray<std::int32_t> face(count);
  base::for_items(count, edges_a_piece, threads, monitor, [&](std::size_t e) { face[e] = finder.face(e); });
  spread_faces(diagram, face);
  SkeletonEdges kept;
  const auto size = count - static_cast<std::size_t>(std::count(face.data(), face.data() + count, deleted));
  kept.edge.reserve(size);
  kept.face.reserve(size);
  for (std::size_t e = 0; e < count; ++e) {
    if (face[e] == deleted) continue;
    kept.edge.push_back(static_cast<std::int32_t>(e));
    kept.face.push_back(face[e]);
  }
  return kept;
}

}  // namespace vorotool::core::skeleton
