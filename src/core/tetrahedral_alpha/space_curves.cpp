#include "core/tetrahedral_alpha/space_curves.hpp"

#include <algorithm>
#include <vector>

#include "core/base/disjoint_sets.hpp"
#include "core/base/groups.hpp"
#include "core/numbers/long_sum.hpp"

namespace vorotool::core::tetrahedral_alpha {

using base::at;
using base::DisjointSets;
using base::LargeArray;
using base::Monitor;
using numbers::LongSum;

namespace {

class SpaceSweep {
 public:
  SpaceSweep(const SpaceCurveInput& input, const Monitor& monitor)
      : in_(input),
        m_(input.spectrum),
        monitor_(monitor),
        out_{LargeArray<double>(m_), LargeArray<double>(m_), LargeArray<std::int32_t>(m_),
             LargeArray<std::int32_t>(m_), LargeArray<std::int32_t>(m_)},
        arrivals_(m_ + 1) {
    for (const std::int32_t rank : in_.tetrahedron_rank) ++arrivals_[at(rank)];
  }

  SpaceCurves run() {
    measure();
    count_regions();
    count_parts();
    count_cavities();
    return std::move(out_);
  }

 private:
  std::int32_t rank_of(std::int32_t tetrahedron) const {
    return tetrahedron < 0 ? static_cast<std::int32_t>(m_) : in_.tetrahedron_rank[at(tetrahedron)];
  }

  void measure() {
    std::vector<LongSum> volume(m_ + 1), area(m_ + 1);
    for (std::size_t t = 0; t < in_.volume.size(); ++t)
      volume[at(in_.tetrahedron_rank[t])].add(in_.volume[t]);
    for (std::size_t m = 0; m < in_.sides.size(); ++m) {
      const auto [low, high] = std::minmax({rank_of(in_.sides[m][0]), rank_of(in_.sides[m][1])});
      area[at(low)].add(in_.area[m]);
      area[at(high)].add(-in_.area[m]);
    }
    LongSum volumes, areas;
    for (std::size_t k = 0; k < m_; ++k) {
      base::report_item(monitor_, k, 4 * m_);
      volumes.add(volume[k]);
      areas.add(area[k]);
      out_.volume[k] = volumes.value.head;
      out_.area[k] = areas.value.head;
    }
  }

  // Simplices by rank, of which the last is that of those that never come.
  template <class RankOf>
  base::Groups<std::uint32_t> by_rank(std::size_t count, const RankOf& rank) const {
    return {m_ + 1, [&](const auto& add) {
              for (std::size_t i = 0; i < count; ++i) add(rank(i), static_cast<std::uint32_t>(i));
            }};
  }

  // What is on both sides of a triangle: 0 is all outside, t + 1 a tetrahedron.
  bool join(DisjointSets<>& cells, std::size_t triangle) const {
    const auto [t, u] = in_.sides[triangle];
    return cells.join(static_cast<std::uint32_t>(t + 1), static_cast<std::uint32_t>(u + 1));
  }

  // Upwards: a tetrahedron is a new region, and a triangle that goes inside may join two.
  void count_regions() {
    const auto triangles = by_rank(in_.sides.size(), [&](std::size_t m) {
      return std::max(rank_of(in_.sides[m][0]), rank_of(in_.sides[m][1]));
    });
    DisjointSets cells(in_.tetrahedron_rank.size() + 1);
    std::int32_t regions = 0;
    for (std::size_t k = 0; k < m_; ++k) {
      base::report_item(monitor_, m_ + k, 4 * m_);
      regions += arrivals_[k];
      for (const std::uint32_t m : triangles[k]) regions -= join(cells, m);
      out_.regions[k] = regions;
    }
  }

  // Upwards: all points are there, and an edge that comes may join two parts.
  void count_parts() {
    const auto edges = by_rank(in_.edges.size(), [&](std::size_t e) { return in_.edge_min[e]; });
    std::int32_t last = -1;
    for (const auto& [a, b] : in_.edges) last = std::max({last, a, b});
    DisjointSets points(at(last + 1));
    auto parts = static_cast<std::int32_t>(in_.points);
    for (std::size_t k = 0; k < m_; ++k) {
      base::report_item(monitor_, 2 * m_ + k, 4 * m_);
      for (const std::uint32_t e : edges[k])
        parts -= points.join(static_cast<std::uint32_t>(in_.edges[e][0]),
                             static_cast<std::uint32_t>(in_.edges[e][1]));
      out_.parts[k] = parts;
    }
  }

  // Downwards: a tetrahedron that leaves is a new cavity, and a triangle that leaves joins what is on both its sides;
  // what is outside counts for nothing.
  void count_cavities() {
    const auto triangles = by_rank(in_.sides.size(), [&](std::size_t m) { return in_.triangle_min[m]; });
    DisjointSets cells(in_.tetrahedron_rank.size() + 1);
    std::int32_t cavities = 0;
    for (std::size_t k = m_; k-- > 0;) {
      base::report_item(monitor_, 4 * m_ - k, 4 * m_);
      cavities += arrivals_[k + 1];
      for (const std::uint32_t m : triangles[k + 1]) cavities -= join(cells, m);
      out_.cavities[k] = cavities;
    }
  }

  const SpaceCurveInput& in_;
  std::size_t m_;
  const Monitor& monitor_;
  SpaceCurves out_;
  std::vector<std::int32_t> arrivals_;  // [spectrum + 1] tetrahedra of each rank
};

}  // namespace

SpaceCurves space_curves(const SpaceCurveInput& input, const Monitor& monitor) {
  return SpaceSweep(input, monitor).run();
}

}  // namespace vorotool::core::tetrahedral_alpha
