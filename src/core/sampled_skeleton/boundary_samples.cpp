#include "core/sampled_skeleton/boundary_samples.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/numbers/special_values.hpp"

namespace vorotool::core::sampled_skeleton {

using base::at;
using base::Monitor;
using kernel::LatticeSite;
using kernel::PlanarGraphView;
using kernel::Point;
using numbers::infinity;

namespace {

constexpr std::size_t segments_a_piece = 1 << 10;

double length_of(const LatticeSite& site) {
  return std::sqrt(static_cast<double>(kernel::norm2(site.b - site.a)));
}

double rounded(double value) { return std::nearbyint(value / seed_step) * seed_step; }

// The place at a distance from one end of a segment.
Point place_from(const kernel::LatticePoint& end, const kernel::LatticePoint& other, double length,
                 double distance) {
  const kernel::LatticeVector way = other - end;
  const double t = distance / length;
  return {rounded(end.x + t * static_cast<double>(way.x)), rounded(end.y + t * static_cast<double>(way.y))};
}

void check(double seeds, std::size_t most) {
  if (!(seeds <= static_cast<double>(most))) throw TooManySeeds(seeds);
}

// `count(j)` seeds lie inside segment j, and `place(j, seeds)` writes them.
template <class Count, class Write>
BoundarySamples sample(const PlanarGraphView& graph, std::size_t most, unsigned threads,
                       const Monitor& monitor, const Count& count, const Write& write) {
  const std::size_t points = graph.points.size(), segments = graph.segments.size();
  BoundarySamples made;
  made.start.resize(segments + 1);
  double total = static_cast<double>(points);
  for (std::size_t j = 0; j < segments; ++j) {
    check(total, most);
    made.start[j] = static_cast<std::int32_t>(total);
    total += count(j);
  }
  check(total, most);
  made.start[segments] = static_cast<std::int32_t>(total);
  made.seeds = base::LargeArray<Point>(static_cast<std::size_t>(total));
  made.segment = base::LargeArray<std::int32_t>(static_cast<std::size_t>(total));
  for (std::size_t i = 0; i < points; ++i) {
    made.seeds[i] = {static_cast<double>(graph.points[i].x), static_cast<double>(graph.points[i].y)};
    made.segment[i] = -1;
  }
  base::for_items(segments, segments_a_piece, threads, monitor, [&](std::size_t j) {
    const std::size_t first = at(made.start[j]), size = at(made.start[j + 1]) - first;
    std::fill_n(made.segment.data() + first, size, static_cast<std::int32_t>(j));
    write(j, std::span(made.seeds.data() + first, size));
  });
  return made;
}

// The samples inside a segment: seeds by the distances of its first end, one between perhaps, and seeds by
// those of its second end.
struct HalvedSegment {
  std::size_t from_first, from_second;
  double between;  // from the first end; 0: none
  std::size_t count() const { return from_first + from_second + (between > 0 ? 1 : 0); }
};

std::span<const double> distances_at(const CornerSteps& steps, std::int32_t point) {
  const std::size_t begin = steps.start[at(point)];
  return std::span(steps.distance).subspan(begin, steps.start[at(point) + 1] - begin);
}

// How many of the distances from an end a half has: a quarter of the last gap is left up to the middle.
std::size_t count_up_to(double half, std::span<const double> distance) {
  std::size_t k = 0;
  for (double last = 0; k < distance.size(); last = distance[k++]) {
    if (distance[k] + (distance[k] - last) / 4 > half) break;
  }
  return k;
}

HalvedSegment halved(const PlanarGraphView& graph, const CornerSteps& steps, std::size_t segment) {
  const auto [a, b] = graph.segments[segment];
  const double length = length_of(graph.segment(segment));
  const auto by_a = distances_at(steps, a), by_b = distances_at(steps, b);
  const std::size_t i = count_up_to(length / 2, by_a), j = count_up_to(length / 2, by_b);
  const double last_a = i > 0 ? by_a[i - 1] : 0, last_b = j > 0 ? by_b[j - 1] : 0;
  const double next_a = i < by_a.size() ? by_a[i] - last_a : infinity;
  const double next_b = j < by_b.size() ? by_b[j] - last_b : infinity;
  const double gap = length - last_a - last_b, next = std::min(next_a, next_b);
  if (gap <= 1.5 * next) return {i, j, 0};
  const double step = std::min(next, gap / 2);
  return {i, j, next_a <= next_b ? last_a + step : length - last_b - step};
}

// The longest segment at each point, and the shortest.
std::vector<std::pair<double, double>> lengths_at_points(const PlanarGraphView& graph) {
  std::vector<std::pair<double, double>> found(graph.points.size(), {0.0, infinity});
  for (std::size_t j = 0; j < graph.segments.size(); ++j) {
    const double length = length_of(graph.segment(j));
    for (const std::int32_t end : graph.segments[j]) {
      found[at(end)].first = std::max(found[at(end)].first, length);
      found[at(end)].second = std::min(found[at(end)].second, length);
    }
  }
  return found;
}

}  // namespace

BoundarySamples sample_by_step(const PlanarGraphView& graph, double step, std::size_t most, unsigned threads,
                               const Monitor& monitor) {
  const auto site = [&](std::size_t j) { return graph.segment(j); };
  return sample(
      graph, most, threads, monitor,
      [&](std::size_t j) { return std::max(0.0, std::floor(length_of(site(j)) / step - 0.5)); },
      [&](std::size_t j, std::span<Point> seeds) {
        const LatticeSite edge = site(j);
        const double length = length_of(edge);
        for (std::size_t k = 0; k < seeds.size(); ++k) {
          seeds[k] = place_from(edge.a, edge.b, length, static_cast<double>(k + 1) * step);
        }
      });
}

CornerSteps even_steps(const PlanarGraphView& graph, double step, std::size_t most) {
  CornerSteps steps{{0}, {}};
  double total = 0;
  for (const auto& [longest, shortest] : lengths_at_points(graph))
    total += std::floor(longest / 2 / step) + 1;
  check(total / 2, most);  // each segment has as many seeds as its own ends ask for in two halves, or nearly
  for (const auto& [longest, shortest] : lengths_at_points(graph)) {
    const auto count = static_cast<std::size_t>(std::floor(longest / 2 / step)) + 1;
    for (std::size_t k = 1; k <= count; ++k) steps.distance.push_back(static_cast<double>(k) * step);
    steps.start.push_back(steps.distance.size());
  }
  return steps;
}

CornerSteps doubled_steps(const PlanarGraphView& graph, double coarsest, std::size_t most) {
  CornerSteps steps{{0}, {}};
  for (const auto& [longest, shortest] : lengths_at_points(graph)) {
    double gap = std::min(coarsest, shortest / 3), distance = 0;
    if (longest > 0) {
      do {
        distance += gap;
        steps.distance.push_back(distance);
        gap = std::min(coarsest, distance);
      } while (distance <= longest / 2);
    }
    check(static_cast<double>(steps.distance.size()) / 2, most);
    steps.start.push_back(steps.distance.size());
  }
  return steps;
}

BoundarySamples sample_from_corners(const PlanarGraphView& graph, const CornerSteps& steps, std::size_t most,
                                    unsigned threads, const Monitor& monitor) {
  return sample(
      graph, most, threads, monitor,
      [&](std::size_t j) { return static_cast<double>(halved(graph, steps, j).count()); },
      [&](std::size_t j, std::span<Point> seeds) {
        const auto [a, b] = graph.segments[j];
        const LatticeSite edge = graph.segment(j);
        const double length = length_of(edge);
        const HalvedSegment half = halved(graph, steps, j);
        std::size_t next = 0;
        for (const double d : distances_at(steps, a).first(half.from_first)) {
          seeds[next++] = place_from(edge.a, edge.b, length, d);
        }
        if (half.between > 0) seeds[next++] = place_from(edge.a, edge.b, length, half.between);
        for (std::size_t k = half.from_second; k-- > 0;) {
          seeds[next++] = place_from(edge.b, edge.a, length, distances_at(steps, b)[k]);
        }
      });
}

CornerSteps refined_steps(const PlanarGraphView& graph, const CornerSteps& steps,
                          std::span<const std::int32_t> start, std::span<const std::int32_t> parts,
                          std::size_t most) {
  std::vector<std::int32_t> of_gap(steps.distance.size(), 1);
  const auto demand = [&](std::int32_t point, std::size_t gap, std::int32_t wanted) {
    const std::size_t number = steps.start[at(point)] + gap;
    if (number < steps.start[at(point) + 1]) of_gap[number] = std::max(of_gap[number], wanted);
  };
  for (std::size_t j = 0; j < graph.segments.size(); ++j) {
    const auto [a, b] = graph.segments[j];
    const HalvedSegment half = halved(graph, steps, j);
    const std::size_t first = at(start[j]) - graph.points.size() + j, pieces = half.count() + 1;
    for (std::size_t k = 0; k < pieces; ++k) {  // what is between the halves is made of a gap of both
      if (k <= half.from_first + (half.between > 0 ? 1 : 0))
        demand(a, std::min(k, half.from_first), parts[first + k]);
      const std::size_t back = pieces - 1 - k;
      if (back <= half.from_second + (half.between > 0 ? 1 : 0)) {
        demand(b, std::min(back, half.from_second), parts[first + k]);
      }
    }
  }
  double total = 0;
  for (std::size_t i = 0; i + 1 < steps.start.size(); ++i) {
    double last = 0;
    for (std::size_t g = steps.start[i]; g < steps.start[i + 1]; last = steps.distance[g++]) {
      const double parts = std::floor((steps.distance[g] - last) / least_gap);
      if (parts < of_gap[g]) of_gap[g] = std::max(1, static_cast<std::int32_t>(parts));
      total += of_gap[g];
    }
  }
  check(total / 2, most);
  CornerSteps refined{{0}, {}};
  refined.distance.reserve(static_cast<std::size_t>(total));
  for (std::size_t i = 0; i + 1 < steps.start.size(); ++i) {
    double last = 0;
    for (std::size_t g = steps.start[i]; g < steps.start[i + 1]; ++g) {
      const double gap = steps.distance[g] - last;
      for (std::int32_t k = 1; k < of_gap[g]; ++k) refined.distance.push_back(last + gap * k / of_gap[g]);
      refined.distance.push_back(last = steps.distance[g]);
    }
    refined.start.push_back(refined.distance.size());
  }
  return refined;
}

}  // namespace vorotool::core::sampled_skeleton
