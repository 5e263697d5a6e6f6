#include "core/segment_voronoi/build/point_voronoi.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"

namespace vorotool::core::segment_voronoi::build {

using base::at;
using base::Monitor;
using delaunay::RingVertex;
using delaunay::Vertex;
using discs::Corner;
using discs::corner_of;
using discs::SegmentSites;

namespace {

constexpr std::size_t points_a_piece = std::size_t{1} << 13;  // points of a piece, some ms of work
// Longer rings than this are searched in a table: a ring may be searched once for each of its entries.
constexpr std::size_t long_ring = 64;

// The site at infinity becomes a neighbor of the vertices on the hull. In a chain the unbounded face is on
// both sides.
void join_infinity(delaunay::Subdivision& mesh, std::span<RingVertex> vertices, Vertex infinite) {
  delaunay::RingStore& store = mesh.stores.emplace_back();
  Vertex from = -1;
  for (Vertex v = vertices.size() < 2 ? -1 : mesh.start; v >= 0;) {
    RingVertex& vertex = vertices[static_cast<std::size_t>(v)];
    const Vertex next = mesh.is_chain && vertex.front() == from ? vertex.back() : vertex.front();
    const bool is_inside_chain = mesh.is_chain && vertex.degree() == 2;
    vertex.insert(vertex.degree(), infinite, store);
    if (is_inside_chain) vertex.insert(1, infinite, store);
    const bool is_last = mesh.is_chain ? next == from : next == mesh.start;
    from = std::exchange(v, is_last ? -1 : next);
  }
}

// The triangles at a vertex begin at the places of its ring: v, the entry and the next one. Their records are
// those of the earliest corner, its lead, in the order of its ring.
class Dual {
 public:
  Dual(const SegmentSites& sites, std::span<const RingVertex> vertices, VoronoiRecords& records)
      : sites_(sites), vertices_(vertices), records_(records), first_(vertices.size() + 1) {}

  void run(unsigned threads, const Monitor& monitor) {
    for_vertices(threads, monitor, [&](Vertex v) { first_[at(v) + 1] = lead_count(v); });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      if (vertices_[i].degree() > long_ring) add_table(static_cast<Vertex>(i));
    }
    for_vertices(threads, monitor, [&](Vertex v) { write(v); });
  }

 private:
  struct Entry {
    Vertex neighbor;
    std::int32_t record;
    bool operator<(const Entry& other) const { return neighbor < other.neighbor; }
  };
  // The record of the first triangle of a vertex's own that begins at a neighbor or after it, by neighbors.
  struct Table {
    Vertex vertex;
    std::vector<Entry> entries;
  };

  template <class Body>
  void for_vertices(unsigned threads, const Monitor& monitor, Body body) {
    base::for_items(vertices_.size(), points_a_piece, threads, monitor,
                    [&](std::size_t i) { body(static_cast<Vertex>(i)); });
  }

  std::span<const Vertex> ring(Vertex v) const {
    return {vertices_[at(v)].ring(), vertices_[at(v)].degree()};
  }
  static bool is_lead(Vertex v, std::span<const Vertex> ring, std::size_t place) {
    return ring[place] > v && ring[place + 1 == ring.size() ? 0 : place + 1] > v;
  }

  std::int32_t lead_count(Vertex v) const;
  void add_table(Vertex v);
  std::int32_t record_from(Vertex v, Vertex neighbor) const;
  std::int32_t record_before(Vertex v, Vertex neighbor) const;
  void write(Vertex v);
  void start(std::int32_t record, const std::array<discs::SiteIndex, 3>& sites);
  Corner first_corner(Vertex v) const;
  void link(Corner a, Corner b);

  const SegmentSites& sites_;
  std::span<const RingVertex> vertices_;
  VoronoiRecords& records_;
  std::vector<std::int32_t> first_;  // [vertices + 1] the first of each one's records
  std::vector<Table> tables_;        // of long rings, by vertices
};

std::int32_t Dual::lead_count(Vertex v) const {
  std::int32_t count = 0;
  for (std::size_t k = 0; k < ring(v).size(); ++k) count += is_lead(v, ring(v), k);
  return count;
}

void Dual::add_table(Vertex v) {
  Table table{v, {}};
  std::int32_t record = first_[at(v)];
  for (std::size_t k = 0; k < ring(v).size(); ++k) {
    table.entries.push_back({ring(v)[k], record});
    record += is_lead(v, ring(v), k);
  }
  std::sort(table.entries.begin(), table.entries.end());
  tables_.push_back(std::move(table));
}

// The record of the first triangle of v's own that begins at a neighbor or after it.
std::int32_t Dual::record_from(Vertex v, Vertex neighbor) const {
  const std::span<const Vertex> ring = this->ring(v);
  if (ring.size() > long_ring) {
    const auto table = std::lower_bound(tables_.begin(), tables_.end(), v,
                                        [](const Table& t, Vertex vertex) { return t.vertex < vertex; });
    return std::lower_bound(table->entries.begin(), table->entries.end(), Entry{neighbor, 0})->record;
  }
  std::int32_t record = first_[at(v)];
  for (std::size_t k = 0; ring[k] != neighbor; ++k) record += is_lead(v, ring, k);
  return record;
}

// The record of v's triangle that ends at a neighbor.
std::int32_t Dual::record_before(Vertex v, Vertex neighbor) const {
  return (ring(v).front() == neighbor ? first_[at(v) + 1] : record_from(v, neighbor)) - 1;
}

// The records that v leads, and the links across the edges to later vertices. Each edge has the triangle that
// begins at it on its left, and the one that ends at it on its right.
void Dual::write(Vertex v) {
  const std::span<const Vertex> ring = this->ring(v);
  std::int32_t record = first_[at(v)];
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vertex w = ring[k], left = ring[k + 1 == ring.size() ? 0 : k + 1],
                 right = ring[k == 0 ? ring.size() - 1 : k - 1];
    if (w < v) continue;
    const std::int32_t last = k == 0 ? first_[at(v) + 1] : record;
    link(left > v ? corner_of(record, 2) : corner_of(record_from(left, v), 0),
         right > v ? corner_of(last - 1, 1) : corner_of(record_before(right, v), 0));
    if (left > v) start(record++, {v, w, left});
  }
  if (!ring.empty()) records_.corner_of_point[at(v)] = first_corner(v);
}

void Dual::start(std::int32_t record, const std::array<discs::SiteIndex, 3>& sites) {
  discs::VoronoiRecord& v = records_[record];
  v.sites = sites;
  v.stamp = 0;
  v.left = 0;
  v.survives = 0;
  v.owner = 0;
  compute_disc(sites_, v);
}

// Of v, in the triangle that begins at the first place of its ring.
Corner Dual::first_corner(Vertex v) const {
  const Vertex a = ring(v)[0], b = ring(v)[1];
  if (v < a && v < b) return corner_of(first_[at(v)], 0);
  return a < b ? corner_of(record_before(a, v), 2) : corner_of(record_from(b, v), 1);
}

void Dual::link(Corner a, Corner b) {
  records_[discs::record_of(a)].twins[static_cast<std::size_t>(discs::place_of(a))] = b;
  records_[discs::record_of(b)].twins[static_cast<std::size_t>(discs::place_of(b))] = a;
}

}  // namespace

VoronoiRecords point_voronoi(const SegmentSites& sites, delaunay::Subdivision& mesh,
                             std::span<RingVertex> vertices, unsigned threads, const Monitor& monitor) {
  VoronoiRecords records(sites.point_count(), sites.segment_count());
  join_infinity(mesh, vertices, sites.infinite());
  Dual(sites, vertices, records).run(threads, monitor);
  return records;
}

}  // namespace vorotool::core::segment_voronoi::build
