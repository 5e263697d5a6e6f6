#include "core/sampled_skeleton/sample_diagram.hpp"

#include <algorithm>
#include <utility>

#include "core/base/disjoint_sets.hpp"
#include "core/base/parallel.hpp"
#include "core/delaunay/delaunay_triangulation.hpp"
#include "core/kernel/predicates.hpp"
#include "core/sampled_skeleton/boundary_crossings.hpp"
#include "core/sampled_skeleton/sample_faces.hpp"

namespace vorotool::core::sampled_skeleton {

using base::at;
using base::LargeArray;
using base::Monitor;
using kernel::PlanarGraphView;
using kernel::Point;

namespace {

constexpr std::size_t triangles_a_piece = 1 << 14;  // about a millisecond

// Calls body(s) for the sides that are to be looked at once.
template <class Body>
void for_each_side(const SampleMesh& mesh, unsigned threads, const Monitor& monitor, const Body& body) {
  const auto visit = [&](std::size_t piece, std::size_t begin, std::size_t end) {
    for (std::size_t s = 3 * begin; s < 3 * end; ++s) {
      if (mesh.is_first(static_cast<Side>(s))) body(piece, static_cast<Side>(s));
    }
  };
  base::for_pieces(mesh.size(), triangles_a_piece, threads, monitor, visit);
}

// The seeds of each group, ascending.
std::vector<std::vector<std::int32_t>> members_of(const PlanarGraphView& graph,
                                                  std::span<const std::int32_t> segment,
                                                  const SampleGroups& groups) {
  std::vector<std::vector<std::int32_t>> members(at(groups.count));
  for (std::size_t s = 0; s < segment.size(); ++s) {
    const std::int32_t group = segment[s] < 0 ? groups.of_point[s] : groups.of_segment(graph, segment[s]);
    members[at(group)].push_back(static_cast<std::int32_t>(s));
  }
  return members;
}

// Triangulations of several sets of seeds, one after the other.
struct GroupMeshes {
  explicit GroupMeshes(std::size_t seeds) : first(seeds) {}

  void add(std::span<const Point> seeds, const std::vector<std::int32_t>& members,
           const std::optional<spatial::Bounds>& within, unsigned threads, const Monitor& monitor) {
    std::vector<Point> places;
    for (const std::int32_t seed : members) places.push_back(seeds[at(seed)]);
    const delaunay::DelaunayTriangulation mesh(places, places.size() < triangles_a_piece ? 1 : threads,
                                               monitor, within);
    for (std::size_t i = 0; i < members.size(); ++i) first[at(members[i])] = members[at(mesh.first()[i])];
    const std::size_t begin = triangles.size(), size = 3 * mesh.triangle_count();
    if (size == 0) return;
    triangles.resize(begin + size);
    neighbors.resize(begin + size);
    mesh.write({triangles.data() + begin, neighbors.data() + begin, nullptr}, threads, monitor);
    for (std::size_t i = begin; i < begin + size; ++i) {
      triangles[i] = members[at(triangles[i])];
      if (neighbors[i] >= 0) neighbors[i] += static_cast<std::int32_t>(begin / 3);
    }
  }

  std::vector<std::int32_t> triangles, neighbors, first;
};

LargeArray<std::int32_t> copied(const std::vector<std::int32_t>& values) {
  LargeArray<std::int32_t> made(values.size());
  std::copy(values.begin(), values.end(), made.data());
  return made;
}

}  // namespace

SampleDiagram::Triangulation SampleDiagram::triangulate(const PlanarGraphView& graph,
                                                        std::span<const Point> seeds,
                                                        std::span<const std::int32_t> segment,
                                                        const SampleGroups& groups, unsigned threads,
                                                        const Monitor& monitor) {
  if (!groups.of_point.empty()) {
    GroupMeshes all(seeds.size());
    for (const auto& members : members_of(graph, segment, groups)) {
      all.add(seeds, members, groups.within, threads, monitor);
    }
    return {copied(all.triangles), copied(all.neighbors), std::move(all.first), {}};
  }
  const delaunay::DelaunayTriangulation mesh(seeds, threads, monitor, groups.within);
  const std::size_t size = 3 * mesh.triangle_count();
  Triangulation made{LargeArray<std::int32_t>(size), LargeArray<std::int32_t>(size), {}, {}};
  if (size > 0) mesh.write({made.triangles.data(), made.neighbors.data(), nullptr}, threads, monitor);
  made.first.assign(mesh.first().begin(), mesh.first().end());
  if (size == 0) made.chain.assign(mesh.hull().begin(), mesh.hull().end());
  return made;
}

SampleDiagram::SampleDiagram(const PlanarGraphView& graph, std::span<const Point> seeds,
                             std::span<const std::int32_t> segment, std::span<const std::int32_t> start,
                             const SampleGroups& groups, unsigned threads, const Monitor& monitor)
    : SampleDiagram(triangulate(graph, seeds, segment, groups, threads, monitor), graph, seeds, segment,
                    start, groups, threads, monitor) {}

SampleDiagram::SampleDiagram(Triangulation&& made, const PlanarGraphView& graph, std::span<const Point> seeds,
                             std::span<const std::int32_t> segment, std::span<const std::int32_t> start,
                             const SampleGroups& groups, unsigned threads, const Monitor& monitor)
    : groups_(groups),
      triangles_(std::move(made.triangles)),
      neighbors_(std::move(made.neighbors)),
      first_(std::move(made.first)),
      chain_(std::move(made.chain)),
      mesh_{seeds, {triangles_.data(), triangles_.size()}, {neighbors_.data(), neighbors_.size()}},
      labels_(graph, seeds, start, segment, first_),
      state_(mesh_.sides()) {
  std::vector<std::uint8_t> has_side(labels_.piece_count());
  classify_sides(has_side, threads, monitor);
  find_walked(has_side);
  join_centers(threads, monitor);
  cross_out(threads, monitor);
  count_deleted();
}

std::int32_t SampleDiagram::group_of(std::int32_t seed) const {
  if (groups_.of_point.empty()) return 0;
  return labels_.is_point(seed) ? groups_.of_point[at(seed)]
                                : groups_.of_segment(labels_.graph(), labels_.segment_of(seed));
}

// Where the seeds of a group are on one line there are no cells to walk through.
void SampleDiagram::find_walked(const std::vector<std::uint8_t>& has_side) {
  std::vector<bool> is_corner(mesh_.seeds.size());
  for (const std::int32_t seed : mesh_.triangles) is_corner[at(seed)] = true;
  for (std::size_t k = 0; k < has_side.size(); ++k) {
    const auto piece = static_cast<std::int32_t>(k);
    if (!has_side[k] && is_corner[at(labels_.piece(piece).first)]) walked_.push_back(piece);
  }
}

void SampleDiagram::classify_sides(std::vector<std::uint8_t>& has_side, unsigned threads,
                                   const Monitor& monitor) {
  for_each_side(mesh_, threads, monitor, [&](std::size_t, Side s) {
    const std::uint8_t state = state_of(s, has_side);
    state_[at(s)] = state;
    if (mesh_.across(s) >= 0) state_[at(mesh_.twin(s))] = state;
  });
}

std::uint8_t SampleDiagram::state_of(Side s, std::vector<std::uint8_t>& has_side) const {
  const std::int32_t p = mesh_.origin(s), q = mesh_.target(s);
  if (!labels_.share(p, q)) return 0;
  const std::int32_t piece = labels_.piece_between(p, q);
  if (piece < 0 || !is_alone_on(s)) return same_label;
  has_side[at(piece)] = 1;
  return same_label | own_piece;
}

// Of the other seeds those opposite to a side would be the first in the disc about it.
bool SampleDiagram::is_alone_on(Side s) const {
  const Point &p = mesh_.seed(mesh_.origin(s)), &q = mesh_.seed(mesh_.target(s));
  if (sign_of_dot(mesh_.seed(mesh_.apex(s)), p, q) <= 0) return false;
  const Side twin = mesh_.across(s) < 0 ? -1 : mesh_.twin(s);
  return twin < 0 || sign_of_dot(mesh_.seed(mesh_.apex(twin)), p, q) > 0;
}

void SampleDiagram::join_centers(unsigned threads, const Monitor& monitor) {
  std::vector<std::vector<Side>> found(base::piece_count(mesh_.size(), triangles_a_piece));
  for_each_side(mesh_, threads, monitor, [&](std::size_t piece, Side s) {
    if (mesh_.across(s) < 0) return;
    const Point &p = mesh_.seed(mesh_.origin(s)), &q = mesh_.seed(mesh_.target(s));
    if (kernel::incircle(p, q, mesh_.seed(mesh_.apex(s)), mesh_.seed(mesh_.apex(mesh_.twin(s)))) == 0) {
      found[piece].push_back(s);
    }
  });
  if (std::all_of(found.begin(), found.end(), [](const auto& sides) { return sides.empty(); })) return;
  base::DisjointSets<Triangle> sets(mesh_.size());
  for (const auto& sides : found) {
    for (const Side s : sides) sets.join(SampleMesh::triangle_of(s), mesh_.across(s));
  }
  root_.resize(mesh_.size());
  for (std::size_t t = 0; t < root_.size(); ++t) root_[t] = sets.find(static_cast<Triangle>(t));
}

// Finds what pieces meet besides their own edges, and then the faces.
void SampleDiagram::cross_out(unsigned threads, const Monitor& monitor) {
  Crossings found;
  std::vector<std::uint8_t> is_on_shape;
  if (!walked_.empty()) {
    const delaunay::TriangulationArrays arrays{mesh_.seeds, mesh_.triangles, mesh_.neighbors, {}, {}, first_};
    found = find_crossings(mesh_, delaunay::VertexTriangles(arrays), labels_, walked_, threads, monitor);
  }
  for (const Crossing& crossing : found.crossings) mark_crossed(crossing.side);
  for (const Side s : found.ridden) mark_crossed(s);
  if (!found.touched.empty()) {
    is_on_shape.resize(mesh_.size());
    for (const Triangle t : found.touched) is_on_shape[at(same_center(t))] = 1;
    for (std::size_t t = 0; t < is_on_shape.size(); ++t) {
      is_on_shape[t] = is_on_shape[at(same_center(static_cast<Triangle>(t)))];
    }
    for (std::size_t s = 0; s < mesh_.sides(); ++s) {
      if (is_on_shape[s / 3]) mark_crossed(static_cast<Side>(s));
    }
  }
  const std::span<const std::uint8_t> state(state_.data(), state_.size());
  face_ = sample_faces({mesh_, labels_, state, is_on_shape, found.crossings}, threads, monitor);
}

void SampleDiagram::mark_crossed(Side s) {
  state_[at(s)] |= crossed;
  if (mesh_.across(s) >= 0) state_[at(mesh_.twin(s))] |= crossed;
}

void SampleDiagram::count_deleted() {
  for (std::size_t s = 0; s < mesh_.sides(); ++s) {
    if (!mesh_.is_first(static_cast<Side>(s)) || state_[s] == 0) continue;
    ++((state_[s] & same_label) != 0 ? counts_.shared : counts_.crossed);
  }
  counts_.walked = walked_.size();
}

}  // namespace vorotool::core::sampled_skeleton
