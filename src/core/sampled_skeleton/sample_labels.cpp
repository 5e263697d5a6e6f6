#include "core/sampled_skeleton/sample_labels.hpp"

#include <algorithm>

namespace vorotool::core::sampled_skeleton {

using base::at;

SampleLabels::SampleLabels(const kernel::PlanarGraphView& graph, std::span<const kernel::Point> seeds,
                           std::span<const std::int32_t> start, std::span<const std::int32_t> segment,
                           std::span<const std::int32_t> first)
    : graph_(graph), incident_(graph), seeds_(seeds), start_(start), segment_(segment), first_(first) {
  for (std::size_t s = 0; s < first.size(); ++s) {
    if (first[s] != static_cast<std::int32_t>(s)) extra_.push_back({first[s], segment[s]});
  }
  std::sort(extra_.begin(), extra_.end());
}

std::span<const SampleLabels::ExtraLabel> SampleLabels::extra(std::int32_t seed) const {
  if (extra_.empty()) return {};
  const auto [begin, end] =
      std::equal_range(extra_.begin(), extra_.end(), ExtraLabel{seed, 0},
                       [](const ExtraLabel& a, const ExtraLabel& b) { return a.seed < b.seed; });
  return {begin, end};
}

bool SampleLabels::is_on(std::int32_t seed, std::int32_t segment) const {
  if (is_point(seed) ? is_end(seed, segment) : inside(seed) == segment) return true;
  const auto more = extra(seed);
  return std::any_of(more.begin(), more.end(),
                     [&](const ExtraLabel& label) { return label.segment == segment; });
}

bool SampleLabels::share(std::int32_t p, std::int32_t q) const {
  const bool known = is_point(p)   ? is_point(q) ? segment_between(p, q) >= 0 : is_end(p, inside(q))
                     : is_point(q) ? is_end(q, inside(p))
                                   : inside(p) == inside(q);
  if (known || extra_.empty()) return known;
  bool found = false;
  visit(p, [&](std::int32_t segment) { found |= is_on(q, segment); });
  return found;
}

std::int32_t SampleLabels::piece_between(std::int32_t p, std::int32_t q) const {
  if (is_point(p) && is_point(q)) {
    const std::int32_t segment = segment_between(p, q);
    return segment >= 0 && start_[at(segment)] == start_[at(segment) + 1] ? first_piece(segment) : -1;
  }
  if (is_point(p)) std::swap(p, q);
  const std::int32_t segment = inside(p), begin = start_[at(segment)], end = start_[at(segment) + 1];
  if (!is_point(q)) {
    if (inside(q) != segment || (p - q != 1 && q - p != 1)) return -1;
    return first_piece(segment) + std::max(p, q) - begin;
  }
  if (graph_.segments[at(segment)][0] == q && p == begin) return first_piece(segment);
  if (graph_.segments[at(segment)][1] == q && p == end - 1) return first_piece(segment + 1) - 1;
  return -1;
}

std::pair<std::int32_t, bool> SampleLabels::segment_of_piece(std::int32_t p, std::int32_t q) const {
  if (!is_point(p)) return {inside(p), is_point(q) ? graph_.segments[at(inside(p))][1] == q : p < q};
  const std::int32_t segment = is_point(q) ? segment_between(p, q) : inside(q);
  return {segment, graph_.segments[at(segment)][0] == p};
}

EdgePiece SampleLabels::piece(std::int32_t number) const {
  // the last segment whose first piece is not later
  std::int32_t low = 0, high = static_cast<std::int32_t>(graph_.segments.size());
  while (high - low > 1) {
    const std::int32_t middle = low + (high - low) / 2;
    (first_piece(middle) <= number ? low : high) = middle;
  }
  const std::int32_t k = number - first_piece(low), begin = start_[at(low)], end = start_[at(low) + 1];
  const auto [a, b] = graph_.segments[at(low)];
  return {first(k == 0 ? a : begin + k - 1), first(k == end - begin ? b : begin + k), low};
}

std::int32_t SampleLabels::piece_at(std::int32_t segment, double share) const {
  const kernel::LatticeSite site = graph_.segment(at(segment));
  const kernel::LatticeVector along = site.b - site.a;
  const double ux = static_cast<double>(along.x), uy = static_cast<double>(along.y);
  const double wanted = share * (ux * ux + uy * uy);
  const auto seeds =
      seeds_.subspan(at(start_[at(segment)]), at(start_[at(segment) + 1] - start_[at(segment)]));
  const auto after =
      std::upper_bound(seeds.begin(), seeds.end(), wanted, [&](double value, const kernel::Point& seed) {
        return value < ux * (seed.x - site.a.x) + uy * (seed.y - site.a.y);
      });
  return first_piece(segment) + static_cast<std::int32_t>(after - seeds.begin());
}

std::int32_t SampleLabels::seed_beside(std::int32_t end, std::int32_t segment) const {
  const std::int32_t begin = start_[at(segment)], stop = start_[at(segment) + 1];
  const auto [a, b] = graph_.segments[at(segment)];
  if (begin == stop) return end == a ? b : a;
  return first(end == a ? begin : stop - 1);
}

}  // namespace vorotool::core::sampled_skeleton
