#include "core/cells_in_space/space_cells.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "core/base/disjoint_sets.hpp"
#include "core/base/groups.hpp"
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/cells_in_space/cell_pieces.hpp"

namespace vorotool::core::cells_in_space {

using base::at;
using base::Monitor;

namespace {

using Index = std::int32_t;

bool is_written(const PieceFace& face) { return face.across < 0 || face.across > face.cell; }

// Puts pieces together.
class Gatherer {
 public:
  Gatherer(std::span<const Center> centers, std::size_t points, std::vector<Piece>&& pieces, unsigned threads)
      : centers_(centers),
        points_(points),
        threads_(threads),
        pieces_(std::move(pieces)),
        on_box_(join_on_box()) {}

  SpaceCells gather() {
    SpaceCells cells;
    number_used(cells);
    for (const Piece& piece : pieces_) {
      for (const PieceFace& face : piece.faces) {
        if (!is_written(face)) continue;
        cells.face_cells.push_back({face.cell, face.across});
        cells.face_starts.push_back(cells.face_starts.back() + (face.end - face.begin));
      }
    }
    if (cells.face_cells.size() > most_faces) throw std::length_error("more than 2147483647 faces");
    cells.corners.resize(static_cast<std::size_t>(cells.face_starts.back()));
    fill_corners(cells);
    base::Groups<Index> of_cells(points_, [&](const auto& add) {
      for (std::size_t f = 0; f < cells.face_cells.size(); ++f) {
        for (const Index cell : cells.face_cells[f]) {
          if (cell >= 0) add(cell, static_cast<Index>(f));
        }
      }
    });
    cells.cell_starts.assign(1, 0);
    for (std::size_t i = 0; i < points_; ++i)
      cells.cell_starts.push_back(cells.cell_starts.back() + static_cast<std::int64_t>(of_cells[i].size()));
    cells.cell_faces = of_cells.take();
    return cells;
  }

 private:
  // Numbers the vertices that faces have: centers in the order of tetrahedra, then those on the box.
  void number_used(SpaceCells& cells) {
    number_.assign(centers_.size() + on_box_.size(), base::no_index);
    for (const Piece& piece : pieces_) {
      for (const Index v : piece.corners) number_[slot(piece, v)] = 0;
    }
    for (std::size_t i = 0; i < number_.size(); ++i) {
      if (number_[i] < 0) continue;
      number_[i] = static_cast<Index>(cells.vertices.size());
      cells.vertices.push_back(i < centers_.size() ? centers_[i].place : Point3{});
    }
    for (const Piece& piece : pieces_) {
      for (std::size_t k = 0; k < piece.places.size(); ++k) {
        const Index number = number_[slot(piece, -1 - static_cast<Index>(k))];
        if (number >= 0) cells.vertices[at(number)] = piece.places[k];
      }
    }
  }

  std::size_t slot(const Piece& piece, Index v) const {
    return v >= 0 ? at(v) : centers_.size() + at(on_box_[at(piece.first_vertex - 1 - v)]);
  }

  void fill_corners(SpaceCells& cells) const {
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
        for (std::size_t i = face.begin; i < face.end; ++i) *end++ = number_[slot(piece, piece.corners[i])];
        std::rotate(begin, std::min_element(begin, end), end);
      }
    });
  }

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
      if (i + 1 == shared.size() || shared[i].cells() != shared[i + 1].cells()) refuse_mesh();
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
    if (b.face->end - b.face->begin != size) refuse_mesh();
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
    if (turn == size) refuse_mesh();
    for (i = 0; i < size; ++i) {
      const Index v = corner(a, i), w = corner(b, opposite(i));
      if (v < 0) sets.join(a.piece->first_vertex - 1 - v, b.piece->first_vertex - 1 - w);
    }
  }

  static constexpr std::size_t most_faces = 0x7fffffff;

  const std::span<const Center> centers_;
  const std::size_t points_;
  const unsigned threads_;
  std::vector<Piece> pieces_;
  const std::vector<Index> on_box_;  // for each vertex on the box the first one that is the same
  std::vector<Index> number_;        // of centers, then of vertices on the box, that are in use; else -1
};

}  // namespace

SpaceCells space_cells(const SpaceMesh& mesh, const Box3& box, unsigned threads, const Monitor& monitor) {
  const SphereCenters spheres = sphere_centers(mesh, box, threads, monitor);
  std::vector<Piece> pieces = cell_pieces(mesh, box, spheres, threads, monitor);
  return Gatherer(spheres.centers, mesh.points.size(), std::move(pieces), threads).gather();
}

}  // namespace vorotool::core::cells_in_space
