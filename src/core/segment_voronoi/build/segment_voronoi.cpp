#include "core/segment_voronoi/build/segment_voronoi.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/indices.hpp"
#include "core/base/memory_release.hpp"
#include "core/delaunay/divide_and_conquer.hpp"
#include "core/delaunay/spatial_sort.hpp"
#include "core/segment_voronoi/build/point_voronoi.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"

namespace vorotool::core::segment_voronoi::build {

using base::IndexPair;
using base::Monitor;
using delaunay::MortonOrder;
using kernel::LatticePoint;
using kernel::PlanarGraphView;

namespace {

// Of n sites there are at most 2 n - 2 vertices, each with four corner numbers in 31 bits.
constexpr std::size_t most_sites = (std::size_t{1} << 28) - 1;

void check(const PlanarGraphView& graph) {
  const std::size_t points = graph.points.size();
  if (points + graph.segments.size() > most_sites) throw std::length_error("more than 268435455 sites");
  for (std::size_t j = 0; j < graph.segments.size(); ++j) {
    for (const std::int32_t end : graph.segments[j]) {
      if (end < 0 || static_cast<std::size_t>(end) >= points) {
        throw std::invalid_argument("segment " + std::to_string(j) + " ends at point " + std::to_string(end) +
                                    ", but there are " + std::to_string(points) + " points");
      }
    }
    if (graph.segments[j][0] == graph.segments[j][1]) {
      throw std::invalid_argument("both ends of segment " + std::to_string(j) + " are the same point");
    }
  }
}

MortonOrder ordered(const PlanarGraphView& graph, const std::optional<spatial::Bounds>& within,
                    unsigned threads, const Monitor& monitor) {
  const std::span<const LatticePoint> points = graph.points;
  std::vector<kernel::Point> places;
  places.reserve(points.size());
  for (const LatticePoint& p : points) places.push_back({static_cast<double>(p.x), static_cast<double>(p.y)});
  std::vector<std::int32_t> first(points.size());
  MortonOrder order =
      delaunay::morton_order(places, first, delaunay::FineOrder::of_places, threads, monitor, within);
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (static_cast<std::size_t>(first[i]) == i) continue;
    throw std::invalid_argument("points " + std::to_string(first[i]) + " and " + std::to_string(i) +
                                " are at one place");
  }
  return order;
}

// The segments by their ends in the numbers of the sites, the first of the two ends first.
std::vector<std::uint32_t> along_points(std::span<const IndexPair> segments,
                                        std::span<const std::int32_t> rank) {
  const auto ends = [&](std::size_t j) {
    const std::int32_t a = rank[static_cast<std::size_t>(segments[j][0])];
    const std::int32_t b = rank[static_cast<std::size_t>(segments[j][1])];
    return std::pair(static_cast<std::size_t>(std::min(a, b)), std::max(a, b));
  };
  std::vector<std::uint32_t> begin(rank.size() + 2), order(segments.size());
  for (std::size_t j = 0; j < segments.size(); ++j) ++begin[ends(j).first + 2];
  for (std::size_t i = 0; i < rank.size(); ++i) begin[i + 2] += begin[i + 1];
  for (std::size_t j = 0; j < segments.size(); ++j) {
    order[begin[ends(j).first + 1]++] = static_cast<std::uint32_t>(j);
  }
  for (std::size_t i = 0; i < rank.size(); ++i) {
    std::sort(order.begin() + begin[i], order.begin() + begin[i + 1],
              [&](std::uint32_t j, std::uint32_t k) { return ends(j) < ends(k); });
  }
  return order;
}

}  // namespace

SegmentVoronoi::SegmentVoronoi(const PlanarGraphView& graph, const std::optional<spatial::Bounds>& within,
                               unsigned threads, const Monitor& monitor) {
  check(graph);
  make_point_diagram(graph, within, threads, monitor);
  base::return_freed_memory(records_->all.size() * sizeof(discs::VoronoiRecord));
  ParallelInsertion rounds(sites_, *records_, threads);
  try {
    rounds.run(monitor);
  } catch (const discs::NoDisc& error) {
    throw std::logic_error(error.what());
  }
  counts_ = rounds.counts();
}

Diagram SegmentVoronoi::take_arrays(std::span<const std::uint8_t> unwanted, unsigned threads,
                                    const Monitor& monitor) {
  if (!unwanted.empty() && unwanted.size() != given_.size())
    throw std::invalid_argument("each site must have its unwanted sides");
  if (!records_) throw std::logic_error("the arrays of the diagram were taken before");
  VoronoiRecords records = std::move(*records_);
  records_.reset();
  return extract_diagram(std::move(sites_), std::move(records), given_, unwanted, threads, monitor);
}

// The triangulation is gone when segments are inserted.
void SegmentVoronoi::make_point_diagram(const PlanarGraphView& graph,
                                        const std::optional<spatial::Bounds>& within, unsigned threads,
                                        const Monitor& monitor) {
  MortonOrder order = ordered(graph, within, threads, monitor);
  const std::span<delaunay::RingVertex> vertices{order.vertices.data(), order.index.size()};
  delaunay::Subdivision mesh =
      delaunay::divide_and_conquer({vertices, order.index, order.code, order.fine}, threads, monitor);
  order.code = std::vector<std::uint32_t>();
  order.fine = std::vector<std::uint32_t>();
  number_sites(graph, order.index);
  records_ = point_voronoi(sites_, mesh, vertices, threads, monitor);
}

// Points in the order of the triangulation, and the segments along them.
void SegmentVoronoi::number_sites(const PlanarGraphView& graph, std::span<const std::uint32_t> order) {
  const std::size_t points = graph.points.size(), segments = graph.segments.size();
  given_.resize(points + segments);
  std::vector<std::int32_t> rank(points);
  std::vector<LatticePoint> places(points);
  for (std::size_t i = 0; i < points; ++i) {
    rank[order[i]] = static_cast<std::int32_t>(i);
    given_[i] = static_cast<std::int32_t>(order[i]);
    places[i] = graph.points[order[i]];
  }
  const std::vector<std::uint32_t> along = along_points(graph.segments, rank);
  std::vector<IndexPair> ends(segments);
  for (std::size_t j = 0; j < segments; ++j) {
    const IndexPair& s = graph.segments[along[j]];
    ends[j] = {rank[static_cast<std::size_t>(s[0])], rank[static_cast<std::size_t>(s[1])]};
    given_[points + j] = static_cast<std::int32_t>(points + along[j]);
  }
  sites_ = discs::SegmentSites(std::move(places), ends);
}

}  // namespace vorotool::core::segment_voronoi::build
