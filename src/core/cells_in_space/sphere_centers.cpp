#include "core/cells_in_space/sphere_centers.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "core/base/disjoint_sets.hpp"
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/cells_in_space/cell_planes.hpp"
#include "core/tetrahedra/predicates.hpp"

namespace vorotool::core::cells_in_space {

using base::at;
using base::for_pieces;
using base::Monitor;

namespace {

using Index = std::int32_t;
using Row = SpaceMesh::Row;

constexpr std::size_t tetrahedra_a_piece = std::size_t{1} << 12;

class CenterMaker {
 public:
  CenterMaker(const SpaceMesh& mesh, const Box3& box, unsigned threads, const Monitor& monitor)
      : mesh_(mesh),
        box_(box),
        threads_(threads),
        monitor_(monitor),
        centers_(mesh.tetrahedra.size()),
        sets_(mesh.tetrahedra.size()) {}

  SphereCenters run() {
    place_centers();
    join_centers();
    return {std::move(centers_), std::move(sets_)};
  }

 private:
  const Point3& point(Index v) const { return mesh_.points[at(v)]; }

  void place_centers() {
    for_pieces(centers_.size(), tetrahedra_a_piece, threads_, monitor_,
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 CellPlanes planes(box_);
                 for (std::size_t t = begin; t < end; ++t)
                   centers_[t] = center_of(planes, mesh_.tetrahedra[t]);
               });
  }

  Center center_of(CellPlanes& planes, const Row& row) const {
    if (tetrahedra::orient3d(point(row[1]), point(row[2]), point(row[3]), point(row[0])) >= 0) refuse_mesh();
    planes.begin(point(row[0]));
    std::array<Index, 3> three{};
    for (std::size_t k = 0; k < 3; ++k) three[k] = planes.add_bisector(point(row[k + 1]));
    RoundedPlace place = planes.place(three);
    const auto is_open = [](const numbers::Rounded& value, double low, double high) {
      return value.error_sign == numbers::undecided && (value.value == low || value.value == high);
    };
    if (is_open(place.x, box_.low.x, box_.high.x) || is_open(place.y, box_.low.y, box_.high.y) ||
        is_open(place.z, box_.low.z, box_.high.z))
      place = planes.place_exactly(three);
    Center center{
        {place.x.value + 0.0, place.y.value + 0.0, place.z.value + 0.0}, 0, 0};  // no negative zeros
    const auto look = [&](const numbers::Rounded& value, double low, double high, int side) {
      const int above_low = value.compare(low), above_high = value.compare(high);
      center.beyond |= static_cast<SideSet>((above_low < 0) << side | (above_high > 0) << (side + 1));
      center.on |= static_cast<SideSet>((above_low == 0) << side | (above_high == 0) << (side + 1));
    };
    look(place.x, box_.low.x, box_.high.x, 0);
    look(place.y, box_.low.y, box_.high.y, 2);
    look(place.z, box_.low.z, box_.high.z, 4);
    return center;
  }

  // Tetrahedra on one sphere are connected by their facets, and have one center.
  void join_centers() {
    std::vector<std::vector<std::pair<Index, Index>>> equal(
        base::piece_count(centers_.size(), tetrahedra_a_piece));
    for_pieces(centers_.size(), tetrahedra_a_piece, threads_, monitor_,
               [&](std::size_t piece, std::size_t begin, std::size_t end) {
                 for (std::size_t t = begin; t < end; ++t) {
                   for (const Index u : mesh_.neighbors[t]) {
                     if (u > static_cast<Index>(t) && is_one_center(t, at(u)))
                       equal[piece].emplace_back(static_cast<Index>(t), u);
                   }
                 }
               });
    base::DisjointSets<Index> sets(centers_.size());
    for (const auto& pairs : equal) {
      for (const auto& [t, u] : pairs) sets.join(t, u);
    }
    for (std::size_t t = 0; t < sets_.size(); ++t) sets_[t] = sets.find(static_cast<Index>(t));
  }

  bool is_one_center(std::size_t t, std::size_t u) const {
    if (centers_[t].place != centers_[u].place) return false;
    const Row &a = mesh_.tetrahedra[t], &b = mesh_.tetrahedra[u];
    return std::all_of(b.begin(), b.end(), [&](Index v) {
      return std::find(a.begin(), a.end(), v) != a.end() ||
             tetrahedra::in_sphere(point(a[0]), point(a[1]), point(a[2]), point(a[3]), point(v)) == 0;
    });
  }

  const SpaceMesh& mesh_;
  const Box3& box_;
  const unsigned threads_;
  const Monitor& monitor_;
  std::vector<Center> centers_;
  std::vector<Index> sets_;
};

}  // namespace

SphereCenters sphere_centers(const SpaceMesh& mesh, const Box3& box, unsigned threads,
                             const Monitor& monitor) {
  return CenterMaker(mesh, box, threads, monitor).run();
}

void refuse_mesh() { throw std::invalid_argument("the triangulation is not Delaunay"); }

}  // namespace vorotool::core::cells_in_space
