#include "core/tetrahedra/tetrahedral_mesh.hpp"

#include <algorithm>
#include <bit>

#include "core/base/available_memory.hpp"

namespace vorotool::core::tetrahedra {

namespace {

constexpr std::size_t most_slots = std::size_t{1} << 29;
constexpr std::size_t bytes_a_slot = sizeof(Tetrahedron) + sizeof(Mark);
// Slots are taken by a hundredth of all, so that threads seldom fill a large page side by side, for which both would
// pay; and by whole blocks (canonical_rows.cpp), so that these are near each other in space.
constexpr std::size_t least_at_once = std::size_t{1} << 9, most_at_once = std::size_t{1} << 16;

}  // namespace

TetrahedralMesh::TetrahedralMesh(std::span<const Point3> points, const SetPredicates& predicates)
    : points_(points),
      predicates_(predicates),
      infinity_(static_cast<Index>(points.size())),
      slots_at_once_(std::clamp(std::bit_floor(points.size() / 16), least_at_once, most_at_once)) {
  // Points in general position have 6.77 tetrahedra each; pages that are not used take no memory.
  const std::size_t expected =
      whole_pieces(std::min(7 * points.size() + points.size() / 8 + 4096, most_slots));
  tetrahedra_ = base::LargeArray<Tetrahedron>(expected);
  marks_ = base::LargeArray<Mark>(expected);
}

std::size_t TetrahedralMesh::whole_pieces(std::size_t slots) const {
  return (slots + slots_at_once_ - 1) / slots_at_once_ * slots_at_once_;
}

void TetrahedralMesh::grow() {
  const std::size_t size = whole_pieces(std::min(slots_ + slots_ / 2, most_slots));
  if (slots_ >= most_slots || size > base::available_memory() / bytes_a_slot) throw TooManyTetrahedra(slots_);
  const auto copy = [&]<class T>(base::LargeArray<T>& array) {
    base::LargeArray<T> larger(size);
    std::copy_n(array.data(), slots_, larger.data());
    array = std::move(larger);
  };
  copy(tetrahedra_);
  copy(marks_);
}

bool TetrahedralMesh::take_slots(std::vector<std::size_t>& free, bool may_grow) {
  const std::lock_guard lock(growing_);
  if (slots_ == tetrahedra_.size()) {
    if (!may_grow) return false;
    grow();
  }
  const std::size_t end = slots_ + slots_at_once_;
  for (std::size_t slot = end; slot-- > slots_;) {  // the first is taken first
    marks_[slot] = Mark::removed;
    free.push_back(slot);
  }
  slots_ = end;
  return true;
}

void TetrahedralMesh::start(Row vertices) {
  const auto& [a, b, c, d] = vertices;
  if (predicates_.orient(point(a), point(b), point(c), point(d)) < 0) std::swap(vertices[0], vertices[1]);
  slots_ = 5;
  std::fill_n(marks_.data(), slots_at_once_, Mark::removed);
  std::fill_n(marks_.data(), slots_, Mark::live);
  row(0) = vertices;
  for (std::size_t i = 0; i < 4; ++i) {  // ghost i + 1 is across facet i
    const auto [k, l, m] = facet_vertices[i];
    row(i + 1) = {vertices[k], vertices[m], vertices[l], infinity_};
    link(facet(0, i), facet(i + 1, 3));
    for (std::size_t place = 0; place < 3; ++place) {
      // The ghost across this facet lacks this vertex.
      const Index v = row(i + 1)[place];
      const auto j =
          static_cast<std::size_t>(std::find(vertices.begin(), vertices.end(), v) - vertices.begin());
      if (j > i) continue;  // that ghost is not there yet
      const Row& other = row(j + 1);
      const auto back = std::find(other.begin(), other.end(), vertices[i]) - other.begin();
      link(facet(i + 1, place), facet(j + 1, static_cast<std::size_t>(back)));
    }
  }
  slots_ = slots_at_once_;
}

}  // namespace vorotool::core::tetrahedra
