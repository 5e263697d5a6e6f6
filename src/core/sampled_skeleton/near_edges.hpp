// The edges of shapes near a part of a Voronoi edge of seeds on them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/kernel/planar_graph_view.hpp"
#include "core/kernel/point.hpp"
#include "core/sampled_skeleton/arc_error_bound.hpp"
#include "core/sampled_skeleton/sample_diagram.hpp"
#include "core/spatial/obb_tree.hpp"

namespace vorotool::core::sampled_skeleton {

// The discs about two points of a Voronoi edge hold those about all points between, if each goes through both
// seeds or, squared, its radius is larger than that by the same for all.
struct DiscPair {
  std::array<kernel::Point, 2> center;
  std::array<double, 2> radius;
};

// Finds edges one time after the other: memory is used again.
class NearEdges {
 public:
  // Of each group the segments of a graph, then all of its points that no segment ends at.
  static std::vector<std::vector<NearEdge>> items(const kernel::PlanarGraphView& graph,
                                                  const SampleGroups& groups);

  // `hierarchy` holds the items by their numbers.
  NearEdges(std::span<const NearEdge> items, const spatial::ObbTree& hierarchy, std::size_t most)
      : items_(items), hierarchy_(hierarchy), most_(most) {}

  // All that meet the discs; nothing if more than `most` meet one of them, as where a shape is round about
  // it.
  std::optional<std::span<const NearEdge>> find(const DiscPair& discs);
  // Whether that was so of a disc of the last search.
  bool is_crowded(std::size_t disc) const { return discs_[disc].numbers.size() > most_; }

 private:
  // The edges that meet one disc. Arcs that follow each other share one.
  struct Found {
    kernel::Point center{0, 0};
    double radius = -1;
    std::vector<std::uint32_t> numbers;
  };
  bool is_known(const kernel::Point& center, double radius, std::size_t i);
  void search(const kernel::Point& center, double radius, Found& found);
  // Whether the surroundings hold a disc; they are gathered where it is hardly away from the last one.
  bool is_surrounded(const kernel::Point& center, double reach);

  std::span<const NearEdge> items_;
  const spatial::ObbTree& hierarchy_;
  std::size_t most_;
  std::array<Found, 2> discs_;
  Found surroundings_;        // what meets a wider disc: many that follow are within it
  kernel::Point last_{0, 0};  // the center of the disc that was searched for last
  std::vector<NearEdge> found_;
};

}  // namespace vorotool::core::sampled_skeleton
