#include "core/cells_in_space/cell_pieces.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "core/base/groups.hpp"
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/cells_in_space/box_cutter.hpp"

namespace vorotool::core::cells_in_space {

using base::at;
using base::Monitor;

namespace {

using Index = std::int32_t;
using Row = SpaceMesh::Row;

constexpr std::size_t points_a_piece = std::size_t{1} << 9;

// The other corners of a tetrahedron, (i, j, k, l) being an even permutation of the four.
struct Others {
  std::size_t k, l;
};
constexpr Others others_of(std::size_t i, std::size_t j) {
  std::size_t k = 0;
  while (k == i || k == j) ++k;
  const std::size_t l = 6 - i - j - k;
  const std::size_t order[] = {i, j, k, l};
  int inversions = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) inversions += order[a] > order[b];
  }
  return inversions % 2 == 0 ? Others{k, l} : Others{l, k};
}

std::size_t corner_of(const Row& row, Index v) {
  const auto found = static_cast<std::size_t>(std::find(row.begin(), row.end(), v) - row.begin());
  if (found == row.size()) refuse_mesh();
  return found;
}

class PieceMaker {
 public:
  PieceMaker(const SpaceMesh& mesh, const Box3& box, const SphereCenters& spheres)
      : mesh_(mesh),
        box_(box),
        spheres_(spheres),
        star_(mesh.points.size(),
              [&](const auto& add) {
                for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
                  for (const Index v : mesh.tetrahedra[t]) add(v, static_cast<Index>(t));
                }
              }),
        linked_(mesh.points.size(), [&](const auto& add) {
          if (!mesh.tetrahedra.empty()) return;
          for (const auto& [a, b] : mesh.edges) add(a, b), add(b, a);
        }) {}

  void make_piece(Piece& piece, std::size_t begin, std::size_t end) const {
    Workshop shop(box_);
    for (std::size_t i = begin; i < end; ++i) {
      const auto v = static_cast<Index>(i);
      if (mesh_.first[i] != v) continue;
      const std::span<const Index> star = star_[v];
      if (star.empty()) {
        if (!mesh_.tetrahedra.empty()) refuse_mesh();
        cut(piece, shop, v);
        continue;
      }
      SideSet any = 0, all = 0xff;
      bool is_open = false;
      for (const Index t : star) {
        const Center& center = spheres_.centers[at(t)];
        any |= center.beyond | center.on, all &= center.beyond;
        is_open = is_open || is_on_hull(at(t), v);
      }
      if (is_open || (any != 0 && all == 0)) {
        cut(piece, shop, v);
      } else if (any == 0) {
        go_round(piece, shop, v);
      }
    }
  }

 private:
  const Point3& point(Index v) const { return mesh_.points[at(v)]; }

  // What a thread keeps from cell to cell.
  struct Workshop {
    explicit Workshop(const Box3& box) : planes(box) {}

    CellPlanes planes;
    BoxCutter cutter;
    std::vector<std::uint64_t> edges;               // other end, tetrahedron
    std::vector<std::pair<double, Index>> others;   // by distance
    std::vector<std::pair<Index, Index>> plane_of;  // of others
    std::vector<Row> star;                          // planes of the other corners
    std::vector<bool> is_through;                   // a vertex, of each plane
    std::vector<Index> number;                      // of each vertex of the cutter
  };

  bool is_on_hull(std::size_t t, Index v) const {
    for (std::size_t k = 0; k < 4; ++k) {
      if (mesh_.neighbors[t][k] < 0 && mesh_.tetrahedra[t][k] != v) return true;
    }
    return false;
  }

  // A cell inside the box: its faces lie across the edges, their vertices are the centers around these.
  void go_round(Piece& piece, Workshop& shop, Index v) const {
    shop.edges.clear();
    const std::span<const Index> star = star_[v];
    for (const Index t : star) {
      for (const Index other : mesh_.tetrahedra[at(t)]) {
        if (other > v) shop.edges.push_back(std::uint64_t{static_cast<std::uint32_t>(other)} << 32 | at(t));
      }
    }
    std::sort(shop.edges.begin(), shop.edges.end());
    Index last = v;
    for (const std::uint64_t edge : shop.edges) {
      const auto other = static_cast<Index>(edge >> 32);
      if (other == last) continue;
      last = other;
      const auto begin = static_cast<std::uint32_t>(piece.corners.size());
      add_ring(piece.corners, v, other, static_cast<Index>(edge & 0xffffffff), star.size());
      const auto end = static_cast<std::uint32_t>(piece.corners.size());
      if (end - begin < 3) {
        piece.corners.resize(begin);
      } else {
        piece.faces.push_back({v, other, begin, end});
      }
    }
  }

  // The centers around an edge, counter-clockwise as seen from its other end; each once.
  void add_ring(std::vector<Index>& corners, Index v, Index other, Index start, std::size_t most) const {
    const std::size_t begin = corners.size();
    Index t = start;
    do {
      if (t < 0 || most-- == 0) refuse_mesh();
      const Index center = spheres_.sets[at(t)];
      if (corners.size() == begin || corners.back() != center) corners.push_back(center);
      const Row& row = mesh_.tetrahedra[at(t)];
      const std::size_t i = corner_of(row, v), j = corner_of(row, other);
      t = mesh_.neighbors[at(t)][others_of(i, j).k];
    } while (t != start);
    while (corners.size() > begin + 1 && corners.back() == corners[begin]) corners.pop_back();
  }

  // A cell that may reach the box: the box is cut by the bisectors with all neighbors.
  void cut(Piece& piece, Workshop& shop, Index v) const {
    find_others(shop, v);
    shop.planes.begin(point(v));
    shop.plane_of.clear();
    for (const auto& [distance, other] : shop.others)
      shop.plane_of.emplace_back(other, shop.planes.add_bisector(point(other)));
    shop.cutter.begin(shop.planes);
    for (const auto& [other, plane] : shop.plane_of) {
      if (!shop.cutter.cut(plane)) return;
    }
    number_vertices(piece, shop, v);
    for (const BoxCutter::Face& face : shop.cutter.faces()) {
      const auto begin = static_cast<std::uint32_t>(piece.corners.size());
      for (const Index corner : face.corners) piece.corners.push_back(shop.number[at(corner)]);
      const bool is_side = at(face.plane) < box_sides;
      const Index across = is_side ? -1 - face.plane : shop.plane_of[at(face.plane) - box_sides].first;
      piece.faces.push_back({v, across, begin, static_cast<std::uint32_t>(piece.corners.size())});
    }
    order_faces(piece, v);
  }

  // Those of a cell, which are the last: by the points across, then sides.
  static void order_faces(Piece& piece, Index v) {
    auto first = piece.faces.end();
    while (first != piece.faces.begin() && (first - 1)->cell == v) --first;
    std::sort(first, piece.faces.end(), [](const PieceFace& a, const PieceFace& b) {
      if ((a.across < 0) != (b.across < 0)) return b.across < 0;
      return a.across < 0 ? a.across > b.across : a.across < b.across;
    });
  }

  void find_others(Workshop& shop, Index v) const {
    auto& others = shop.others;
    others.clear();
    const auto add = [&](Index other) {
      const Point3 &p = point(v), &q = point(other);
      const double x = q.x - p.x, y = q.y - p.y, z = q.z - p.z;
      others.emplace_back(x * x + y * y + z * z, other);
    };
    for (const Index t : star_[v]) {
      for (const Index other : mesh_.tetrahedra[at(t)]) {
        if (other != v) add(other);
      }
    }
    for (const Index other : linked_[v]) add(other);
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
  }

  // Vertices where three bisectors meet are centers of tetrahedra; the others are on the box.
  void number_vertices(Piece& piece, Workshop& shop, Index v) const {
    find_star_planes(shop, v);
    shop.is_through.assign(shop.planes.size(), false);
    const std::span<const Index> star = star_[v];
    for (const Index corner : shop.cutter.vertices()) {
      const BoxCutter::Vertex& vertex = shop.cutter.vertex(corner);
      SideSet sides = 0;
      for (const Index plane : vertex.through) {
        shop.is_through[at(plane)] = true;
        if (at(plane) < box_sides) sides |= static_cast<SideSet>(1 << plane);
      }
      const auto found = std::find_if(shop.star.begin(), shop.star.end(), [&](const Row& planes) {
        return shop.is_through[at(planes[0])] && shop.is_through[at(planes[1])] &&
               shop.is_through[at(planes[2])];
      });
      for (const Index plane : vertex.through) shop.is_through[at(plane)] = false;
      if (at(corner) >= shop.number.size()) shop.number.resize(at(corner) + 1);
      Index& number = shop.number[at(corner)];
      if (found != shop.star.end()) {
        number = spheres_.sets[at(star[static_cast<std::size_t>(found - shop.star.begin())])];
        continue;
      }
      if (sides == 0) refuse_mesh();
      const RoundedPlace place = shop.planes.place(vertex.at.planes);
      piece.places.push_back({place.x.value + 0.0, place.y.value + 0.0, place.z.value + 0.0});
      piece.sides.push_back(sides);
      number = -static_cast<Index>(piece.places.size());
    }
  }

  void find_star_planes(Workshop& shop, Index v) const {
    std::sort(shop.plane_of.begin(), shop.plane_of.end());
    shop.star.clear();
    for (const Index t : star_[v]) {
      Row planes{};
      std::size_t count = 0;
      for (const Index other : mesh_.tetrahedra[at(t)]) {
        if (other == v) continue;
        planes[count++] =
            std::lower_bound(shop.plane_of.begin(), shop.plane_of.end(), std::pair(other, Index{0}))->second;
      }
      shop.star.push_back(planes);
    }
    std::sort(shop.plane_of.begin(), shop.plane_of.end(),
              [](const auto& a, const auto& b) { return a.second < b.second; });
  }

  const SpaceMesh& mesh_;
  const Box3& box_;
  const SphereCenters& spheres_;
  const base::Groups<Index> star_;    // tetrahedra of each point
  const base::Groups<Index> linked_;  // points that share an edge, where there are no tetrahedra
};

}  // namespace

std::vector<Piece> cell_pieces(const SpaceMesh& mesh, const Box3& box, const SphereCenters& spheres,
                               unsigned threads, const Monitor& monitor) {
  const PieceMaker maker(mesh, box, spheres);
  std::vector<Piece> pieces(base::piece_count(mesh.points.size(), points_a_piece));
  base::for_pieces(mesh.points.size(), points_a_piece, threads, monitor,
                   [&](std::size_t piece, std::size_t begin, std::size_t end) {
                     maker.make_piece(pieces[piece], begin, end);
                   });
  return pieces;
}

}  // namespace vorotool::core::cells_in_space
