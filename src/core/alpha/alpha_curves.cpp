#include "core/alpha/alpha_curves.hpp"

#include <vector>

#include "core/base/disjoint_sets.hpp"
#include "core/base/groups.hpp"
#include "core/numbers/long_sum.hpp"

namespace vorotool::core::alpha {

using base::DisjointSets;
using base::LargeArray;
using base::Monitor;
using numbers::LongSum;

namespace {

// Edges by their ranks, of which the last is that of those that never come.
base::Groups<std::uint32_t> by_rank(std::span<const std::int32_t> rank, std::size_t ranks) {
  return {ranks + 1, [&](const auto& add) {
            for (std::size_t i = 0; i < rank.size(); ++i) add(rank[i], static_cast<std::uint32_t>(i));
          }};
}

class Sweep {
 public:
  Sweep(const CurveInput& input, const Monitor& monitor)
      : in_(input),
        m_(input.spectrum),
        monitor_(monitor),
        out_{LargeArray<double>(m_), LargeArray<double>(m_), LargeArray<std::int32_t>(m_),
             LargeArray<std::int32_t>(m_), LargeArray<std::int32_t>(m_)} {}

  Curves run() {
    measure();
    count_regions();
    count_cavities();
    return std::move(out_);
  }

 private:
  struct Change {
    LongSum area, perimeter;
    std::int32_t edges = 0;
  };

  void measure() {
    std::vector<Change> change(m_ + 1);
    const auto at = [&](std::int32_t rank) -> Change& { return change[static_cast<std::size_t>(rank)]; };
    for (std::size_t t = 0; t < in_.triangle_rank.size(); ++t) at(in_.triangle_rank[t]).area.add(in_.area[t]);
    for (std::size_t e = 0; e < in_.length.size(); ++e) {
      at(in_.edges.mid[e]).perimeter.add(in_.length[e]);
      at(in_.edges.max[e]).perimeter.add(-in_.length[e]);
      ++at(in_.edges.min[e]).edges;
      --at(in_.edges.max[e]).edges;
    }
    Change sum;
    for (std::size_t k = 0; k < m_; ++k) {
      base::report_item(monitor_, k, 3 * m_);
      sum.area.add(change[k].area);
      sum.perimeter.add(change[k].perimeter);
      sum.edges += change[k].edges;
      out_.area[k] = sum.area.value.head;
      out_.perimeter[k] = sum.perimeter.value.head;
      out_.edges[k] = sum.edges;
    }
  }

  std::vector<std::int32_t> triangles_by_rank() const {
    std::vector<std::int32_t> count(m_ + 1);
    for (const std::int32_t rank : in_.triangle_rank) ++count[static_cast<std::size_t>(rank)];
    return count;
  }

  // The two faces of an edge: 0 is the unbounded one, t + 1 a triangle.
  bool join(DisjointSets<>& faces, std::size_t edge) const {
    return faces.join(static_cast<std::uint32_t>(in_.sides[2 * edge] + 1),
                      static_cast<std::uint32_t>(in_.sides[2 * edge + 1] + 1));
  }

  // Upwards: a triangle is a new region, and an edge that goes inside may join two.
  void count_regions() {
    const base::Groups<std::uint32_t> edges = by_rank(in_.edges.max, m_);
    const std::vector<std::int32_t> triangles = triangles_by_rank();
    DisjointSets faces(in_.triangle_rank.size() + 1);
    std::int32_t regions = 0;
    for (std::size_t k = 0; k < m_; ++k) {
      base::report_item(monitor_, m_ + k, 3 * m_);
      regions += triangles[k];
      for (const std::uint32_t e : edges[k]) regions -= join(faces, e);
      out_.regions[k] = regions;
    }
  }

  // Downwards: a triangle that leaves is a new hole, and an edge that then has none left joins it with what
  // is on the other side; the unbounded face counts for nothing.
  void count_cavities() {
    const base::Groups<std::uint32_t> edges = by_rank(in_.edges.mid, m_);
    const std::vector<std::int32_t> triangles = triangles_by_rank();
    DisjointSets faces(in_.triangle_rank.size() + 1);
    std::int32_t cavities = 0;
    for (std::size_t k = m_; k-- > 0;) {
      base::report_item(monitor_, 3 * m_ - k, 3 * m_);
      cavities += triangles[k + 1];
      for (const std::uint32_t e : edges[k + 1]) cavities -= join(faces, e);
      out_.cavities[k] = cavities;
    }
  }

  const CurveInput& in_;
  std::size_t m_;
  const Monitor& monitor_;
  Curves out_;
};

}  // namespace

Curves alpha_curves(const CurveInput& input, const Monitor& monitor) { return Sweep(input, monitor).run(); }

}  // namespace vorotool::core::alpha
