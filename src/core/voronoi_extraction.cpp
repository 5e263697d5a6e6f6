#include "core/voronoi_extraction.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "core/coincident_vertices.hpp"
#include "core/parallel.hpp"
#include "core/polished_disc.hpp"

namespace vorotool::core {
namespace {

constexpr std::size_t piece_size = std::size_t{1} << 13;  // items of a piece of work, some ms

// Calls body(piece, begin, end) for pieces of the items.
template <class Body>
void for_pieces(std::size_t count, unsigned threads, const Monitor& monitor, Body body) {
  parallel_for(
      piece_count(count, piece_size), threads,
      [&](std::size_t piece) { body(piece, piece * piece_size, std::min(count, (piece + 1) * piece_size)); },
      monitor);
}

}  // namespace

VoronoiExtraction::VoronoiExtraction(const SegmentSites& sites, const VoronoiRecords& records,
                                     std::span<const std::int32_t> given, unsigned threads,
                                     const Monitor& monitor)
    : sites_(sites),
      records_(records),
      given_(given),
      vertex_of_(static_cast<std::size_t>(records.size)),
      merged_(static_cast<std::size_t>(records.size)) {
  merge_coincident(threads, monitor);
  put_in_order(threads, monitor);
}

std::int32_t VoronoiExtraction::root(std::int32_t record) const {
  while (vertex_of_[static_cast<std::size_t>(record)] != record) {
    record = vertex_of_[static_cast<std::size_t>(record)];
  }
  return record;
}

// The smaller number becomes the root: no chain is longer than a place has vertices.
void VoronoiExtraction::unite(std::int32_t u, std::int32_t w) {
  merged_[static_cast<std::size_t>(u)] = merged_[static_cast<std::size_t>(w)] = true;
  u = root(u);
  w = root(w);
  vertex_of_[static_cast<std::size_t>(std::max(u, w))] = std::min(u, w);
}

void VoronoiExtraction::merge_coincident(unsigned threads, const Monitor& monitor) {
  std::iota(vertex_of_.begin(), vertex_of_.end(), 0);
  using Pair = std::array<std::int32_t, 2>;
  std::vector<std::vector<Pair>> pairs(piece_count(vertex_of_.size(), piece_size));
  for_pieces(vertex_of_.size(), threads, monitor, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    for (auto u = static_cast<std::int32_t>(begin); u < static_cast<std::int32_t>(end); ++u) {
      const VoronoiRecord& v = records_[u];
      if (v.is_infinite()) continue;
      for (int i = 0; i < 3; ++i) {
        const std::int32_t w = record_of(v.twins[static_cast<std::size_t>(i)]);
        if (w < u || records_[w].is_infinite()) continue;
        if (are_coincident(sites_, v, i, records_[w])) pairs[piece].push_back({u, w});
      }
    }
  });
  for (const std::vector<Pair>& some : pairs) {
    for (const auto& [u, w] : some) unite(u, w);
  }
  for (std::int32_t v = 0; v < records_.size; ++v) vertex_of_[static_cast<std::size_t>(v)] = root(v);
}

// The border of a place is gone round counter-clockwise: from half-edge to half-edge of one vertex, and on in
// the next vertex of the place where a half-edge has no length. A point whose segments leave no gap of 180
// degrees is inside.
Corner VoronoiExtraction::next_spoke(Corner corner) const {
  const std::int32_t place = vertex_of_[static_cast<std::size_t>(record_of(corner))];
  for (;;) {
    corner = corner_of(record_of(corner), following(place_of(corner)));
    const Corner twin = records_[record_of(corner)].twins[static_cast<std::size_t>(place_of(corner))];
    if (vertex_of_[static_cast<std::size_t>(record_of(twin))] != place) return corner;
    corner = twin;
  }
}

// A half-edge of a record that leaves its place, or -1.
Corner VoronoiExtraction::border_of(std::int32_t record) const {
  for (int i = 0; i < 3; ++i) {
    const Corner twin = records_[record].twins[static_cast<std::size_t>(i)];
    if (vertex_of_[static_cast<std::size_t>(record_of(twin))] !=
        vertex_of_[static_cast<std::size_t>(record)]) {
      return corner_of(record, i);
    }
  }
  return -1;
}

// The sites around a vertex, from the smallest number on.
void VoronoiExtraction::gather_ring(std::int32_t record, std::vector<Spoke>& ring) const {
  ring.clear();
  const auto add = [&](Corner corner) {
    const VoronoiRecord& v = records_[record_of(corner)];
    const int left = preceding(place_of(corner));
    ring.push_back({number_of(v.sites[static_cast<std::size_t>(left)]), corner, v.is_left(left)});
  };
  if (!merged_[static_cast<std::size_t>(record)]) {
    for (int i = 0; i < 3; ++i) add(corner_of(record, i));
  } else {
    Corner corner = border_of(record);
    const Corner first = corner;
    do {
      add(corner);
      corner = next_spoke(corner);
    } while (corner != first);
  }
  const auto smallest = std::min_element(ring.begin(), ring.end(),
                                         [](const Spoke& a, const Spoke& b) { return a.site < b.site; });
  std::rotate(ring.begin(), smallest, ring.end());
}

// One record of each place, on its border.
std::vector<std::int32_t> VoronoiExtraction::representatives() {
  std::vector<std::int32_t> records;
  records.reserve(vertex_of_.size());
  std::vector<bool> seen(vertex_of_.size());
  for (std::int32_t v = 0; v < records_.size; ++v) {
    if (records_[v].is_infinite()) {
      ++infinite_;
    } else if (!merged_[static_cast<std::size_t>(v)]) {
      records.push_back(v);
    } else if (const auto place = static_cast<std::size_t>(vertex_of_[static_cast<std::size_t>(v)]);
               !seen[place] && border_of(v) >= 0) {
      seen[place] = true;
      records.push_back(v);
    }
  }
  return records;
}

// Vertices are sorted by their first three sites: no others have these three, in this order.
void VoronoiExtraction::put_in_order(unsigned threads, const Monitor& monitor) {
  const std::vector<std::int32_t> records = representatives();
  std::vector<std::uint32_t> begin(given_.size() + 2);
  std::vector<Spoke> ring;
  for (const std::int32_t record : records) {
    gather_ring(record, ring);
    ring_size_ += ring.size();
    ++begin[static_cast<std::size_t>(ring[0].site) + 2];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  order_.resize(records.size());
  for (const std::int32_t record : records) {
    gather_ring(record, ring);
    order_[begin[static_cast<std::size_t>(ring[0].site) + 1]++] = record;
  }
  for_pieces(given_.size(), threads, monitor, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t site = first; site < last; ++site) sort_by_ring(begin[site], begin[site + 1]);
  });
  number_vertices();
}

// Vertices order_[begin] ... order_[end - 1], which share their smallest site.
void VoronoiExtraction::sort_by_ring(std::size_t begin, std::size_t end) {
  if (end - begin < 2) return;
  struct Item {
    std::int32_t second, third, record;
    auto operator<=>(const Item&) const = default;
  };
  std::vector<Item> items;
  std::vector<Spoke> ring;
  for (std::size_t k = begin; k < end; ++k) {
    gather_ring(order_[k], ring);
    items.push_back({ring[1].site, ring[2].site, order_[k]});
  }
  std::sort(items.begin(), items.end());
  for (std::size_t k = begin; k < end; ++k) order_[k] = items[k - begin].record;
}

// Turns places into numbers of vertices: the root of each place first, marked by its complement.
void VoronoiExtraction::number_vertices() {
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const std::int32_t place = vertex_of_[static_cast<std::size_t>(order_[k])];
    vertex_of_[static_cast<std::size_t>(place)] = ~static_cast<std::int32_t>(k);
  }
  for (std::int32_t& place : vertex_of_) {
    if (place >= 0) place = vertex_of_[static_cast<std::size_t>(place)];
  }
  for (std::int32_t v = 0; v < records_.size; ++v) {
    std::int32_t& vertex = vertex_of_[static_cast<std::size_t>(v)];
    vertex = records_[v].is_infinite() ? -1 : ~vertex;
  }
}

void VoronoiExtraction::append_edge(std::int32_t source, Corner corner, std::vector<Edge>& edges) const {
  const VoronoiRecord& v = records_[record_of(corner)];
  const auto [right, left] = sites_of_edge(v, place_of(corner));
  if (number_of(left) > number_of(right)) return;  // written from its other end
  const Corner twin = v.twins[static_cast<std::size_t>(place_of(corner))];
  edges.push_back(
      {source, vertex_of_[static_cast<std::size_t>(record_of(twin))], number_of(left), number_of(right)});
}

std::vector<VoronoiExtraction::Edge> VoronoiExtraction::edges_from_infinity() const {
  std::vector<Edge> edges;
  for (std::int32_t v = 0; v < records_.size; ++v) {
    if (!records_[v].is_infinite()) continue;
    append_edge(-1, corner_of(v, records_[v].find(sites_.infinite())), edges);
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

void VoronoiExtraction::write_vertex(std::size_t vertex, const std::vector<Spoke>& ring,
                                     const DiagramArrays& out) const {
  std::vector<Contact> contacts;
  for (const Spoke& spoke : ring) {
    const VoronoiRecord& v = records_[record_of(spoke.corner)];
    contacts.push_back({sites_of_edge(v, place_of(spoke.corner)).left, spoke.is_left});
  }
  const PolishedDisc disc = polished_disc(sites_, records_[order_[vertex]], contacts);
  out.vertices[2 * vertex] = disc.x;
  out.vertices[2 * vertex + 1] = disc.y;
  out.radius[vertex] = disc.radius;
}

// Two rounds over the vertices, in pieces: what each piece has, and then writing it where it belongs.
void VoronoiExtraction::write(const DiagramArrays& out, unsigned threads, const Monitor& monitor) const {
  struct Size {
    std::size_t ring = 0, edges = 0;
  };
  std::vector<Size> start(piece_count(order_.size(), piece_size) + 1);
  for_pieces(order_.size(), threads, monitor, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    start[piece + 1] = {};
    std::vector<Spoke> ring;
    std::vector<Edge> edges;
    for (std::size_t vertex = begin; vertex < end; ++vertex) {
      gather_ring(order_[vertex], ring);
      start[piece + 1].ring += ring.size();
      edges.clear();
      for (const Spoke& spoke : ring) append_edge(0, spoke.corner, edges);
      start[piece + 1].edges += edges.size();
    }
  });
  const std::vector<Edge> infinite = edges_from_infinity();
  write_edges(infinite, 0, out);
  start[0].edges = infinite.size();
  for (std::size_t piece = 1; piece < start.size(); ++piece) {
    start[piece].ring += start[piece - 1].ring;
    start[piece].edges += start[piece - 1].edges;
  }
  for_pieces(order_.size(), threads, monitor, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    std::size_t ring_start = start[piece].ring;
    std::vector<Spoke> ring;
    std::vector<Edge> edges;
    for (std::size_t vertex = begin; vertex < end; ++vertex) {
      gather_ring(order_[vertex], ring);
      write_vertex(vertex, ring, out);
      out.vertex_start[vertex] = static_cast<std::int32_t>(ring_start);
      const std::size_t first = edges.size();
      for (const Spoke& spoke : ring) {
        out.vertex_sites[ring_start++] = spoke.site;
        append_edge(static_cast<std::int32_t>(vertex), spoke.corner, edges);
      }
      std::sort(edges.begin() + static_cast<std::ptrdiff_t>(first), edges.end());
    }
    write_edges(edges, start[piece].edges, out);
  });
  out.vertex_start[order_.size()] = static_cast<std::int32_t>(ring_size_);
}

void VoronoiExtraction::write_edges(const std::vector<Edge>& edges, std::size_t start,
                                    const DiagramArrays& out) {
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Edge& edge = edges[k];
    const std::size_t place = 2 * (start + k);
    out.edges[place] = edge.source;
    out.edges[place + 1] = edge.target;
    out.edge_sites[place] = edge.left;
    out.edge_sites[place + 1] = edge.right;
  }
}

}  // namespace vorotool::core
