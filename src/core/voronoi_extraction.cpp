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
constexpr std::size_t batch_size = 64;                    // pieces that are kept at once, below 1 MB each
constexpr std::size_t ahead = 8;                          // vertices: how early memory is called for

// Calls body(piece, begin, end) for pieces of the items.
template <class Body>
void for_pieces(std::size_t count, unsigned threads, const Monitor& monitor, Body body) {
  parallel_for(
      piece_count(count, piece_size), threads,
      [&](std::size_t piece) { body(piece, piece * piece_size, std::min(count, (piece + 1) * piece_size)); },
      monitor);
}

// Whether an edge is written with the vertex at this end of it: that with the smaller number, or the only
// one.
bool is_written_from(std::size_t vertex, std::int32_t target) {
  return target < 0 || static_cast<std::size_t>(target) > vertex;
}

}  // namespace

VoronoiExtraction::VoronoiExtraction(const SegmentSites& sites, const VoronoiRecords& records,
                                     std::span<const std::int32_t> given, unsigned threads,
                                     const Monitor& monitor)
    : sites_(sites),
      records_(records),
      given_(given),
      vertex_of_(records.all.size()),
      merged_(records.all.size()) {
  merge_coincident(threads, monitor);
  choose_leads();
  put_in_order(threads, monitor);
}

// With every step the way is halved for those who come after.
std::int32_t VoronoiExtraction::root(std::int32_t record) {
  const auto above = [&](std::int32_t v) -> std::int32_t& { return vertex_of_[static_cast<std::size_t>(v)]; };
  while (above(record) != record) {
    above(record) = above(above(record));
    record = above(record);
  }
  return record;
}

// The smaller number becomes the root.
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
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(records_.all.size()); ++v)
    vertex_of_[static_cast<std::size_t>(v)] = root(v);
}

bool VoronoiExtraction::is_border(Corner corner) const {
  return target_of(corner) != vertex_of_[static_cast<std::size_t>(record_of(corner))];
}

// The border of a place is gone round counter-clockwise: from half-edge to half-edge of one vertex, and on in
// the next vertex of the place where a half-edge has no length. A point whose segments leave no gap of 180
// degrees is inside.
Corner VoronoiExtraction::next_spoke(Corner corner) const {
  for (;;) {
    const std::int32_t record = record_of(corner);
    corner = corner_of(record, following(place_of(corner)));
    if (is_border(corner)) return corner;
    corner = records_[record].twins[static_cast<std::size_t>(place_of(corner))];
  }
}

// A half-edge of a record that leaves its place; there is one.
Corner VoronoiExtraction::border_of(std::int32_t record) const {
  int i = 0;
  while (!is_border(corner_of(record, i))) ++i;
  return corner_of(record, i);
}

// Half-edges of a record that leave its place.
int VoronoiExtraction::border_size(std::int32_t record) const {
  if (!merged_[static_cast<std::size_t>(record)]) return 3;
  int size = 0;
  for (int i = 0; i < 3; ++i) size += is_border(corner_of(record, i));
  return size;
}

VoronoiExtraction::Spoke VoronoiExtraction::spoke_at(Corner corner) const {
  const VoronoiRecord& v = records_[record_of(corner)];
  const int left = preceding(place_of(corner));
  return {v.sites[static_cast<std::size_t>(left)], corner, v.is_left(left)};
}

void VoronoiExtraction::gather_ring(std::int32_t record, Ring& ring) const {
  ring.clear();
  if (!merged_[static_cast<std::size_t>(record)]) {
    const std::array<SiteIndex, 3>& sites = records_[record].sites;
    int i = static_cast<int>(std::min_element(sites.begin(), sites.end()) - sites.begin());
    i = following(i);  // the site is on the left of this edge
    for (int k = 0; k < 3; ++k, i = following(i)) ring.push_back(spoke_at(corner_of(record, i)));
    return;
  }
  const Corner first = border_of(record);
  Corner corner = first;
  do {
    ring.push_back(spoke_at(corner));
    corner = next_spoke(corner);
  } while (corner != first);
  const auto least = std::min_element(ring.begin(), ring.end(),
                                      [](const Spoke& a, const Spoke& b) { return a.site < b.site; });
  std::rotate(ring.begin(), least, ring.end());
}

// The place to which an edge leads, in the end the number of its vertex.
std::int32_t VoronoiExtraction::target_of(Corner corner) const {
  const Corner twin = records_[record_of(corner)].twins[static_cast<std::size_t>(place_of(corner))];
  return vertex_of_[static_cast<std::size_t>(record_of(twin))];
}

// The first record of each place that is on its border stands for it.
void VoronoiExtraction::choose_leads() {
  leads_.assign(vertex_of_.size(), false);
  std::vector<bool> seen(vertex_of_.size());
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(records_.all.size()); ++v) {
    if (!merged_[static_cast<std::size_t>(v)]) continue;
    const auto place = static_cast<std::size_t>(vertex_of_[static_cast<std::size_t>(v)]);
    if (seen[place] || border_size(v) == 0) continue;
    seen[place] = leads_[static_cast<std::size_t>(v)] = true;
  }
}

// What a record says of its vertex: nothing (first = -1) if another one stands for its place.
VoronoiExtraction::Key VoronoiExtraction::key_of(std::int32_t record, Ring& ring) const {
  const auto v = static_cast<std::size_t>(record);
  if (records_[record].is_infinite() || (merged_[v] && !leads_[v])) return {-1, -1, -1, record};
  gather_ring(record, ring);
  return {ring[0].site, ring[1].site, ring[2].site, record};
}

// Vertices are sorted by their first three sites: no others have these three, in this order.
void VoronoiExtraction::put_in_order(unsigned threads, const Monitor& monitor) {
  const std::size_t records = vertex_of_.size();
  LargeArray<Key> keys(records);
  std::vector<std::size_t> rings(piece_count(records, piece_size)), infinite(rings.size());
  for_pieces(records, threads, monitor, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    Ring ring;
    for (std::size_t v = begin; v < end; ++v) {
      const auto record = static_cast<std::int32_t>(v);
      keys[v] = key_of(record, ring);
      infinite[piece] += records_[record].is_infinite();
      if (keys[v].first >= 0) rings[piece] += ring.size();
    }
  });
  ring_size_ = std::accumulate(rings.begin(), rings.end(), std::size_t{0});
  infinite_ = std::accumulate(infinite.begin(), infinite.end(), std::size_t{0});
  sort_keys(keys, threads, monitor);
  number_vertices(threads, monitor);
}

// By the first site in one go, and by the others among the few that share it.
void VoronoiExtraction::sort_keys(const LargeArray<Key>& keys, unsigned threads, const Monitor& monitor) {
  const auto sites = static_cast<std::size_t>(sites_.infinite());
  std::vector<std::uint32_t> begin(sites + 2);
  const std::span all(keys.data(), keys.size());
  for (const Key& key : all) {
    if (key.first >= 0) ++begin[static_cast<std::size_t>(key.first) + 2];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  LargeArray<Key> sorted(begin[sites + 1]);
  for (const Key& key : all) {
    if (key.first >= 0) sorted[begin[static_cast<std::size_t>(key.first) + 1]++] = key;
  }
  order_.resize(sorted.size());
  for_pieces(sites, threads, monitor, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t site = first; site < last; ++site) {
      std::sort(sorted.data() + begin[site], sorted.data() + begin[site + 1]);
    }
    for (std::size_t k = begin[first]; k < begin[last]; ++k) order_[k] = sorted[k].record;
  });
}

// Turns places into numbers of vertices: the root of each place first, marked by its complement. No two
// vertices have a place in common, and no root changes in the second round.
void VoronoiExtraction::number_vertices(unsigned threads, const Monitor& monitor) {
  const auto of = [&](auto record) -> std::int32_t& { return vertex_of_[static_cast<std::size_t>(record)]; };
  for_pieces(order_.size(), threads, monitor, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) of(of(order_[k])) = ~static_cast<std::int32_t>(k);
  });
  for_pieces(vertex_of_.size(), threads, monitor, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (of(v) >= 0) of(v) = of(of(v));
    }
  });
  for_pieces(vertex_of_.size(), threads, monitor, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      of(v) = records_[static_cast<std::int32_t>(v)].is_infinite() ? -1 : ~of(v);
    }
  });
}

// Half-edges from infinity to infinity, each edge once, in the order of the sites on their left.
std::vector<Corner> VoronoiExtraction::edges_without_vertex() const {
  std::vector<Corner> edges;
  const auto sites = [&](Corner corner) {
    return sites_of_edge(records_[record_of(corner)], place_of(corner));
  };
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(records_.all.size()); ++v) {
    if (!records_[v].is_infinite()) continue;
    const Corner corner = corner_of(v, records_[v].find(sites_.infinite()));
    const EdgeSites beside = sites(corner);
    if (target_of(corner) < 0 && beside.left < beside.right) edges.push_back(corner);
  }
  std::sort(edges.begin(), edges.end(), [&](Corner a, Corner b) {
    const EdgeSites p = sites(a), q = sites(b);
    return p.left != q.left ? p.left < q.left : p.right < q.right;
  });
  return edges;
}

// Where the edges of a piece belong is known once those before are counted. So pieces are worked on in
// batches: their rings and edges are gathered, and then put in their places.
void VoronoiExtraction::write(const DiagramArrays& out, unsigned threads, const Monitor& monitor) const {
  std::size_t edge = 0, site = 0;
  for (const Corner corner : edges_without_vertex()) write_edge(edge++, edge_at(-1, corner), out);
  const std::size_t pieces = piece_count(order_.size(), piece_size);
  std::vector<Piece> batch(std::min(pieces, batch_size));
  for (std::size_t first = 0; first < pieces; first += batch_size) {
    const std::size_t count = std::min(batch_size, pieces - first);
    parallel_for(
        count, threads,
        [&](std::size_t k) {
          const std::size_t begin = (first + k) * piece_size;
          write_discs(begin, std::min(order_.size(), begin + piece_size), batch[k], out);
        },
        monitor);
    for (std::size_t k = 0; k < count; ++k) {
      batch[k].first_site = std::exchange(site, site + batch[k].sites.size());
      batch[k].first_edge = std::exchange(edge, edge + batch[k].edges.size());
    }
    parallel_for(count, threads, [&](std::size_t k) { put_piece((first + k) * piece_size, batch[k], out); });
  }
  out.vertex_start[order_.size()] = static_cast<std::int32_t>(site);
}

// Records are far apart in memory: they are called for early, and then what they lead to.
void VoronoiExtraction::prefetch(std::size_t vertex) const {
  if (vertex + 2 * ahead < order_.size()) __builtin_prefetch(&records_[order_[vertex + 2 * ahead]]);
  if (vertex + ahead >= order_.size()) return;
  for (const Corner twin : records_[order_[vertex + ahead]].twins) {
    __builtin_prefetch(&vertex_of_[static_cast<std::size_t>(record_of(twin))]);
  }
}

void VoronoiExtraction::write_discs(std::size_t begin, std::size_t end, Piece& piece,
                                    const DiagramArrays& out) const {
  Ring ring;
  std::vector<Contact> contacts;
  piece.clear();
  for (std::size_t vertex = begin; vertex < end; ++vertex) {
    prefetch(vertex);
    gather_ring(order_[vertex], ring);
    contacts.clear();
    piece.ring_sizes.push_back(static_cast<std::int32_t>(ring.size()));
    for (const Spoke& spoke : ring) {
      contacts.push_back({spoke.site, spoke.is_left});
      piece.sites.push_back(given(spoke.site));
      if (is_written_from(vertex, target_of(spoke.corner))) {
        piece.edges.push_back(edge_at(static_cast<std::int32_t>(vertex), spoke.corner));
      }
    }
    const auto sites = piece.sites.end() - static_cast<std::ptrdiff_t>(ring.size());
    std::rotate(sites, std::min_element(sites, piece.sites.end()), piece.sites.end());
    const PolishedDisc disc = polished_disc(sites_, records_[order_[vertex]], contacts);
    out.vertices[2 * vertex] = disc.x;
    out.vertices[2 * vertex + 1] = disc.y;
    out.radius[vertex] = disc.radius;
  }
}

void VoronoiExtraction::put_piece(std::size_t begin, const Piece& piece, const DiagramArrays& out) {
  std::size_t start = piece.first_site;
  std::copy(piece.sites.begin(), piece.sites.end(), out.vertex_sites + start);
  for (std::size_t k = 0; k < piece.ring_sizes.size(); ++k) {
    out.vertex_start[begin + k] = static_cast<std::int32_t>(start);
    start += static_cast<std::size_t>(piece.ring_sizes[k]);
  }
  for (std::size_t k = 0; k < piece.edges.size(); ++k) write_edge(piece.first_edge + k, piece.edges[k], out);
}

VoronoiExtraction::Edge VoronoiExtraction::edge_at(std::int32_t source, Corner corner) const {
  const auto [right, left] = sites_of_edge(records_[record_of(corner)], place_of(corner));
  return {source, target_of(corner), given(left), given(right)};
}

void VoronoiExtraction::write_edge(std::size_t place, const Edge& edge, const DiagramArrays& out) {
  out.edges[2 * place] = edge.source;
  out.edges[2 * place + 1] = edge.target;
  out.edge_sites[2 * place] = edge.left;
  out.edge_sites[2 * place + 1] = edge.right;
}

}  // namespace vorotool::core
