#include "core/cells_in_space/verify_space_cells.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/cells_in_space/vectors.hpp"
#include "core/spatial/kd_tree.hpp"
#include "core/text/number_text.hpp"

namespace vorotool::core::cells_in_space {

using base::at;
using base::Fault;
using base::Monitor;

namespace {

using Index = std::int32_t;

constexpr std::size_t checked_a_piece = std::size_t{1} << 14;
constexpr double slack = 0x1p-47;  // of the terms of a comparison, for its own roundings

Point3 magnitudes(const Point3& p) { return {std::abs(p.x), std::abs(p.y), std::abs(p.z)}; }
double sum(const Point3& p) { return p.x + p.y + p.z; }
double largest(const Point3& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }
bool is_finite(const Point3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }
Point3 scaled(const Point3& p, int exponent) {
  return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}
double coordinate(const Point3& p, std::size_t axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

// To the next double of larger magnitude.
double spacing(double value) {
  const double size = std::abs(value);
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(size) + 1) - size;
}

int exponent_of(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  return exponent;
}

std::string text_of(const Point3& p) {
  std::string text = "(";
  text::append_number(text, p.x);
  text::append_number(text += ", ", p.y);
  text::append_number(text += ", ", p.z);
  return text + ")";
}

// Why the checks suffice. Each face is a convex polygon in the plane half-way between its two sites, or on a side of
// the box, and turns its back on the first; the surface of each cell is closed. So each cell winds a number of times
// around each point off the faces; the sum of these numbers is the same all over the box, and 1, as volumes add up to
// that of the box. None is negative: from a point in such a part of cell c, the ray away from site c would leave that
// part through a face behind which c gains, so that it would go towards site c there. So the cells tile the box. The
// distance to the site of the cell that a point is in, less the square of the place, is linear in each cell and concave
// across each face: it is the least one for all sites that have a cell. A site without one is at no vertex nearer than
// the sites of the cells there, so nowhere: the difference is linear in each cell.
class Checker {
 public:
  Checker(std::span<const Point3> sites, const CellFaces& cells, const Box3& box, unsigned threads,
          const Monitor& monitor)
      : given_(sites), cells_(cells), box_(box), threads_(threads), monitor_(monitor) {}

  Fault run() {
    if (!std::all_of(given_.begin(), given_.end(), is_finite) ||
        !std::all_of(cells_.vertices.begin(), cells_.vertices.end(), is_finite) || !is_finite(box_.low) ||
        !is_finite(box_.high))
      return "a coordinate is not finite";
    if (Fault fault = check_all(cells_.face_cells.size(), &Checker::check_sides)) return fault;
    if (Fault fault = check_all(given_.size(), &Checker::check_list)) return fault;
    if (Fault fault = check_lists()) return fault;
    if (Fault fault = check_all(given_.size(), &Checker::check_surface)) return fault;
    scale();
    for (const auto check : {&Checker::check_places, &Checker::check_shape}) {
      if (Fault fault = check_all(cells_.face_cells.size(), check)) return fault;
    }
    if (Fault fault = check_empty()) return fault;
    return check_volumes();
  }

 private:
  Fault check_all(std::size_t count, Fault (Checker::*check)(std::size_t) const) const {
    return base::first_fault(count, [&](std::size_t i) { return (this->*check)(i); }, threads_, monitor_);
  }

  // ---- who has which faces
  Fault check_sides(std::size_t face) const {
    const auto& [a, b] = cells_.face_cells[face];
    if (cells_.face(face).size() < 3) return "face " + std::to_string(face) + " has fewer than three corners";
    if (a >= 0 && (b < 0 || b > a)) return {};
    return "the cells of face " + std::to_string(face) +
           " are not two cells, the smaller first, or one and a side of the box";
  }

  Index across(std::size_t cell, Index face) const {
    const auto& [a, b] = cells_.face_cells[at(face)];
    return at(a) == cell ? b : a;
  }

  // By the cells across, then the sides of the box.
  Fault check_list(std::size_t cell) const {
    const std::span<const Index> faces = cells_.cell(cell);
    for (std::size_t k = 0; k < faces.size(); ++k) {
      const auto& [a, b] = cells_.face_cells[at(faces[k])];
      if (at(a) != cell && (b < 0 || at(b) != cell)) return is_listed_wrong(cell);
      if (k == 0) continue;
      const Index last = across(cell, faces[k - 1]), next = across(cell, faces[k]);
      if (last == next && faces[k - 1] != faces[k]) return "two faces lie between the same cells";
      if ((last < 0) == (next < 0) ? (last < 0 ? next >= last : next <= last) : last < 0)
        return is_listed_wrong(cell);
    }
    return {};
  }

  static std::string is_listed_wrong(std::size_t cell) {
    return "the faces of cell " + std::to_string(cell) +
           " are not those that have them on a side, by the cells across, then the sides of the box";
  }

  // Each cell lists faces of its own, each once; so that all are listed if their number is right.
  Fault check_lists() const {
    std::vector<std::size_t> counts(given_.size());
    for (const auto& sides : cells_.face_cells) {
      for (const Index cell : sides) {
        if (cell >= 0) ++counts[at(cell)];
      }
    }
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] != cells_.cell(i).size()) return is_listed_wrong(i);
    }
    return {};
  }

  // ---- surfaces
  // Each vertex has three faces or more, each edge one on either side, and vertices - edges + faces is 2.
  Fault check_surface(std::size_t cell) const {
    const std::span<const Index> faces = cells_.cell(cell);
    std::size_t size = 0;
    for (const Index face : faces) size += cells_.face(at(face)).size();
    std::vector<Index> corners;
    corners.reserve(size);
    for (const Index face : faces) {
      const std::span<const Index> ring = cells_.face(at(face));
      corners.insert(corners.end(), ring.begin(), ring.end());
    }
    const std::string of_cell = "cell " + std::to_string(cell);
    if (const char* what = fault_of_edges(cell, size)) return what + of_cell;
    std::sort(corners.begin(), corners.end());
    std::size_t vertices = 0;
    for (auto begin = corners.begin(); begin != corners.end(); ++vertices) {
      const auto end = std::find_if(begin, corners.end(), [&](Index v) { return v != *begin; });
      if (end - begin < 3)
        return "vertex " + std::to_string(*begin) + " is on fewer than three faces of " + of_cell;
      begin = end;
    }
    if (faces.empty() || vertices + faces.size() == size / 2 + 2) return {};
    return "vertices - edges + faces is not 2 for " + of_cell;
  }

  const char* fault_of_edges(std::size_t cell, std::size_t size) const {
    std::vector<std::uint64_t> edges;  // the ends, the smaller first, and the direction
    edges.reserve(size);
    for (const Index face : cells_.cell(cell)) {
      const std::span<const Index> ring = cells_.face(at(face));
      const bool is_second = at(cells_.face_cells[at(face)][0]) != cell;
      Index tail = ring.back();
      for (const Index head : ring) {
        const bool is_back = (tail > head) != is_second;
        const auto low = static_cast<std::uint64_t>(std::min(tail, head));
        const auto high = static_cast<std::uint64_t>(std::max(tail, head));
        edges.push_back(low << 32 | high << 1 | static_cast<std::uint64_t>(is_back));
        tail = head;
      }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (i > 0 && edges[i] == edges[i - 1]) return "an edge belongs to three faces of ";
      if ((i ^ 1) >= edges.size() || edges[i] >> 1 != edges[i ^ 1] >> 1)
        return "the surface is not closed of ";
    }
    return nullptr;
  }

  // ---- places
  // Makes copies: for distances, of all times the power of two that brings coordinates into [-1, 1]; for shapes, of
  // vertices relative to the box, times that which brings them into [0, 1].
  void scale() {
    double most = std::max(largest(box_.low), largest(box_.high));
    const double in_box = most;
    for (const Point3& p : given_) most = std::max(most, largest(p));
    const int exponent = -exponent_of(most);
    for (const Point3& p : given_) sites_.push_back(scaled(p, exponent));
    const Point3 half = scaled(box_.high, -1) - scaled(box_.low, -1);
    const int of_box = -1 - exponent_of(largest(half));
    step_ = 2 * std::ldexp(spacing(in_box), of_box) + 0x1p-51;
    const auto relative = [&](const Point3& p) { return scaled(p, of_box) - scaled(box_.low, of_box); };
    high_ = relative(box_.high);
    vertices_.resize(cells_.vertices.size());
    relative_.resize(cells_.vertices.size());
    base::for_items(vertices_.size(), checked_a_piece, threads_, monitor_, [&](std::size_t v) {
      vertices_[v] = scaled(cells_.vertices[v], exponent);
      relative_[v] = relative(cells_.vertices[v]);
    });
  }

  // Corners are in the box, and on the side of it or as far from both sites.
  Fault check_places(std::size_t face) const {
    const auto& [a, b] = cells_.face_cells[face];
    for (const Index v : cells_.face(face)) {
      const Point3& p = cells_.vertices[at(v)];
      const Point3 &low = box_.low, &high = box_.high;
      if (p.x < low.x || p.y < low.y || p.z < low.z || p.x > high.x || p.y > high.y || p.z > high.z)
        return "vertex " + std::to_string(v) + " is outside the box";
      if (b < 0) {
        const std::size_t side = at(-1 - b);
        if (coordinate(p, side / 2) != coordinate(side % 2 == 0 ? low : high, side / 2))
          return "a corner of face " + std::to_string(face) + " is not on its side of the box";
      } else if (const Comparison found = compare(at(v), at(a), at(b));
                 std::abs(found.difference) > found.allowed) {
        return "vertex " + text_of(p) + " between cells " + std::to_string(a) + " and " + std::to_string(b) +
               " is nearer to one of their sites by more than rounding explains";
      }
    }
    return {};
  }

  // The difference of the squared distances to two sites, positive if the second is nearer, and what roundings explain.
  struct Comparison {
    double difference, allowed;
  };
  Comparison compare(std::size_t vertex, std::size_t own, std::size_t other) const {
    const Point3 &v = vertices_[vertex], &p = sites_[own], &q = sites_[other];
    const Point3 way = q - p, from = v - p, to = v - q, size = magnitudes(way);
    const double rounding = 2 * scalar_product(size, {spacing(v.x), spacing(v.y), spacing(v.z)});
    return {scalar_product(way, from + to),
            rounding + scalar_product(size, magnitudes(from) + magnitudes(to)) * slack + 0x1p-1000};
  }

  // ---- shapes
  // Faces are convex and go round once, counter-clockwise as seen from outside the first cell: no corner turns the
  // other way, and all triangles with the first corner are as the first one.
  Fault check_shape(std::size_t face) const {
    const Point3 outwards = outwards_of(face);
    const std::span<const Index> ring = cells_.face(face);
    const auto corner = [&](std::size_t i) { return relative_[at(ring[i % ring.size()])]; };
    Point3 area{0, 0, 0};
    double rounding = 0;
    bool is_convex = true;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point3 from = corner(i + 1) - corner(i), to = corner(i + 2) - corner(i + 1);
      const Point3 first = corner(i) - corner(0), second = corner(i + 1) - corner(0);
      area = area + vector_product(first, second);
      rounding += rounding_of(first, second);
      is_convex = is_convex && !is_turned(vector_product(from, to), rounding_of(from, to), outwards) &&
                  !is_turned(vector_product(first, second), rounding_of(first, second), outwards);
    }
    if (is_turned(area, rounding, outwards))
      return "face " + std::to_string(face) + " goes round the wrong way";
    if (!is_convex) return "face " + std::to_string(face) + " is not convex";
    return {};
  }

  // From the first site to the second, or out of the box.
  Point3 outwards_of(std::size_t face) const {
    const auto& [a, b] = cells_.face_cells[face];
    if (b >= 0) return sites_[at(b)] - sites_[at(a)];
    std::array<double, 3> normal{};
    const std::size_t side = at(-1 - b);
    normal[side / 2] = side % 2 == 0 ? -1 : 1;
    return {normal[0], normal[1], normal[2]};
  }

  // How far a component of the cross product may be off: those of the factors are off by less than a step, as vertices
  // are rounded.
  double rounding_of(const Point3& p, const Point3& q) const {
    return 4 * step_ * (largest(p) + largest(q) + step_);
  }

  static bool is_turned(const Point3& area, double rounding, const Point3& outwards) {
    const Point3 size = magnitudes(outwards);
    return scalar_product(area, outwards) <
           -(rounding * sum(size) + scalar_product(magnitudes(area), size) * slack);
  }

  // ---- sites without a cell
  Fault check_empty() const {
    if (Fault fault = check_duplicates()) return fault;
    std::vector<std::uint32_t> empty;
    std::array<std::vector<double>, 3> columns;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      if (!cells_.cell(i).empty()) continue;
      empty.push_back(static_cast<std::uint32_t>(i));
      for (std::size_t axis = 0; axis < 3; ++axis) columns[axis].push_back(coordinate(sites_[i], axis));
    }
    if (empty.empty()) return {};
    std::vector<Index> owner(vertices_.size(), -1);
    for (std::size_t f = 0; f < cells_.face_cells.size(); ++f) {
      for (const Index v : cells_.face(f)) owner[at(v)] = cells_.face_cells[f][0];
    }
    using Tree = spatial::KdTree<double, double, 3>;
    const Tree tree({columns[0], columns[1], columns[2]}, empty, monitor_);
    const auto check = [&](std::size_t v) -> Fault {
      if (owner[v] < 0) return {};
      const Point3& p = vertices_[v];
      const Tree::Nearest nearest = tree.nearest({p.x, p.y, p.z});
      const Comparison found = compare(v, at(owner[v]), nearest.label);
      if (found.difference <= found.allowed) return {};
      return "cell " + std::to_string(nearest.label) + " is empty, but its site is the nearest to vertex " +
             text_of(cells_.vertices[v]);
    };
    return base::first_fault(vertices_.size(), check, threads_, monitor_);
  }

  Fault check_duplicates() const {
    std::vector<std::size_t> order(given_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
      if (given_[i] == given_[j]) return i < j;
      return tetrahedra::comes_before(given_[i], given_[j]);
    });
    for (std::size_t k = 1; k < order.size(); ++k) {
      if (given_[order[k - 1]] == given_[order[k]] && !cells_.cell(order[k]).empty())
        return "point " + std::to_string(order[k]) + " lies on an earlier one, but has a cell";
    }
    return {};
  }

  // ---- volumes
  // Their sum is a multiple of that of the box, so that no rounding matters.
  Fault check_volumes() const {
    const double whole = high_.x * high_.y * high_.z;
    if (given_.empty() || whole < 0x1p-900) return {};
    std::vector<double> volumes(given_.size());
    base::for_items(volumes.size(), checked_a_piece, threads_, monitor_,
                    [&](std::size_t i) { volumes[i] = volume(i); });
    const double share = std::accumulate(volumes.begin(), volumes.end(), 0.0) / whole;
    if (std::abs(share - 1) < 0x1p-20) return {};
    std::string text = "the volumes of the cells do not add up to that of the box, but to ";
    text::append_number(text, share);
    return text + " times that";
  }

  double volume(std::size_t cell) const {
    double six = 0;
    const std::span<const Index> faces = cells_.cell(cell);
    for (const Index face : faces) {
      const std::span<const Index> ring = cells_.face(at(face));
      const Point3 apex = relative_[at(cells_.face(at(faces[0]))[0])];
      const Point3 first = relative_[at(ring[0])] - apex;
      double part = 0;
      for (std::size_t i = 1; i + 1 < ring.size(); ++i)
        part += scalar_product(
            first, vector_product(relative_[at(ring[i])] - apex, relative_[at(ring[i + 1])] - apex));
      six += at(cells_.face_cells[at(face)][0]) == cell ? part : -part;
    }
    return six / 6;
  }

  const std::span<const Point3> given_;
  const CellFaces& cells_;
  const Box3& box_;
  const unsigned threads_;
  const Monitor& monitor_;
  std::vector<Point3> sites_, vertices_;  // times a power of two
  std::vector<Point3> relative_;          // vertices, relative to the box, times another one
  Point3 high_{};                         // the highest corner of the box, so
  double step_ = 0;                       // more than by which a difference of those may be off
};

}  // namespace

Fault find_space_cell_fault(std::span<const Point3> sites, const CellFaces& cells, const Box3& box,
                            unsigned threads, const Monitor& monitor) {
  return Checker(sites, cells, box, threads, monitor).run();
}

}  // namespace vorotool::core::cells_in_space
