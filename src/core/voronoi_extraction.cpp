#include "core/voronoi_extraction.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "core/page_advice.hpp"
#include "core/parallel.hpp"
#include "core/polished_disc.hpp"
#include "core/vertex_numbers.hpp"
#include "core/voronoi_records.hpp"

namespace vorotool::core {
namespace {

constexpr std::size_t piece_size = std::size_t{1} << 13;  // items of a piece of work, some ms
constexpr std::int32_t ahead = 8;                         // records: how early memory is called for

// Calls body(piece, begin, end) for pieces of the items.
template <class Body>
void for_pieces(std::size_t count, unsigned threads, const Monitor& monitor, Body body) {
  parallel_for(
      piece_count(count, piece_size), threads,
      [&](std::size_t piece) { body(piece, piece * piece_size, std::min(count, (piece + 1) * piece_size)); },
      monitor);
}

// ---- vertices and what is around them --------------------------------------------------------------------

// Writes the centres, radii and rings of vertices, and where their edges lead. Sites have the numbers of the
// engine.
class VertexWriter {
 public:
  VertexWriter(const SegmentSites& sites, VoronoiRecords& records, const VertexNumbers& numbers,
               DiagramArrays& out, LargeArray<std::int32_t>& targets)
      : sites_(sites), records_(records), numbers_(numbers), out_(out), targets_(targets) {}

  void run(unsigned threads, const Monitor& monitor);

 private:
  void write_records(std::int32_t begin, std::int32_t end);
  void write_merged(std::size_t k, std::vector<Contact>& contacts);
  void write_single(std::int32_t record);
  void write_disc(std::size_t vertex, const PolishedDisc& disc);

  const SegmentSites& sites_;
  VoronoiRecords& records_;
  const VertexNumbers& numbers_;
  DiagramArrays& out_;
  LargeArray<std::int32_t>& targets_;
};

// Records are read for the last time, those of the points and of the segments of a stretch of the curve
// together: what is written, in the order of the vertices, is near in memory too.
void VertexWriter::run(unsigned threads, const Monitor& monitor) {
  const std::size_t pieces = piece_count(records_.all.size(), piece_size);
  const auto write_stretch = [&](std::size_t first, std::size_t count, std::size_t piece) {
    const std::size_t begin = first + count * piece / pieces, end = first + count * (piece + 1) / pieces;
    write_records(static_cast<std::int32_t>(begin), static_cast<std::int32_t>(end));
    discard(records_.all, begin, end);
  };
  parallel_for(
      pieces, threads,
      [&](std::size_t piece) {
        write_stretch(0, records_.of_points, piece);
        write_stretch(records_.of_points, records_.all.size() - records_.of_points, piece);
      },
      monitor);
}

void VertexWriter::write_records(std::int32_t begin, std::int32_t end) {
  const auto merged = numbers_.merged_leads();
  std::vector<Contact> contacts;
  auto k = static_cast<std::size_t>(std::ranges::lower_bound(merged, begin) - merged.begin());
  for (std::int32_t record = begin; record < end; ++record) {
    if (record + ahead < end) {
      for (const Corner twin : records_[record + ahead].twins) numbers_.prefetch(record_of(twin));
    }
    if (numbers_.is_merged(record)) {
      if (k < merged.size() && merged[k] == record) write_merged(k++, contacts);
    } else if (!records_[record].is_infinite()) {
      write_single(record);
    }
  }
}

void VertexWriter::write_merged(std::size_t k, std::vector<Contact>& contacts) {
  const std::int32_t record = numbers_.merged_leads()[k];
  const auto vertex = static_cast<std::size_t>(numbers_.of(record));
  auto place = static_cast<std::size_t>(out_.vertex_start[vertex]);
  contacts.clear();
  for (const VertexNumbers::Spoke& spoke : numbers_.merged_ring(k)) {
    contacts.push_back({static_cast<SiteIndex>(spoke.site), spoke.is_left != 0});
    out_.vertex_sites[place] = contacts.back().site;
    targets_[place++] = numbers_.of(spoke.across);
  }
  write_disc(vertex, polished_disc(sites_, records_[record], contacts));
}

void VertexWriter::write_single(std::int32_t record) {
  const VoronoiRecord& v = records_[record];
  const auto vertex = static_cast<std::size_t>(numbers_.of(record));
  auto place = static_cast<std::size_t>(out_.vertex_start[vertex]);
  std::array<Contact, 3> contacts;
  int i = static_cast<int>(std::min_element(v.sites.begin(), v.sites.end()) - v.sites.begin());
  for (Contact& contact : contacts) {
    contact = {v.sites[static_cast<std::size_t>(i)], v.is_left(i)};
    i = following(i);  // the site is on the left of this edge
    out_.vertex_sites[place] = contact.site;
    targets_[place++] = numbers_.of(record_of(v.twins[static_cast<std::size_t>(i)]));
  }
  write_disc(vertex, polished_disc(sites_, v, contacts));
}

void VertexWriter::write_disc(std::size_t vertex, const PolishedDisc& disc) {
  out_.vertices[2 * vertex] = disc.x;
  out_.vertices[2 * vertex + 1] = disc.y;
  out_.radius[vertex] = disc.radius;
}

// ---- edges -----------------------------------------------------------------------------------------------

struct Edge {
  std::int32_t source, target, left, right;  // sites in the engine's numbers
};

// Edges from infinity to infinity, each once, in the order of the sites on their left.
std::vector<Edge> edges_without_vertex(const VoronoiRecords& records, const VertexNumbers& numbers,
                                       SiteIndex infinite) {
  std::vector<Edge> edges;
  for (const std::int32_t record : numbers.infinite()) {
    const VoronoiRecord& v = records[record];
    const int i = v.find(infinite);
    const auto [right, left] = sites_of_edge(v, i);
    const std::int32_t across = numbers.of(record_of(v.twins[static_cast<std::size_t>(i)]));
    if (across == VertexNumbers::at_infinity && left < right) edges.push_back({-1, -1, left, right});
  }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    return a.left != b.left ? a.left < b.left : a.right < b.right;
  });
  return edges;
}

// Writes edges from the rings of vertices, and then the rings in the numbers of the input.
class EdgeWriter {
 public:
  EdgeWriter(LargeArray<std::int32_t>& targets, std::span<const std::int32_t> given, DiagramArrays& out)
      : targets_(targets), given_(given), out_(out) {}

  void run(const std::vector<Edge>& without_vertex, unsigned threads, const Monitor& monitor);

 private:
  // An edge is written with the end that has the smaller number: it may be the only one.
  static bool is_written_from(std::size_t vertex, std::int32_t target) {
    return target > static_cast<std::int32_t>(vertex);
  }
  std::size_t start(std::size_t vertex) const { return static_cast<std::size_t>(out_.vertex_start[vertex]); }
  std::size_t count(std::size_t begin, std::size_t end) const;
  void write(std::size_t begin, std::size_t end, std::size_t place);
  void put(std::size_t place, const Edge& edge);

  std::int32_t given(SiteIndex site) const { return given_[static_cast<std::size_t>(site)]; }

  LargeArray<std::int32_t>& targets_;
  std::span<const std::int32_t> given_;
  DiagramArrays& out_;
};

void EdgeWriter::run(const std::vector<Edge>& without_vertex, unsigned threads, const Monitor& monitor) {
  for (std::size_t k = 0; k < without_vertex.size(); ++k) put(k, without_vertex[k]);
  const std::size_t vertices = out_.radius.size();
  std::vector<std::size_t> first(piece_count(vertices, piece_size));
  for_pieces(vertices, threads, monitor, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    first[piece] = count(begin, end);
  });
  std::exclusive_scan(first.begin(), first.end(), first.begin(), without_vertex.size());
  for_pieces(vertices, threads, monitor, [&](std::size_t piece, std::size_t begin, std::size_t end) {
    write(begin, end, first[piece]);
    discard(targets_, start(begin), start(end));
  });
}

std::size_t EdgeWriter::count(std::size_t begin, std::size_t end) const {
  std::size_t edges = 0;
  for (std::size_t vertex = begin; vertex < end; ++vertex) {
    for (std::size_t k = start(vertex); k < start(vertex + 1); ++k)
      edges += is_written_from(vertex, targets_[k]);
  }
  return edges;
}

void EdgeWriter::write(std::size_t begin, std::size_t end, std::size_t place) {
  for (std::size_t vertex = begin; vertex < end; ++vertex) {
    const std::span<std::int32_t> sites(out_.vertex_sites.data() + start(vertex),
                                        start(vertex + 1) - start(vertex));
    SiteIndex right = sites.back();
    for (std::size_t k = 0; k < sites.size(); ++k) {
      const std::int32_t target = targets_[start(vertex) + k];
      if (is_written_from(vertex, target)) {
        put(place++, {static_cast<std::int32_t>(vertex), target == VertexNumbers::at_infinity ? -1 : target,
                      sites[k], right});
      }
      right = sites[k];
    }
    for (std::int32_t& site : sites) site = given(site);
    std::rotate(sites.begin(), std::min_element(sites.begin(), sites.end()), sites.end());
  }
}

void EdgeWriter::put(std::size_t place, const Edge& edge) {
  out_.edges[2 * place] = edge.source;
  out_.edges[2 * place + 1] = edge.target;
  out_.edge_sites[2 * place] = given(edge.left);
  out_.edge_sites[2 * place + 1] = given(edge.right);
}

}  // namespace

DiagramArrays extract_diagram(SegmentSites sites, VoronoiRecords records, std::span<const std::int32_t> given,
                              unsigned threads, const Monitor& monitor) {
  records.corner_of_point = std::vector<Corner>();
  DiagramArrays out;
  LargeArray<std::int32_t> targets;  // [sites around vertices] where the edge before each leads
  std::vector<Edge> without_vertex;
  std::size_t edges = 0;
  {
    VertexNumbers numbers(sites, records, threads, monitor);
    without_vertex = edges_without_vertex(records, numbers, sites.infinite());
    out.vertex_start = numbers.take_starts();
    const std::size_t vertices = out.vertex_start.size() - 1;
    const auto ring = static_cast<std::size_t>(out.vertex_start[vertices]);
    edges = (ring + numbers.infinite().size()) / 2;
    out.vertices = with_small_pages<double>(2 * vertices);
    out.radius = with_small_pages<double>(vertices);
    out.vertex_sites = with_small_pages<std::int32_t>(ring);
    targets = with_small_pages<std::int32_t>(ring);
    return_freed_memory();
    VertexWriter(sites, records, numbers, out, targets).run(threads, monitor);
  }
  records.all = {};
  sites = {};
  out.edges = LargeArray<std::int32_t>(2 * edges);
  out.edge_sites = LargeArray<std::int32_t>(2 * edges);
  EdgeWriter(targets, given, out).run(without_vertex, threads, monitor);
  return out;
}

}  // namespace vorotool::core
