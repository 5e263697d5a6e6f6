#include "core/tetrahedra/canonical_rows.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/atomic_ref.hpp"
#include "core/base/memory_release.hpp"
#include "core/base/parallel.hpp"

namespace vorotool::core::tetrahedra {

namespace {

constexpr std::size_t rows_a_piece = std::size_t{1} << 15;
constexpr std::size_t rows_a_block = std::size_t{1} << 12;  // 64 KiB

std::size_t offset(Index v) { return static_cast<std::size_t>(v); }

class Canonical {
 public:
  Canonical(TetrahedralMesh& mesh, unsigned threads, const base::Monitor& monitor)
      : mesh_(mesh),
        threads_(threads),
        monitor_(monitor),
        slots_(mesh.slots()),
        ends_(mesh.points().size() + 1) {}

  CanonicalRows run() {
    turn_rows();
    sort_slots();
    number_neighbors();
    CanonicalRows result{count_, {}, {}};
    base::LargeArray<Row> rows = mesh_.take_rows(), across = mesh_.take_across();
    result.vertices = gather(rows);
    rows = {};
    result.neighbors = gather(across);
    return result;
  }

 private:
  template <class Body>
  void for_tetrahedra(const Body& body) {
    base::for_items(slots_, rows_a_piece, threads_, monitor_, [&](std::size_t slot) {
      if (mesh_.is_tetrahedron(slot)) body(slot);
    });
  }

  // Even permutations, which keep the orientation. Counts the tetrahedra of each first vertex.
  void turn_rows() {
    static constexpr std::size_t turns[4][3][4] = {{{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}},
                                                   {{1, 0, 3, 2}, {1, 3, 2, 0}, {1, 2, 0, 3}},
                                                   {{2, 0, 1, 3}, {2, 1, 3, 0}, {2, 3, 0, 1}},
                                                   {{3, 0, 2, 1}, {3, 2, 1, 0}, {3, 1, 0, 2}}};
    for_tetrahedra([&](std::size_t slot) {
      const Row old = mesh_.row(slot), across = mesh_.across(slot);
      const std::size_t low = old[1] < old[0], high = 2 + (old[3] < old[2]);
      const auto& choices = turns[old[high] < old[low] ? high : low];
      const std::size_t first = old[choices[1][1]] < old[choices[0][1]];
      const std::size_t best = old[choices[2][1]] < old[choices[first][1]] ? 2 : first;
      const auto& [i, j, k, l] = choices[best];
      mesh_.row(slot) = {old[i], old[j], old[k], old[l]};
      mesh_.across(slot) = {across[i], across[j], across[k], across[l]};
      base::atomic_ref(ends_[offset(old[i]) + 1]).fetch_add(1, std::memory_order_relaxed);
    });
  }

  // Slots by their first vertices, and then each group by the others.
  void sort_slots() {
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    count_ = ends_.back();
    order_ = base::LargeArray<std::uint32_t>(count_);
    for_tetrahedra([&](std::size_t slot) {
      auto place =
          base::atomic_ref(ends_[offset(mesh_.row(slot)[0])]).fetch_add(1, std::memory_order_relaxed);
      order_[place] = static_cast<std::uint32_t>(slot);
    });
    position_ = base::LargeArray<Index>(slots_);
    base::for_pieces(slots_, rows_a_piece, threads_, monitor_,
                     [&](std::size_t, std::size_t begin, std::size_t end) {
                       std::fill(position_.data() + begin, position_.data() + end, -1);
                     });
    const std::size_t vertices = ends_.size() - 1;
    base::for_pieces(vertices, rows_a_piece / 8, threads_, monitor_,
                     [&](std::size_t, std::size_t begin, std::size_t end) { sort_groups(begin, end); });
  }

  void sort_groups(std::size_t first_vertex, std::size_t last_vertex) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
    std::size_t place = first_vertex == 0 ? 0 : ends_[first_vertex - 1];
    for (std::size_t v = first_vertex; v < last_vertex; ++v) {
      keyed.clear();
      for (std::size_t k = place; k < ends_[v]; ++k) {
        const Row& row = mesh_.row(order_[k]);
        keyed.emplace_back(static_cast<std::uint64_t>(row[1]) << 32 | static_cast<std::uint32_t>(row[2]),
                           order_[k]);
      }
      std::sort(keyed.begin(), keyed.end());
      for (const auto& [key, slot] : keyed) {
        order_[place] = slot;
        position_[slot] = static_cast<Index>(place++);
      }
    }
  }

  void number_neighbors() {
    for_tetrahedra([&](std::size_t slot) {
      for (Index& facet : mesh_.across(slot)) facet = position_[TetrahedralMesh::slot_of(facet)];
    });
    position_ = {};
  }

  // The rows of tetrahedra in order. Blocks go back to the system once all their rows are read: as slots are about in
  // the order of the curve too, few blocks are in use at a time.
  base::LargeArray<Row> gather(base::LargeArray<Row>& from) {
    std::vector<std::uint32_t> left(slots_ / rows_a_block + 1);
    for (std::size_t k = 0; k < count_; ++k) ++left[order_[k] / rows_a_block];
    base::LargeArray<Row> to(count_);
    const auto copy = [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) to[k] = from[order_[k]];
      for (std::size_t k = begin; k < end; ++k) {
        const std::size_t block = order_[k] / rows_a_block;
        if (base::atomic_ref(left[block]).fetch_add(0xffffffffU, std::memory_order_relaxed) == 1)
          base::discard(from, block * rows_a_block, std::min(slots_, (block + 1) * rows_a_block));
      }
    };
    base::for_pieces(count_, rows_a_piece, threads_, monitor_, copy);
    return to;
  }

  TetrahedralMesh& mesh_;
  const unsigned threads_;
  const base::Monitor& monitor_;
  const std::size_t slots_;
  std::vector<std::uint32_t> ends_;  // [vertices + 1] where the rows of each end
  std::size_t count_ = 0;
  base::LargeArray<std::uint32_t> order_;  // slots of tetrahedra
  base::LargeArray<Index> position_;       // [slots] in that order, -1 of others
};

}  // namespace

CanonicalRows canonical_rows(TetrahedralMesh& mesh, unsigned threads, const base::Monitor& monitor) {
  return Canonical(mesh, threads, monitor).run();
}

}  // namespace vorotool::core::tetrahedra
