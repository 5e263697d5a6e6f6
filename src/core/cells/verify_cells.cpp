#include "core/cells/verify_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/kernel/circumcenter.hpp"
#include "core/kernel/predicates.hpp"
#include "core/numbers/double_double.hpp"
#include "core/numbers/elementary.hpp"
#include "core/spatial/kd_tree.hpp"
#include "core/text/number_text.hpp"

namespace vorotool::core::cells {

using base::Fault;
using base::Monitor;
using kernel::Point;
using numbers::DoubleDouble;
using numbers::hypotenuse;
using numbers::two_difference;
using text::append_number;

namespace {

constexpr std::size_t cells_a_piece = std::size_t{1} << 12;

// Twice the distance at which the place that is rounded to this point may lie from it, times 2^scale.
double rounding_diameter(const Point& p, int scale) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto ulp = [=](double v) {
    return std::ldexp(std::nextafter(std::abs(v), infinity) - std::abs(v), scale);
  };
  return hypotenuse(ulp(p.x), ulp(p.y));
}

// An exact sum to a relative error of a few roundings: terms come by increasing magnitude.
double approximately(std::span<const double> terms) {
  return std::accumulate(terms.begin(), terms.end(), 0.0);
}

std::string text_of(const Point& p) {
  std::string text = "(";
  append_number(text, p.x);
  append_number(text += ", ", p.y);
  return text + ")";
}

// For bounds computed in a few steps of doubles.
constexpr double generous = 1 + 0x1p-40;

class Checker {
 public:
  Checker(const CellRings& cells, const Box& frame, unsigned threads, const Monitor& monitor)
      : in_(cells), frame_(frame), threads_(threads), monitor_(monitor) {}

  Fault run() {
    if (Fault fault = check_starts()) return fault;
    if (Fault fault = check_duplicates()) return fault;
    make_tree();
    const auto check = [&](std::size_t cell) { return check_cell(cell); };
    if (Fault fault = base::first_fault(in_.sites.size(), check, threads_, monitor_)) return fault;
    return check_area();
  }

 private:
  using Tree = spatial::KdTree<double, double>;

  std::span<const Point> ring(std::size_t cell) const {
    const auto begin = static_cast<std::size_t>(in_.starts[cell]);
    return in_.vertices.subspan(begin, static_cast<std::size_t>(in_.starts[cell + 1]) - begin);
  }

  Fault check_starts() const {
    for (std::size_t i = 0; i < in_.sites.size(); ++i) {
      const std::int64_t size = in_.starts[i + 1] - in_.starts[i];
      if (size == 1 || size == 2)
        return "cell " + std::to_string(i) + " has only " + std::to_string(size) + " vertices";
    }
    return {};
  }

  Fault check_duplicates() const {
    std::vector<std::uint32_t> order(in_.sites.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t i) { return std::tuple(in_.sites[i].x, in_.sites[i].y, i); };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t k = 1; k < order.size(); ++k) {
      const Point &p = in_.sites[order[k - 1]], &q = in_.sites[order[k]];
      if (p.x == q.x && p.y == q.y && !ring(order[k]).empty()) {
        return "point " + std::to_string(order[k]) + " lies on an earlier one, but has a cell";
      }
    }
    return {};
  }

  // A power of two brings all coordinates into [-1, 1]: squares of distances do not overflow. What underflows
  // makes the tree's answer less near than it could be, but compare_distances() decides.
  void make_tree() {
    double largest = 0;
    for (const auto points : {in_.sites, in_.vertices}) {
      for (const Point& p : points) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    }
    scale_ = largest > 0 ? -std::ilogb(largest) - 1 : 0;
    std::vector<double> x, y;
    std::vector<std::uint32_t> labels(in_.sites.size());
    std::iota(labels.begin(), labels.end(), 0U);
    for (const Point& p : in_.sites) {
      x.push_back(std::ldexp(p.x, scale_));
      y.push_back(std::ldexp(p.y, scale_));
    }
    tree_.emplace(Tree::Columns{x, y}, labels, monitor_);
    place_.resize(in_.sites.size());
    for (std::size_t i = 0; i < place_.size(); ++i) {
      place_[tree_->site(static_cast<std::ptrdiff_t>(i)).index] = static_cast<std::uint32_t>(i);
    }
  }

  Fault check_cell(std::size_t cell) const {
    const std::span<const Point> vertices = ring(cell);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const Point &p = vertices[k], &q = vertices[(k + 1) % vertices.size()],
                  &r = vertices[(k + 2) % vertices.size()];
      const auto fault = [&](const std::string& what) {
        return "vertex " + text_of(q) + " of cell " + std::to_string(cell) + what;
      };
      if (q.x < frame_.left || q.x > frame_.right || q.y < frame_.bottom || q.y > frame_.top) {
        return fault(" is not in the frame");
      }
      if (p.x == q.x && p.y == q.y) return fault(" is repeated");
      if (turns_right(p, q, r)) return fault(" is not convex");
      const std::size_t other = nearest_site(q, cell);
      if (is_nearer(q, in_.sites[other], in_.sites[cell])) {
        return fault(" is nearer to site " + std::to_string(other) + " by more than rounding explains");
      }
    }
    return {};
  }

  // Places within d / 2 of p, q, r, for which the cross product of q - p and r - p is not negative, change it
  // by at most d (|q - p| + |r - p|) + d^2.
  static bool turns_right(const Point& p, const Point& q, const Point& r) {
    if (kernel::orient2d(p, q, r) >= 0) return false;
    const int scale = scale_for({p.x - q.x, p.y - q.y, p.x - r.x, p.y - r.y});
    const auto scaled = [&](const Point& v) { return Point{std::ldexp(v.x, scale), std::ldexp(v.y, scale)}; };
    const Point a = scaled(p), b = scaled(q), c = scaled(r);
    const double d =
        std::max({rounding_diameter(p, scale), rounding_diameter(q, scale), rounding_diameter(r, scale)});
    const DoubleDouble cross = two_difference(b.x, a.x) * two_difference(c.y, a.y) -
                               two_difference(b.y, a.y) * two_difference(c.x, a.x);
    return -cross.head > (d * (distance(a, b) + distance(a, c)) + d * d) * generous;
  }

  // The binary exponent of a factor that brings the largest difference near 1: what follows does not
  // overflow, nor underflow so that it matters.
  static int scale_for(const std::array<double, 4>& differences) {
    double largest = 0;
    for (const double value : differences) largest = std::max(largest, std::abs(value));
    return std::isfinite(largest) ? -std::ilogb(largest) : -1023;
  }

  std::size_t nearest_site(const Point& q, std::size_t own) const {
    const Tree::Place at{std::ldexp(q.x, scale_), std::ldexp(q.y, scale_)};
    const Tree::Nearest nearest = tree_->nearest(at, tree_->bound(place_[own], at));
    return tree_->site(nearest.place).index;
  }

  // Whether q is nearer to a site than to its own by more than its rounding diameter d. The difference of the
  // squared distances is then more than 2 d times the smaller one and d^2. It may cancel to any degree: its
  // sum is exact.
  static bool is_nearer(const Point& q, const Point& site, const Point& own) {
    if (kernel::compare_distances(q, own, site) <= 0) return false;
    const int scale = scale_for({q.x - own.x, q.y - own.y, q.x - site.x, q.y - site.y});
    const auto difference = [&](double to, double from) {
      return numbers::Expansion<2>(two_difference(std::ldexp(to, scale), std::ldexp(from, scale)));
    };
    const auto product = [&](double at, double a, double b) {
      return difference(b, a) * (difference(at, a) + difference(at, b));
    };
    const auto squares = product(q.x, own.x, site.x) + product(q.y, own.y, site.y);
    const double d = rounding_diameter(q, scale);
    const double reach = hypotenuse(std::ldexp(q.x, scale) - std::ldexp(site.x, scale),
                                    std::ldexp(q.y, scale) - std::ldexp(site.y, scale));
    return approximately(squares.terms()) > (2 * d * reach + d * d) * generous;
  }

  // Cells that share their vertices tile the frame: areas add up to its area whatever the rounding. Each
  // product has a relative error below 12 u^2 once its factors are exact, and there are as many as vertices.
  Fault check_area() const {
    const int width = -std::ilogb(frame_.right / 2 - frame_.left / 2);
    const int height = -std::ilogb(frame_.top / 2 - frame_.bottom / 2);
    const auto x = [&](double v) { return std::ldexp(v, width); };
    const auto y = [&](double v) { return std::ldexp(v, height); };
    const auto twice_area = [&](std::span<const Point> vertices) {
      DoubleDouble sum{0, 0};
      for (std::size_t k = 0; k + 1 < vertices.size(); ++k) {
        const Point &o = vertices[0], &p = vertices[k], &q = vertices[k + 1];
        sum = sum + (two_difference(x(p.x), x(o.x)) * two_difference(y(q.y), y(o.y)) -
                     two_difference(y(p.y), y(o.y)) * two_difference(x(q.x), x(o.x)));
      }
      return sum;
    };
    std::vector<DoubleDouble> sums(base::piece_count(in_.sites.size(), cells_a_piece), DoubleDouble{0, 0});
    const auto add = [&](std::size_t piece, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) sums[piece] = sums[piece] + twice_area(ring(i));
    };
    base::for_pieces(in_.sites.size(), cells_a_piece, threads_, monitor_, add);
    const DoubleDouble sum = std::accumulate(sums.begin(), sums.end(), DoubleDouble{0, 0});
    const std::array<Point, 4> corners{Point{frame_.left, frame_.bottom},
                                       {frame_.right, frame_.bottom},
                                       {frame_.right, frame_.top},
                                       {frame_.left, frame_.top}};
    const DoubleDouble frame = twice_area(corners);
    const double allowed = 0x1p-102 * static_cast<double>(in_.vertices.size() + 8) * frame.head;
    if (in_.sites.empty() || std::abs((sum - frame).head) <= allowed) return {};
    std::string share;
    append_number(share, sum.head / frame.head);
    return "the areas of the cells add up to " + share + " times that of the frame";
  }

  const CellRings& in_;
  const Box frame_;
  const unsigned threads_;
  const Monitor& monitor_;
  int scale_ = 0;  // binary exponent of the factor between coordinates and those of the tree
  std::optional<Tree> tree_;
  std::vector<std::uint32_t> place_;  // [n] of each site in the tree
};

}  // namespace

Fault find_cell_fault(const CellRings& cells, const Box& frame, unsigned threads, const Monitor& monitor) {
  return Checker(cells, frame, threads, monitor).run();
}

}  // namespace vorotool::core::cells
