// A segment Voronoi diagram as flat arrays: coincident vertices merged, everything in an order that depends
// on the input only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/large_array.hpp"
#include "core/monitor.hpp"
#include "core/segment_insertion.hpp"
#include "core/segment_sites.hpp"
#include "core/voronoi_records.hpp"

namespace vorotool::core {

// Where to write a diagram. Sites have the numbers of the input: points first, then segments. What comes
// first is decided by the order in which the engine works on the sites, that of a curve through the points:
// it depends on where they are, not on how they are numbered.
struct DiagramArrays {
  double* vertices;            // [2 vertex_count] in the order of the lists of their sites
  double* radius;              // [vertex_count]
  std::int32_t* vertex_start;  // [vertex_count + 1] where the sites of each vertex begin
  // [ring_size] the sites that the disc of a vertex touches and whose cells meet there, counter-clockwise
  // from the smallest number.
  std::int32_t* vertex_sites;
  // [2 edge_count] source and target; -1 at infinity, as source only of edges that have no vertex. These come
  // first; the others with their source, the end with the smaller number, counter-clockwise around it.
  std::int32_t* edges;
  std::int32_t* edge_sites;  // [2 edge_count] on the left and on the right
};

class VoronoiExtraction {
 public:
  VoronoiExtraction(const SegmentSites& sites, const VoronoiRecords& records,
                    std::span<const std::int32_t> given, unsigned threads, const Monitor& monitor);

  std::size_t vertex_count() const { return order_.size(); }
  std::size_t ring_size() const { return ring_size_; }
  std::size_t edge_count() const { return (ring_size_ + infinite_) / 2; }

  void write(const DiagramArrays& out, unsigned threads, const Monitor& monitor) const;

 private:
  // A site around a vertex, and the half-edge after which its cell comes counter-clockwise.
  struct Spoke {
    SiteIndex site;
    Corner corner;  // opposite to the edge on whose left the site is
    bool is_left;   // the disc lies to the left of the segment
  };
  // The sites around a vertex counter-clockwise, the first of the engine's order first.
  using Ring = std::vector<Spoke>;
  // The first three sites around a vertex, and a record of it.
  struct Key {
    SiteIndex first, second, third;
    std::int32_t record;
    auto operator<=>(const Key&) const = default;
  };
  struct Edge {
    std::int32_t source, target, left, right;
  };
  // Rings and edges of some consecutive vertices, and where they belong.
  struct Piece {
    std::vector<std::int32_t> ring_sizes, sites;
    std::vector<Edge> edges;
    std::size_t first_site = 0, first_edge = 0;

    void clear() {
      ring_sizes.clear();
      sites.clear();
      edges.clear();
    }
  };

  void merge_coincident(unsigned threads, const Monitor& monitor);
  std::int32_t root(std::int32_t record);
  void unite(std::int32_t u, std::int32_t w);
  void choose_leads();
  Key key_of(std::int32_t record, Ring& ring) const;
  void put_in_order(unsigned threads, const Monitor& monitor);
  void sort_keys(const LargeArray<Key>& keys, unsigned threads, const Monitor& monitor);
  void number_vertices(unsigned threads, const Monitor& monitor);

  Corner next_spoke(Corner corner) const;
  Corner border_of(std::int32_t record) const;
  int border_size(std::int32_t record) const;
  bool is_border(Corner corner) const;
  void gather_ring(std::int32_t record, Ring& ring) const;
  Spoke spoke_at(Corner corner) const;
  std::int32_t target_of(Corner corner) const;

  std::vector<Corner> edges_without_vertex() const;
  void prefetch(std::size_t vertex) const;
  void write_discs(std::size_t begin, std::size_t end, Piece& piece, const DiagramArrays& out) const;
  static void put_piece(std::size_t begin, const Piece& piece, const DiagramArrays& out);
  Edge edge_at(std::int32_t source, Corner corner) const;
  static void write_edge(std::size_t place, const Edge& edge, const DiagramArrays& out);

  std::int32_t given(SiteIndex site) const { return given_[static_cast<std::size_t>(site)]; }

  const SegmentSites& sites_;
  const VoronoiRecords& records_;
  std::span<const std::int32_t> given_;
  // [records] a record at the same place, one for all of a place; in the end the number of the vertex, -1 at
  // infinity
  std::vector<std::int32_t> vertex_of_;
  std::vector<std::int32_t> order_;  // [vertices] a record of each
  std::vector<bool> merged_;         // [records] whether it shares its place with others
  std::vector<bool> leads_;          // [records] of these, whether it stands for its place
  std::size_t ring_size_ = 0, infinite_ = 0;
};

}  // namespace vorotool::core
