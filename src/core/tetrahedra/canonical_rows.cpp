#include "core/tetrahedra/canonical_rows.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/atomic_ref.hpp"
#include "core/base/memory_release.hpp"
#include "core/base/parallel.hpp"

namespace vorotool::core::tetrahedra {

namespace {

constexpr std::size_t rows_a_block = std::size_t{1} << 7;  // a page of 4 KiB
constexpr std::size_t blocks_at_once = 4;                  // that several threads give back, or more
constexpr std::uint32_t gone = 0xffffffff;  // tetrahedra that are left of a block that is given back
constexpr std::size_t rows_a_piece = std::size_t{1} << 15;
constexpr std::size_t vertices_a_piece = rows_a_piece / 8;
constexpr std::size_t ahead = 16;  // rows that are loaded before their turn

std::size_t offset(Index v) { return static_cast<std::size_t>(v); }

// The order of four different numbers: a bit for each two of which the second is less.
template <class Number>
constexpr unsigned order_of(const std::array<Number, 4>& v) {
  const auto bit = [](bool is_less, int place) { return static_cast<unsigned>(is_less) << place; };
  return bit(v[1] < v[0], 0) | bit(v[2] < v[0], 1) | bit(v[3] < v[0], 2) | bit(v[2] < v[1], 3) |
         bit(v[3] < v[1], 4) | bit(v[3] < v[2], 5);
}

// By their order the places of the least, of the next, and of the others, an even permutation with these: it keeps the
// orientation.
using Turn = std::array<std::uint8_t, 4>;
constexpr auto turns = [] {
  std::array<Turn, 64> all{};
  Turn ranks{0, 1, 2, 3};
  do {
    Turn& turn = all[order_of(ranks)];
    for (std::uint8_t place = 0; place < 4; ++place) turn[ranks[place]] = place;
    if (std::popcount(order_of(ranks)) % 2 != 0) std::swap(turn[2], turn[3]);
  } while (std::next_permutation(ranks.begin(), ranks.end()));
  return all;
}();

class Canonical {
 public:
  Canonical(TetrahedralMesh& mesh, std::span<const Index> index, unsigned threads,
            const base::Monitor& monitor)
      : mesh_(mesh),
        index_(index),
        threads_(base::resolve_threads(threads)),
        monitor_(monitor),
        slots_(mesh.slots()),
        ends_(mesh.points().size() + 1),
        left_(slots_ / rows_a_block + 1) {}

  CanonicalRows run() {
    count_rows();
    mesh_.drop_marks();
    sort_slots();
    number_neighbors();
    return gather();
  }

 private:
  // Their first number tells ghosts and empty slots, and later on the place of the others in the order.
  static constexpr Index none = -1;

  // Of five passes over all rows or all vertices.
  base::Monitor next_pass() {
    const double from = 0.2 * passes_++;
    return base::part_of(monitor_, from, from + 0.2);
  }

  template <class Body>
  void for_tetrahedra(const Body& body) {
    base::for_items(slots_, rows_a_piece, threads_, next_pass(), [&](std::size_t slot) {
      if (mesh_.row(slot)[0] != none) body(slot);
    });
  }
  // For pieces of vertices: body(first, last).
  template <class Body>
  void for_vertices(const Body& body) {
    base::for_pieces(ends_.size() - 1, vertices_a_piece, threads_, next_pass(),
                     [&](std::size_t, std::size_t begin, std::size_t end) { body(begin, end); });
  }

  std::uint32_t add_to(std::uint32_t& number, std::uint32_t added) {
    if (threads_ > 1) return base::atomic_ref(number).fetch_add(added, std::memory_order_relaxed);
    return std::exchange(number, number + added);
  }

  static Index first_of(const Row& row) {
    return std::min(std::min(row[0], row[1]), std::min(row[2], row[3]));
  }

  // Counts the tetrahedra of each first vertex.
  void count_rows() {
    base::for_items(slots_, rows_a_piece, threads_, next_pass(), [&](std::size_t slot) {
      if (!mesh_.is_tetrahedron(slot)) {
        mesh_.row(slot)[0] = none;
        return;
      }
      add_to(ends_[offset(first_of(mesh_.row(slot))) + 1], 1);
      ++left_[slot / rows_a_block];
    });
  }

  static void turn(Tetrahedron& tetrahedron) {
    const auto& [i, j, k, l] = turns[order_of(tetrahedron.vertices)];
    const auto turned = [&](const Row& row) { return Row{row[i], row[j], row[k], row[l]}; };
    tetrahedron = {turned(tetrahedron.vertices), turned(tetrahedron.across)};
  }

  // Slots by their first vertices, and then each group, turned, by the others.
  void sort_slots() {
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    count_ = ends_.back();
    order_ = base::LargeArray<std::uint32_t>(count_);
    for_tetrahedra([&](std::size_t slot) {
      order_[add_to(ends_[offset(first_of(mesh_.row(slot)))], 1)] = static_cast<std::uint32_t>(slot);
    });
    for_vertices([&](std::size_t first, std::size_t last) { sort_groups(first, last); });
  }

  std::size_t begin_of(std::size_t vertex) const { return vertex == 0 ? 0 : ends_[vertex - 1]; }

  void sort_groups(std::size_t first_vertex, std::size_t last_vertex) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;
    std::size_t place = begin_of(first_vertex);
    const std::size_t last = begin_of(last_vertex) - 1;
    for (std::size_t v = first_vertex; v < last_vertex; ++v) {
      keyed.clear();
      for (std::size_t k = place; k < ends_[v]; ++k) {
        __builtin_prefetch(&mesh_.row(order_[std::min(k + ahead, last)]), 1);
        turn(mesh_.tetrahedron(order_[k]));
        const Row& row = mesh_.row(order_[k]);
        keyed.emplace_back(static_cast<std::uint64_t>(row[1]) << 32 | static_cast<std::uint32_t>(row[2]),
                           order_[k]);
      }
      std::sort(keyed.begin(), keyed.end());
      for (const auto& [key, slot] : keyed) {
        order_[place] = slot;
        mesh_.row(slot)[0] = static_cast<Index>(place++);
      }
    }
  }

  void number_neighbors() {
    for_tetrahedra([&](std::size_t slot) {
      for (Index& facet : mesh_.across(slot)) facet = mesh_.row(TetrahedralMesh::slot_of(facet))[0];
    });
  }

  // Blocks go back to the system once all their rows are read: as slots are about in the order of the curve too, few
  // blocks are in use at a time.
  CanonicalRows gather() {
    CanonicalRows result{count_, base::LargeArray<Row>(count_), base::LargeArray<Row>(count_)};
    base::LargeArray<Tetrahedron> from = mesh_.take_tetrahedra();
    for_vertices([&](std::size_t first, std::size_t last) {
      for (std::size_t v = first; v < last; ++v) {
        for (std::size_t k = begin_of(v); k < ends_[v]; ++k) {
          __builtin_prefetch(&from[order_[std::min(k + ahead, begin_of(last) - 1)]]);
          const Tetrahedron& tetrahedron = from[order_[k]];
          const Row& row = tetrahedron.vertices;
          result.vertices[k] = {index_[v], index_[offset(row[1])], index_[offset(row[2])],
                                index_[offset(row[3])]};
          result.neighbors[k] = tetrahedron.across;
        }
      }
      std::vector<std::size_t> read;  // blocks
      for (std::size_t k = begin_of(first); k < begin_of(last); ++k) {
        const std::size_t block = order_[k] / rows_a_block;
        std::uint32_t& left = left_[block];
        const std::uint32_t before =
            threads_ > 1 ? base::atomic_ref(left).fetch_sub(1, std::memory_order_acq_rel) : left--;
        if (before == 1) read.push_back(block);
      }
      for (const std::size_t block : read) discard_around(from, block);
      base::discard(order_, begin_of(first), begin_of(last));
    });
    return result;
  }

  // Gives back a block that is read, with those beside it; where there are other threads, which each call stops, only if
  // these are many.
  void discard_around(base::LargeArray<Tetrahedron>& from, std::size_t block) {
    const auto is_read = [&](std::size_t b) {
      return base::atomic_ref(left_[b]).load(std::memory_order_acquire) == 0;
    };
    if (!is_read(block)) return;  // it is gone
    std::size_t begin = block, end = block + 1;
    while (begin > 0 && is_read(begin - 1)) --begin;
    while (end < left_.size() && is_read(end)) ++end;
    if (threads_ > 1 && end - begin < blocks_at_once) return;
    for (std::size_t b = begin; b < end; ++b)
      base::atomic_ref(left_[b]).store(gone, std::memory_order_relaxed);
    base::discard(from, begin * rows_a_block, std::min(slots_, end * rows_a_block));
  }

  TetrahedralMesh& mesh_;
  const std::span<const Index> index_;
  const unsigned threads_;
  const base::Monitor& monitor_;
  int passes_ = 0;
  const std::size_t slots_;
  std::vector<std::uint32_t> ends_;  // [vertices + 1] where the rows of each end
  std::vector<std::uint32_t> left_;  // tetrahedra of each block that are not gathered yet
  std::size_t count_ = 0;
  base::LargeArray<std::uint32_t> order_;  // slots of tetrahedra
};

}  // namespace

CanonicalRows canonical_rows(TetrahedralMesh& mesh, std::span<const Index> index, unsigned threads,
                             const base::Monitor& monitor) {
  return Canonical(mesh, index, threads, monitor).run();
}

}  // namespace vorotool::core::tetrahedra
