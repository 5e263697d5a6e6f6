#include "core/delaunay/point_insertion.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/base/atomic_ref.hpp"
#include "core/base/parallel.hpp"
#include "core/delaunay/insertion_mesh.hpp"
#include "core/delaunay/vertex_triangles.hpp"
#include "core/spatial/morton_grid.hpp"

namespace vorotool::core::delaunay {

using base::for_items;
using base::LargeArray;
using base::Monitor;
using kernel::Point;
using spatial::Bounds;

namespace {

using Slot = InsertionMesh::Slot;
using Vertex = InsertionMesh::Vertex;

constexpr std::size_t rows_a_piece = std::size_t{1} << 15;
constexpr std::size_t poll_every = 1024;  // insertions, some milliseconds

// Points of one cell of the grid that are ordered by (x, y). Of more, divide_and_conquer() makes an order of
// its own, which a further point may change from the beginning.
constexpr std::size_t few = 2;

Bounds bounds_of(std::span<const Point> points) {
  Bounds bounds(points[0]);
  for (const Point& p : points) bounds.add(p);
  return bounds;
}

// How many points there are in each of some cells of a grid.
class CellCounts {
 public:
  // The table is at most half full.
  explicit CellCounts(std::size_t cells) : slots_(std::bit_ceil(2 * cells + 2)) {}

  void add_cell(std::uint32_t code) { slots_[place(code)].code = std::uint64_t{code} + 1; }
  void count(std::uint32_t code) {
    Entry& entry = slots_[place(code)];
    if (entry.code != 0) base::atomic_ref(entry.points).fetch_add(1, std::memory_order_relaxed);
  }
  bool any_above(std::size_t limit) const {
    return std::any_of(slots_.begin(), slots_.end(),
                       [=](const Entry& entry) { return entry.points > limit; });
  }

 private:
  struct Entry {
    std::uint64_t code = 0;  // one more; 0 is free
    std::size_t points = 0;
  };

  // Of the cell, or the free one where it would be.
  std::size_t place(std::uint32_t code) const {
    std::size_t i =
        (code * 0x9e3779b97f4a7c15ULL) >> 32;  // golden ratio: the product's high half is well mixed
    for (;; ++i) {
      const std::uint64_t found = slots_[i & (slots_.size() - 1)].code;
      if (found == 0 || found == std::uint64_t{code} + 1) return i & (slots_.size() - 1);
    }
  }

  std::vector<Entry> slots_;
};

// The triangles and edges of which a vertex is the earliest, written anew.
struct Block {
  Vertex vertex;
  std::size_t first_triangle, first_edge;  // among all new ones; the last block is an end
};

class Inserter {
 public:
  Inserter(const TriangulationArrays& mesh, std::span<const Point> points, unsigned threads,
           const Monitor& monitor)
      : in_(mesh),
        points_(points),
        bounds_(bounds_of(mesh.points)),
        grid_(bounds_),
        threads_(threads),
        monitor_(monitor),
        codes_(points.size()),
        mesh_(mesh, points, points.size() - mesh.points.size()),
        first_(points.size()) {
    std::copy(mesh.first.begin(), mesh.first.end(), first_.begin());
  }

  std::optional<InsertedArrays> run(std::span<const std::int32_t> hints) {
    const auto further = points_.subspan(in_.points.size());
    if (!std::all_of(further.begin(), further.end(), [&](const Point& p) { return bounds_.holds(p); }))
      return {};
    number_cells();
    insert_all(hints);
    mesh_.make_fans();
    make_blocks();
    if (changes_order()) return {};
    InsertedArrays out = arrays_to_fill();
    merge_triangles(out);
    merge_edges(out);
    out.hull = walk_hull();
    out.first = std::move(first_);
    return out;
  }

 private:
  const Point& at(Vertex v) const { return points_[static_cast<std::size_t>(v)]; }

  std::uint32_t code(Vertex v) const { return codes_[static_cast<std::size_t>(v)]; }

  void number_cells() {
    for_items(points_.size(), rows_a_piece, threads_, monitor_,
              [&](std::size_t i) { codes_[i] = grid_.code(points_[i]); });
  }

  // The order of vertices: along the curve, and by (x, y) in a cell of few points.
  bool is_earlier(Vertex v, Vertex w) const {
    if (code(v) != code(w)) return code(v) < code(w);
    return at(v).x != at(w).x ? at(v).x < at(w).x : at(v).y < at(w).y;
  }

  // Insertion.

  // Along the curve, and points of one place in their order.
  std::vector<Vertex> order_of_insertion() const {
    std::vector<std::pair<std::uint32_t, Vertex>> order;
    for (std::size_t i = in_.points.size(); i < points_.size(); ++i) {
      order.emplace_back(codes_[i], static_cast<Vertex>(i));
    }
    std::sort(order.begin(), order.end());
    std::vector<Vertex> result;
    for (const auto& item : order) result.push_back(item.second);
    return result;
  }

  void insert_all(std::span<const std::int32_t> hints) {
    std::size_t done = 0, row = 0;
    for (const Vertex v : order_of_insertion()) {
      if (done++ % poll_every == 0) base::report(monitor_, 0);
      const auto i = static_cast<std::size_t>(v) - in_.points.size();
      if (!hints.empty()) row = 0;
      const Vertex aim = hints.empty() ? v : first_[static_cast<std::size_t>(hints[i])];
      Slot near = start_for(aim, row);
      if (!hints.empty()) near = mesh_.slot_at(aim, near);
      first_[static_cast<std::size_t>(v)] = mesh_.insert(v, near);
    }
  }

  // A triangle that was close to a place before anything was inserted: they are in the order of their first
  // corners. Wherever its slot has gone since, it did not go far. `row` is where the search for an earlier
  // place ended.
  Slot start_for(Vertex v, std::size_t& row) const {
    const std::size_t rows = in_.triangles.size() / 3;
    row = first_row(row, rows, [&](std::size_t t) { return code(in_.triangles[3 * t]) < code(v); });
    return static_cast<Slot>(std::min(row, rows - 1));
  }

  // The first row, from one on, that is not before something; the steps double, since it is expected to be
  // close.
  template <class Before>
  static std::size_t first_row(std::size_t from, std::size_t rows, Before before) {
    std::size_t begin = from, step = 1;
    while (begin + step <= rows && before(begin + step - 1)) {
      begin += step;
      step *= 2;
    }
    std::size_t end = std::min(begin + step - 1, rows);
    while (begin < end) {
      const std::size_t middle = std::midpoint(begin, end);
      if (before(middle)) {
        begin = middle + 1;
      } else {
        end = middle;
      }
    }
    return begin;
  }

  // What changed.

  // The vertices of changed triangles, in order, each with a triangle.
  std::vector<std::pair<Vertex, Slot>> changed_vertices() const {
    std::vector<std::pair<Vertex, Slot>> found;
    for (const Slot s : mesh_.changed()) {
      if (mesh_.is_ghost(s)) continue;
      for (int k = 0; k < 3; ++k) found.emplace_back(mesh_.corner(s, k), s);
    }
    std::sort(found.begin(), found.end());
    const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
    found.erase(std::unique(found.begin(), found.end(), same), found.end());
    std::sort(found.begin(), found.end(),
              [&](const auto& a, const auto& b) { return is_earlier(a.first, b.first); });
    return found;
  }

  struct Spoke {
    Vertex neighbor;  // or infinity
    Slot slot;        // the triangle counter-clockwise after it
  };

  void make_blocks() {
    std::vector<Spoke> ring;
    for (const auto& [v, slot] : changed_vertices()) {
      blocks_.push_back({v, new_triangles_.size(), new_edges_.size() / 2});
      go_round(v, slot, ring);
      write_block(v, ring);
      near_.push_back(v);
      for (const Spoke& spoke : ring) near_.push_back(spoke.neighbor);
    }
    blocks_.push_back({-1, new_triangles_.size(), new_edges_.size() / 2});
  }

  // The neighbors of a vertex, counter-clockwise from the earliest one.
  void go_round(Vertex v, Slot start, std::vector<Spoke>& ring) const {
    ring.clear();
    Slot s = start;
    do {
      const int k = mesh_.corner_of(s, v);
      ring.push_back({mesh_.corner(s, following(k)), s});
      s = mesh_.across(s, following(k));
      if (ring.size() > mesh_.slots())
        throw std::invalid_argument("the triangles around a point form no ring");
    } while (s != start);
    const auto before = [&](const Spoke& a, const Spoke& b) {
      if (a.neighbor == InsertionMesh::infinity || b.neighbor == InsertionMesh::infinity) {
        return b.neighbor == InsertionMesh::infinity && a.neighbor != InsertionMesh::infinity;
      }
      return is_earlier(a.neighbor, b.neighbor);
    };
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), before), ring.end());
  }

  void write_block(Vertex v, const std::vector<Spoke>& ring) {
    const auto is_later = [&](Vertex w) { return w != InsertionMesh::infinity && is_earlier(v, w); };
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (!is_later(ring[i].neighbor)) continue;
      new_edges_.push_back(std::min(v, ring[i].neighbor));
      new_edges_.push_back(std::max(v, ring[i].neighbor));
      if (!is_later(ring[(i + 1) % ring.size()].neighbor)) continue;
      mesh_.rotate(ring[i].slot, mesh_.corner_of(ring[i].slot, v));
      new_triangles_.push_back(ring[i].slot);
    }
  }

  // Whether a cell that matters above has so many points that their order may be another.
  bool changes_order() const {
    CellCounts cells(near_.size() + points_.size() - in_.points.size());
    for (const Vertex v : near_) {
      if (v != InsertionMesh::infinity) cells.add_cell(code(v));
    }
    for (std::size_t i = in_.points.size(); i < points_.size(); ++i) cells.add_cell(codes_[i]);
    for_items(points_.size(), rows_a_piece, threads_, monitor_,
              [&](std::size_t i) { cells.count(codes_[i]); });
    return cells.any_above(few);
  }

  // The new arrays: what was there, but for the blocks that are written anew.

  InsertedArrays arrays_to_fill() const {
    const auto is_first = [&](std::size_t i) { return first_[i] == static_cast<Vertex>(i); };
    std::size_t vertices = 0;
    for (std::size_t i = in_.points.size(); i < points_.size(); ++i) vertices += is_first(i);
    std::size_t ghosts = 0;
    for (const Slot s : mesh_.changed()) ghosts += mesh_.is_ghost(s);
    const std::size_t triangles = in_.triangles.size() / 3 + in_.hull.size() + 2 * vertices - ghosts;
    const std::size_t edges = (3 * triangles + ghosts) / 2;
    return {LargeArray<std::int32_t>(3 * triangles),
            LargeArray<std::int32_t>(3 * triangles),
            LargeArray<std::int32_t>(2 * edges),
            {},
            {}};
  }

  // Calls keep(begin, end) for rows that stay and renew(block) for blocks, in order. is_before(row, v) tells
  // whether a row belongs to an earlier vertex, belongs(row, v) whether it belongs to this one.
  template <class IsBefore, class Belongs, class Keep, class Renew>
  void merge(std::size_t rows, IsBefore is_before, Belongs belongs, Keep keep, Renew renew) const {
    std::size_t row = 0;
    for (std::size_t b = 0; b + 1 < blocks_.size(); ++b) {
      const Vertex v = blocks_[b].vertex;
      const std::size_t begin = first_row(row, rows, [&](std::size_t i) { return is_before(i, v); });
      keep(row, begin);
      renew(b);
      row = begin;
      while (row < rows && belongs(row, v)) ++row;
    }
    keep(row, rows);
  }

  void merge_triangles(InsertedArrays& out) const {
    const std::size_t rows = out.triangles.size() / 3;
    LargeArray<Slot> slot_of(rows);                  // of the result
    LargeArray<std::int32_t> row_of(mesh_.slots());  // in the result; of ghosts, -1
    std::fill_n(row_of.data(), row_of.size(), -1);
    std::size_t next = 0;
    const auto put = [&](Slot s) {
      if (next == rows) throw std::invalid_argument("the triangles are not in their order");
      row_of[static_cast<std::size_t>(s)] = static_cast<std::int32_t>(next);
      slot_of[next++] = s;
    };
    const auto lead = [&](std::size_t t) { return in_.triangles[3 * t]; };
    merge(
        in_.triangles.size() / 3, [&](std::size_t t, Vertex v) { return is_earlier(lead(t), v); },
        [&](std::size_t t, Vertex v) { return lead(t) == v; },
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t t = begin; t < end; ++t) put(static_cast<Slot>(t));
        },
        [&](std::size_t b) {
          for (std::size_t i = blocks_[b].first_triangle; i < blocks_[b + 1].first_triangle; ++i) {
            put(new_triangles_[i]);
          }
        });
    if (next != rows) throw std::invalid_argument("the triangles are not in their order");
    for_items(rows, rows_a_piece, threads_, monitor_, [&](std::size_t row) {
      for (int k = 0; k < 3; ++k) {
        const std::size_t place = 3 * row + static_cast<std::size_t>(k);
        out.triangles[place] = mesh_.corner(slot_of[row], k);
        out.neighbors[place] = row_of[static_cast<std::size_t>(mesh_.across(slot_of[row], k))];
      }
    });
  }

  void merge_edges(InsertedArrays& out) const {
    std::int32_t* next = out.edges.data();
    const std::int32_t* last = next + out.edges.size();
    const auto copy = [&](std::span<const std::int32_t> edges, std::size_t begin, std::size_t end) {
      if (static_cast<std::size_t>(last - next) < 2 * (end - begin)) {
        throw std::invalid_argument("the edges are not in their order");
      }
      next = std::copy(edges.begin() + static_cast<std::ptrdiff_t>(2 * begin),
                       edges.begin() + static_cast<std::ptrdiff_t>(2 * end), next);
    };
    const auto lead = [&](std::size_t e) {
      const Vertex a = in_.edges[2 * e], b = in_.edges[2 * e + 1];
      return is_earlier(a, b) ? a : b;
    };
    merge(
        in_.edges.size() / 2, [&](std::size_t e, Vertex v) { return is_earlier(lead(e), v); },
        [&](std::size_t e, Vertex v) { return lead(e) == v; },
        [&](std::size_t begin, std::size_t end) { copy(in_.edges, begin, end); },
        [&](std::size_t b) { copy(new_edges_, blocks_[b].first_edge, blocks_[b + 1].first_edge); });
    if (next != last) throw std::invalid_argument("the edges are not in their order");
  }

  // Counter-clockwise from the smallest vertex.
  std::vector<std::int32_t> walk_hull() const {
    std::vector<std::int32_t> hull;
    const auto changed = mesh_.changed();
    const auto is_ghost = [&](Slot s) { return mesh_.is_ghost(s); };
    const Slot start = *std::find_if(changed.begin(), changed.end(), is_ghost);
    Slot s = start;
    do {
      const int k = preceding(mesh_.corner_of(s, InsertionMesh::infinity));
      hull.push_back(mesh_.corner(s, k));
      s = mesh_.across(s, k);
    } while (s != start);
    const auto before = [&](Vertex v, Vertex w) {
      return at(v).x != at(w).x ? at(v).x < at(w).x : at(v).y < at(w).y;
    };
    std::rotate(hull.begin(), std::min_element(hull.begin(), hull.end(), before), hull.end());
    return hull;
  }

  const TriangulationArrays& in_;
  const std::span<const Point> points_;
  const Bounds bounds_;
  const spatial::MortonGrid grid_;
  const unsigned threads_;
  const Monitor& monitor_;
  LargeArray<std::uint32_t> codes_;  // [points] of their cells
  InsertionMesh mesh_;
  std::vector<std::int32_t> first_;
  std::vector<Block> blocks_;
  std::vector<Slot> new_triangles_;
  std::vector<std::int32_t> new_edges_;
  std::vector<Vertex> near_;  // vertices whose order was asked for
};

}  // namespace

std::optional<InsertedArrays> insert_points(const TriangulationArrays& mesh, std::span<const Point> points,
                                            std::span<const std::int32_t> hints, unsigned threads,
                                            const Monitor& monitor) {
  check_indices(mesh);
  if (mesh.triangles.empty()) return {};
  return Inserter(mesh, points, threads, monitor).run(hints);
}

}  // namespace vorotool::core::delaunay
