#include "core/alpha/region_persistence.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "core/alpha/merge_tree.hpp"
#include "core/base/disjoint_sets.hpp"
#include "core/base/groups.hpp"
#include "core/base/indices.hpp"
#include "core/numbers/long_sum.hpp"

namespace vorotool::core::alpha {

using base::at;
using base::Groups;
using base::Monitor;

namespace {

using Numbers = std::vector<std::int32_t>;

// Items by their ranks, those that never come last.
Groups<std::int32_t> items_by_rank(std::span<const std::int32_t> rank, std::size_t ranks) {
  return {ranks + 1, [&](const auto& add) {
            for (std::size_t i = 0; i < rank.size(); ++i) add(rank[i], static_cast<std::int32_t>(i));
          }};
}

struct Part {
  std::int32_t region = -1;  // -1 of one that comes with the rank at hand
  std::int32_t vertices = 3, triangles = 1;
  numbers::LongSum area;
};

class RegionSweep {
 public:
  RegionSweep(const RegionInput& input, const Monitor& monitor)
      : in_(input),
        monitor_(monitor),
        edges_(items_by_rank(input.rank_max, input.spectrum)),
        triangles_(items_by_rank(input.triangle_rank, input.spectrum)),
        parts_(input.triangle_rank.size()),
        sets_(input.triangle_rank.size()) {}

  Regions run() {
    count_shared();
    for (std::size_t t = 0; t < parts_.size(); ++t) parts_[t].area.add(in_.area[t]);
    for (std::size_t k = 0; k < in_.spectrum; ++k) {
      base::report_item(monitor_, in_.spectrum + k, 2 * in_.spectrum);
      take_rank(static_cast<std::int32_t>(k));
    }
    return std::move(out_);
  }

 private:
  // Vertices of a set of triangles, each once: three a triangle, less one for each join of sets that both had
  // a vertex. With the triangles around it in an order in which every set lies side by side, these are the
  // joins of any two that follow one another.
  void count_shared() {
    MergeTree tree(parts_.size());
    for (std::size_t k = 0; k < in_.spectrum; ++k) {
      base::report_item(monitor_, k, 2 * in_.spectrum);
      for (const std::int32_t e : edges_[k]) tree.join(in_.sides[2 * at(e)], in_.sides[2 * at(e) + 1]);
    }
    shared_.assign(at(tree.joins()), 0);
    const Numbers place = tree.order();
    Groups<std::int32_t> around(in_.points, [&](const auto& add) {
      for (std::size_t i = 0; i < in_.triangles.size(); ++i) {
        if (at(in_.triangle_rank[i / 3]) < in_.spectrum)
          add(in_.triangles[i], static_cast<std::int32_t>(i / 3));
      }
    });
    const auto comes_before = [&](std::int32_t a, std::int32_t b) { return place[at(a)] < place[at(b)]; };
    for (std::size_t v = 0; v < around.size(); ++v) {
      const std::span<std::int32_t> fan = around[v];
      std::sort(fan.begin(), fan.end(), comes_before);
      for (std::size_t i = 1; i < fan.size(); ++i) {
        const std::int32_t join = tree.joined_at(fan[i - 1], fan[i]);
        if (join >= 0) ++shared_[at(join)];
      }
    }
  }

  Part& part_of(std::int32_t t) { return parts_[at(sets_.find(t))]; }

  // Whether of two regions that merge the first one lives on.
  bool is_elder(std::int32_t a, std::int32_t b) const {
    const auto key = [&](std::int32_t region) {
      const std::size_t i = at(region);
      return std::tuple(out_.birth[i], -out_.vertices[i], out_.triangle[i]);
    };
    return key(a) < key(b);
  }

  // What regions were just before this rank stays in `out_` until the end of it.
  void take_rank(std::int32_t rank) {
    Numbers changed(triangles_[rank].begin(), triangles_[rank].end()), dying;
    for (const std::int32_t e : edges_[rank]) {
      const std::int32_t a = in_.sides[2 * at(e)], b = in_.sides[2 * at(e) + 1];
      const Part p = part_of(a), q = part_of(b);
      if (!sets_.join(a, b)) continue;
      Part& both = part_of(a);
      both = p;
      both.vertices += q.vertices - shared_[next_join_++];
      both.triangles += q.triangles;
      both.area.add(q.area);
      if (p.region >= 0 && q.region >= 0) {
        both.region = is_elder(p.region, q.region) ? p.region : q.region;
        dying.push_back(both.region == p.region ? q.region : p.region);
      } else {
        both.region = std::max(p.region, q.region);
      }
      changed.push_back(a);
    }
    for (std::int32_t& t : changed) t = sets_.find(t);
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    for (const std::int32_t t : changed) record(t, rank);
    for (const std::int32_t region : dying) {
      out_.death[at(region)] = rank;
      out_.into[at(region)] = part_of(out_.triangle[at(region)]).region;
    }
  }

  void record(std::int32_t first_triangle, std::int32_t rank) {
    Part& part = parts_[at(first_triangle)];
    if (part.region < 0) {
      part.region = static_cast<std::int32_t>(out_.birth.size());
      out_.birth.push_back(rank);
      out_.death.push_back(static_cast<std::int32_t>(in_.spectrum));
      out_.into.push_back(-1);
      out_.triangle.push_back(first_triangle);
      for (Numbers* counts : {&out_.vertices, &out_.triangles}) counts->push_back(0);
      out_.area.push_back(0);
    }
    out_.vertices[at(part.region)] = part.vertices;
    out_.triangles[at(part.region)] = part.triangles;
    out_.area[at(part.region)] = part.area.value.head;
  }

  const RegionInput& in_;
  const Monitor& monitor_;
  Groups<std::int32_t> edges_, triangles_;
  std::vector<Part> parts_;  // [t] of the set whose first triangle it is
  base::DisjointSets<std::int32_t> sets_;
  Numbers shared_;  // of each join, in order, the vertices that both sets had
  std::size_t next_join_ = 0;
  Regions out_;
};

}  // namespace

Regions region_persistence(const RegionInput& input, const Monitor& monitor) {
  return RegionSweep(input, monitor).run();
}

}  // namespace vorotool::core::alpha
