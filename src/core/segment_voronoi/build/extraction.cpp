#include "core/segment_voronoi/build/extraction.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "core/base/memory_release.hpp"
#include "core/base/parallel.hpp"
#include "core/segment_voronoi/build/refined_disc.hpp"
#include "core/segment_voronoi/build/vertex_merging.hpp"
#include "core/segment_voronoi/discs/records.hpp"

namespace vorotool::core::segment_voronoi::build {

using base::for_pieces;
using base::LargeArray;
using base::Monitor;
using base::piece_count;
using base::with_small_pages;
using discs::SegmentSites;
using discs::SiteIndex;
using discs::VoronoiRecord;

namespace {

constexpr std::size_t items_a_piece = std::size_t{1} << 13;  // items of a piece of work, some ms

// Vertices and what is around them.

// Calls on_single(record) and on_merged(k, record) for the records begin ... end - 1 that stand for their
// places.
template <class OnSingle, class OnMerged>
void for_leads(const VoronoiRecords& records, const VertexMerging& numbers, std::size_t begin,
               std::size_t end, OnSingle on_single, OnMerged on_merged) {
  const auto merged = numbers.merged_leads();
  const auto last = static_cast<std::int32_t>(end);
  auto record = static_cast<std::int32_t>(begin);
  auto k = static_cast<std::size_t>(std::ranges::lower_bound(merged, record) - merged.begin());
  for (; record < last; ++record) {
    if (!numbers.is_merged(record)) {
      if (!records[record].is_infinite() && !numbers.is_left_out(record)) on_single(record);
    } else if (k < merged.size() && merged[k] == record) {
      on_merged(k++, record);
    }
  }
}

// The sites of a record of its own, and the corners opposite to the edges before them.
struct SingleRing {
  explicit SingleRing(const VoronoiRecord& v) {
    int i = static_cast<int>(std::min_element(v.sites.begin(), v.sites.end()) - v.sites.begin());
    for (std::size_t k = 0; k < 3; ++k) {
      contacts[k] = {v.sites[static_cast<std::size_t>(i)], v.is_left(i)};
      i = discs::following(i);  // the site is on the left of this edge
      across[k] = discs::record_of(v.twins[static_cast<std::size_t>(i)]);
    }
  }
  std::array<Contact, 3> contacts;
  std::array<std::int32_t, 3> across;  // records to which the edges lead
};

// Gives the records that stand for their places the discs of their vertices.
void refine_discs(const SegmentSites& sites, VoronoiRecords& records, const VertexMerging& numbers,
                  unsigned threads, const Monitor& monitor) {
  const auto refine_piece = [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<Contact> contacts;
    const auto refine = [&](std::int32_t record, std::span<const Contact> around) {
      const RefinedDisc disc = refined_disc(sites, records[record], around);
      records[record].x = disc.x;
      records[record].y = disc.y;
      records[record].radius = disc.radius;
    };
    for_leads(
        records, numbers, begin, end,
        [&](std::int32_t record) { refine(record, SingleRing(records[record]).contacts); },
        [&](std::size_t k, std::int32_t record) {
          contacts.clear();
          for (const VertexMerging::Spoke& spoke : numbers.merged_ring(k)) {
            contacts.push_back({static_cast<SiteIndex>(spoke.site), spoke.is_left != 0});
          }
          refine(record, contacts);
        });
  };
  for_pieces(records.all.size(), items_a_piece, threads, monitor, refine_piece);
}

// Writes the centers, radii and rings of vertices, and where their edges lead. Sites have the numbers of the
// engine.
class VertexWriter {
 public:
  VertexWriter(VoronoiRecords& records, const VertexMerging& numbers, Diagram& out,
               LargeArray<std::int32_t>& targets)
      : records_(records), numbers_(numbers), out_(out), targets_(targets) {}

  void run(unsigned threads, const Monitor& monitor);

 private:
  void write_stretch(std::size_t first, std::size_t count, std::size_t piece, std::size_t pieces);
  void write_disc(std::size_t vertex, const VoronoiRecord& v);

  VoronoiRecords& records_;
  const VertexMerging& numbers_;
  Diagram& out_;
  LargeArray<std::int32_t>& targets_;
};

// Records are read for the last time, those of the points and of the segments of a stretch of the curve
// together: what is written, in the order of the vertices, is near in memory too.
void VertexWriter::run(unsigned threads, const Monitor& monitor) {
  const std::size_t pieces = piece_count(records_.all.size(), items_a_piece);
  base::parallel_for(
      pieces, threads,
      [&](std::size_t piece) {
        write_stretch(0, records_.of_points, piece, pieces);
        write_stretch(records_.of_points, records_.all.size() - records_.of_points, piece, pieces);
      },
      monitor);
}

void VertexWriter::write_stretch(std::size_t first, std::size_t count, std::size_t piece,
                                 std::size_t pieces) {
  const std::size_t begin = first + count * piece / pieces, end = first + count * (piece + 1) / pieces;
  const auto put = [&](std::size_t place, SiteIndex site, std::int32_t across) {
    out_.vertex_sites[place] = site;
    targets_[place] = numbers_.of(across);
  };
  const auto start_of = [&](std::int32_t record) {
    const auto vertex = static_cast<std::size_t>(numbers_.of(record));
    write_disc(vertex, records_[record]);
    return static_cast<std::size_t>(out_.vertex_start[vertex]);
  };
  for_leads(
      records_, numbers_, begin, end,
      [&](std::int32_t record) {
        const std::size_t start = start_of(record);
        const SingleRing ring(records_[record]);
        for (std::size_t i = 0; i < 3; ++i) put(start + i, ring.contacts[i].site, ring.across[i]);
      },
      [&](std::size_t k, std::int32_t record) {
        std::size_t place = start_of(record);
        for (const VertexMerging::Spoke& spoke : numbers_.merged_ring(k)) {
          put(place++, static_cast<SiteIndex>(spoke.site), spoke.across);
        }
      });
  base::discard(records_.all, begin, end);
}

void VertexWriter::write_disc(std::size_t vertex, const VoronoiRecord& v) {
  out_.vertices[2 * vertex] = v.x;
  out_.vertices[2 * vertex + 1] = v.y;
  out_.radius[vertex] = v.radius;
}

// Edges.

struct Edge {
  std::int32_t source, target, left, right;  // sites in the engine's numbers
};

// Edges from infinity to infinity, each once, in the order of the sites on their left.
std::vector<Edge> edges_without_vertex(const VoronoiRecords& records, const VertexMerging& numbers,
                                       SiteIndex infinite) {
  std::vector<Edge> edges;
  for (const std::int32_t record : numbers.infinite()) {
    const VoronoiRecord& v = records[record];
    const int i = v.find(infinite);
    const auto [right, left] = discs::sites_of_edge(v, i);
    const std::int32_t across = numbers.of(discs::record_of(v.twins[static_cast<std::size_t>(i)]));
    if (across == VertexMerging::at_infinity && left < right) edges.push_back({-1, -1, left, right});
  }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    return a.left != b.left ? a.left < b.left : a.right < b.right;
  });
  return edges;
}

// Writes edges from the rings of vertices, and then the rings in the numbers of the input.
class EdgeWriter {
 public:
  EdgeWriter(LargeArray<std::int32_t>& targets, std::span<const std::int32_t> given, Diagram& out)
      : targets_(targets), given_(given), out_(out) {}

  void run(const std::vector<Edge>& without_vertex, unsigned threads, const Monitor& monitor);

 private:
  // An edge is written with the end that has the smaller number: it may be the only one.
  static bool is_written_from(std::size_t vertex, std::int32_t target) {
    return target > static_cast<std::int32_t>(vertex) && target != VertexMerging::left_out;
  }
  std::size_t start(std::size_t vertex) const { return static_cast<std::size_t>(out_.vertex_start[vertex]); }
  std::size_t count(std::size_t begin, std::size_t end) const;
  void write(std::size_t begin, std::size_t end, std::size_t place);
  void put(std::size_t place, const Edge& edge);

  std::int32_t given(SiteIndex site) const { return given_[static_cast<std::size_t>(site)]; }

  LargeArray<std::int32_t>& targets_;
  std::span<const std::int32_t> given_;
  Diagram& out_;
};

void EdgeWriter::run(const std::vector<Edge>& without_vertex, unsigned threads, const Monitor& monitor) {
  const std::size_t vertices = out_.radius.size();
  std::vector<std::size_t> first(piece_count(vertices, items_a_piece));
  for_pieces(
      vertices, items_a_piece, threads, monitor,
      [&](std::size_t piece, std::size_t begin, std::size_t end) { first[piece] = count(begin, end); });
  const std::size_t edges = std::accumulate(first.begin(), first.end(), without_vertex.size());
  std::exclusive_scan(first.begin(), first.end(), first.begin(), without_vertex.size());
  out_.edges = LargeArray<std::int32_t>(2 * edges);
  out_.edge_sites = LargeArray<std::int32_t>(2 * edges);
  for (std::size_t k = 0; k < without_vertex.size(); ++k) put(k, without_vertex[k]);
  const auto write_piece = [&](std::size_t piece, std::size_t begin, std::size_t end) {
    write(begin, end, first[piece]);
    base::discard(targets_, start(begin), start(end));
  };
  for_pieces(vertices, items_a_piece, threads, monitor, write_piece);
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
        put(place++, {static_cast<std::int32_t>(vertex), target == VertexMerging::at_infinity ? -1 : target,
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

Diagram extract_diagram(SegmentSites sites, VoronoiRecords records, std::span<const std::int32_t> given,
                        std::span<const std::uint8_t> unwanted, unsigned threads, const Monitor& monitor) {
  std::vector<std::uint8_t> own_unwanted;  // by the numbers of the engine
  if (!unwanted.empty()) {
    own_unwanted.resize(given.size());
    for (std::size_t i = 0; i < given.size(); ++i)
      own_unwanted[i] = unwanted[static_cast<std::size_t>(given[i])];
  }
  records.corner_of_point = std::vector<discs::Corner>();
  const std::size_t in_use = records.all.size() * sizeof(VoronoiRecord);
  base::return_freed_memory(in_use);
  Diagram out;
  LargeArray<std::int32_t> targets;  // [sites around vertices] where the edge before each leads
  std::vector<Edge> without_vertex;
  {
    const SiteIndex infinite = sites.infinite();
    VertexMerging numbers(sites, records, own_unwanted, threads, monitor);
    refine_discs(sites, records, numbers, threads, monitor);
    sites = SegmentSites();
    numbers.assign(threads, monitor);
    without_vertex = edges_without_vertex(records, numbers, infinite);
    out.vertex_start = numbers.take_starts();
    const std::size_t vertices = out.vertex_start.size() - 1;
    const auto ring = static_cast<std::size_t>(out.vertex_start[vertices]);
    out.vertices = with_small_pages<double>(2 * vertices);
    out.radius = with_small_pages<double>(vertices);
    out.vertex_sites = with_small_pages<std::int32_t>(ring);
    targets = with_small_pages<std::int32_t>(ring);
    base::return_freed_memory(in_use);
    VertexWriter(records, numbers, out, targets).run(threads, monitor);
  }
  records.all = {};
  EdgeWriter(targets, given, out).run(without_vertex, threads, monitor);
  return out;
}

}  // namespace vorotool::core::segment_voronoi::build
