#include "core/sampled_skeleton/boundary_crossings.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/numbers/fixed_integer.hpp"
#include "core/numbers/rounded_quotient.hpp"
#include "core/numbers/sign.hpp"

namespace vorotool::core::sampled_skeleton {

using delaunay::following;
using delaunay::preceding;
using delaunay::VertexTriangles;
using kernel::LatticeSite;
using kernel::LatticeVector;
using kernel::Point;
using numbers::widen;

namespace {

// A parameter t = numerator / (2 denominator) along a piece where a cell is left for that of a neighbor.
// From core/sampled_skeleton/sample_mesh.hpp: both are below 2^108.
struct Exit {
  numbers::int128 numerator, denominator;
};

// The sign of the difference of two parameters with positive denominators: products are below 2^216.
int compare(const Exit& a, const Exit& b) {
  const double left = static_cast<double>(a.numerator) * static_cast<double>(b.denominator);
  const double right = static_cast<double>(b.numerator) * static_cast<double>(a.denominator);
  if (std::abs(left - right) > 8 * numbers::unit_roundoff * (std::abs(left) + std::abs(right)))
    return numbers::sign_of(left - right);
  return (widen(a.numerator) * widen(b.denominator) - widen(b.numerator) * widen(a.denominator)).sign();
}

// A neighbor of the seed in whose cell a walk is.
struct Spoke {
  std::int32_t seed;
  Side side;         // between both
  bool from_origin;  // the walker's seed is its origin
};

class Walk {
 public:
  Walk(const SampleMesh& mesh, const VertexTriangles& rings, const EdgePiece& piece, std::int32_t number,
       Crossings& found)
      : mesh_(mesh),
        rings_(rings),
        piece_(piece),
        number_(number),
        way_(sample_difference(mesh.seed(piece.last), mesh.seed(piece.first))),
        found_(found) {}

  void run() {
    for (std::int32_t p = piece_.first; p != piece_.last;) p = leave(p);
  }

 private:
  // Where q takes over from p: |x - p| = |x - q| at x = first + t way.
  Exit exit_to(std::int32_t p, std::int32_t q) const {
    const Point &from = mesh_.seed(piece_.first), &a = mesh_.seed(p), &b = mesh_.seed(q);
    const SampleVector step = sample_difference(b, a);
    const SampleVector sum = sample_difference(b, from) + sample_difference(a, from);
    return {dot(step, sum), dot(way_, step)};
  }

  // Goes through the cell of p, notes what is crossed where it is left, and gives the next seed.
  std::int32_t leave(std::int32_t p) {
    tied_.clear();
    ridden_.clear();
    Exit least{};
    visit_spokes(p, [&](const Spoke& spoke) {
      const Exit exit = exit_to(p, spoke.seed);
      if (exit.denominator == 0 && exit.numerator == 0) ridden_.push_back(spoke);
      if (exit.denominator <= 0) return;
      const int order = tied_.empty() ? -1 : compare(exit, least);
      if (order > 0) return;
      if (order < 0) tied_.clear();
      least = exit;
      tied_.push_back(spoke);
    });
    if (tied_.empty()) throw std::logic_error("a piece of an edge leads out of the diagram of its seeds");
    for (const Spoke& spoke : ridden_) found_.ridden.push_back(spoke.side);
    if (tied_.size() + ridden_.size() == 1) {
      found_.crossings.push_back({tied_[0].side, number_, tied_[0].from_origin});
      return tied_[0].seed;
    }
    note_touched(p);
    // beyond a vertex the nearest seed is the one that the piece approaches fastest
    return std::max_element(tied_.begin(), tied_.end(),
                            [&](const Spoke& a, const Spoke& b) {
                              return exit_to(p, a.seed).denominator < exit_to(p, b.seed).denominator;
                            })
        ->seed;
  }

  template <class Visit>
  void visit_spokes(std::int32_t p, const Visit& visit) const {
    Spoke last{-1, -1, false};
    const bool is_open = rings_.visit(p, [&](Triangle t, std::int32_t next, std::int32_t after) {
      const Side opposite = mesh_.opposite(t, p);
      visit(Spoke{next, preceding(opposite), true});
      last = {after, following(opposite), false};
    });
    if (is_open) visit(last);
  }

  // The circumcenters of triangles with two neighbors that take over at once.
  void note_touched(std::int32_t p) {
    const auto is_tied = [&](std::int32_t seed) {
      const auto same = [&](const Spoke& spoke) { return spoke.seed == seed; };
      return std::any_of(tied_.begin(), tied_.end(), same) ||
             std::any_of(ridden_.begin(), ridden_.end(), same);
    };
    rings_.visit(p, [&](Triangle t, std::int32_t next, std::int32_t after) {
      if (is_tied(next) && is_tied(after)) found_.touched.push_back(t);
    });
  }

  const SampleMesh& mesh_;
  const VertexTriangles& rings_;
  EdgePiece piece_;
  std::int32_t number_;
  SampleVector way_;
  Crossings& found_;
  std::vector<Spoke> tied_, ridden_;
};

// The segment of a piece, as the piece leads from the cell of the side's origin to that of its target.
LatticeSite across_side(const SampleLabels& labels, const Crossing& crossing) {
  const LatticeSite site = labels.graph().segment(base::at(labels.piece(crossing.piece).segment));
  return crossing.from_origin ? site : LatticeSite{site.b, site.a};
}

// On which side of the line of one segment the other one is: 1 if on its left, 0 if on both.
int side_of(const LatticeSite& line, const LatticeSite& other) {
  const LatticeVector way = line.b - line.a;
  const std::int64_t a = kernel::cross(way, other.a - line.a), b = kernel::cross(way, other.b - line.a);
  return (std::max(a, b) > 0 ? 1 : 0) - (std::min(a, b) < 0 ? 1 : 0);
}

// Negative if the other one is on the left. Segments meet at ends only: one at least is on one side of the
// other's line, or both are on one line.
int compare_segments(const LatticeSite& one, const LatticeSite& other) {
  const int side = side_of(other, one);
  return side != 0 ? side : -side_of(one, other);
}

template <class Items>
void append(Items& all, const Items& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

Crossings find_crossings(const SampleMesh& mesh, const VertexTriangles& rings, const SampleLabels& labels,
                         std::span<const std::int32_t> pieces, unsigned threads,
                         const base::Monitor& monitor) {
  constexpr std::size_t grain = 1 << 8;
  std::vector<Crossings> found(base::piece_count(pieces.size(), grain));
  const auto walk = [&](std::size_t part, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Walk(mesh, rings, labels.piece(pieces[i]), pieces[i], found[part]).run();
    }
  };
  base::for_pieces(pieces.size(), grain, threads, monitor, walk);
  Crossings all;
  for (const Crossings& part : found) {
    append(all.crossings, part.crossings);
    append(all.ridden, part.ridden);
    append(all.touched, part.touched);
  }
  return all;
}

// With u along the Voronoi edge, a crossing is at u x = u first + t u way = (2 d u first + n u way) / (2 d):
// the numerator is below 2^217, the denominator below 2^109, and products of both below 2^326.
int compare_crossings(const SampleMesh& mesh, const SampleLabels& labels, const Crossing& one,
                      const Crossing& other) {
  using Long = numbers::FixedInteger<6>;
  struct Place {
    Long numerator, denominator;
  };
  const Point &p = mesh.seed(mesh.origin(one.side)), &q = mesh.seed(mesh.target(one.side));
  const SampleVector step = sample_difference(q, p), along = left_of(step);
  const auto place = [&](const Crossing& crossing) {
    const EdgePiece piece = labels.piece(crossing.piece);
    const Point& from = mesh.seed(piece.first);
    const SampleVector way = sample_difference(mesh.seed(piece.last), from);
    const SampleVector sum = sample_difference(q, from) + sample_difference(p, from);
    numbers::int128 n = dot(step, sum), d = dot(way, step);
    if (d < 0) n = -n, d = -d;
    const auto first = widen(2 * d) * widen(dot(along, sample_difference(from, p)));
    return Place{numbers::resized<6>(first + widen(n) * widen(dot(along, way))),
                 numbers::resized<6>(widen(2 * d))};
  };
  const auto product = [](const Long& a, const Long& b) {
    const numbers::FixedInteger<12> whole = a * b;
    Long low;
    std::copy_n(whole.limb.begin(), 6, low.limb.begin());
    return low;
  };
  const Place a = place(one), b = place(other);
  const int order = (product(a.numerator, b.denominator) - product(b.numerator, a.denominator)).sign();
  return order != 0 ? order : compare_segments(across_side(labels, one), across_side(labels, other));
}

}  // namespace vorotool::core::sampled_skeleton
