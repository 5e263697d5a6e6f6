// A segment Voronoi diagram as flat arrays: coincident vertices merged, everything in an order that depends
// on the input only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/monitor.hpp"
#include "core/segment_insertion.hpp"
#include "core/segment_sites.hpp"
#include "core/voronoi_records.hpp"

namespace vorotool::core {

// Where to write a diagram. Sites have the numbers of the input: points first, then segments.
struct DiagramArrays {
  double* vertices;            // [2 vertex_count] in the order of the lists of their sites
  double* radius;              // [vertex_count]
  std::int32_t* vertex_start;  // [vertex_count + 1] where the sites of each vertex begin
  // [ring_size] the sites that the disc of a vertex touches and whose cells meet there, counter-clockwise
  // from the smallest number.
  std::int32_t* vertex_sites;
  std::int32_t* edges;  // [2 edge_count] source and target, -1 at infinity, in the order of all four numbers
  std::int32_t*
      edge_sites;  // [2 edge_count] on the left and on the right; that on the left is the smaller one
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
  // A site around a vertex, and the half-edge after which its cell begins counter-clockwise.
  struct Spoke {
    SiteIndex site;  // the number in the input
    Corner corner;   // opposite to the edge on whose left the site is
    bool is_left;    // the disc lies to the left of the segment
  };
  struct Edge {
    std::int32_t source, target, left, right;
    auto operator<=>(const Edge&) const = default;
  };

  void merge_coincident(unsigned threads, const Monitor& monitor);
  std::int32_t root(std::int32_t record) const;
  void unite(std::int32_t u, std::int32_t w);
  Corner next_spoke(Corner corner) const;
  Corner border_of(std::int32_t record) const;
  void gather_ring(std::int32_t record, std::vector<Spoke>& ring) const;
  std::vector<std::int32_t> representatives();
  void put_in_order(unsigned threads, const Monitor& monitor);
  void sort_by_ring(std::size_t begin, std::size_t end);
  void number_vertices();
  void append_edge(std::int32_t source, Corner corner, std::vector<Edge>& edges) const;
  std::vector<Edge> edges_from_infinity() const;
  void write_vertex(std::size_t vertex, const std::vector<Spoke>& ring, const DiagramArrays& out) const;
  static void write_edges(const std::vector<Edge>& edges, std::size_t start, const DiagramArrays& out);
  std::int32_t number_of(SiteIndex site) const { return given_[static_cast<std::size_t>(site)]; }

  const SegmentSites& sites_;
  const VoronoiRecords& records_;
  std::span<const std::int32_t> given_;
  // [records] a record at the same place, itself for one of each place; later the number of the vertex, -1 at
  // infinity
  std::vector<std::int32_t> vertex_of_;
  std::vector<std::int32_t> order_;  // [vertices] a record of each
  std::vector<bool> merged_;         // [records] whether it shares its place with others
  std::size_t ring_size_ = 0, infinite_ = 0;
};

}  // namespace vorotool::core
