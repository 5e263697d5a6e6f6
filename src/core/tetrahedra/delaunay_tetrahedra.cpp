#include "core/tetrahedra/delaunay_tetrahedra.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/base/memory_release.hpp"
#include "core/kernel/predicates.hpp"
#include "core/tetrahedra/predicates.hpp"
#include "core/tetrahedra/spatial_order.hpp"
#include "core/tetrahedra/tetrahedral_mesh.hpp"

namespace vorotool::core::tetrahedra {

using base::Monitor;
using Index = TetrahedralMesh::Index;
using Row = TetrahedralMesh::Row;

namespace {

constexpr std::size_t most_points = std::size_t{1} << 28;
constexpr double order_share = 0.05, mesh_share = 0.85;  // of the time, for the monitor

bool are_collinear(const Point3& a, const Point3& b, const Point3& c) {
  return kernel::orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 &&
         kernel::orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         kernel::orient2d({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

// The first points of which each is off the span of those before; up to four.
std::vector<Index> spanning_points(std::span<const Point3> points) {
  std::vector<Index> found;
  const auto at = [&](std::size_t i) -> const Point3& { return points[static_cast<std::size_t>(found[i])]; };
  for (std::size_t i = 0; i < points.size() && found.size() < 4; ++i) {
    const bool is_spanned = (found.size() == 2 && are_collinear(at(0), at(1), points[i])) ||
                            (found.size() == 3 && orient3d(at(0), at(1), at(2), points[i]) == 0);
    if (!is_spanned) found.push_back(static_cast<Index>(i));
  }
  return found;
}

// A biased randomized insertion order (N. Amenta, S. Choi, G. Rote 2003): the last round has 7/8 of the points, that
// before it 7/8 of what is left, and so on; in each round they follow the curve.
class Rounds {
 public:
  explicit Rounds(std::size_t points) {
    while (points >> (3 * last_) > 64) ++last_;
  }

  int count() const { return last_ + 1; }
  // The round of a point, 0 for the last one.
  int round_of(std::size_t i) const {
    std::uint64_t bits = (i + 1) * 0x9E3779B97F4A7C15U;
    bits = (bits ^ bits >> 32) * 0xD6E8FEB86659FD93U;
    return std::min(std::countr_zero(bits ^ bits >> 32) / 3, last_);
  }

 private:
  int last_ = 0;
};

void insert_all(TetrahedralMesh& mesh, std::size_t points, const std::vector<Index>& start,
                const Monitor& monitor) {
  const Rounds rounds(points);
  std::size_t done = 0;
  mesh.start({start[0], start[1], start[2], start[3]});
  for (int round = rounds.count() - 1; round >= 0; --round) {
    for (std::size_t i = 0; i < points; ++i) {
      if (rounds.round_of(i) != round) continue;
      const auto v = static_cast<Index>(i);
      if (std::find(start.begin(), start.end(), v) != start.end()) continue;
      mesh.insert(v);
      if (++done % 1024 != 0) continue;
      const double part = static_cast<double>(done) / static_cast<double>(points);
      base::report(monitor, order_share + (mesh_share - order_share) * part);
    }
  }
}

// Turns the rows into their final form, at their final places.
class Finish {
 public:
  explicit Finish(TetrahedralMesh& mesh) : mesh_(mesh), position_(mesh.slots()) {}

  // The number of tetrahedra; those behind are none.
  std::size_t run(std::size_t points, const Monitor& monitor) {
    turn_rows();
    base::report(monitor, mesh_share + 0.02);
    sort_rows(points);
    base::report(monitor, mesh_share + 0.1);
    number_neighbors();
    move_rows();
    return count_;
  }

 private:
  // The smallest vertex first, then the smallest of the others: even permutations, which keep the orientation.
  void turn_rows() {
    for (std::size_t slot = 0; slot < mesh_.slots(); ++slot) {
      if (!mesh_.is_used(slot)) continue;
      ++count_;
      Row& row = mesh_.row(slot);
      const auto i = static_cast<std::size_t>(std::min_element(row.begin(), row.end()) - row.begin());
      std::array<std::size_t, 4> from{i, 0, 0, 0};
      static constexpr std::size_t others[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
      std::copy_n(others[i], 3, from.begin() + 1);
      const auto second = std::min_element(from.begin() + 1, from.end(),
                                           [&](std::size_t a, std::size_t b) { return row[a] < row[b]; });
      std::rotate(from.begin() + 1, second, from.end());
      const auto turned = [&](const Row& old) {
        return Row{old[from[0]], old[from[1]], old[from[2]], old[from[3]]};
      };
      row = turned(row);
      mesh_.across(slot) = turned(mesh_.across(slot));
    }
  }

  // The place of each slot: those of tetrahedra by their rows, the others behind. Three vertices in order tell the
  // side of their triangle, and so the fourth.
  void sort_rows(std::size_t points) {
    std::vector<std::uint32_t> start(points + 1);
    for (std::size_t slot = 0; slot < mesh_.slots(); ++slot) {
      if (mesh_.is_used(slot)) ++start[static_cast<std::size_t>(mesh_.row(slot)[0]) + 1];
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    base::LargeArray<std::uint32_t> slots(count_);
    std::uint32_t next = static_cast<std::uint32_t>(count_);
    for (std::size_t slot = 0; slot < mesh_.slots(); ++slot) {
      if (mesh_.is_used(slot)) {
        slots[start[static_cast<std::size_t>(mesh_.row(slot)[0])]++] = static_cast<std::uint32_t>(slot);
      } else {
        position_[slot] = next++;
      }
    }
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
    std::size_t begin = 0;
    for (std::size_t v = 0; v < points; ++v) {  // start[v] is the end of those of v now
      keyed.clear();
      for (std::size_t k = begin; k < start[v]; ++k) {
        const Row& row = mesh_.row(slots[k]);
        keyed.emplace_back(static_cast<std::uint64_t>(row[1]) << 32 | static_cast<std::uint32_t>(row[2]),
                           slots[k]);
      }
      std::sort(keyed.begin(), keyed.end());
      for (const auto& [key, slot] : keyed) position_[slot] = static_cast<std::uint32_t>(begin++);
    }
  }

  void number_neighbors() {
    for (std::size_t slot = 0; slot < mesh_.slots(); ++slot) {
      if (!mesh_.is_used(slot)) continue;
      for (Index& facet : mesh_.across(slot)) {
        const std::uint32_t place = position_[static_cast<std::size_t>(facet) / 4];
        facet = place < count_ ? static_cast<Index>(place) : -1;
      }
    }
  }

  // Along the cycles of the permutation: no second copy of the rows.
  void move_rows() {
    for (std::size_t slot = 0; slot < mesh_.slots(); ++slot) {
      while (position_[slot] != slot) {
        const std::uint32_t to = position_[slot];
        std::swap(mesh_.row(slot), mesh_.row(to));
        std::swap(mesh_.across(slot), mesh_.across(to));
        std::swap(position_[slot], position_[to]);
      }
    }
  }

  TetrahedralMesh& mesh_;
  std::size_t count_ = 0;
  base::LargeArray<std::uint32_t> position_;
};

}  // namespace

Tetrahedra triangulate(std::span<const Point3> points, unsigned threads, const Monitor& monitor) {
  if (points.size() > most_points) throw std::length_error("more than 268435456 points");
  Tetrahedra result;
  result.first.resize(points.size());
  SpatialOrder order = spatial_order(points, result.first, threads, monitor);
  result.duplicates = points.size() - order.points.size();
  const std::size_t count = order.points.size();
  move_to_integers(order.points);
  const std::vector<Index> start = spanning_points(order.points);
  result.dimension = static_cast<int>(start.size()) - 1;
  if (result.dimension < 3) return result;
  const SetPredicates predicates(order.points);
  TetrahedralMesh mesh(order.points, predicates);
  insert_all(mesh, count, start, monitor);
  order.points = {};
  result.count = Finish(mesh).run(count, monitor);
  result.vertices = mesh.take_rows();
  result.neighbors = mesh.take_across();
  for (std::size_t i = 0; i < result.count; ++i) {
    for (Index& v : result.vertices[i]) v = order.index[static_cast<std::size_t>(v)];
  }
  base::discard(result.vertices, result.count, result.vertices.size());
  base::discard(result.neighbors, result.count, result.neighbors.size());
  return result;
}

}  // namespace vorotool::core::tetrahedra
