#include "core/point_voronoi.hpp"

#include <algorithm>
#include <vector>

#include "core/parallel.hpp"

namespace vorotool::core {
namespace {

constexpr std::size_t piece_size = std::size_t{1} << 14;  // records of a piece, some ms of work

class Dual {
 public:
  Dual(const SegmentSites& sites, const HalfEdges& edges, VoronoiRecords& records)
      : sites_(sites), edges_(edges), records_(records), corner_(static_cast<std::size_t>(edges.size())) {}

  void run(HalfEdge hull, unsigned threads, const Monitor& monitor) {
    number_outer_faces(hull);
    number_triangles();
    const auto size = static_cast<std::size_t>(records_.size);
    parallel_for(
        piece_count(size, piece_size), threads,
        [&](std::size_t piece) {
          for (std::size_t v = piece * piece_size; v < std::min(size, (piece + 1) * piece_size); ++v) {
            compute_disc(sites_, records_.all[v]);
          }
        },
        monitor);
  }

 private:
  void number_outer_faces(HalfEdge hull);
  void number_triangles();
  void link(HalfEdge e);
  void start(const std::array<SiteIndex, 3>& sites);

  Corner& corner(HalfEdge e) { return corner_[static_cast<std::size_t>(e)]; }

  const SegmentSites& sites_;
  const HalfEdges& edges_;
  VoronoiRecords& records_;
  std::vector<Corner>
      corner_;  // [half-edges] 1 + the corner opposite to it in the face on its left; 0: none yet
};

void Dual::start(const std::array<SiteIndex, 3>& sites) {
  VoronoiRecord& v = records_[records_.size];
  v.sites = sites;
  v.stamp = 0;
  v.left = 0;
  v.survives = 0;
  v.owner = 0;
  for (int i = 0; i < 3; ++i) {
    const SiteIndex site = sites[static_cast<std::size_t>(i)];
    if (sites_.is_point(site)) {
      records_.corner_of_point[static_cast<std::size_t>(site)] = corner_of(records_.size, i);
    }
  }
  ++records_.size;
}

// The unbounded face, gone round with the face on the left, has a vertex at infinity for each half-edge.
void Dual::number_outer_faces(HalfEdge hull) {
  const HalfEdge first = HalfEdges::twin(hull);
  HalfEdge e = first;
  do {
    start({edges_.origin(e), edges_.target(e), sites_.infinite()});
    corner(e) = 1 + corner_of(records_.size - 1, 2);
    e = edges_.next_left(e);
  } while (e != first);
  const std::int32_t count = records_.size;
  for (std::int32_t v = 0; v < count; ++v) {
    const std::int32_t next = v + 1 == count ? 0 : v + 1;
    records_[v].twins[0] = corner_of(next, 1);
    records_[next].twins[1] = corner_of(v, 0);
  }
}

void Dual::number_triangles() {
  for (HalfEdge e = 0; e < edges_.size(); ++e) {
    if (!edges_.exists(e) || corner(e) != 0) continue;
    const HalfEdge f = edges_.next_left(e), g = edges_.next_left(f);
    start({edges_.origin(e), edges_.origin(f), edges_.origin(g)});
    corner(e) = 1 + corner_of(records_.size - 1, 2);
    corner(f) = 1 + corner_of(records_.size - 1, 0);
    corner(g) = 1 + corner_of(records_.size - 1, 1);
  }
  for (HalfEdge e = 0; e < edges_.size(); ++e) {
    if (edges_.exists(e)) link(e);
  }
}

void Dual::link(HalfEdge e) {
  const Corner here = corner(e) - 1;
  records_[record_of(here)].twins[static_cast<std::size_t>(place_of(here))] = corner(HalfEdges::twin(e)) - 1;
}

}  // namespace

VoronoiRecords point_voronoi(const SegmentSites& sites, const HalfEdges& edges, HalfEdge hull,
                             std::size_t room, unsigned threads, const Monitor& monitor) {
  VoronoiRecords records(room, sites.point_count());
  if (hull != no_edge) Dual(sites, edges, records).run(hull, threads, monitor);
  return records;
}

}  // namespace vorotool::core
