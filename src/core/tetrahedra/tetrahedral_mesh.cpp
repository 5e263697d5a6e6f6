#include "core/tetrahedra/tetrahedral_mesh.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/base/flat_map.hpp"

namespace vorotool::core::tetrahedra {

namespace {

constexpr std::size_t most_slots = std::size_t{1} << 29;

// The vertices of each facet: with what lies on its inner side they are a positive tetrahedron.
constexpr std::array<std::array<std::size_t, 3>, 4> facet_vertices{
    {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

// The other places k and l of two places i and j, in the order in which i, j, k, l is an even permutation. Seen from
// the tetrahedron across facet j, which keeps the vertex at i, they are the other way round.
struct Edge {
  std::size_t from, to;
};
constexpr std::array<std::array<Edge, 4>, 4> edge_beside{{{{{0, 0}, {2, 3}, {3, 1}, {1, 2}}},
                                                          {{{3, 2}, {0, 0}, {0, 3}, {2, 0}}},
                                                          {{{1, 3}, {3, 0}, {0, 0}, {0, 1}}},
                                                          {{{2, 1}, {0, 2}, {1, 0}, {0, 0}}}}};

}  // namespace

TetrahedralMesh::TetrahedralMesh(std::span<const Point3> points, const SetPredicates& predicates)
    : points_(points),
      predicates_(predicates),
      infinity_(static_cast<Index>(points.size())),
      number_(points.size() + 1) {
  // Points in general position have 6.77 tetrahedra each; pages that are not used take no memory.
  const std::size_t expected = std::min(7 * points.size() + 1024, most_slots);
  rows_ = base::LargeArray<Row>(expected);
  across_ = base::LargeArray<Row>(expected);
  removed_ = base::LargeArray<std::uint8_t>(expected);
}

void TetrahedralMesh::grow() {
  if (slots_ >= most_slots) throw std::length_error("more than 536870912 tetrahedra");
  const std::size_t size = std::min(slots_ + slots_ / 2, most_slots);
  const auto copy = [&]<class T>(base::LargeArray<T>& array) {
    base::LargeArray<T> larger(size);
    std::copy_n(array.data(), slots_, larger.data());
    array = std::move(larger);
  };
  copy(rows_);
  copy(across_);
  copy(removed_);
}

std::size_t TetrahedralMesh::new_slot() {
  if (!free_.empty()) {
    const std::size_t slot = free_.back();
    free_.pop_back();
    return slot;
  }
  if (slots_ == rows_.size()) grow();
  return slots_++;
}

void TetrahedralMesh::start(Row vertices) {
  const auto& [a, b, c, d] = vertices;
  if (predicates_.orient(point(a), point(b), point(c), point(d)) < 0) std::swap(vertices[0], vertices[1]);
  for (std::size_t slot = 0; slot < 5; ++slot) removed_[new_slot()] = 0;
  rows_[0] = vertices;
  for (std::size_t i = 0; i < 4; ++i) {  // ghost i + 1 is across facet i
    const auto [k, l, m] = facet_vertices[i];
    rows_[i + 1] = {vertices[k], vertices[m], vertices[l], infinity_};
    link(facet(0, i), facet(i + 1, 3));
    for (std::size_t place = 0; place < 3; ++place) {
      // The ghost across this facet lacks this vertex.
      const Index v = rows_[i + 1][place];
      const auto j =
          static_cast<std::size_t>(std::find(vertices.begin(), vertices.end(), v) - vertices.begin());
      if (j > i) continue;  // that ghost is not there yet
      const Row& other = rows_[j + 1];
      const auto back = std::find(other.begin(), other.end(), vertices[i]) - other.begin();
      link(facet(i + 1, place), facet(j + 1, static_cast<std::size_t>(back)));
    }
  }
  last_ = 0;
}

// A visibility walk. It ends, as the simplices of a lower hull are in an acyclic order seen from any point (H.
// Edelsbrunner, "An acyclicity theorem for cell complexes in d dimensions", 1990).
std::size_t TetrahedralMesh::locate(const Point3& p) const {
  std::size_t slot = last_, from = 4;
  while (!is_ghost(slot)) {
    const Row& row = rows_[slot];
    std::size_t out = 4;
    for (std::size_t i = 0; i < 4 && out == 4; ++i) {
      if (i == from) continue;
      const auto [k, l, m] = facet_vertices[i];
      if (predicates_.orient(point(row[k]), point(row[l]), point(row[m]), p) < 0) out = i;
    }
    if (out == 4) break;
    const Index next = across_[slot][out];
    slot = slot_of(next);
    from = place_of(next);
  }
  return slot;
}

bool TetrahedralMesh::holds(std::size_t slot, const Point3& p) const {
  if (is_ghost(slot)) {
    const Row& row = rows_[slot];
    const int side = predicates_.orient(point(row[0]), point(row[1]), point(row[2]), p);
    if (side != 0) return side > 0;
    slot = slot_of(across_[slot][3]);
    if (removed_[slot] != 0) return true;
  }
  const Row& row = rows_[slot];
  return predicates_.in_sphere(point(row[0]), point(row[1]), point(row[2]), point(row[3]), p) > 0;
}

void TetrahedralMesh::dig(std::size_t slot, Index v) {
  const Point3 p = point(v);
  cavity_.clear();
  walls_.clear();
  const auto remove = [&](std::size_t s) {
    removed_[s] = 1;
    cavity_.push_back(s);
  };
  remove(slot);
  for (std::size_t k = 0; k < cavity_.size(); ++k) {
    const std::size_t inner = cavity_[k];
    for (std::size_t i = 0; i < 4; ++i) {
      const Index outside = across_[inner][i];
      const std::size_t outer = slot_of(outside);
      if (removed_[outer] != 0) continue;
      if (holds(outer, p)) {
        remove(outer);
      } else {
        walls_.push_back({rows_[inner], outside, static_cast<int>(i)});
        walls_.back().vertices[i] = v;
      }
    }
  }
}

void TetrahedralMesh::fill() {
  filled_.clear();
  std::size_t taken = 0;
  for (const Wall& wall : walls_) {
    const std::size_t slot = taken < cavity_.size() ? cavity_[taken++] : new_slot();
    removed_[slot] = 0;
    rows_[slot] = wall.vertices;
    link(facet(slot, static_cast<std::size_t>(wall.place)), wall.outside);
    filled_.push_back(slot);
    if (wall.vertices[3] != infinity_) last_ = slot;
  }
  free_.insert(free_.end(), cavity_.begin() + static_cast<std::ptrdiff_t>(taken), cavity_.end());
}

std::uint8_t TetrahedralMesh::number_of(Index v) {
  std::uint8_t& number = number_[static_cast<std::size_t>(v)];
  if (number >= numbered_count_ || numbered_[number] != v) {
    number = static_cast<std::uint8_t>(numbered_count_);
    numbered_[numbered_count_++] = v;
  }
  return number;
}

// The walls are a sphere around the new vertex. Each edge of theirs is in two of them, in opposite directions: once
// all have left in a table which facet is beside it, each finds the other.
void TetrahedralMesh::link_few() {
  numbered_count_ = 0;
  numbers_.resize(walls_.size());
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const auto i = static_cast<std::size_t>(walls_[w].place);
    for (std::size_t j = 0; j < 4; ++j)
      numbers_[w][j] = j == i ? std::uint8_t{0} : number_of(walls_[w].vertices[j]);
    for (std::size_t j = 0; j < 4; ++j) {
      if (j == i) continue;
      const Edge edge = edge_beside[i][j];
      facets_[numbers_[w][edge.from] * few + numbers_[w][edge.to]] = facet(filled_[w], j);
    }
  }
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const auto i = static_cast<std::size_t>(walls_[w].place);
    for (std::size_t j = 0; j < 4; ++j) {
      if (j == i) continue;
      const Edge edge = edge_beside[i][j];
      across_[filled_[w]][j] = facets_[numbers_[w][edge.to] * few + numbers_[w][edge.from]];
    }
  }
}

void TetrahedralMesh::link_many() {
  base::FlatMap facets(2 * walls_.size());
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const auto i = static_cast<std::size_t>(walls_[w].place);
    for (std::size_t j = 0; j < 4; ++j) {
      if (j == i) continue;
      const Edge edge = edge_beside[i][j];
      const auto [least, most] = std::minmax(walls_[w].vertices[edge.from], walls_[w].vertices[edge.to]);
      std::uint64_t& other =
          facets[static_cast<std::uint64_t>(least) << 32 | static_cast<std::uint64_t>(most)];
      const Index here = facet(filled_[w], j);
      if (other == 0) {
        other = static_cast<std::uint64_t>(here) + 1;
      } else {
        link(here, static_cast<Index>(other - 1));
      }
    }
  }
}

void TetrahedralMesh::insert(Index v) {
  dig(locate(point(v)), v);
  fill();
  if (walls_.size() / 2 + 2 <= few) {  // by Euler's relation, as many vertices
    link_few();
  } else {
    link_many();
  }
}

}  // namespace vorotool::core::tetrahedra
