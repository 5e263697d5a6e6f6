// The edges of shapes near a Voronoi edge of seeds on them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/axis_bound.hpp"
#include "core/seed_diagram.hpp"
#include "core/site_hierarchy.hpp"

namespace vorotool::core {

// The discs about two points of a Voronoi edge hold those about all points between, if each goes through both
// seeds or, squared, its radius is larger than that by the same for all.
struct DiscPair {
  std::array<Place, 2> centre;
  std::array<double, 2> square;  // of the radii
};

// Finds edges one time after the other: memory is used again.
class NearEdges {
 public:
  // Reaches across the sides of the triangulation that meet the discs. No seed is in them, but for a margin,
  // so that these are few unless the shape is round about a disc. A piece that no side has as its own may be
  // missed in this way: if there are any, `hierarchy` holds all edges by their numbers.
  NearEdges(const SeedDiagram& diagram, const SiteHierarchy* hierarchy)
      : diagram_(diagram), hierarchy_(hierarchy) {}

  // All edges, and points without edges, that meet the discs, and perhaps others; nothing where there are too
  // many. The centres are on the Voronoi edge of the side.
  std::optional<std::span<const NearEdge>> find(Side side, const DiscPair& discs);
  // The sides that the last search found to meet the discs and to have pieces of their own.
  std::span<const Side> pieces() const { return pieces_; }
  // Triangles that the last search came to.
  std::span<const Triangle> triangles() const { return triangles_; }

 private:
  void look_at(Triangle t, const DiscPair& discs);
  void add(std::int32_t segment);

  const SeedDiagram& diagram_;
  const SiteHierarchy* hierarchy_;
  std::vector<Triangle> triangles_;
  std::vector<Side> pieces_;
  std::vector<NearEdge> found_;
};

}  // namespace vorotool::core
