#include "core/cells_in_space/space_cells.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/base/disjoint_sets.hpp"
#include "core/base/groups.hpp"
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/cells_in_space/box_cutter.hpp"
#include "core/tetrahedra/predicates.hpp"

namespace vorotool::core::cells_in_space {

using base::at;
using base::for_pieces;
using base::Monitor;

namespace {

using Index = std::int32_t;
using Row = SpaceMesh::Row;

constexpr std::size_t tetrahedra_a_piece = std::size_t{1} << 12, points_a_piece = std::size_t{1} << 9;

[[noreturn]] void refuse() { throw std::invalid_argument("the triangulation is not Delaunay"); }

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
  if (found == row.size()) refuse();
  return found;
}

using SideSet = std::uint8_t;  // a bit a side

// The center of the sphere of a tetrahedron.
struct Center {
  Point3 place;
  SideSet beyond, on;  // sides of the box beyond which it is, or on which
};

// One face of a cell, its corners in those of the piece: tetrahedra, or -1 - k for vertex k on the box of the piece.
struct PieceFace {
  Index cell, across;  // across: a point, or -1 - side
  std::uint32_t begin, end;
};

// What some points have: all faces of cells that were cut, of the others those towards greater points.
struct Piece {
  std::vector<PieceFace> faces;
  std::vector<Index> corners;
  std::vector<Point3> places;  // of vertices on the box
  std::vector<SideSet> sides;  // on which each is
  Index first_vertex = 0;      // the number of the first of them

  bool is_on_box(const PieceFace& face) const {
    return std::any_of(corners.begin() + face.begin, corners.begin() + face.end,
                       [](Index v) { return v < 0; });
  }
};

bool is_written(const PieceFace& face) { return face.across < 0 || face.across > face.cell; }

class CellMaker {
 public:
  CellMaker(const SpaceMesh& mesh, const Box3& box, unsigned threads, const Monitor& monitor)
      : mesh_(mesh),
        box_(box),
        threads_(threads),
        monitor_(monitor),
        centers_(mesh.tetrahedra.size()),
        sets_(mesh.tetrahedra.size()),
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

  SpaceCells run() {
    place_centers();
    join_centers();
    pieces_.resize(base::piece_count(mesh_.points.size(), points_a_piece));
    for_pieces(mesh_.points.size(), points_a_piece, threads_, monitor_,
               [&](std::size_t piece, std::size_t begin, std::size_t end) {
                 make_piece(pieces_[piece], begin, end);
               });
    const std::vector<Index> on_box = join_on_box();
    return gather(on_box);
  }

 private:
  const Point3& point(Index v) const { return mesh_.points[at(v)]; }

  // ---- centers of tetrahedra
  void place_centers() {
    for_pieces(centers_.size(), tetrahedra_a_piece, threads_, monitor_,
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 CellPlanes planes(box_);
                 for (std::size_t t = begin; t < end; ++t)
                   centers_[t] = center_of(planes, mesh_.tetrahedra[t]);
               });
  }

  Center center_of(CellPlanes& planes, const Row& row) const {
    if (tetrahedra::orient3d(point(row[1]), point(row[2]), point(row[3]), point(row[0])) >= 0) refuse();
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

  // ---- cells
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

  void make_piece(Piece& piece, std::size_t begin, std::size_t end) const {
    Workshop shop(box_);
    for (std::size_t i = begin; i < end; ++i) {
      const auto v = static_cast<Index>(i);
      if (mesh_.first[i] != v) continue;
      const std::span<const Index> star = star_[v];
      if (star.empty()) {
        if (!mesh_.tetrahedra.empty()) refuse();
        cut(piece, shop, v);
        continue;
      }
      SideSet any = 0, all = 0xff;
      bool is_open = false;
      for (const Index t : star) {
        const Center& center = centers_[at(t)];
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
      if (t < 0 || most-- == 0) refuse();
      const Index center = sets_[at(t)];
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
        number = sets_[at(star[static_cast<std::size_t>(found - shop.star.begin())])];
        continue;
      }
      if (sides == 0) refuse();
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

  // ---- vertices on the box
  struct Shared {
    Index smaller, greater;
    const Piece* piece;
    const PieceFace* face;

    std::pair<Index, Index> cells() const { return {smaller, greater}; }
  };

  // For each vertex on the box the first one that is the same. Those of two cells are the same where they are the same
  // corner of the face in common, which both have; and all cells at a vertex are connected by such faces.
  std::vector<Index> join_on_box() {
    Index count = 0;
    std::vector<Shared> shared;
    for (Piece& piece : pieces_) {
      piece.first_vertex = count;
      count += static_cast<Index>(piece.places.size());
      for (const PieceFace& face : piece.faces) {
        if (face.across >= 0 && piece.is_on_box(face))
          shared.push_back(
              {std::min(face.cell, face.across), std::max(face.cell, face.across), &piece, &face});
      }
    }
    std::sort(shared.begin(), shared.end(), [](const Shared& a, const Shared& b) {
      return std::pair(a.cells(), a.face->cell) < std::pair(b.cells(), b.face->cell);
    });
    base::DisjointSets<Index> sets(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < shared.size(); i += 2) {
      if (i + 1 == shared.size() || shared[i].cells() != shared[i + 1].cells()) refuse();
      join_corners(shared[i], shared[i + 1], sets);
    }
    std::vector<Index> result(static_cast<std::size_t>(count));
    for (Index k = 0; k < count; ++k) result[at(k)] = sets.find(k);
    return result;
  }

  // A polygon meets a side of the box in one edge at most, so that what its corners are, centers of certain tetrahedra
  // or on certain sides, is the same in one rotation only.
  static void join_corners(const Shared& a, const Shared& b, base::DisjointSets<Index>& sets) {
    const std::size_t size = a.face->end - a.face->begin;
    if (b.face->end - b.face->begin != size) refuse();
    const auto corner = [](const Shared& of, std::size_t i) { return of.piece->corners[of.face->begin + i]; };
    const auto is_same = [&](Index v, Index w) {
      if (v >= 0 || w >= 0) return v == w;
      return a.piece->sides[at(-1 - v)] == b.piece->sides[at(-1 - w)];
    };
    std::size_t turn = 0, i = 0;
    const auto opposite = [&](std::size_t k) { return (turn + size - k) % size; };
    for (; turn < size; ++turn) {
      for (i = 0; i < size && is_same(corner(a, i), corner(b, opposite(i))); ++i) {
      }
      if (i == size) break;
    }
    if (turn == size) refuse();
    for (i = 0; i < size; ++i) {
      const Index v = corner(a, i), w = corner(b, opposite(i));
      if (v < 0) sets.join(a.piece->first_vertex - 1 - v, b.piece->first_vertex - 1 - w);
    }
  }

  // ---- the result
  SpaceCells gather(const std::vector<Index>& on_box) {
    SpaceCells cells;
    number_used(cells, on_box);
    for (const Piece& piece : pieces_) {
      for (const PieceFace& face : piece.faces) {
        if (!is_written(face)) continue;
        cells.face_cells.push_back({face.cell, face.across});
        cells.face_starts.push_back(cells.face_starts.back() + (face.end - face.begin));
      }
    }
    if (cells.face_cells.size() > most_faces) throw std::length_error("more than 2147483647 faces");
    cells.corners.resize(static_cast<std::size_t>(cells.face_starts.back()));
    fill_corners(cells, on_box);
    base::Groups<Index> of_cells(mesh_.points.size(), [&](const auto& add) {
      for (std::size_t f = 0; f < cells.face_cells.size(); ++f) {
        for (const Index cell : cells.face_cells[f]) {
          if (cell >= 0) add(cell, static_cast<Index>(f));
        }
      }
    });
    cells.cell_starts.assign(1, 0);
    for (std::size_t i = 0; i < mesh_.points.size(); ++i)
      cells.cell_starts.push_back(cells.cell_starts.back() + static_cast<std::int64_t>(of_cells[i].size()));
    cells.cell_faces = of_cells.take();
    return cells;
  }

  // Numbers the vertices that faces have: centers in the order of tetrahedra, then those on the box.
  void number_used(SpaceCells& cells, const std::vector<Index>& on_box) {
    number_.assign(centers_.size() + on_box.size(), base::no_index);
    for (const Piece& piece : pieces_) {
      for (const Index v : piece.corners) number_[slot(piece, v, on_box)] = 0;
    }
    for (std::size_t i = 0; i < number_.size(); ++i) {
      if (number_[i] < 0) continue;
      number_[i] = static_cast<Index>(cells.vertices.size());
      cells.vertices.push_back(i < centers_.size() ? centers_[i].place : Point3{});
    }
    for (const Piece& piece : pieces_) {
      for (std::size_t k = 0; k < piece.places.size(); ++k) {
        const Index number = number_[slot(piece, -1 - static_cast<Index>(k), on_box)];
        if (number >= 0) cells.vertices[at(number)] = piece.places[k];
      }
    }
  }

  std::size_t slot(const Piece& piece, Index v, const std::vector<Index>& on_box) const {
    return v >= 0 ? at(v) : centers_.size() + at(on_box[at(piece.first_vertex - 1 - v)]);
  }

  void fill_corners(SpaceCells& cells, const std::vector<Index>& on_box) const {
    std::vector<std::size_t> begins{0};
    for (const Piece& piece : pieces_) {
      const auto written = std::count_if(piece.faces.begin(), piece.faces.end(), is_written);
      begins.push_back(begins.back() + static_cast<std::size_t>(written));
    }
    base::parallel_for(pieces_.size(), threads_, [&](std::size_t k) {
      const Piece& piece = pieces_[k];
      auto face_start = cells.face_starts.begin() + static_cast<std::ptrdiff_t>(begins[k]);
      for (const PieceFace& face : piece.faces) {
        if (!is_written(face)) continue;
        const auto begin = cells.corners.begin() + static_cast<std::ptrdiff_t>(*face_start++);
        auto end = begin;
        for (std::size_t i = face.begin; i < face.end; ++i)
          *end++ = number_[slot(piece, piece.corners[i], on_box)];
        std::rotate(begin, std::min_element(begin, end), end);
      }
    });
  }

  static constexpr std::size_t most_faces = 0x7fffffff;

  const SpaceMesh& mesh_;
  const Box3 box_;
  const unsigned threads_;
  const Monitor& monitor_;
  std::vector<Center> centers_;
  std::vector<Index> sets_;           // of each tetrahedron the first one with the same center
  const base::Groups<Index> star_;    // tetrahedra of each point
  const base::Groups<Index> linked_;  // points that share an edge, where there are no tetrahedra
  std::vector<Piece> pieces_;
  std::vector<Index> number_;  // of centers, then of vertices on the box, that are in use; else -1
};

}  // namespace

SpaceCells space_cells(const SpaceMesh& mesh, const Box3& box, unsigned threads, const Monitor& monitor) {
  return CellMaker(mesh, box, threads, monitor).run();
}

}  // namespace vorotool::core::cells_in_space
