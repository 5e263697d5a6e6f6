// The vertices of a finished segment Voronoi diagram: records of one place taken together, and numbered in an
// order that depends on the input only.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/large_array.hpp"
#include "core/monitor.hpp"
#include "core/segment_insertion.hpp"
#include "core/segment_sites.hpp"
#include "core/voronoi_records.hpp"

namespace vorotool::core {

class VertexNumbers {
 public:
  static constexpr std::int32_t at_infinity = std::numeric_limits<std::int32_t>::max();

  // Vertices are sorted by the lists of their sites, each in the engine's order from its first one.
  VertexNumbers(const SegmentSites& sites, const VoronoiRecords& records, unsigned threads,
                const Monitor& monitor);

  std::size_t count() const { return leads_.size(); }
  // Of the sites around all vertices.
  std::size_t ring_size() const { return ring_size_; }
  // The number of a record's vertex, or at_infinity.
  std::int32_t of(std::int32_t record) const { return ~code_[static_cast<std::size_t>(record)]; }
  // Tells the processor that of() will be asked soon.
  void prefetch(std::int32_t record) const { __builtin_prefetch(&code_[static_cast<std::size_t>(record)]); }
  // [vertices] the record that stands for each.
  std::span<const std::int32_t> leads() const { return {leads_.data(), leads_.size()}; }
  // Whether a record stands for its vertex; others are at infinity, or share their place with it.
  bool is_lead(std::int32_t record) const {
    return of(record) != at_infinity &&
           (!is_merged(record) || leads_[static_cast<std::size_t>(of(record))] == record);
  }
  // Whether a record shares its place with others.
  bool is_merged(std::int32_t record) const { return is_merged_[static_cast<std::size_t>(record)]; }
  // Ascending: those that stand for others too, and those at infinity.
  std::span<const std::int32_t> merged_leads() const { return merged_leads_; }
  std::span<const std::int32_t> infinite() const { return infinite_; }

  // The corners around the vertex that a record stands for, counter-clockwise: opposite to its edges, from
  // that on whose left the first site of the engine's order is. `nodes` are records or links.
  template <class Nodes>
  void gather_ring(const Nodes& nodes, std::int32_t record, std::vector<Corner>& ring) const;

 private:
  // The sites around a vertex that come first, and the record that stands for it.
  struct Key {
    SiteIndex first, second, third;
    std::int32_t record;
    auto operator<=>(const Key&) const = default;
  };
  using Pair = std::array<std::int32_t, 2>;
  struct Found {
    std::vector<Pair> coincident;  // neighbours
    std::vector<std::int32_t> infinite;
  };

  std::int32_t& code(std::int32_t record) { return code_[static_cast<std::size_t>(record)]; }
  std::uint32_t& count_at(SiteIndex first) { return begin_[static_cast<std::size_t>(first) + 2]; }

  void look_at(std::int32_t record, Found& found);
  void merge(const std::vector<Found>& found);
  std::int32_t root(std::int32_t record);
  void choose_leads();
  void gather_keys(unsigned threads, const Monitor& monitor);
  void sort_by_first_site(unsigned threads, const Monitor& monitor);
  void sort_buckets(SiteIndex first, SiteIndex last);
  Key key_of(std::int32_t record) const;
  void number(unsigned threads, const Monitor& monitor);

  // Whether an edge leaves the place of its vertex, which shares it with others.
  template <class Nodes>
  bool is_border(const Nodes& nodes, Corner corner) const {
    const std::int32_t record = record_of(corner);
    const Corner twin = nodes[record].twins[static_cast<std::size_t>(place_of(corner))];
    return code_[static_cast<std::size_t>(record_of(twin))] != code_[static_cast<std::size_t>(record)];
  }

  const SegmentSites& sites_;
  const VoronoiRecords& records_;
  // [records] In the end the complement of the number of the vertex. Before, that of the first site; at a
  // place with several records, one of these, not negative, is the same for all.
  LargeArray<std::int32_t> code_;
  std::vector<bool> is_merged_;       // [records]
  std::vector<std::uint32_t> begin_;  // [sites + 2] where vertices begin, by their first sites
  LargeArray<std::int32_t> leads_;
  std::vector<std::int32_t> merged_leads_, infinite_;
  std::vector<Key> merged_keys_;  // [merged_leads] until vertices are sorted
  std::size_t ring_size_ = 0;
};

// The site on the left of the edge opposite to a corner.
template <class Nodes>
SiteIndex left_site(const Nodes& nodes, Corner corner) {
  return nodes[record_of(corner)].sites[static_cast<std::size_t>(preceding(place_of(corner)))];
}

// The border of a place is gone round counter-clockwise: from half-edge to half-edge of one vertex, and on in
// the next vertex of the place where a half-edge has no length. A point whose segments leave no gap of 180
// degrees is inside.
template <class Nodes>
void VertexNumbers::gather_ring(const Nodes& nodes, std::int32_t record, std::vector<Corner>& ring) const {
  if (!is_merged(record)) {
    const std::array<SiteIndex, 3>& sites = nodes[record].sites;
    const int first =
        following(static_cast<int>(std::min_element(sites.begin(), sites.end()) - sites.begin()));
    ring.assign(
        {corner_of(record, first), corner_of(record, following(first)), corner_of(record, preceding(first))});
    return;
  }
  ring.clear();
  Corner corner = corner_of(record, 0);
  while (!is_border(nodes, corner)) ++corner;
  const Corner first = corner;
  do {
    ring.push_back(corner);
    for (;;) {
      const std::int32_t here = record_of(corner);
      corner = corner_of(here, following(place_of(corner)));
      if (is_border(nodes, corner)) break;
      corner = nodes[here].twins[static_cast<std::size_t>(place_of(corner))];
    }
  } while (corner != first);
  const auto least = std::min_element(ring.begin(), ring.end(), [&](Corner a, Corner b) {
    return left_site(nodes, a) < left_site(nodes, b);
  });
  std::rotate(ring.begin(), least, ring.end());
}

}  // namespace vorotool::core
