#include "core/voronoi/own_ends.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

#include "core/base/indices.hpp"

namespace vorotool::core::voronoi {

using base::at;
using base::IndexPair;
using base::no_index;
using segment_voronoi::build::DiagramView;

namespace {

class Finder {
 public:
  explicit Finder(const DiagramView& diagram)
      : diagram_(diagram),
        degree_(diagram.points.size()),
        segment_(diagram.points.size(), no_index),
        alias_(diagram.points.size()) {
    for (const auto& [a, b] : diagram.segments) {
      ++degree_[at(a)];
      ++degree_[at(b)];
    }
    std::iota(alias_.begin(), alias_.end(), 0);
  }

  void add(std::size_t edge) {
    const auto [left, right] = diagram_.edge_sites[edge];
    const bool has_left = !diagram_.is_point(left);  // the segment is on its left
    const std::int32_t segment = has_left ? left : right, point = has_left ? right : left;
    const auto [source, target] = diagram_.edges[edge];
    const bool begins = is_corner(source), ends = is_corner(target);
    const bool is_first = diagram_.ends(segment)[0] == point;
    const IndexPair& faces = diagram_.faces[diagram_.segment_of(segment)];
    // along an edge that leads away from the end, a segment on its left has it on its own right
    const std::int32_t forth = faces[has_left == is_first ? 1 : 0],
                       back = faces[has_left == is_first ? 0 : 1];
    const auto number = static_cast<std::int32_t>(edge);
    const std::int32_t near_source = begins ? forth : back, near_target = ends ? back : forth;
    if (!begins && !ends && degree_[at(point)] > 1) {
      halves_[0].push_back({number, near_source, point, true});
      halves_[1].push_back({number, near_target, point, false});
    } else {
      whole_.push_back({number, near_source, no_index, false});
    }
    if (degree_[at(point)] > 1) note(point, segment);
  }

  OwnEnds take() {
    for (const std::vector<Piece>& half : halves_) whole_.insert(whole_.end(), half.begin(), half.end());
    return {std::move(whole_), std::move(alias_)};
  }

 private:
  bool is_corner(std::int32_t vertex) const { return vertex >= 0 && diagram_.radius[at(vertex)] == 0; }

  // The cell of a point has at most two segments beside it that end there.
  void note(std::int32_t point, std::int32_t segment) {
    std::int32_t& known = segment_[at(point)];
    if (known == no_index) {
      known = segment;
    } else if (known != segment &&
               cross(diagram_.way_from(point, known), diagram_.way_from(point, segment)) == 0) {
      alias_[at(point)] = std::min(known, segment);
    }
  }

  const DiagramView& diagram_;
  std::vector<std::int32_t> degree_;
  std::vector<std::int32_t> segment_;  // [n] one beside the cell of each point, as far as known
  std::vector<std::int32_t> alias_;
  std::vector<Piece> whole_;
  std::array<std::vector<Piece>, 2> halves_;
};

}  // namespace

OwnEnds own_ends(const DiagramView& diagram, const skeleton::SkeletonEdges& kept) {
  Finder finder(diagram);
  std::size_t next = 0;
  for (std::size_t e = 0; e < diagram.edges.size(); ++e) {
    if (next < kept.edge.size() && at(kept.edge[next]) == e) {
      ++next;
    } else {
      finder.add(e);
    }
  }
  return finder.take();
}

}  // namespace vorotool::core::voronoi
