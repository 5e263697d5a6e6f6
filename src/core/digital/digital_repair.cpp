#include "core/digital/digital_repair.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/flat_map.hpp"
#include "core/delaunay/flip_mesh.hpp"
#include "core/digital/digital_dual.hpp"

namespace vorotool::core::digital {

using base::Monitor;
using delaunay::FlipMesh;
using delaunay::OrderedPoints;
using delaunay::RingVertex;
using delaunay::Subdivision;
using delaunay::Vertex;

namespace {

constexpr FlipMesh::Side sides_between_polls = 3 << 14;

Vertex as_vertex(std::size_t i) { return static_cast<Vertex>(i); }

// Links every side of the dual with its twin, and the ring with ghosts. False if it is no closed surface.
bool assemble(const DigitalDual& dual, FlipMesh& mesh, const Monitor& monitor) {
  if (dual.ring.size() < 2) return false;
  base::FlatMap waiting(
      2 * dual.triangles.size());  // by a, b: the side, plus 1, whose twin b, a is to come; then 0
  std::size_t open = 0;
  const auto close = [&](Vertex a, Vertex b, FlipMesh::Side side) {
    const auto key = [](Vertex from, Vertex to) {
      return (static_cast<std::uint64_t>(from) + 1) << 32 | (static_cast<std::uint64_t>(to) + 1);
    };
    if (const std::uint64_t other = waiting.find(key(b, a)); other != 0) {
      mesh.link(side, static_cast<FlipMesh::Side>(other - 1));
      waiting[key(b, a)] = 0;
      --open;
      return true;
    }
    std::uint64_t& own = waiting[key(a, b)];
    if (own != 0) return false;  // the same side twice
    own = static_cast<std::uint64_t>(side) + 1;
    ++open;
    return true;
  };
  for (const auto& [a, b, c] : dual.triangles) {
    const FlipMesh::Side s = mesh.add_triangle(a, b, c);
    if (s % sides_between_polls == 0) base::report(monitor, 0.5);
    if (!close(a, b, s) || !close(b, c, s + 1) || !close(c, a, s + 2)) return false;
  }
  const std::size_t count = dual.ring.size();
  const FlipMesh::Side first = 3 * static_cast<FlipMesh::Side>(dual.triangles.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Vertex here = dual.ring[i], next = dual.ring[(i + 1) % count];
    const FlipMesh::Side s = mesh.add_triangle(next, here, FlipMesh::infinity);
    if (!close(next, here, s)) return false;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto ghost = first + 3 * static_cast<FlipMesh::Side>(i);
    const auto next = first + 3 * static_cast<FlipMesh::Side>((i + 1) % count);
    mesh.link(ghost + 2, next + 1);  // from infinity to the vertex that the next one leaves
  }
  return open == 0;
}

bool are_collinear(std::span<const RingVertex> vertices) {
  for (std::size_t i = 2; i < vertices.size(); ++i) {
    if (kernel::orient2d(vertices[0].point, vertices[1].point, vertices[i].point) != 0) return false;
  }
  return true;
}

std::vector<Vertex> vertices_of_labels(const OrderedPoints& ordered, std::size_t sites) {
  std::vector<Vertex> vertex(sites, -1);  // of duplicates: they have no region
  for (std::size_t i = 0; i < ordered.index.size(); ++i) vertex[ordered.index[i]] = as_vertex(i);
  return vertex;
}

// Inserts the points that are in no triangle. Returns their number.
std::uint64_t insert_missing(FlipMesh& mesh, const std::vector<bool>& used) {
  std::uint64_t inserted = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) continue;
    mesh.insert(as_vertex(v));
    ++inserted;
  }
  return inserted;
}

std::optional<Subdivision> repaired(const DigitalDual& dual, std::span<RingVertex> vertices,
                                    DigitalRepair& repair, const Monitor& monitor) {
  FlipMesh mesh(vertices, monitor);
  if (!assemble(dual, mesh, monitor)) return {};
  repair.straightened = mesh.straighten();
  if (!mesh.is_positive()) return {};
  mesh.make_delaunay();
  repair.filled = mesh.fills();
  repair.flipped = mesh.flips();
  std::vector<bool> used(vertices.size(), false);
  for (const auto& triangle : dual.triangles) {
    for (const Vertex v : triangle) used[static_cast<std::size_t>(v)] = true;
  }
  for (const Vertex v : dual.ring) used[static_cast<std::size_t>(v)] = true;
  if (!mesh.has_triangle()) return {};  // collinear sites, and others to be inserted
  repair.inserted = insert_missing(mesh, used);
  return mesh.subdivision();
}

}  // namespace

Subdivision delaunay_by_insertion(const OrderedPoints& ordered, const Monitor& monitor) {
  const std::span<RingVertex> vertices = ordered.vertices;
  if (are_collinear(vertices)) return delaunay::divide_and_conquer(ordered, 1, monitor);
  delaunay::permute_equal_codes(ordered);
  std::size_t third = 2;
  while (kernel::orient2d(vertices[0].point, vertices[1].point, vertices[third].point) == 0) ++third;
  FlipMesh mesh(vertices, monitor);
  mesh.start(0, 1, as_vertex(third));
  std::vector<bool> used(vertices.size(), false);
  used[0] = used[1] = used[third] = true;
  insert_missing(mesh, used);
  std::optional<Subdivision> result = mesh.subdivision();
  if (!result) throw std::logic_error("insertion left no triangulation");
  return std::move(*result);
}

Subdivision digital_delaunay(std::span<std::uint32_t> image, const tessellation::PixelFrame& frame,
                             const DigitalSites& sites, const OrderedPoints& ordered, DigitalRepair& repair,
                             unsigned threads, const Monitor& monitor) {
  if (are_collinear(ordered.vertices)) return delaunay::divide_and_conquer(ordered, 1, monitor);
  delaunay::permute_equal_codes(ordered);
  const Reconnection moved = connect_regions(image, frame, sites.x, sites.y, sites.scale, threads, monitor);
  repair.split_regions = moved.regions;
  repair.moved_pixels = moved.pixels;
  const std::vector<Vertex> vertex = vertices_of_labels(ordered, sites.x.size());
  DigitalDual dual = find_dual(image, frame.width, vertex, ordered.vertices, monitor);
  repair.three_label_corners = dual.three_label_corners;
  repair.four_label_corners = dual.four_label_corners;
  repair.twins = remove_twins(dual, ordered.vertices.size());
  if (std::optional<Subdivision> result = repaired(dual, ordered.vertices, repair, monitor)) {
    repair.route = DigitalRepair::repaired;
    return std::move(*result);
  }
  repair.route = DigitalRepair::rebuilt;
  repair.inserted = ordered.vertices.size();
  return delaunay_by_insertion(ordered, monitor);
}

}  // namespace vorotool::core::digital
