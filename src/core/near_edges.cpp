#include "core/near_edges.hpp"

#include <algorithm>
#include <cmath>

namespace vorotool::core {
namespace {

constexpr std::size_t most_triangles = 128;  // some microseconds of work, much more than nearly all arcs take

// Centres are rounded, and so are the squares: discs are taken to be larger by more than that.
constexpr double margin = 1 + 0x1p-40;

bool meets(const Point& a, const Point& b, const DiscPair& discs) {
  const double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
  for (std::size_t i = 0; i < 2; ++i) {
    const double px = discs.centre[i][0] - a.x, py = discs.centre[i][1] - a.y;
    const double t = std::clamp((px * x + py * y) / square, 0.0, 1.0), qx = px - t * x, qy = py - t * y;
    if (qx * qx + qy * qy <= margin * discs.square[i]) return true;
  }
  return false;
}

}  // namespace

std::optional<std::span<const NearEdge>> NearEdges::find(Side side, const DiscPair& discs) {
  triangles_.clear();
  pieces_.clear();
  found_.clear();
  triangles_.push_back(SeedMesh::triangle_of(side));
  if (diagram_.mesh().across(side) >= 0) triangles_.push_back(diagram_.mesh().across(side));
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (triangles_.size() > most_triangles) return {};
    look_at(triangles_[i], discs);
  }
  if (diagram_.walked_pieces().empty()) return found_;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [x, y] = discs.centre[i];
    hierarchy_->near(x, y, std::sqrt(margin * discs.square[i]), [&](std::uint32_t segment) {
      add(static_cast<std::int32_t>(segment));
      return found_.size() <= most_triangles;
    });
    if (found_.size() > most_triangles) return {};
  }
  return found_;
}

void NearEdges::look_at(Triangle t, const DiscPair& discs) {
  const SeedMesh& mesh = diagram_.mesh();
  const SeedLabels& labels = diagram_.labels();
  for (Side s = 3 * t; s < 3 * t + 3; ++s) {
    const std::int32_t p = mesh.origin(s), q = mesh.target(s);
    if (labels.is_lone(p)) found_.push_back({-1, {labels.graph().point(p), labels.graph().point(p)}});
    if (!meets(mesh.seed(p), mesh.seed(q), discs)) continue;
    if (diagram_.has_own_piece(s)) {
      pieces_.push_back(s);
      add(labels.segment_of_piece(p, q).first);
    }
    const Triangle u = mesh.across(s);
    if (u >= 0 && std::find(triangles_.begin(), triangles_.end(), u) == triangles_.end())
      triangles_.push_back(u);
  }
}

void NearEdges::add(std::int32_t segment) {
  const auto same = [&](const NearEdge& edge) { return edge.segment == segment; };
  if (std::any_of(found_.begin(), found_.end(), same)) return;
  found_.push_back({segment, diagram_.labels().graph().site(segment)});
}

}  // namespace vorotool::core
