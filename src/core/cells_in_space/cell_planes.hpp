// The planes that bound the Voronoi cell of a site in space, and exact decisions about the points where they meet.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/cells_in_space/polyhedra.hpp"
#include "core/numbers/rounded_quotient.hpp"

namespace vorotool::core::cells_in_space {

// A point where three planes meet, as homogeneous coordinates in floating point with the sums of the absolute terms of
// each: what filters need. Relative to the site, at (x, y, z) / w.
struct Meeting {
  std::array<std::int32_t, 3> planes;  // in such an order that w is positive
  double x, y, z, w;
  double x_size, y_size, z_size, w_size;
};

// A place rounded to the nearest doubles.
struct RoundedPlace {
  numbers::Rounded x, y, z;
};

// Planes of one cell: the six sides of the box, then bisectors of the site and others. Inside is the side of each on
// which the box, or the site, is.
class CellPlanes {
 public:
  explicit CellPlanes(const Box3& box) : box_(box) {}

  // Begins the cell of another site: there are no bisectors.
  void begin(const Point3& site);
  // Adds the bisector of the site and another one at another place; gives its number.
  std::int32_t add_bisector(const Point3& other);
  std::size_t size() const { return rows_.size(); }

  // Where three planes meet in one point.
  Meeting meeting(std::array<std::int32_t, 3> planes) const;
  // 1 if the point is inside a plane, 0 if it is on it, -1 if it is beyond; decided exactly.
  int side(const Meeting& point, std::int32_t plane) const;
  // The point rounded: in 106 bits if these tell, else in integers. By integers it has the signs of its errors.
  RoundedPlace place(const std::array<std::int32_t, 3>& planes) const;
  RoundedPlace place_exactly(const std::array<std::int32_t, 3>& planes) const;

 private:
  // Inside are the points v, relative to the site, of which n v <= d.
  struct Row {
    double x, y, z, d;
    bool is_moderate;
    Point3 other;  // of a bisector
  };

  const Row& row(std::int32_t plane) const { return rows_[static_cast<std::size_t>(plane)]; }
  double side_value(std::size_t plane) const;
  bool is_moderate(const std::array<std::int32_t, 3>& planes) const;
  template <std::size_t n>
  class Integers;

  Box3 box_;
  Point3 site_{};
  std::vector<Row> rows_;
};

}  // namespace vorotool::core::cells_in_space
