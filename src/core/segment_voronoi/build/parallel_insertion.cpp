#include "core/segment_voronoi/build/parallel_insertion.hpp"

#include <algorithm>
#include <numeric>

#include "core/base/parallel.hpp"

namespace vorotool::core::segment_voronoi::build {

using base::Monitor;

namespace {

constexpr std::size_t insertions_a_piece = 512;  // insertions of a piece of work, some ms
// Shorter rounds are not worth sharing: threads would often be in each other's way.
constexpr std::size_t pieces_to_share = 16;
constexpr std::int32_t insertions_ahead = 3;  // insertions: how early memory is called for

}  // namespace

ParallelInsertion::ParallelInsertion(const discs::SegmentSites& sites, VoronoiRecords& records,
                                     unsigned threads)
    : sites_(sites),
      records_(records),
      threads_(base::resolve_threads(threads)),
      order_(make_brio(sites.segment_count())),
      alone_(sites, records) {}

void ParallelInsertion::run(const Monitor& monitor) {
  for (std::size_t r = 0; r + 1 < order_.begin.size(); ++r) {
    const std::size_t begin = order_.begin[r], end = order_.begin[r + 1];
    if (threads_ > 1 && end - begin >= pieces_to_share * insertions_a_piece) {
      insert_together(begin, end, monitor);
    } else {
      Places places(end - begin);
      std::iota(places.begin(), places.end(), static_cast<std::int32_t>(begin));
      insert_alone(places, monitor);
    }
  }
}

// There are at most two attempts for each place: their numbers, and the stamps made of them, fit in 31 bits.
bool ParallelInsertion::insert(SegmentInsertion& worker, std::int32_t place) const {
  const auto first_segment = static_cast<discs::SiteIndex>(sites_.point_count());
  const auto count = static_cast<std::int32_t>(order_.items.size());
  const auto item = [&](std::int32_t k) { return order_.items[static_cast<std::size_t>(k)]; };
  if (place + insertions_ahead < count) worker.prefetch(first_segment + item(place + insertions_ahead));
  const std::int32_t number = 1 + place + (&worker == &alone_ ? count : 0);
  const auto fresh = static_cast<std::int32_t>(records_.of_points) + 2 * item(place);
  return worker.insert(first_segment + item(place), number, fresh);
}

void ParallelInsertion::insert_alone(const Places& places, const Monitor& monitor) {
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double done = static_cast<double>(places[k]) / static_cast<double>(order_.items.size());
    if (k % (insertions_a_piece / 2) == 0) base::report(monitor, done);
    insert(alone_, places[k]);
  }
}

// A piece is a stretch of the curve. Segments that are in the way of another thread are left to the end.
void ParallelInsertion::insert_together(std::size_t begin, std::size_t end, const Monitor& monitor) {
  std::vector<Places> left(base::piece_count(end - begin, insertions_a_piece));
  const auto insert_piece = [&](std::size_t piece) {
    SegmentInsertion& worker = take_worker();
    const std::size_t first = begin + piece * insertions_a_piece;
    for (std::size_t k = first; k < std::min(end, first + insertions_a_piece); ++k) {
      const auto place = static_cast<std::int32_t>(k);
      if (!insert(worker, place)) left[piece].push_back(place);
    }
    const std::lock_guard lock(mutex_);
    idle_.push_back(&worker);
  };
  base::parallel_for(left.size(), threads_, insert_piece, monitor);
  for (const Places& places : left) insert_alone(places, monitor);
}

SegmentInsertion& ParallelInsertion::take_worker() {
  const std::lock_guard lock(mutex_);
  if (idle_.empty()) {
    const auto number = static_cast<std::uint16_t>(workers_.size() + 1);
    workers_.push_back(std::make_unique<SegmentInsertion>(sites_, records_, number));
    return *workers_.back();
  }
  SegmentInsertion& worker = *idle_.back();
  idle_.pop_back();
  return worker;
}

SegmentVoronoiCounts ParallelInsertion::counts() const {
  SegmentVoronoiCounts sum;
  const auto add = [&](const SegmentInsertion& worker) {
    sum.visited += worker.visited();
    sum.cyclic += worker.cyclic();
    sum.escalations += worker.escalations();
  };
  add(alone_);
  for (const auto& worker : workers_) add(*worker);
  return sum;
}

}  // namespace vorotool::core::segment_voronoi::build
