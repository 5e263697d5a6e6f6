#include "core/tetrahedra/delaunay_tetrahedra.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <memory>
#include <new>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/base/memory_release.hpp"
#include "core/base/parallel.hpp"
#include "core/kernel/predicates.hpp"
#include "core/tetrahedra/canonical_rows.hpp"
#include "core/tetrahedra/point_inserter.hpp"
#include "core/tetrahedra/predicates.hpp"
#include "core/tetrahedra/spatial_order.hpp"
#include "core/tetrahedra/tetrahedral_mesh.hpp"

namespace vorotool::core::tetrahedra {

using base::Monitor;

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

// Gives back the memory too, unlike an assignment of {}.
template <class T>
void release(std::vector<T>& items) {
  std::vector<T>().swap(items);
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

// Rounds that have enough points are inserted by several threads, each of which owns an interval of the curve. Those
// that wait for what others own are tried again with intervals moved by half of their length, and then with fewer of
// them; what is left is inserted by one.
class Insertion {
 public:
  Insertion(TetrahedralMesh& mesh, const std::vector<Index>& start, unsigned threads, const Monitor& monitor)
      : mesh_(mesh),
        count_(mesh.points().size()),
        rounds_(count_),
        is_done_(count_),
        numbers_(count_, PointInserter::unnumbered),
        slots_(count_, unknown),
        threads_(base::resolve_threads(threads)),
        monitor_(monitor),
        alone_(mesh, {numbers_, slots_}, 0, count_) {
    mesh.start({start[0], start[1], start[2], start[3]});
    for (const Index v : start)
      is_done_[static_cast<std::size_t>(v)] = 1, slots_[static_cast<std::size_t>(v)] = 0;
    alone_.begin_at(0);
  }

  void run() {
    for (int round = rounds_.count() - 1; round >= 0; --round) {
      std::size_t left = count_ >> (3 * round);
      for (std::size_t parts = most_parts(left); parts > 1; parts = std::min(parts / 2, most_parts(left))) {
        const std::size_t length = base::piece_count(count_, parts);
        left -= std::min(left, insert_in_parts(round, parts, 0));
        left -= std::min(left, insert_in_parts(round, parts, length / 2));
      }
      insert_here(alone_, round, 0, count_);
    }
  }

 private:
  static constexpr std::size_t points_a_thread = std::size_t{1} << 14;
  static constexpr std::size_t points_at_once = std::size_t{1} << 17;  // of a thread: some 200 ms
  static constexpr std::size_t far = 8, farthest = 64;                 // on the curve
  static constexpr std::uint32_t unknown = 0xffffffff;

  std::size_t at(std::size_t k) const { return k < count_ ? k : k - count_; }

  std::size_t most_parts(std::size_t points) const {
    return std::min<std::size_t>(threads_, points / points_a_thread);
  }

  // Inserts the points of a round in an interval that are not yet, as far as they can be.
  std::size_t insert_here(PointInserter& inserter, int round, std::size_t begin, std::size_t end) {
    std::size_t done = 0, last = end;
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = at(k);
      if (rounds_.round_of(i) != round || is_done_[i] != 0) continue;
      if (last == end || k - last > far) begin_near(inserter, begin, k);
      if (!inserter.insert(static_cast<Index>(i))) continue;
      is_done_[i] = 1;
      last = k;
      ++done;
      if (&inserter == &alone_ && done % 1024 == 0) report(1024);
    }
    return done;
  }

  // A search begins where the last point before is, that is in the triangulation. Of parts, which must not look at what
  // others change, this is found out by aim().
  void begin_near(PointInserter& inserter, std::size_t begin, std::size_t k) {
    if (&inserter == &alone_) aim(inserter, begin, k);
    if (slots_[at(k)] != unknown) inserter.begin_at(slots_[at(k)]);
  }

  // Finds where the search for a point is to begin: what an inserter owns then it goes on to own.
  void aim(PointInserter& inserter, std::size_t begin, std::size_t k) {
    std::uint32_t& slot = slots_[at(k)];
    slot = unknown;
    for (std::size_t left = std::min(k - begin, farthest); left > 0 && slot == unknown; --left) {
      const std::size_t i = at(--k);
      if (is_done_[i] != 0 && inserter.begin_at(slots_[i])) slot = slots_[i];
    }
  }

  // For points of a round that are far from each other, and for some of the others.
  void aim_all(PointInserter& inserter, int round, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin, last = begin; k < end; ++k) {
      const std::size_t i = at(k);
      if (rounds_.round_of(i) != round || is_done_[i] != 0) continue;
      slots_[i] = unknown;
      if (k - last < far) continue;
      aim(inserter, begin, k);
      last = k;
    }
  }

  // Each part begins `shift` later, the last one goes on to the first points.
  std::size_t insert_in_parts(int round, std::size_t parts, std::size_t shift) {
    const std::size_t length = base::piece_count(count_, parts);
    const auto end_of = [&](std::size_t part) { return shift + std::min((part + 1) * length, count_); };
    std::vector<std::unique_ptr<PointInserter>> inserters;
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t begin = shift + part * length;
      inserters.push_back(std::make_unique<PointInserter>(mesh_, PointInserter::Notes{numbers_, slots_},
                                                          at(begin), end_of(part) - begin));
      std::size_t slot = 0;
      while (slot < mesh_.slots() && !inserters[part]->begin_at(slot)) ++slot;
    }
    base::parallel_for(parts, threads_, [&](std::size_t part) {
      aim_all(*inserters[part], round, shift + part * length, end_of(part));
    });
    std::size_t all = 0;
    for (std::size_t from = 0; from < length; from += points_at_once) {
      std::atomic<std::size_t> done{0};
      base::parallel_for(parts, threads_, [&](std::size_t part) {
        const std::size_t begin = std::min(shift + part * length + from, end_of(part));
        done += insert_here(*inserters[part], round, begin, std::min(begin + points_at_once, end_of(part)));
      });
      report(done);
      all += done;
    }
    for (const auto& inserter : inserters) {
      alone_.free().insert(alone_.free().end(), inserter->free().begin(), inserter->free().end());
    }
    return all;
  }

  void report(std::size_t more) {
    done_ += more;
    const double part = static_cast<double>(done_) / static_cast<double>(count_);
    base::report(monitor_, order_share + (mesh_share - order_share) * std::min(part, 1.0));
  }

  TetrahedralMesh& mesh_;
  const std::size_t count_;
  const Rounds rounds_;
  std::vector<std::uint8_t> is_done_, numbers_;
  std::vector<std::uint32_t> slots_;
  const unsigned threads_;
  const Monitor& monitor_;
  PointInserter alone_;
  std::size_t done_ = 0;
};

}  // namespace

Tetrahedra triangulate(std::span<const Point3> points, unsigned threads, const Monitor& monitor) {
  if (points.size() > most_points) throw std::length_error("more than 268435456 points");
  Tetrahedra result;
  result.first.resize(points.size());
  SpatialOrder order = spatial_order(points, result.first, threads, base::part_of(monitor, 0, order_share));
  result.duplicates = points.size() - order.count;
  const std::span<Point3> distinct(order.points.get(), order.count);
  move_to_integers(distinct);
  const std::vector<Index> start = spanning_points(distinct);
  result.dimension = static_cast<int>(start.size()) - 1;
  if (result.dimension < 3) return result;
  const SetPredicates predicates(distinct);
  TetrahedralMesh mesh(distinct, predicates);
  if (result.duplicates == 0) release(result.first);  // it is made anew, where all are first
  CanonicalRows rows;
  try {
    Insertion(mesh, start, threads, monitor).run();
    order.points.reset();
    base::return_freed_memory(points.size_bytes());
    rows = canonical_rows(mesh, order.index, threads, base::part_of(monitor, mesh_share, 1));
  } catch (const std::bad_alloc&) {
    throw TooManyTetrahedra(mesh.slots());
  }
  if (result.duplicates == 0) {
    result.first.resize(points.size());
    std::iota(result.first.begin(), result.first.end(), 0);
  }
  result.count = rows.count;
  result.vertices = std::move(rows.vertices);
  result.neighbors = std::move(rows.neighbors);
  return result;
}

}  // namespace vorotool::core::tetrahedra
