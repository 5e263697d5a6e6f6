// Inserts open segments into a Voronoi diagram of points and segments, one after the other.
#pragma once

#include <cstdint>
#include <vector>

#include "core/large_array.hpp"
#include "core/segment_predicates.hpp"
#include "core/segment_sites.hpp"
#include "core/voronoi_records.hpp"

namespace vorotool::core {

// The vertices of a diagram, in an array with room for all that are to come; a point's cell is found by one of
// its corners.
struct VoronoiRecords {
  explicit VoronoiRecords(std::size_t room, std::size_t points) : all(room), corner_of_point(points) {}

  VoronoiRecord& operator[](std::int32_t record) { return all[static_cast<std::size_t>(record)]; }
  const VoronoiRecord& operator[](std::int32_t record) const { return all[static_cast<std::size_t>(record)]; }

  LargeArray<VoronoiRecord> all;
  std::int32_t size = 0;                // records in use, the first ones
  std::vector<Corner> corner_of_point;  // [points]
};

// Computes centre, radius and bounds of errors of a record from its sites.
void compute_disc(const SegmentSites& sites, VoronoiRecord& record);

class SegmentInsertion {
 public:
  SegmentInsertion(const SegmentSites& sites, VoronoiRecords& records)
      : sites_(sites), records_(records), predicates_(sites) {}

  void insert(SiteIndex segment);

  std::int64_t visited() const { return visited_; }
  std::int64_t cyclic() const { return cyclic_; }
  const EscalationCounts& escalations() const { return predicates_.counts(); }

 private:
  // An edge on the border of the conflict set, from the side of the set. Counter-clockwise around it the cell
  // of the right site comes before the edge and that of the left one after it.
  struct Cut {
    Corner outer;  // opposite to the edge in its other vertex
    std::int32_t partner;  // the other cut of an edge that keeps its middle, else -1
    SiteIndex right, left;
    std::uint8_t is_left;  // bit 1: the disc is left of segment `right`, bit 2: left of segment `left`
  };

  bool is_in_conflict(std::int32_t record, const SegmentQuery& query);
  std::int32_t find_first(const SegmentQuery& query);
  Corner turned(Corner corner) const;
  void collect(std::int32_t first, const SegmentQuery& query);
  std::size_t inner_edges() const;
  void cut_cycles(const SegmentQuery& query);
  void gather_cuts();
  void pair_cuts();
  std::size_t cut_at(SiteIndex end) const;
  void replace(const SegmentQuery& query);
  std::int32_t record_for(std::size_t cut) const;
  void write(std::size_t cut, SiteIndex segment, bool is_left);

  const SegmentSites& sites_;
  VoronoiRecords& records_;
  SegmentPredicates predicates_;
  std::int32_t number_ = 0;  // insertions so far
  std::int64_t visited_ = 0, cyclic_ = 0;
  std::vector<std::int32_t> conflicts_;
  std::vector<Cut> cuts_;
};

}  // namespace vorotool::core
