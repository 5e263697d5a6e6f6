// The Voronoi diagram of seeds on the edges of shapes, and what of it is deleted (paper, section 3.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/kernel/point.hpp"
#include "core/sampled_skeleton/sample_labels.hpp"
#include "core/sampled_skeleton/sample_mesh.hpp"
#include "core/spatial/morton_grid.hpp"

namespace vorotool::core::sampled_skeleton {

struct SampleDiagramCounts {
  std::size_t shared = 0;   // Voronoi edges between seeds with a label in common
  std::size_t crossed = 0;  // others that the shapes meet
  std::size_t walked = 0;   // pieces of edges that meet other cells than those of their ends, or may do so
};

// Shapes that have diagrams of their own: no seed of one has a cell in that of another, wherever it is.
struct SampleGroups {
  std::span<const std::int32_t> of_point;  // [points of the graph] from 0; empty: all are one group
  std::int32_t count = 1;
  // Holds all seeds: triangles are in an order along the curve through it
  std::optional<spatial::Bounds> within;

  std::int32_t of_segment(const kernel::PlanarGraphView& graph, std::int32_t segment) const {
    return of_point.empty() ? 0 : of_point[base::at(graph.segments[base::at(segment)][0])];
  }
};

// All decisions are exact for the seeds as they are rounded, with edges as polylines through them: by the
// predicates of the triangulation, signs of dot products, and the walks of
// core/sampled_skeleton/boundary_crossings.hpp.
class SampleDiagram {
 public:
  // The samples (core/sampled_skeleton/boundary_samples.hpp) must outlive the diagram. Throws
  // std::length_error for more than 2^28 seeds. The mesh holds the triangles of one group after the other; a
  // segment and its ends are in one group.
  SampleDiagram(const kernel::PlanarGraphView& graph, std::span<const kernel::Point> seeds,
                std::span<const std::int32_t> segment, std::span<const std::int32_t> start,
                const SampleGroups& groups, unsigned threads, const base::Monitor& monitor);
  SampleDiagram(const SampleDiagram&) = delete;
  SampleDiagram& operator=(const SampleDiagram&) = delete;

  const SampleMesh& mesh() const { return mesh_; }
  const SampleLabels& labels() const { return labels_; }
  const SampleDiagramCounts& counts() const { return counts_; }
  const SampleGroups& groups() const { return groups_; }
  std::int32_t group_of(std::int32_t seed) const;

  // Seeds from end to end where all are on one line, and there are no triangles; else none, and of several
  // groups.
  std::span<const std::int32_t> chain() const { return chain_; }
  // The Voronoi edge of a side is none of those that are deleted: neither between seeds with a label in
  // common, nor met by the shapes.
  bool is_kept(Side s) const { return state_[static_cast<std::size_t>(s)] == 0; }
  // A piece meets the Voronoi edge that is not the own one of the side.
  bool is_crossed(Side s) const { return (state_[static_cast<std::size_t>(s)] & crossed) != 0; }
  // The ends of a side follow each other on an edge, and no seed is in the closed disc about the piece
  // between.
  bool has_own_piece(Side s) const { return (state_[static_cast<std::size_t>(s)] & own_piece) != 0; }
  // The face of the graph that the circumcenter of a triangle is in; -1 where it is on a piece.
  std::int32_t face(Triangle t) const { return face_[static_cast<std::size_t>(t)]; }
  // One triangle, the first, for all with the same circumcenter.
  Triangle same_center(Triangle t) const { return root_.empty() ? t : root_[static_cast<std::size_t>(t)]; }
  // Pieces that no side has as its own, ascending.
  std::span<const std::int32_t> walked_pieces() const { return walked_; }

 private:
  struct Triangulation {
    base::LargeArray<std::int32_t> triangles, neighbors;
    std::vector<std::int32_t> first, chain;
  };
  static Triangulation triangulate(const kernel::PlanarGraphView& graph, std::span<const kernel::Point> seeds,
                                   std::span<const std::int32_t> segment, const SampleGroups& groups,
                                   unsigned threads, const base::Monitor& monitor);
  SampleDiagram(Triangulation&& made, const kernel::PlanarGraphView& graph,
                std::span<const kernel::Point> seeds, std::span<const std::int32_t> segment,
                std::span<const std::int32_t> start, const SampleGroups& groups, unsigned threads,
                const base::Monitor& monitor);

  void find_walked(const std::vector<std::uint8_t>& has_side);
  void classify_sides(std::vector<std::uint8_t>& has_side, unsigned threads, const base::Monitor& monitor);
  std::uint8_t state_of(Side s, std::vector<std::uint8_t>& has_side) const;
  bool is_alone_on(Side s) const;
  void join_centers(unsigned threads, const base::Monitor& monitor);
  void cross_out(unsigned threads, const base::Monitor& monitor);
  void mark_crossed(Side s);
  void count_deleted();

  SampleGroups groups_;
  base::LargeArray<std::int32_t> triangles_, neighbors_;
  std::vector<std::int32_t> first_, chain_;
  SampleMesh mesh_;
  SampleLabels labels_;
  base::LargeArray<std::uint8_t> state_;  // [sides] of both sides of an edge
  std::vector<Triangle> root_;            // empty while all centers differ
  std::vector<std::int32_t> walked_;
  std::vector<std::int32_t> face_;
  SampleDiagramCounts counts_;
};

}  // namespace vorotool::core::sampled_skeleton
