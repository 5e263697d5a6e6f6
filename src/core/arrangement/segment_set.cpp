#include "core/arrangement/segment_set.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/arrangement/coordinate_compression.hpp"
#include "core/base/groups.hpp"
#include "core/base/radix_sort.hpp"

namespace vorotool::core::arrangement {

using kernel::LatticePoint;

SortedPoints sort_points(std::span<const LatticePoint> points, const base::Monitor& monitor) {
  const CoordinateCompression columns(points, &LatticePoint::x), rows(points, &LatticePoint::y);
  std::vector<base::Keyed> keyed;
  keyed.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint64_t column = columns.of(points[i].x);
    keyed.push_back({column << rows.bits() | rows.of(points[i].y), static_cast<std::uint32_t>(i)});
  }
  base::radix_sort(keyed,
                   columns.bits() + rows.bits());  // stable: of equal points the smallest index comes first
  base::report(monitor, 0);
  SortedPoints result;
  result.rank.resize(points.size());
  result.points.reserve(points.size());
  result.first.reserve(points.size());
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    if (i == 0 || keyed[i].key != keyed[i - 1].key) {
      result.points.push_back(points[keyed[i].value]);
      result.first.push_back(static_cast<std::int32_t>(keyed[i].value));
    }
    result.rank[keyed[i].value] = static_cast<std::int32_t>(result.points.size()) - 1;
  }
  return result;
}

std::vector<std::int32_t> first_at_place(std::span<const LatticePoint> points, const base::Monitor& monitor) {
  const CoordinateCompression columns(points, &LatticePoint::x), rows(points, &LatticePoint::y);
  const int index_bits = static_cast<int>(std::bit_width(points.size()));
  const int bits = index_bits + columns.bits() + rows.bits();
  if (bits <= 64) {  // a word holds place and index
    std::vector<std::uint64_t> words;
    words.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::uint64_t column = columns.of(points[i].x);
      words.push_back((column << rows.bits() | rows.of(points[i].y)) << index_bits | i);
    }
    base::radix_sort(words, index_bits, bits);
    base::report(monitor, 0);
    std::vector<std::int32_t> result(points.size());
    const std::uint64_t index_mask = (std::uint64_t{1} << index_bits) - 1;
    std::uint64_t first = words.empty() ? 0 : words.front();
    for (const std::uint64_t word : words) {
      if ((word ^ first) > index_mask) first = word;
      result[word & index_mask] = static_cast<std::int32_t>(first & index_mask);
    }
    return result;
  }
  SortedPoints sorted = sort_points(points, monitor);
  for (std::int32_t& each : sorted.rank) each = sorted.first[static_cast<std::size_t>(each)];
  return std::move(sorted.rank);
}

namespace {}  // namespace

SegmentSet join_links(std::vector<LatticePoint> points, std::vector<Link> links) {
  SegmentSet set;
  set.points = std::move(points);
  const auto point = [&](std::int32_t i) { return set.points[static_cast<std::size_t>(i)]; };
  base::Groups<Link> by_lower_end(set.points.size(), [&](const auto& add) {
    for (const Link& link : links) add(link.lower, link);
  });
  set.start.reserve(set.points.size() + 1);
  set.lower_end.reserve(links.size());
  set.upper_end.reserve(links.size());
  set.source_start.reserve(links.size() + 1);
  set.source.reserve(links.size());
  for (std::size_t i = 0; i < set.points.size(); ++i) {
    set.start.push_back(static_cast<std::int32_t>(set.lower_end.size()));
    const std::span<Link> own = by_lower_end[i];
    std::sort(own.begin(), own.end(), [&](const Link& a, const Link& b) {
      if (a.upper == b.upper) return a.source < b.source;
      const std::int64_t area = turn(set.points[i], point(a.upper), point(b.upper));
      return area != 0 ? area > 0 : a.upper < b.upper;
    });
    for (auto link = own.begin(); link != own.end(); ++link) {
      if (link == own.begin() || link->upper != std::prev(link)->upper) {
        set.lower_end.push_back(link->lower);
        set.upper_end.push_back(link->upper);
        set.source_start.push_back(static_cast<std::int32_t>(set.source.size()));
      }
      set.source.push_back(link->source);
    }
  }
  set.start.push_back(static_cast<std::int32_t>(set.lower_end.size()));
  set.source_start.push_back(static_cast<std::int32_t>(set.source.size()));
  return set;
}

}  // namespace vorotool::core::arrangement
