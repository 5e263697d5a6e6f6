// Inserts all segments of a diagram, round after round, on several threads.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/segment_voronoi/build/brio.hpp"
#include "core/segment_voronoi/build/segment_insertion.hpp"
#include "core/segment_voronoi/discs/sites.hpp"

namespace vorotool::core::segment_voronoi::build {

// Counts of the work; with several threads they depend on how these met.
struct SegmentVoronoiCounts {
  std::int64_t visited = 0;  // vertices tested while segments were inserted
  std::int64_t cyclic = 0;   // segments whose vertices in conflict closed a cycle
  EscalationCounts escalations;
};

class ParallelInsertion {
 public:
  ParallelInsertion(const discs::SegmentSites& sites, VoronoiRecords& records, unsigned threads);

  void run(const base::Monitor& monitor);
  SegmentVoronoiCounts counts() const;

 private:
  using Places = std::vector<std::int32_t>;

  bool insert(SegmentInsertion& worker, std::int32_t place) const;
  void insert_alone(const Places& places, const base::Monitor& monitor);
  void insert_together(std::size_t begin, std::size_t end, const base::Monitor& monitor);
  SegmentInsertion& take_worker();

  const discs::SegmentSites& sites_;
  VoronoiRecords& records_;
  unsigned threads_;
  Brio order_;
  SegmentInsertion alone_;
  std::mutex mutex_;  // of what follows
  std::vector<std::unique_ptr<SegmentInsertion>> workers_;
  std::vector<SegmentInsertion*> idle_;
};

}  // namespace vorotool::core::segment_voronoi::build
