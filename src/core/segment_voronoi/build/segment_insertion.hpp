// Inserts open segments into a Voronoi diagram of points and segments, one after the other or on several
// threads at once.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "core/base/atomic_ref.hpp"
#include "core/base/large_array.hpp"
#include "core/segment_voronoi/build/insertion_predicates.hpp"
#include "core/segment_voronoi/discs/records.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::build {

// The vertices of a diagram: first those of the points alone, then room for two more for each segment. All
// are in use when all segments are. Both follow the order of the sites. A point's cell is found by one of its
// corners.
struct VoronoiRecords {
  VoronoiRecords(std::size_t points, std::size_t segments)
      : of_points(points < 2 ? 0 : 2 * points - 2), all(of_points + 2 * segments), corner_of_point(points) {}

  discs::VoronoiRecord& operator[](std::int32_t record) { return all[static_cast<std::size_t>(record)]; }
  const discs::VoronoiRecord& operator[](std::int32_t record) const {
    return all[static_cast<std::size_t>(record)];
  }

  // Tells the processor that a record will be looked at soon.
  void prefetch(std::int32_t record) const { __builtin_prefetch(&all[static_cast<std::size_t>(record)]); }

  // A corner of a point's cell. Threads that share the diagram see a record no later than its corner.
  discs::Corner corner_at(discs::SiteIndex point) {
    return base::atomic_ref(corner_of_point[static_cast<std::size_t>(point)]).load(std::memory_order_acquire);
  }
  void set_corner(discs::SiteIndex point, discs::Corner corner) {
    base::atomic_ref(corner_of_point[static_cast<std::size_t>(point)])
        .store(corner, std::memory_order_release);
  }

  std::size_t of_points;
  base::LargeArray<discs::VoronoiRecord> all;
  std::vector<discs::Corner> corner_of_point;  // [points]
};

// Computes center, radius and bounds of errors of a record from its sites.
void compute_disc(const discs::SegmentSites& sites, discs::VoronoiRecord& record);

// Threads share a diagram so: a thread takes each record before it looks at it, gives all back after an
// insertion, and gives up at once where another thread has a record. What an insertion changes are the
// vertices in conflict and the links of those beside them, all of which it has looked at.
class SegmentInsertion {
 public:
  // Worker 0 works alone; others have numbers of their own.
  SegmentInsertion(const discs::SegmentSites& sites, VoronoiRecords& records, std::uint16_t worker = 0)
      : sites_(sites), records_(records), predicates_(sites), worker_(worker) {}

  // Every attempt has a number of its own, from 1; two records from `fresh` on are those of the segment.
  // Returns false, with nothing changed, if another thread is in the way.
  bool insert(discs::SiteIndex segment, std::int32_t number, std::int32_t fresh);

  // Tells the processor that a segment will be inserted soon.
  void prefetch(discs::SiteIndex segment) const {
    for (const discs::SiteIndex end : sites_.segment(segment).ends) {
      records_.prefetch(discs::record_of(records_.corner_at(end)));
    }
  }

  std::int64_t visited() const { return visited_; }
  std::int64_t cyclic() const { return cyclic_; }
  const EscalationCounts& escalations() const { return predicates_.counts(); }

 private:
  // An edge on the border of the conflict set, from the side of the set. Counter-clockwise around it the cell
  // of the right site comes before the edge and that of the left one after it.
  struct Cut {
    discs::Corner outer;   // opposite to the edge in its other vertex
    std::int32_t partner;  // the other cut of an edge that keeps its middle, else -1
    discs::SiteIndex right, left;
    std::uint8_t is_left;  // bit 1: the disc is left of segment `right`, bit 2: left of segment `left`
  };

  bool take(std::int32_t record);
  void give_back();
  bool is_in_conflict(std::int32_t record, const SegmentQuery& query);
  bool has_stamp(std::int32_t record) const { return records_[record].stamp >> 1 == number_; }
  bool has_conflict(std::int32_t record) const { return records_[record].stamp == 2 * number_ + 1; }
  std::int32_t find_first(const SegmentQuery& query);
  bool is_found(discs::Corner corner, discs::SiteIndex end, const SegmentQuery& query);
  discs::Corner turned(discs::Corner corner) const;
  void collect(std::int32_t first, const SegmentQuery& query);
  std::size_t inner_edges() const;
  void cut_cycles(const SegmentQuery& query);
  void gather_cuts();
  void pair_cuts();
  std::size_t cut_at(discs::SiteIndex end) const;
  void replace(const SegmentQuery& query);
  std::int32_t record_for(std::size_t cut) const;
  void write(std::size_t cut, discs::SiteIndex segment, bool is_left);

  const discs::SegmentSites& sites_;
  VoronoiRecords& records_;
  InsertionPredicates predicates_;
  std::uint16_t worker_;
  std::int32_t number_ = 0;          // of the attempt
  std::int32_t fresh_ = 0;           // the first of two records that it may begin
  bool hindered_ = false;            // by another thread
  std::vector<std::int32_t> taken_;  // records that others may not look at
  std::int64_t visited_ = 0, cyclic_ = 0;
  std::vector<std::int32_t> conflicts_;
  std::vector<Cut> cuts_;
};

}  // namespace vorotool::core::segment_voronoi::build
