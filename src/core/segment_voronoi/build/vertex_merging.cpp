#include "core/segment_voronoi/build/vertex_merging.hpp"

#include <atomic>
#include <numeric>

#include "core/base/atomic_ref.hpp"
#include "core/base/parallel.hpp"
#include "core/segment_voronoi/build/coincident_vertices.hpp"
#include "core/segment_voronoi/build/wanted_faces.hpp"

namespace vorotool::core::segment_voronoi::build {

using base::Monitor;
using base::piece_count;
using discs::Corner;
using discs::corner_of;
using discs::place_of;
using discs::record_of;
using discs::SiteIndex;
using discs::VoronoiRecord;

namespace {

constexpr std::size_t vertices_a_piece = std::size_t{1} << 13;  // items of a piece of work, some ms
constexpr std::size_t items_ahead = 8;                          // items: how early others are called for

std::uint32_t add(std::uint32_t& counter, std::uint32_t value) {
  return base::atomic_ref(counter).fetch_add(value, std::memory_order_relaxed);
}

void prefetch_neighbors(const VoronoiRecords& records, std::int32_t record) {
  for (const Corner twin : records[record].twins) records.prefetch(record_of(twin));
}

}  // namespace

VertexMerging::VertexMerging(const discs::SegmentSites& sites, const VoronoiRecords& records,
                             std::span<const std::uint8_t> unwanted, unsigned threads, const Monitor& monitor)
    : records_(records),
      code_(records.all.size()),
      is_merged_(records.all.size()),
      begin_(static_cast<std::size_t>(sites.infinite()) + 2) {
  std::vector<Found> found(piece_count(code_.size(), vertices_a_piece));
  const auto look = [&](std::size_t piece, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      look_at(sites, unwanted, static_cast<std::int32_t>(v), found[piece]);
  };
  base::for_pieces(code_.size(), vertices_a_piece, threads, monitor, look);
  for (const Found& some : found)
    infinite_.insert(infinite_.end(), some.infinite.begin(), some.infinite.end());
  merge(found);
  found = std::vector<Found>();
  choose_leads();
  gather_rings(threads, monitor);
}

void VertexMerging::assign(unsigned threads, const Monitor& monitor) {
  sort_by_first_site(threads, monitor);
  number(threads, monitor);
  make_starts();
}

// Its disc, if it has a radius, is in the face of each site on that side.
bool VertexMerging::is_unwanted(const VoronoiRecord& v, std::span<const std::uint8_t> unwanted) const {
  if (unwanted.empty() || v.radius == 0) return false;
  for (int i = 0; i < 3; ++i) {
    const auto site = static_cast<std::size_t>(v.sites[static_cast<std::size_t>(i)]);
    if ((unwanted[site] & (v.is_left(i) ? unwanted_left : unwanted_right)) != 0) return true;
  }
  return false;
}

// As if it were alone at its place. Where points have cells without area, a record of these alone may be not
// unwanted while others at its place are: then it stays alone, outside.
void VertexMerging::look_at(const discs::SegmentSites& sites, std::span<const std::uint8_t> unwanted,
                            std::int32_t u, Found& found) {
  if (static_cast<std::size_t>(u) + items_ahead < code_.size()) {
    prefetch_neighbors(records_, u + static_cast<std::int32_t>(items_ahead));
  }
  const VoronoiRecord& v = records_[u];
  if (v.is_infinite()) {
    code(u) = ~at_infinity;
    found.infinite.push_back(u);
    return;
  }
  if (is_unwanted(v, unwanted)) {
    code(u) = ~left_out;
    return;
  }
  const SiteIndex first = *std::min_element(v.sites.begin(), v.sites.end());
  code(u) = ~first;
  add(count_at(first), 1);
  for (int i = 0; i < 3; ++i) {
    const std::int32_t w = record_of(v.twins[static_cast<std::size_t>(i)]);
    if (w < u || records_[w].is_infinite() || is_unwanted(records_[w], unwanted)) continue;
    if (are_coincident(sites, v, i, records_[w])) found.coincident.push_back({u, w});
  }
}

// The smallest number at a place becomes that of the place. With every step to it the way is halved for those
// who come after.
std::int32_t VertexMerging::root(std::int32_t record) {
  if (code(record) < 0) {
    --count_at(~code(record));
    code(record) = record;
    is_merged_[static_cast<std::size_t>(record)] = true;
  }
  while (code(record) != record) {
    code(record) = code(code(record));
    record = code(record);
  }
  return record;
}

void VertexMerging::merge(const std::vector<Found>& found) {
  for (const Found& some : found) {
    for (const auto& [u, w] : some.coincident) {
      const std::int32_t one = root(u), other = root(w);
      code(std::max(one, other)) = std::min(one, other);
    }
  }
  for (const Found& some : found) {
    for (const auto& [u, w] : some.coincident) {
      code(u) = root(u);
      code(w) = root(w);
    }
  }
}

// The border of a place is gone round counter-clockwise: from half-edge to half-edge of one vertex, and on in
// the next vertex of the place where a half-edge has no length. A point whose segments leave no gap of 180
// degrees is inside.
void VertexMerging::gather_ring(std::int32_t record, std::vector<Spoke>& spokes) const {
  const auto begin = static_cast<std::ptrdiff_t>(spokes.size());
  Corner corner = corner_of(record, 0);
  while (!is_border(corner)) ++corner;
  const Corner first = corner;
  do {
    spokes.push_back(spoke_at(corner));
    for (;;) {
      const std::int32_t here = record_of(corner);
      corner = corner_of(here, discs::following(place_of(corner)));
      if (is_border(corner)) break;
      corner = records_[here].twins[static_cast<std::size_t>(place_of(corner))];
    }
  } while (corner != first);
  const auto least = std::min_element(spokes.begin() + begin, spokes.end(),
                                      [](const Spoke& a, const Spoke& b) { return a.site < b.site; });
  std::rotate(spokes.begin() + begin, least, spokes.end());
}

// The edge opposite to a corner, and the site on its left.
VertexMerging::Spoke VertexMerging::spoke_at(Corner corner) const {
  const VoronoiRecord& v = records_[record_of(corner)];
  const int left = discs::preceding(place_of(corner));
  return {static_cast<std::uint32_t>(v.sites[static_cast<std::size_t>(left)]), v.is_left(left),
          record_of(v.twins[static_cast<std::size_t>(place_of(corner))])};
}

std::span<const VertexMerging::Spoke> VertexMerging::merged_ring(std::size_t k) const {
  const std::span<const Spoke> rings = rings_[k / vertices_a_piece];
  const bool is_last = k + 1 == ring_begin_.size() || (k + 1) % vertices_a_piece == 0;
  return rings.subspan(ring_begin_[k], (is_last ? rings.size() : ring_begin_[k + 1]) - ring_begin_[k]);
}

// The first record of each place that is on its border.
void VertexMerging::choose_leads() {
  std::vector<bool> seen(code_.size());
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(code_.size()); ++v) {
    if (!is_merged(v) || seen[static_cast<std::size_t>(code(v))]) continue;
    const auto is_border = [&](int i) { return this->is_border(corner_of(v, i)); };
    if (!is_border(0) && !is_border(1) && !is_border(2)) continue;
    seen[static_cast<std::size_t>(code(v))] = true;
    merged_leads_.push_back(v);
  }
}

void VertexMerging::gather_rings(unsigned threads, const Monitor& monitor) {
  ring_begin_.resize(merged_leads_.size());
  rings_.resize(piece_count(merged_leads_.size(), vertices_a_piece));
  const auto gather = [&](std::size_t piece, std::size_t begin, std::size_t end) {
    std::vector<Spoke> spokes;
    for (std::size_t k = begin; k < end; ++k) {
      if (k + items_ahead < merged_leads_.size())
        prefetch_neighbors(records_, merged_leads_[k + items_ahead]);
      ring_begin_[k] = static_cast<std::uint32_t>(spokes.size());
      gather_ring(merged_leads_[k], spokes);
      add(count_at(static_cast<SiteIndex>(spokes[ring_begin_[k]].site)), 1);
    }
    rings_[piece].assign(spokes.begin(), spokes.end());  // no more memory than it takes
  };
  base::for_pieces(merged_leads_.size(), vertices_a_piece, threads, monitor, gather);
}

// By the first site in one go, and by the others among the few that share it. No two have the same three
// sites first, in the same order. Keys of several records are named by the complements of their numbers.
void VertexMerging::sort_by_first_site(unsigned threads, const Monitor& monitor) {
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  leads_ = base::LargeArray<std::int32_t>(begin_.back() + 1);
  const auto put = [&](std::int32_t name, SiteIndex first) {
    leads_[add(begin_[static_cast<std::size_t>(first) + 1], 1)] = name;
  };
  base::for_items(code_.size(), vertices_a_piece, threads, monitor, [&](std::size_t i) {
    const auto v = static_cast<std::int32_t>(i);
    if (code(v) < 0 && ~code(v) < left_out) put(v, ~code(v));
  });
  base::for_items(merged_leads_.size(), vertices_a_piece, threads, monitor, [&](std::size_t i) {
    const std::int32_t name = ~static_cast<std::int32_t>(i);
    put(name, key_of(name).first);
  });
  const auto sort = [&](std::size_t, std::size_t begin, std::size_t end) {
    sort_buckets(static_cast<SiteIndex>(begin), static_cast<SiteIndex>(end));
  };
  base::for_pieces(begin_.size() - 2, vertices_a_piece, threads, monitor, sort);
  begin_ = std::vector<std::uint32_t>();
}

VertexMerging::Key VertexMerging::key_of(std::int32_t name) const {
  if (name < 0) {
    const auto k = static_cast<std::size_t>(~name);
    const auto ring = merged_ring(k);
    const auto site = [&](std::size_t i) { return static_cast<SiteIndex>(ring[i].site); };
    return {site(0), site(1), site(2), merged_leads_[k]};
  }
  const std::array<SiteIndex, 3>& sites = records_[name].sites;
  const auto i = static_cast<int>(std::min_element(sites.begin(), sites.end()) - sites.begin());
  return {sites[static_cast<std::size_t>(i)], sites[static_cast<std::size_t>(discs::following(i))],
          sites[static_cast<std::size_t>(discs::preceding(i))], name};
}

// Vertices whose first sites are first ... last - 1. Their records are far apart in memory: they are called
// for early.
void VertexMerging::sort_buckets(SiteIndex first, SiteIndex last) {
  std::vector<Key> keys;
  std::size_t k = begin_[static_cast<std::size_t>(first)], called = k;
  const std::size_t all = begin_[static_cast<std::size_t>(last)];
  for (SiteIndex site = first; site < last; ++site) {
    const std::size_t begin = k, end = begin_[static_cast<std::size_t>(site) + 1];
    for (; called < std::min(all, end + items_ahead); ++called) {
      if (leads_[called] >= 0) records_.prefetch(leads_[called]);
    }
    keys.clear();
    for (; k < end; ++k) keys.push_back(key_of(leads_[k]));
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 0; i < keys.size(); ++i) leads_[begin + i] = keys[i].record;
  }
}

// First one record of each place, then the others.
void VertexMerging::number(unsigned threads, const Monitor& monitor) {
  base::for_items(leads_.size() - 1, vertices_a_piece, threads, monitor, [&](std::size_t k) {
    const std::int32_t lead = leads_[k];
    code(is_merged(lead) ? code(lead) : lead) = ~static_cast<std::int32_t>(k);
  });
  base::for_items(merged_leads_.empty() ? 0 : code_.size(), vertices_a_piece, threads, monitor,
                  [&](std::size_t i) {
                    const auto v = static_cast<std::int32_t>(i);
                    if (code(v) >= 0) code(v) = code(code(v));
                  });
}

// Of three sites each, but for places with several records.
void VertexMerging::make_starts() {
  std::fill_n(leads_.data(), leads_.size(), 3);
  for (std::size_t k = 0; k < merged_leads_.size(); ++k) {
    leads_[static_cast<std::size_t>(of(merged_leads_[k]))] = static_cast<std::int32_t>(merged_ring(k).size());
  }
  std::exclusive_scan(leads_.data(), leads_.data() + leads_.size(), leads_.data(), 0);
}

}  // namespace vorotool::core::segment_voronoi::build
