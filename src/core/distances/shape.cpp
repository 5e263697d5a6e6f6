#include "core/distances/shape.hpp"

#include "core/base/parallel.hpp"
#include "core/kernel/predicates.hpp"

namespace vorotool::core::distances {

using kernel::Point;

namespace {

constexpr std::size_t places_a_piece = 1 << 10;  // some milliseconds

}  // namespace

Shape::Shape(std::span<const Element> elements, std::span<const std::int32_t> ring_of,
             std::span<const Ring> rings, const base::Monitor& monitor)
    : elements_(elements), ring_of_(ring_of), rings_(rings), tree_(elements, monitor) {}

bool Shape::contains(const Point& p) const {
  if (!is_filled()) return false;
  std::vector<std::int32_t> crossed;  // rings, once for each edge that the ray from p to the right crosses
  bool is_on = false;
  const Box ray{p, {std::numeric_limits<double>::infinity(), p.y}};
  tree_.meeting(ray, [&](const ElementTree::Item& item) {
    const auto& [a, b] = item.element;
    if (ring_of_[item.number] < 0) return;
    const int side = kernel::orient2d(a, b, p);
    if (side == 0) {
      is_on = is_on || Box::of(item.element).meets({p, p});
    } else if ((a.y > p.y) != (b.y > p.y) && (side > 0) == (b.y > a.y)) {
      crossed.push_back(ring_of_[item.number]);
    }
  });
  if (is_on) return true;
  // What is left are the rings that are crossed an odd number of times. A polygon of these whose shell comes
  // first and is followed by no hole of its own has p inside.
  std::sort(crossed.begin(), crossed.end());
  std::vector<std::int32_t> around;
  for (const std::int32_t ring : crossed) {
    if (!around.empty() && around.back() == ring) {
      around.pop_back();
    } else {
      around.push_back(ring);
    }
  }
  for (std::size_t i = 0; i < around.size(); ++i) {
    const Ring& ring = rings_[static_cast<std::size_t>(around[i])];
    if (ring.is_hole) continue;
    const bool has_hole =
        i + 1 < around.size() && rings_[static_cast<std::size_t>(around[i + 1])].polygon == ring.polygon;
    if (!has_hole) return true;
  }
  return false;
}

Reached Shape::reach(const Point& p) const {
  if (contains(p)) return {0, p};
  const Nearest found = tree_.nearest(p);
  const Point on = nearest_place(elements_[found.element], p);
  return {std::sqrt(found.d2), on};
}

std::vector<std::uint8_t> contained(const Shape& shape, std::span<const Point> places, unsigned threads,
                                    const base::Monitor& monitor) {
  std::vector<std::uint8_t> found(places.size());
  base::for_items(places.size(), places_a_piece, threads, monitor,
                  [&](std::size_t i) { found[i] = shape.contains(places[i]); });
  return found;
}

std::vector<Reached> reached(const Shape& shape, std::span<const Point> places, unsigned threads,
                             const base::Monitor& monitor) {
  std::vector<Reached> found(places.size());
  base::for_items(places.size(), places_a_piece, threads, monitor,
                  [&](std::size_t i) { found[i] = shape.reach(places[i]); });
  return found;
}

}  // namespace vorotool::core::distances
