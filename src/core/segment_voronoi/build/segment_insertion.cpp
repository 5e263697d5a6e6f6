#include "core/segment_voronoi/build/segment_insertion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/base/atomic_ref.hpp"
#include "core/numbers/double_double.hpp"
#include "core/numbers/sign.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"
#include "core/segment_voronoi/discs/tangent_disc.hpp"

namespace vorotool::core::segment_voronoi::build {

using discs::Corner;
using discs::corner_of;
using discs::following;
using discs::place_of;
using discs::record_of;
using discs::SiteIndex;
using discs::VoronoiRecord;
using numbers::unit_roundoff;

namespace {

// A float that is not less than a bound.
float rounded_up(double bound) { return static_cast<float>(bound * (1 + 0x1p-22)); }

template <class Real>
void put_disc(const discs::TangentDisc<Real>& disc, VoronoiRecord& record) {
  record.x = static_cast<double>(Real(static_cast<double>(disc.anchor.x)) + disc.x);
  record.y = static_cast<double>(Real(static_cast<double>(disc.anchor.y)) + disc.y);
  record.radius = static_cast<double>(disc.radius);
  // Every number is rounded once.
  const double size = std::abs(record.x) + std::abs(record.y) + record.radius;
  record.position_error = rounded_up(disc.position_error + 2 * unit_roundoff * size);
  record.radius_error = rounded_up(disc.radius_error + unit_roundoff * record.radius);
}

// Each number errs by at most 2^-52 of itself.
void put_disc(const discs::RoundedDisc& disc, VoronoiRecord& record) {
  record.x = disc.x;
  record.y = disc.y;
  record.radius = disc.radius;
  record.position_error = rounded_up(2 * unit_roundoff * (std::abs(disc.x) + std::abs(disc.y)));
  record.radius_error = rounded_up(2 * unit_roundoff * disc.radius);
}

// Where a disc is known worse than this, relative to its radius, its tests would fail too often: then more
// digits are taken at once. Nothing depends on the choice but speed.
constexpr double coarse = 0x1p-20;

// Sites from the one of the least number on: the exact level rounds what it finds from the first one, and
// which is first in a record depends on what was inserted before.
std::array<SiteIndex, 3> from_least(std::array<SiteIndex, 3> sites) {
  std::rotate(sites.begin(), std::ranges::min_element(sites), sites.end());
  return sites;
}

}  // namespace

void compute_disc(const discs::SegmentSites& sites, VoronoiRecord& record) {
  for (const SiteIndex site : record.sites) {
    if (site != sites.infinite()) continue;
    record.radius = std::numeric_limits<double>::infinity();
    return;
  }
  const auto disc = discs::tangent_disc<double>(sites, record.sites, record.left);
  if (disc.radius == 0 || disc.known_within(coarse)) return put_disc(disc, record);
  const auto finer = discs::tangent_disc<numbers::DoubleDouble>(sites, record.sites, record.left);
  if (finer.known_within(coarse)) return put_disc(finer, record);
  put_disc(discs::exact_disc_rounded(sites.triple(from_least(record.sites))), record);
}

// Whether this thread may look at a record. What others did to it before is visible then.
bool SegmentInsertion::take(std::int32_t record) {
  if (worker_ == 0) return true;
  const base::atomic_ref owner(records_[record].owner);
  std::uint16_t found = owner.load(std::memory_order_relaxed);
  if (found == worker_) return true;
  if (found != 0 || !owner.compare_exchange_strong(found, worker_, std::memory_order_acquire)) {
    hindered_ = true;
    return false;
  }
  taken_.push_back(record);
  return true;
}

void SegmentInsertion::give_back() {
  for (const std::int32_t record : taken_) {
    base::atomic_ref(records_[record].owner).store(0, std::memory_order_release);
  }
  taken_.clear();
}

// Of a record that is taken.
bool SegmentInsertion::is_in_conflict(std::int32_t record, const SegmentQuery& query) {
  VoronoiRecord& v = records_[record];
  ++visited_;
  const bool conflict = predicates_.in_conflict(v, query);
  v.stamp = 2 * number_ + conflict;
  return conflict;
}

// The same site's corner in the next vertex counter-clockwise around its cell.
Corner SegmentInsertion::turned(Corner corner) const {
  const auto side = static_cast<std::size_t>(following(place_of(corner)));
  const Corner across = records_[record_of(corner)].twins[side];
  return corner_of(record_of(across), following(place_of(across)));
}

// Whether a corner of an end is in conflict. A corner that was looked up may be that of the end no longer.
bool SegmentInsertion::is_found(Corner corner, SiteIndex end, const SegmentQuery& query) {
  const std::int32_t record = record_of(corner);
  if (!take(record)) return false;
  hindered_ |= records_[record].sites[static_cast<std::size_t>(place_of(corner))] != end;
  if (hindered_) return false;
  return has_stamp(record) ? has_conflict(record) : is_in_conflict(record, query);
}

// A vertex in conflict on the border of the cell of an end: there is one at each end. Both cells are walked
// around in turn, so that the smaller one decides how long it takes.
std::int32_t SegmentInsertion::find_first(const SegmentQuery& query) {
  Corner at_p = records_.corner_at(query.p), at_q = records_.corner_at(query.q);
  const Corner stop_p = at_p, stop_q = at_q;
  do {
    if (is_found(at_p, query.p, query)) return record_of(at_p);
    if (!hindered_ && is_found(at_q, query.q, query)) return record_of(at_q);
    if (hindered_) return -1;
    at_p = turned(at_p);
    at_q = turned(at_q);
  } while (at_p != stop_p && at_q != stop_q);
  throw std::logic_error("a segment takes no vertex from the cell of its end");
}

void SegmentInsertion::collect(std::int32_t first, const SegmentQuery& query) {
  conflicts_.assign(1, first);
  for (const Corner next : records_[first].twins) records_.prefetch(record_of(next));
  for (std::size_t k = 0; k < conflicts_.size(); ++k) {
    VoronoiRecord& v = records_[conflicts_[k]];
    v.survives = 0;
    for (const Corner twin : v.twins) {
      const std::int32_t other = record_of(twin);
      if (!take(other)) return;
      if (has_stamp(other) || !is_in_conflict(other, query)) continue;
      conflicts_.push_back(other);
      for (const Corner next : records_[other].twins) records_.prefetch(record_of(next));
    }
  }
}

// Edges with both ends in the conflict set that are not cut in their middle.
std::size_t SegmentInsertion::inner_edges() const {
  std::size_t halves = 0;
  for (const std::int32_t record : conflicts_) {
    const VoronoiRecord& v = records_[record];
    for (std::size_t i = 0; i < 3; ++i) {
      const bool inner = has_conflict(record_of(v.twins[i]));
      halves += inner && (v.survives >> i & 1) == 0;
    }
  }
  return halves / 2;
}

// The part of the diagram's edges inside the new cell is a tree: no cell is swallowed. Where the vertices in
// conflict close a cycle, some edges between them keep their middle.
void SegmentInsertion::cut_cycles(const SegmentQuery& query) {
  ++cyclic_;
  for (const std::int32_t record : conflicts_) {
    VoronoiRecord& u = records_[record];
    for (int i = 0; i < 3; ++i) {
      const Corner twin = u.twins[static_cast<std::size_t>(i)];
      VoronoiRecord& w = records_[record_of(twin)];
      const bool inner = has_conflict(record_of(twin));
      if (!inner || twin < corner_of(record, i)) continue;
      if (!predicates_.survives(u, i, w, query)) continue;
      u.survives |= static_cast<std::uint8_t>(1 << i);
      w.survives |= static_cast<std::uint8_t>(1 << place_of(twin));
    }
  }
  if (inner_edges() + 1 != conflicts_.size()) {
    throw std::logic_error("the vertices that a segment takes are not joined as a tree");
  }
}

// Goes around the tree counter-clockwise. A half-edge that keeps its middle receives the number of its cut.
void SegmentInsertion::gather_cuts() {
  cuts_.clear();
  Corner corner = corner_of(conflicts_[0], 0);
  std::size_t steps = 3 * conflicts_.size();
  for (; steps > 0; --steps) {
    VoronoiRecord& u = records_[record_of(corner)];
    const int i = place_of(corner), r = following(i), l = discs::preceding(i);
    const Corner twin = u.twins[static_cast<std::size_t>(i)];
    const bool inner = has_conflict(record_of(twin));
    if (inner && (u.survives >> i & 1) == 0) {
      corner = corner_of(record_of(twin), following(place_of(twin)));
      continue;
    }
    const auto sides = static_cast<std::uint8_t>(u.is_left(r) << 1 | u.is_left(l) << 2);
    if (inner) u.twins[static_cast<std::size_t>(i)] = static_cast<Corner>(cuts_.size());
    cuts_.push_back({twin, inner ? 0 : -1, u.sites[static_cast<std::size_t>(r)],
                     u.sites[static_cast<std::size_t>(l)], sides});
    corner = corner_of(record_of(corner), r);
  }
  if (corner != corner_of(conflicts_[0], 0) || cuts_.size() != conflicts_.size() + 2) {
    throw std::logic_error("the cell of a segment is not bounded by one cycle");
  }
}

// Before any record is written again.
void SegmentInsertion::pair_cuts() {
  for (Cut& cut : cuts_) {
    if (cut.partner < 0) continue;
    cut.partner = records_[record_of(cut.outer)].twins[static_cast<std::size_t>(place_of(cut.outer))];
  }
}

// The cut after which the cell of an end begins.
std::size_t SegmentInsertion::cut_at(SiteIndex end) const {
  for (std::size_t k = 0; k < cuts_.size(); ++k) {
    if (cuts_[k].left == end) return k;
  }
  throw std::logic_error("the cell of a segment does not meet that of its end");
}

std::int32_t SegmentInsertion::record_for(std::size_t cut) const {
  const std::size_t freed = conflicts_.size();
  return cut < freed ? conflicts_[cut] : fresh_ + static_cast<std::int32_t>(cut - freed);
}

// Vertex k lies on cut k; between it and vertex k + 1 the new cell borders on the left site of cut k. Going
// counter-clockwise the cell of p comes first, then what lies right of the segment, the cell of q, and what
// lies left.
void SegmentInsertion::replace(const SegmentQuery& query) {
  const std::size_t count = cuts_.size();
  const std::size_t at_p = cut_at(query.p), at_q = cut_at(query.q);
  for (const std::int32_t fresh : {fresh_, fresh_ + 1}) {
    records_[fresh].owner = worker_;
    if (worker_ != 0) taken_.push_back(fresh);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const bool is_right = at_p < at_q ? at_p < k && k <= at_q : at_p < k || k <= at_q;
    write(k, query.site, !is_right);
  }
  for (std::size_t k = 0; k < count; ++k) compute_disc(sites_, records_[record_for(k)]);
}

void SegmentInsertion::write(std::size_t k, SiteIndex segment, bool is_left) {
  const std::size_t count = cuts_.size();
  const Cut& cut = cuts_[k];
  const std::int32_t here = record_for(k);
  const std::int32_t after = record_for(k + 1 == count ? 0 : k + 1);
  const std::int32_t before = record_for(k == 0 ? count - 1 : k - 1);
  VoronoiRecord& v = records_[here];
  // The rest of an edge that is cut at both ends leads to another new vertex.
  const Corner outer =
      cut.partner < 0 ? cut.outer : corner_of(record_for(static_cast<std::size_t>(cut.partner)), 0);
  v.sites = {segment, cut.right, cut.left};
  v.twins = {outer, corner_of(after, 2), corner_of(before, 1)};
  v.left = static_cast<std::uint8_t>(cut.is_left | (is_left ? 1 : 0));
  v.stamp = 2 * number_;
  if (cut.partner < 0) {
    records_[record_of(outer)].twins[static_cast<std::size_t>(place_of(outer))] = corner_of(here, 0);
  }
  for (const int i : {1, 2}) {
    const SiteIndex site = v.sites[static_cast<std::size_t>(i)];
    if (sites_.is_point(site)) records_.set_corner(site, corner_of(here, i));
  }
}

bool SegmentInsertion::insert(SiteIndex segment, std::int32_t number, std::int32_t fresh) {
  const SegmentQuery query(sites_, segment);
  number_ = number;
  fresh_ = fresh;
  hindered_ = false;
  const std::int32_t first = find_first(query);
  if (!hindered_) collect(first, query);
  if (!hindered_) {
    if (inner_edges() + 1 != conflicts_.size()) cut_cycles(query);
    gather_cuts();
    pair_cuts();
    replace(query);
  }
  give_back();
  return !hindered_;
}

}  // namespace vorotool::core::segment_voronoi::build
