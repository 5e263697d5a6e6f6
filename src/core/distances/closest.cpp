#include "core/distances/closest.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/distances/along_segment.hpp"
#include "core/kernel/predicates.hpp"

namespace vorotool::core::distances {

using kernel::Point;

namespace {

// The closest pair of elements so far: the smallest square of the distance, then the smallest numbers.
struct Pair {
  double d2 = std::numeric_limits<double>::infinity();
  std::uint32_t a = UINT32_MAX, b = UINT32_MAX;

  friend bool operator<(const Pair& p, const Pair& q) {
    return std::tie(p.d2, p.a, p.b) < std::tie(q.d2, q.a, q.b);
  }
};

struct Places {
  double d2;
  Point on_a, on_b;
};

bool is_on(const Element& e, const Point& p) {
  return kernel::orient2d(e.a, e.b, p) == 0 && Box::of(e).meets({p, p});
}

// The closest places of an end of one and the other element.
Places from_end(const Element& e, const Point& p) {
  if (is_on(e, p)) return {0, p, p};
  return {square_distance(e, p), p, nearest_place(e, p)};
}

Places closest(const Element& a, const Element& b) {
  Places best = from_end(b, a.a);
  const auto take = [&](const Places& other) {
    if (other.d2 < best.d2) best = other;
  };
  const auto take_turned = [&](const Places& other) { take({other.d2, other.on_b, other.on_a}); };
  take(from_end(b, a.b));
  take_turned(from_end(a, b.a));
  take_turned(from_end(a, b.b));
  if (best.d2 > 0 && Box::of(a).meets(Box::of(b))) {
    std::vector<double> shares;
    add_meetings(a, b, shares);
    if (!shares.empty()) best = {0, a.at(shares.front()), a.at(shares.front())};
  }
  return best;
}

class PairSearch {
 public:
  PairSearch(const ElementTree& a, const ElementTree& b, const base::Monitor& monitor)
      : a_(a), b_(b), monitor_(monitor) {}

  Pair run() {
    search(a_.root(), b_.root());
    return best_;
  }

 private:
  using Run = ElementTree::Run;

  Pair bound(const Run& a, const Run& b) const {
    const auto& [box_a, least_a] = a_.node(a);
    const auto& [box_b, least_b] = b_.node(b);
    return {box_a.square_distance(box_b), least_a, least_b};
  }

  void search(const Run& a, const Run& b) {
    base::report_item(monitor_, ++steps_);
    if (a_.is_leaf(a) && b_.is_leaf(b)) {
      compare(a, b);
      return;
    }
    // The larger of both is divided.
    const bool divides_a = !a_.is_leaf(a) && (b_.is_leaf(b) || a.size() >= b.size());
    const std::array<std::array<Run, 2>, 2> below =
        divides_a ? std::array{std::array{a.left(), b}, std::array{a.right(), b}}
                  : std::array{std::array{a, b.left()}, std::array{a, b.right()}};
    const std::array<Pair, 2> bounds{bound(below[0][0], below[0][1]), bound(below[1][0], below[1][1])};
    const std::size_t first = bounds[1] < bounds[0] ? 1 : 0;
    for (const std::size_t i : {first, 1 - first}) {
      if (bounds[i] < best_) search(below[i][0], below[i][1]);
    }
  }

  void compare(const Run& a, const Run& b) {
    for (const auto& [element_a, number_a] : a_.items(a)) {
      for (const auto& [element_b, number_b] : b_.items(b)) {
        const double apart = Box::of(element_a).square_distance(Box::of(element_b));
        if (!(Pair{apart, number_a, number_b} < best_)) continue;
        best_ = std::min(best_, {closest(element_a, element_b).d2, number_a, number_b});
      }
    }
  }

  const ElementTree& a_;
  const ElementTree& b_;
  const base::Monitor& monitor_;
  std::size_t steps_ = 0;
  Pair best_;
};

// The first of the elements whose first end a shape contains. Where no elements of both meet, each is inside
// a polygon with all of its places, or with none.
std::optional<Point> first_inside(std::span<const Element> elements, const Shape& shape, unsigned threads,
                                  const base::Monitor& monitor) {
  if (!shape.is_filled()) return {};
  constexpr std::size_t grain = 1 << 8;  // elements a piece: up to some milliseconds
  std::atomic<std::size_t> first = elements.size();
  base::for_items(elements.size(), grain, threads, monitor, [&](std::size_t i) {
    const bool follows = i % grain != 0 && elements[i - 1].b == elements[i].a;
    std::size_t known = first.load();
    if (follows || i >= known || !shape.contains(elements[i].a)) return;
    while (i < known && !first.compare_exchange_weak(known, i)) {
    }
  });
  const std::size_t found = first.load();
  if (found == elements.size()) return {};
  return elements[found].a;
}

}  // namespace

Closest closest_places(const Shape& a, const Shape& b, unsigned threads, const base::Monitor& monitor) {
  if (a.empty() || b.empty()) return {-1, {0, 0}, {0, 0}};
  const Pair pair = PairSearch(a.tree(), b.tree(), monitor).run();
  const Places places = closest(a.elements()[pair.a], b.elements()[pair.b]);
  if (places.d2 > 0) {
    std::optional<Point> inside = first_inside(a.elements(), b, threads, monitor);
    if (!inside) inside = first_inside(b.elements(), a, threads, monitor);
    if (inside) return {0, *inside, *inside};
  }
  return {std::sqrt(places.d2), places.on_a, places.on_b};
}

}  // namespace vorotool::core::distances
