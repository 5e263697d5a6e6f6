// The labels of seeds (paper, section 3.1): a seed has the labels of all edges that it is on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/indices.hpp"
#include "core/kernel/planar_graph_view.hpp"
#include "core/kernel/point.hpp"
#include "core/segment_voronoi/build/incident_segments.hpp"

namespace vorotool::core::sampled_skeleton {

// A piece of an edge between seeds that follow each other.
struct EdgePiece {
  std::int32_t first, last;  // seeds, along the segment; of seeds at one place the first
  std::int32_t segment;
};

// Of seeds as core/sampled_skeleton/boundary_samples.hpp numbers them.
class SampleLabels {
 public:
  // `first` names for each of the seeds the first one at the same place. Nearly all are that themselves;
  // seeds on segments that meet at a very small angle may be rounded to one place, and the first then has all
  // labels.
  SampleLabels(const kernel::PlanarGraphView& graph, std::span<const kernel::Point> seeds,
               std::span<const std::int32_t> start, std::span<const std::int32_t> segment,
               std::span<const std::int32_t> first);

  const kernel::PlanarGraphView& graph() const { return graph_; }
  const segment_voronoi::build::IncidentSegments& incident() const { return incident_; }
  std::size_t piece_count() const { return start_.size() - 1 + segment_.size() - graph_.points.size(); }

  bool is_point(std::int32_t seed) const { return static_cast<std::size_t>(seed) < graph_.points.size(); }
  // A point of the graph without segments.
  bool is_lone(std::int32_t seed) const { return is_point(seed) && incident_.at(seed).empty(); }
  // The segment that a seed is inside of: it is no point.
  std::int32_t segment_of(std::int32_t seed) const { return inside(seed); }
  // Row of the table of sites: points, then segments.
  std::int32_t site_of(std::int32_t seed) const {
    return is_point(seed) ? seed : static_cast<std::int32_t>(graph_.points.size()) + inside(seed);
  }
  // Calls visit(segment) for the labels of a seed.
  template <class Visit>
  void visit(std::int32_t seed, const Visit& visit) const;

  // Whether a seed has the label of a segment.
  bool is_on(std::int32_t seed, std::int32_t segment) const;
  // Whether two seeds have a label in common.
  bool share(std::int32_t p, std::int32_t q) const;
  // The number of the piece between two seeds, or -1. It may not be found where seeds share their places.
  std::int32_t piece_between(std::int32_t p, std::int32_t q) const;
  EdgePiece piece(std::int32_t number) const;
  // The segment that a piece between two seeds belongs to, and whether it goes from the first to the second.
  std::pair<std::int32_t, bool> segment_of_piece(std::int32_t p, std::int32_t q) const;
  // Calls visit(piece) for the pieces of a segment between two places on it, as shares of its length; where
  // one is beyond an end, up to that.
  template <class Visit>
  void visit_pieces(std::int32_t segment, double from, double to, const Visit& visit) const;
  // The seed next to an end of a segment.
  std::int32_t seed_beside(std::int32_t end, std::int32_t segment) const;
  // Calls visit(seed) for the seeds next to one along its segments.
  template <class Visit>
  void visit_beside(std::int32_t seed, const Visit& visit) const;

 private:
  struct ExtraLabel {
    std::int32_t seed, segment;
    auto operator<=>(const ExtraLabel&) const = default;
  };

  std::int32_t inside(std::int32_t seed) const { return segment_[static_cast<std::size_t>(seed)]; }
  std::int32_t first(std::int32_t seed) const { return first_[static_cast<std::size_t>(seed)]; }
  std::int32_t first_piece(std::int32_t segment) const {
    return start_[static_cast<std::size_t>(segment)] - static_cast<std::int32_t>(graph_.points.size()) +
           segment;
  }
  std::int32_t segment_between(std::int32_t p, std::int32_t q) const {
    const std::int32_t site = incident_.between(p, q);
    return site < 0 ? -1 : site - static_cast<std::int32_t>(graph_.points.size());
  }
  bool is_end(std::int32_t point, std::int32_t segment) const {
    const auto [a, b] = graph_.segments[base::at(segment)];
    return a == point || b == point;
  }
  std::span<const ExtraLabel> extra(std::int32_t seed) const;
  std::int32_t piece_at(std::int32_t segment, double share) const;

  kernel::PlanarGraphView graph_;
  segment_voronoi::build::IncidentSegments incident_;
  std::span<const kernel::Point> seeds_;
  std::span<const std::int32_t> start_, segment_, first_;
  std::vector<ExtraLabel> extra_;  // sorted
};

template <class Visit>
void SampleLabels::visit(std::int32_t seed, const Visit& visit) const {
  if (is_point(seed)) {
    const auto points = static_cast<std::int32_t>(graph_.points.size());
    for (const std::int32_t site : incident_.at(seed)) visit(site - points);
  } else {
    visit(inside(seed));
  }
  for (const ExtraLabel& label : extra(seed)) visit(label.segment);
}

template <class Visit>
void SampleLabels::visit_pieces(std::int32_t segment, double from, double to, const Visit& visit) const {
  if (from > to) std::swap(from, to);
  if (to < 0 || from > 1) return;
  const std::int32_t last = piece_at(segment, to);
  for (std::int32_t piece = piece_at(segment, from); piece <= last; ++piece) visit(piece);
}

template <class Visit>
void SampleLabels::visit_beside(std::int32_t seed, const Visit& visit) const {
  if (is_point(seed)) {
    const auto points = static_cast<std::int32_t>(graph_.points.size());
    for (const std::int32_t site : incident_.at(seed)) visit(seed_beside(seed, site - points));
    return;
  }
  const auto segment = static_cast<std::size_t>(inside(seed));
  const auto [a, b] = graph_.segments[segment];
  visit(seed == start_[segment] ? a : seed - 1);
  visit(seed == start_[segment + 1] - 1 ? b : seed + 1);
}

}  // namespace vorotool::core::sampled_skeleton
