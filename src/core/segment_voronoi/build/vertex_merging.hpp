// The vertices of a finished segment Voronoi diagram: records of one place taken together, and numbered in an
// order that depends on the input only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/segment_voronoi/build/segment_insertion.hpp"
#include "core/segment_voronoi/discs/records.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::build {

class VertexMerging {
 public:
  static constexpr std::int32_t at_infinity = std::numeric_limits<std::int32_t>::max();
  static constexpr std::int32_t left_out = at_infinity - 1;
  // A site around a vertex, and the record to which the edge before it leads.
  struct Spoke {
    std::uint32_t site : 31;
    std::uint32_t is_left : 1;  // the disc lies to the left of the segment
    std::int32_t across;
  };

  // Finds the places of the records. Those are left out that are no corners and where a site is unwanted;
  // `unwanted` tells its sides (core/segment_voronoi/build/wanted_faces.hpp), or is empty if there is none.
  VertexMerging(const discs::SegmentSites& sites, const VoronoiRecords& records,
                std::span<const std::uint8_t> unwanted, unsigned threads, const base::Monitor& monitor);
  // Numbers them, sorted by the lists of their sites, each in the engine's order from its first one.
  void assign(unsigned threads, const base::Monitor& monitor);

  // Once they have numbers:
  // [vertices + 1] where the sites of each vertex begin: the array is given away.
  base::LargeArray<std::int32_t> take_starts() { return std::move(leads_); }
  // The number of a record's vertex, or at_infinity, or left_out.
  std::int32_t of(std::int32_t record) const { return ~code_[static_cast<std::size_t>(record)]; }
  // Tells the processor that of() will be asked soon.
  void prefetch(std::int32_t record) const { __builtin_prefetch(&code_[static_cast<std::size_t>(record)]); }

  // Before, too:
  bool is_left_out(std::int32_t record) const { return of(record) == left_out; }
  // Whether a record shares its place with others.
  bool is_merged(std::int32_t record) const { return is_merged_[static_cast<std::size_t>(record)]; }
  // Ascending: a record of each place that has several, and those at infinity.
  std::span<const std::int32_t> merged_leads() const { return merged_leads_; }
  std::span<const std::int32_t> infinite() const { return infinite_; }
  // Counter-clockwise around the vertex of merged_leads()[k], from the first site of the engine's order.
  std::span<const Spoke> merged_ring(std::size_t k) const;

 private:
  // The sites around a vertex that come first, and the record that stands for it.
  struct Key {
    discs::SiteIndex first, second, third;
    std::int32_t record;
    auto operator<=>(const Key&) const = default;
  };
  struct Found {
    std::vector<base::IndexPair> coincident;  // neighbors
    std::vector<std::int32_t> infinite;
  };

  std::int32_t& code(std::int32_t record) { return code_[static_cast<std::size_t>(record)]; }
  std::uint32_t& count_at(discs::SiteIndex first) { return begin_[static_cast<std::size_t>(first) + 2]; }

  bool is_unwanted(const discs::VoronoiRecord& v, std::span<const std::uint8_t> unwanted) const;
  void look_at(const discs::SegmentSites& sites, std::span<const std::uint8_t> unwanted, std::int32_t record,
               Found& found);
  void merge(const std::vector<Found>& found);
  std::int32_t root(std::int32_t record);
  void choose_leads();
  void gather_rings(unsigned threads, const base::Monitor& monitor);
  void gather_ring(std::int32_t record, std::vector<Spoke>& spokes) const;
  Spoke spoke_at(discs::Corner corner) const;
  void sort_by_first_site(unsigned threads, const base::Monitor& monitor);
  void sort_buckets(discs::SiteIndex first, discs::SiteIndex last);
  Key key_of(std::int32_t name) const;
  void number(unsigned threads, const base::Monitor& monitor);
  void make_starts();

  // Whether an edge leaves the place of its vertex, which shares it with others.
  bool is_border(discs::Corner corner) const {
    const std::int32_t record = discs::record_of(corner);
    const discs::Corner twin = records_[record].twins[static_cast<std::size_t>(discs::place_of(corner))];
    return code_[static_cast<std::size_t>(discs::record_of(twin))] != code_[static_cast<std::size_t>(record)];
  }

  const VoronoiRecords& records_;
  // [records] In the end the complement of the number of the vertex. Before, that of the first site; at a
  // place with several records, one of these, not negative, is the same for all.
  base::LargeArray<std::int32_t> code_;
  std::vector<bool> is_merged_;       // [records]
  std::vector<std::uint32_t> begin_;  // [sites + 2] where vertices begin, by their first sites
  // [vertices + 1] The record that stands for each vertex; in the end where its sites begin.
  base::LargeArray<std::int32_t> leads_;
  std::vector<std::int32_t> merged_leads_, infinite_;
  std::vector<std::uint32_t> ring_begin_;  // [merged_leads] among the rings of a piece of them
  std::vector<std::vector<Spoke>> rings_;  // [pieces of merged_leads]
};

}  // namespace vorotool::core::segment_voronoi::build
