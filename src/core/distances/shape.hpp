// A set of the plane: points, segments, and what lies inside polygons.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/distances/element_tree.hpp"

namespace vorotool::core::distances {

// A place of a shape, and how far another one is from it.
struct Reached {
  double distance;
  kernel::Point on;
};

class Shape {
 public:
  struct Ring {
    std::int32_t polygon;
    std::int32_t is_hole;
  };

  // Elements with a ring >= 0 bound what is inside the polygon of that ring: all places that are inside its
  // shell and in none of its holes, each ring by the even-odd rule. Rings of a polygon follow one another.
  // What is given must outlive the shape.
  Shape(std::span<const Element> elements, std::span<const std::int32_t> ring_of, std::span<const Ring> rings,
        const base::Monitor& monitor);

  std::span<const Element> elements() const { return elements_; }
  const ElementTree& tree() const { return tree_; }
  bool empty() const { return elements_.empty(); }
  bool is_filled() const { return !rings_.empty(); }
  bool is_bound(std::uint32_t element) const { return is_filled() && ring_of_[element] >= 0; }

  // Whether a place is inside a polygon or on the outline of one; exact.
  bool contains(const kernel::Point& p) const;

  // From the place itself, if it is inside, else from the nearest element.
  Reached reach(const kernel::Point& p) const;

 private:
  std::span<const Element> elements_;
  std::span<const std::int32_t> ring_of_;
  std::span<const Ring> rings_;
  ElementTree tree_;
};

// Of each place whether the shape contains it, and its `reach`.
std::vector<std::uint8_t> contained(const Shape& shape, std::span<const kernel::Point> places,
                                    unsigned threads, const base::Monitor& monitor);
std::vector<Reached> reached(const Shape& shape, std::span<const kernel::Point> places, unsigned threads,
                             const base::Monitor& monitor);

}  // namespace vorotool::core::distances
