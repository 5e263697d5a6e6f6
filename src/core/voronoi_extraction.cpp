#include "core/voronoi_extraction.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/polished_disc.hpp"
#include "core/vertex_numbers.hpp"
#include "core/voronoi_records.hpp"

namespace vorotool::core {
namespace {

constexpr std::size_t piece_size = std::size_t{1} << 12;  // items of a piece of work, a tenth of a ms
constexpr std::size_t batch_size = 16;                    // pieces that are kept at once, some 200 KB each
constexpr std::size_t ahead = 8;                          // vertices: how early memory is called for

using Links = LargeArray<VoronoiLink>;

// Calls body(begin, end) for pieces of the items.
template <class Body>
void for_pieces(std::size_t count, unsigned threads, const Monitor& monitor, Body body) {
  parallel_for(
      piece_count(count, piece_size), threads,
      [&](std::size_t piece) { body(piece * piece_size, std::min(count, (piece + 1) * piece_size)); },
      monitor);
}

// ---- centres and radii -----------------------------------------------------------------------------------

class DiscWriter {
 public:
  DiscWriter(const SegmentSites& sites, VoronoiRecords& records, const VertexNumbers& numbers,
             DiagramArrays& out)
      : sites_(sites), records_(records), numbers_(numbers), out_(out), links_(records.all.size()) {}

  // Leaves of the records what links them. Discs with several records are found while these are all there.
  Links run(unsigned threads, const Monitor& monitor) {
    const auto merged = numbers_.merged_leads();
    for_pieces(merged.size(), threads, monitor, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) polish(merged[k]);
    });
    for_pieces(links_.size(), threads, monitor, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto record = static_cast<std::int32_t>(i);
        links_[i] = {records_.all[i].sites, records_.all[i].twins};
        if (!numbers_.is_lead(record)) continue;
        if (!numbers_.is_merged(record)) polish(record);
        put(records_.all[i], static_cast<std::size_t>(numbers_.of(record)));
      }
      records_.all.discard(begin, end);
    });
    return std::move(links_);
  }

 private:
  void polish(std::int32_t record) {
    thread_local std::vector<Corner> ring;
    thread_local std::vector<Contact> contacts;
    numbers_.gather_ring(records_, record, ring);
    contacts.clear();
    for (const Corner corner : ring) {
      const VoronoiRecord& v = records_[record_of(corner)];
      contacts.push_back({left_site(records_, corner), v.is_left(preceding(place_of(corner)))});
    }
    const PolishedDisc disc = polished_disc(sites_, records_[record], contacts);
    VoronoiRecord& v = records_[record];
    v.x = disc.x;
    v.y = disc.y;
    v.radius = disc.radius;
  }

  void put(const VoronoiRecord& v, std::size_t vertex) {
    out_.vertices[2 * vertex] = v.x;
    out_.vertices[2 * vertex + 1] = v.y;
    out_.radius[vertex] = v.radius;
  }

  const SegmentSites& sites_;
  VoronoiRecords& records_;
  const VertexNumbers& numbers_;
  DiagramArrays& out_;
  Links links_;
};

// ---- sites around vertices, and edges --------------------------------------------------------------------

class EdgeWriter {
 public:
  EdgeWriter(const Links& links, const VertexNumbers& numbers, SiteIndex infinite,
             std::span<const std::int32_t> given, DiagramArrays& out)
      : links_(links), numbers_(numbers), infinite_(infinite), given_(given), out_(out) {}

  void run(unsigned threads, const Monitor& monitor);

 private:
  struct Edge {
    std::int32_t source, target, left, right;
  };
  // Rings and edges of some consecutive vertices, and where they belong.
  struct Piece {
    std::vector<std::int32_t> ring_sizes, sites;
    std::vector<Edge> edges;
    std::size_t first_site = 0, first_edge = 0;
  };

  std::vector<Corner> edges_without_vertex() const;
  void gather(std::size_t begin, std::size_t end, Piece& piece) const;
  void put(std::size_t begin, const Piece& piece);
  void put_edge(std::size_t place, const Edge& edge);
  void prefetch(std::size_t vertex) const;

  std::int32_t given(SiteIndex site) const { return given_[static_cast<std::size_t>(site)]; }
  // Where an edge leads.
  std::int32_t target_of(Corner corner) const {
    return numbers_.of(
        record_of(links_[record_of(corner)].twins[static_cast<std::size_t>(place_of(corner))]));
  }
  Edge edge_at(std::int32_t source, Corner corner) const {
    const auto [right, left] = sites_of_edge(links_[record_of(corner)], place_of(corner));
    const std::int32_t target = target_of(corner);
    return {source, target == VertexNumbers::at_infinity ? -1 : target, given(left), given(right)};
  }

  const Links& links_;
  const VertexNumbers& numbers_;
  SiteIndex infinite_;
  std::span<const std::int32_t> given_;
  DiagramArrays& out_;
};

// Half-edges from infinity to infinity, each edge once, in the order of the sites on their left.
std::vector<Corner> EdgeWriter::edges_without_vertex() const {
  std::vector<Corner> edges;
  const auto sites = [&](Corner corner) {
    return sites_of_edge(links_[record_of(corner)], place_of(corner));
  };
  for (const std::int32_t v : numbers_.infinite()) {
    const auto& around = links_[v].sites;
    const auto place = std::find(around.begin(), around.end(), infinite_) - around.begin();
    const Corner corner = corner_of(v, static_cast<int>(place));
    const EdgeSites beside = sites(corner);
    if (target_of(corner) == VertexNumbers::at_infinity && beside.left < beside.right)
      edges.push_back(corner);
  }
  std::sort(edges.begin(), edges.end(), [&](Corner a, Corner b) {
    const EdgeSites p = sites(a), q = sites(b);
    return p.left != q.left ? p.left < q.left : p.right < q.right;
  });
  return edges;
}

// Where the edges of a piece belong is known once those before are counted. So pieces are worked on in
// batches: their rings and edges are gathered, and then put in their places.
void EdgeWriter::run(unsigned threads, const Monitor& monitor) {
  std::size_t edge = 0, site = 0;
  for (const Corner corner : edges_without_vertex()) put_edge(edge++, edge_at(-1, corner));
  const std::size_t vertices = numbers_.count(), pieces = piece_count(vertices, piece_size);
  std::vector<Piece> batch(std::min(pieces, batch_size));
  for (std::size_t first = 0; first < pieces; first += batch_size) {
    const std::size_t count = std::min(batch_size, pieces - first);
    parallel_for(
        count, threads,
        [&](std::size_t k) {
          const std::size_t begin = (first + k) * piece_size;
          gather(begin, std::min(vertices, begin + piece_size), batch[k]);
        },
        monitor);
    for (std::size_t k = 0; k < count; ++k) {
      batch[k].first_site = std::exchange(site, site + batch[k].sites.size());
      batch[k].first_edge = std::exchange(edge, edge + batch[k].edges.size());
    }
    parallel_for(count, threads, [&](std::size_t k) { put((first + k) * piece_size, batch[k]); });
  }
  out_.vertex_start[vertices] = static_cast<std::int32_t>(site);
}

// Links are far apart in memory: they are called for early, and then what they lead to.
void EdgeWriter::prefetch(std::size_t vertex) const {
  const auto leads = numbers_.leads();
  if (vertex + 2 * ahead < leads.size()) __builtin_prefetch(&links_[leads[vertex + 2 * ahead]]);
  if (vertex + ahead >= leads.size()) return;
  for (const Corner twin : links_[leads[vertex + ahead]].twins) numbers_.prefetch(record_of(twin));
}

// An edge is written with the end that has the smaller number: it may be the only one.
void EdgeWriter::gather(std::size_t begin, std::size_t end, Piece& piece) const {
  std::vector<Corner> ring;
  piece.ring_sizes.clear();
  piece.sites.clear();
  piece.edges.clear();
  for (std::size_t vertex = begin; vertex < end; ++vertex) {
    prefetch(vertex);
    const auto number = static_cast<std::int32_t>(vertex);
    numbers_.gather_ring(links_, numbers_.leads()[vertex], ring);
    piece.ring_sizes.push_back(static_cast<std::int32_t>(ring.size()));
    for (const Corner corner : ring) {
      piece.sites.push_back(given(left_site(links_, corner)));
      if (target_of(corner) > number) piece.edges.push_back(edge_at(number, corner));
    }
    const auto sites = piece.sites.end() - static_cast<std::ptrdiff_t>(ring.size());
    std::rotate(sites, std::min_element(sites, piece.sites.end()), piece.sites.end());
  }
}

void EdgeWriter::put(std::size_t begin, const Piece& piece) {
  std::size_t start = piece.first_site;
  std::copy(piece.sites.begin(), piece.sites.end(), out_.vertex_sites.data() + start);
  for (std::size_t k = 0; k < piece.ring_sizes.size(); ++k) {
    out_.vertex_start[begin + k] = static_cast<std::int32_t>(start);
    start += static_cast<std::size_t>(piece.ring_sizes[k]);
  }
  for (std::size_t k = 0; k < piece.edges.size(); ++k) put_edge(piece.first_edge + k, piece.edges[k]);
}

void EdgeWriter::put_edge(std::size_t place, const Edge& edge) {
  out_.edges[2 * place] = edge.source;
  out_.edges[2 * place + 1] = edge.target;
  out_.edge_sites[2 * place] = edge.left;
  out_.edge_sites[2 * place + 1] = edge.right;
}

}  // namespace

DiagramArrays extract_diagram(SegmentSites sites, VoronoiRecords records, std::span<const std::int32_t> given,
                              unsigned threads, const Monitor& monitor) {
  records.corner_of_point = {};
  const SiteIndex infinite = sites.infinite();
  const VertexNumbers numbers(sites, records, threads, monitor);
  const std::size_t vertices = numbers.count(), ring = numbers.ring_size(),
                    edges = (ring + numbers.infinite().size()) / 2;
  DiagramArrays out;
  out.vertices = LargeArray<double>(2 * vertices);
  out.radius = LargeArray<double>(vertices);
  const Links links = DiscWriter(sites, records, numbers, out).run(threads, monitor);
  records.all = {};
  sites = {};
  out.vertex_start = LargeArray<std::int32_t>(vertices + 1);
  out.vertex_sites = LargeArray<std::int32_t>(ring);
  out.edges = LargeArray<std::int32_t>(2 * edges);
  out.edge_sites = LargeArray<std::int32_t>(2 * edges);
  EdgeWriter(links, numbers, infinite, given, out).run(threads, monitor);
  return out;
}

}  // namespace vorotool::core
