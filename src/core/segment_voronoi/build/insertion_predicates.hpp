// The decisions of the insertion of a segment: which Voronoi vertices it takes, and which edges between such
// vertices keep a middle part. Every sign is the exact one.
//
// All points are in the diagram before any segment. So a disc of the diagram holds neither end of a new
// segment (p, q) inside, and the segment enters it only where it is nearer to the center than the radius at a
// foot strictly between p and q. Touching is no conflict.
#pragma once

#include <cstdint>

#include "core/segment_voronoi/discs/records.hpp"
#include "core/segment_voronoi/discs/sites.hpp"
#include "core/segment_voronoi/discs/tangent_disc.hpp"

namespace vorotool::core::segment_voronoi::build {

// How many decisions needed more than a filter in floating point.
struct EscalationCounts {
  std::int64_t integer = 0;        // settled by a few integers
  std::int64_t double_double = 0;  // settled by numbers of 106 bits
  std::int64_t exact = 0;          // settled by multiprecision

  EscalationCounts& operator+=(const EscalationCounts& other) {
    integer += other.integer;
    double_double += other.double_double;
    exact += other.exact;
    return *this;
  }
};

// A segment that is inserted, or tested.
struct SegmentQuery {
  SegmentQuery(const discs::SegmentSites& sites, discs::SiteIndex segment)
      : site(segment), segment(sites.segment(segment)), p(this->segment.ends[0]), q(this->segment.ends[1]) {}

  discs::SiteIndex site;
  const discs::SegmentSite& segment;
  discs::SiteIndex p, q;  // its ends
};

class InsertionPredicates {
 public:
  explicit InsertionPredicates(const discs::SegmentSites& sites) : sites_(sites) {}

  // Whether the open segment enters the open disc of a vertex. At infinity: whether it is an edge of the
  // hull.
  bool in_conflict(const discs::VoronoiRecord& vertex, const SegmentQuery& query) {
    return sign(vertex, query) < 0;
  }

  // The sign of the distance of the open segment from the vertex less its radius, where that is negative;
  // 0 if the closed segment touches the disc, else positive.
  int sign(const discs::VoronoiRecord& vertex, const SegmentQuery& query);

  // Whether edge i of vertex u, whose ends u and w are both in conflict, has points that are not.
  bool survives(const discs::VoronoiRecord& u, int i, const discs::VoronoiRecord& w,
                const SegmentQuery& query);

  const EscalationCounts& counts() const { return counts_; }

 private:
  int corner_sign(const discs::VoronoiRecord& vertex, int i, const SegmentQuery& query) const;
  int end_sign(const discs::VoronoiRecord& vertex, int i, const SegmentQuery& query);
  int sign_in_double_double(const discs::VoronoiRecord& vertex, const SegmentQuery& query) const;
  bool is_touched_as_fourth(const discs::VoronoiRecord& vertex, const SegmentQuery& query) const;
  int sign_beyond_filter(const discs::VoronoiRecord& vertex, const SegmentQuery& query);

  // An edge between a point and another site; seen from the point it turns counter-clockwise.
  struct Arc {
    const discs::VoronoiRecord &from, &to;
    discs::SiteIndex point, other;
  };
  bool has_shadow_on(const discs::VoronoiRecord& u, int i, const discs::VoronoiRecord& w, bool of_left,
                     const SegmentQuery& query);
  int shadow_on_line(const Arc& arc, const SegmentQuery& query) const;
  int shadow_on_parabola(const Arc& arc, const SegmentQuery& query) const;
  int end_shadow_on_parabola(const Arc& arc, const SegmentQuery& query) const;

  const discs::SegmentSites& sites_;
  EscalationCounts counts_;
};

}  // namespace vorotool::core::segment_voronoi::build
