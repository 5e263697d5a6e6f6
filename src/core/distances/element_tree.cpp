#include "core/distances/element_tree.hpp"

#include <array>

namespace vorotool::core::distances {

ElementTree::ElementTree(std::span<const Element> elements, const base::Monitor& monitor) {
  items_.reserve(elements.size());
  for (const Element& element : elements)
    items_.push_back({element, static_cast<std::uint32_t>(items_.size())});
  std::size_t leaves = 1;
  while (leaves * leaf_size < items_.size()) leaves *= 2;
  nodes_.resize(2 * leaves - 1);
  first_leaf_ = leaves - 1;
  if (!items_.empty()) build(root(), monitor);
}

void ElementTree::build(const Run& run, const base::Monitor& monitor) {
  if (run.size() > 4096) base::report(monitor, 0);
  Node made{Box::of(items_[run.first].element), UINT32_MAX};
  for (const Item& item : items(run)) {
    made.box.add(Box::of(item.element));
    made.least_number = std::min(made.least_number, item.number);
  }
  nodes_[run.node] = made;
  if (is_leaf(run)) return;
  const Box& box = made.box;
  const bool by_x = box.high.x - box.low.x >= box.high.y - box.low.y;
  const auto place = [by_x](const Item& i) {
    return by_x ? i.element.a.x + i.element.b.x : i.element.a.y + i.element.b.y;
  };
  const auto item = [this](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(item(run.first), item(run.left().last), item(run.last), [&](const Item& i, const Item& j) {
    return place(i) != place(j) ? place(i) < place(j) : i.number < j.number;
  });
  build(run.left(), monitor);
  build(run.right(), monitor);
}

void ElementTree::nearest(const Run& run, const Box& place, Nearest& best) const {
  if (is_leaf(run)) {
    for (const Item& item : items(run))
      best = std::min(best, {square_distance(item.element, place.low), item.number});
    return;
  }
  std::array<Run, 2> below{run.left(), run.right()};
  std::array<Nearest, 2> bound;
  for (std::size_t i = 0; i < 2; ++i) {
    const Node& own = node(below[i]);
    bound[i] = {own.box.square_distance(place), own.least_number};
  }
  const std::size_t first = bound[1] < bound[0] ? 1 : 0;
  if (bound[first] < best) nearest(below[first], place, best);
  if (bound[1 - first] < best) nearest(below[1 - first], place, best);
}

}  // namespace vorotool::core::distances
