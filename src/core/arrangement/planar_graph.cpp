#include "core/arrangement/planar_graph.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/arrangement/faces.hpp"
#include "core/arrangement/rectilinear_intersections.hpp"
#include "core/arrangement/segment_intersections.hpp"
#include "core/arrangement/segment_set.hpp"
#include "core/arrangement/snap_rounding.hpp"
#include "core/base/disjoint_sets.hpp"
#include "core/base/groups.hpp"

namespace vorotool::core::arrangement {

using base::Monitor;
using kernel::LatticePoint;

namespace {

// A part of the whole, for the monitor.
Monitor part_of(const Monitor& monitor, double begin, double end) {
  if (!monitor) return {};
  return [&monitor, begin, end](double done) { return monitor(begin + done * (end - begin)); };
}

class Maker {
 public:
  Maker(std::span<const LatticePoint> vertices, const Rings& rings, const Monitor& monitor)
      : vertices_(vertices), rings_(rings), monitor_(monitor) {}

  PlanarGraph make() {
    if (!rings_.polygon.empty()) {
      graph_.is_repaired.assign(static_cast<std::size_t>(rings_.polygon.back()) + 1, 0);
    }
    arrange();
    const Faces faces = find_faces(set_.view(), below_);
    const FacePolygons inside =
        find_face_polygons(set_, faces, rings_, ring_of_edge_, part_of(monitor_, 0.8, 1));
    keep_borders(faces, inside);
    find_point_holes(faces, inside);
    number_points();
    number_segments();
    number_faces(faces, inside);
    report_empty_polygons();
    return std::move(graph_);
  }

 private:
  // A segment that stays: its first edge, and whether that runs from the upper to the lower end.
  struct Border {
    std::int32_t segment, edge;
    bool is_back;
  };

  void count_repair(Repair kind, std::int32_t edge, std::int32_t other) {
    RepairCount& repair = graph_.repairs[static_cast<std::size_t>(kind)];
    ++repair.count;
    const auto ring = static_cast<std::size_t>(ring_of_edge_[static_cast<std::size_t>(edge)]);
    graph_.is_repaired[static_cast<std::size_t>(rings_.polygon[ring])] = 1;
    if (repair.edge < 0 || edge < repair.edge || (edge == repair.edge && other < repair.other)) {
      repair.edge = edge;
      repair.other = other;
    }
  }

  // Segments that meet at common ends only.

  void arrange() {
    SortedPoints sorted = sort_points(vertices_, monitor_);
    find_flat_holes(sorted.rank);
    std::vector<Link> links = edges(sorted.rank);
    vertex_of_point_ = std::move(sorted.first);
    rank_ = std::move(sorted.rank);
    set_ = join_links(std::move(sorted.points), std::move(links));
    if (auto below = sweep_rectilinear(set_.view(), monitor_)) {
      below_ = std::move(*below);
      return;
    }
    SweepResult swept = sweep_segments(set_.view(), part_of(monitor_, 0, 0.5));
    if (!swept.meetings.empty()) {
      report_meetings(swept);
      snap(swept);
      swept = sweep_segments(set_.view(), part_of(monitor_, 0.6, 0.8));
      if (!swept.meetings.empty()) throw std::logic_error("snapped segments still meet: a defect");
    }
    below_ = std::move(swept.below);
  }

  // Holes whose vertices are at one or two places: points and segments that their polygons go around.
  void find_flat_holes(const std::vector<std::int32_t>& rank) {
    is_flat_hole_.assign(rings_.kind.size(), 0);
    for (std::size_t ring = 0; ring < rings_.kind.size(); ++ring) {
      if (rings_.kind_of(static_cast<std::int32_t>(ring)) != RingKind::hole) continue;
      const std::span<const std::int32_t> places(
          rank.begin() + static_cast<std::ptrdiff_t>(rings_.start[ring]),
          rank.begin() + static_cast<std::ptrdiff_t>(rings_.start[ring + 1]));
      const std::int32_t first = places.front();
      const auto other = std::ranges::find_if(places, [&](std::int32_t place) { return place != first; });
      const std::int32_t second = other == places.end() ? first : *other;
      is_flat_hole_[ring] =
          std::ranges::all_of(places, [&](std::int32_t place) { return place == first || place == second; });
    }
  }

  // The edges of all rings but those without length, between sorted points.
  std::vector<Link> edges(const std::vector<std::int32_t>& rank) {
    std::vector<Link> links;
    links.reserve(vertices_.size());
    ring_of_edge_.resize(vertices_.size());
    for (std::size_t ring = 0; ring < rings_.kind.size(); ++ring) {
      const auto begin = static_cast<std::size_t>(rings_.start[ring]);
      const auto end = static_cast<std::size_t>(rings_.start[ring + 1]);
      const bool is_line = rings_.kind_of(static_cast<std::int32_t>(ring)) == RingKind::line;
      for (std::size_t k = begin; k < end; ++k) {
        ring_of_edge_[k] = static_cast<std::int32_t>(ring);
        if (k + 1 == end && (is_line || begin + 1 == end)) break;  // a line ends; a single vertex has no edge
        const std::int32_t a = rank[k], b = rank[k + 1 == end ? begin : k + 1];
        const auto edge = static_cast<std::int32_t>(k);
        if (a == b) {
          count_repair(Repair::repeated_vertex, edge, -1);
        } else {
          links.push_back({std::min(a, b), std::max(a, b), edge});
        }
      }
    }
    return links;
  }

  // Meetings come place by place.
  void report_meetings(const SweepResult& swept) {
    const auto points = static_cast<std::int32_t>(set_.points.size());
    for (std::size_t i = 0; i < swept.meetings.size();) {
      const std::int32_t place = swept.meetings[i].place;
      std::int32_t first = -1, second = -1;  // the smallest edges that meet here
      std::size_t end = i;
      for (; end < swept.meetings.size() && swept.meetings[end].place == place; ++end) {
        const std::int32_t edge = first_source(swept.meetings[end].segment);
        if (place < points) {
          count_repair(Repair::touching_vertex, edge, vertex_of_point_[static_cast<std::size_t>(place)]);
        } else if (first < 0 || edge < first) {
          second = std::exchange(first, edge);
        } else if (second < 0 || edge < second) {
          second = edge;
        }
      }
      if (place >= points) count_repair(Repair::crossing, first, second);
      i = end;
    }
  }

  std::int32_t first_source(std::int32_t segment) const {
    return set_.sources_of(static_cast<std::size_t>(segment)).front();
  }

  // Replaces the segments by the pieces of their chains, and the points by the nodes.
  void snap(const SweepResult& swept) {
    const SnappedSegments snapped = snap_segments(set_.view(), swept, part_of(monitor_, 0.5, 0.6));
    for (std::size_t s = 0; s < set_.size(); ++s) {
      if (snapped.is_loose[s] == 0) continue;
      for (const std::int32_t edge : set_.sources_of(s)) count_repair(Repair::moved_edge, edge, -1);
    }
    std::vector<std::int32_t> rank = merge_points(snapped.new_points);
    std::vector<Link> links;
    for (std::size_t s = 0; s < set_.size(); ++s) {
      for (std::int32_t k = snapped.chain_start[s] + 1; k < snapped.chain_start[s + 1]; ++k) {
        const std::int32_t a = rank[static_cast<std::size_t>(snapped.chain[static_cast<std::size_t>(k - 1)])];
        const std::int32_t b = rank[static_cast<std::size_t>(snapped.chain[static_cast<std::size_t>(k)])];
        for (const std::int32_t edge : set_.sources_of(s)) {
          if (links.size() == INT32_MAX) throw TooManyCrossings();
          links.push_back({std::min(a, b), std::max(a, b), edge});
        }
      }
    }
    for (std::int32_t& each : rank_) each = rank[static_cast<std::size_t>(each)];
    set_ = join_links(std::move(set_.points), std::move(links));
  }

  // Adds new points to the sorted ones; returns the place of each of both afterwards.
  std::vector<std::int32_t> merge_points(const std::vector<LatticePoint>& fresh) {
    const std::size_t old = set_.points.size();
    std::vector<std::int32_t> rank(old + fresh.size()), vertex(old + fresh.size());
    std::vector<LatticePoint> merged;
    merged.reserve(rank.size());
    for (std::size_t i = 0, j = 0; i < old || j < fresh.size();) {
      const bool takes_old = j == fresh.size() || (i < old && lexicographic_less(set_.points[i], fresh[j]));
      const auto place = static_cast<std::int32_t>(merged.size());
      rank[takes_old ? i : old + j] = place;
      vertex[static_cast<std::size_t>(place)] = takes_old ? vertex_of_point_[i] : -1;
      merged.push_back(takes_old ? set_.points[i++] : fresh[j++]);
    }
    set_.points = std::move(merged);
    vertex_of_point_ = std::move(vertex);
    return rank;
  }

  // Segments that bound something.

  bool is_of_line(std::size_t segment) const {
    const auto edges = set_.sources_of(segment);
    return std::any_of(edges.begin(), edges.end(), [this](std::int32_t edge) {
      return rings_.kind_of(ring_of_edge_[static_cast<std::size_t>(edge)]) == RingKind::line;
    });
  }

  // Whether a segment is of a hole without area, and lies in the polygon.
  bool is_of_flat_hole(std::size_t segment, std::span<const std::int32_t> polygons) const {
    const auto edges = set_.sources_of(segment);
    return std::any_of(edges.begin(), edges.end(), [&](std::int32_t edge) {
      const auto ring = static_cast<std::size_t>(ring_of_edge_[static_cast<std::size_t>(edge)]);
      return is_flat_hole_[ring] != 0 &&
             std::binary_search(polygons.begin(), polygons.end(), rings_.polygon[ring]);
    });
  }

  void keep_borders(const Faces& faces, const FacePolygons& inside) {
    borders_.reserve(set_.size());
    for (std::size_t s = 0; s < set_.size(); ++s) {
      const auto segment = static_cast<std::int32_t>(s);
      const auto left = inside.of(faces.left[s]), right = inside.of(faces.right[s]);
      if (is_of_line(s) || !std::equal(left.begin(), left.end(), right.begin(), right.end()) ||
          is_of_flat_hole(s, left)) {
        borders_.push_back({segment, first_source(segment), false});
      } else {
        count_repair(Repair::idle_segment, first_source(segment), -1);
      }
    }
  }

  struct PointHole {
    std::int32_t point, face, polygon;
  };

  // The face of a point: above the segment next below it, or beside a segment there.
  std::vector<std::int32_t> faces_of_points(const Faces& faces) const {
    std::vector<std::int32_t> face(set_.points.size());
    for (std::size_t i = 0; i < face.size(); ++i) {
      face[i] = below_[i] < 0 ? 0 : faces.left[static_cast<std::size_t>(below_[i])];
    }
    for (std::size_t s = 0; s < set_.size(); ++s) {
      face[static_cast<std::size_t>(set_.lower_end[s])] = faces.left[s];
      face[static_cast<std::size_t>(set_.upper_end[s])] = faces.left[s];
    }
    return face;
  }

  // The ends of a border are sites already.
  void find_point_holes(const Faces& faces, const FacePolygons& inside) {
    if (std::ranges::find(is_flat_hole_, 1) == is_flat_hole_.end()) return;
    std::vector<std::uint8_t> is_known(set_.points.size(), 0);
    for (const Border& border : borders_) {
      is_known[static_cast<std::size_t>(source_of(border))] = 1;
      is_known[static_cast<std::size_t>(target_of(border))] = 1;
    }
    const std::vector<std::int32_t> face_of = faces_of_points(faces);
    for (std::size_t ring = 0; ring < rings_.kind.size(); ++ring) {
      if (is_flat_hole_[ring] == 0) continue;
      const auto begin = static_cast<std::size_t>(rings_.start[ring]);
      const auto end = static_cast<std::size_t>(rings_.start[ring + 1]);
      const std::int32_t point = rank_[begin];
      if (std::any_of(rank_.begin() + static_cast<std::ptrdiff_t>(begin),
                      rank_.begin() + static_cast<std::ptrdiff_t>(end),
                      [&](std::int32_t other) { return other != point; })) {
        continue;
      }
      const std::int32_t face = face_of[static_cast<std::size_t>(point)];
      const auto polygons = inside.of(face);
      if (is_known[static_cast<std::size_t>(point)] != 0) continue;
      if (std::binary_search(polygons.begin(), polygons.end(), rings_.polygon[ring])) {
        point_holes_.push_back({point, face, rings_.polygon[ring]});
      } else {
        count_repair(Repair::idle_segment, static_cast<std::int32_t>(begin), -1);
      }
    }
  }

  // Numbers that depend on the input alone.

  void number_points() {
    std::vector<std::uint8_t> is_used(set_.points.size(), 0);
    for (const Border& border : borders_) {
      is_used[static_cast<std::size_t>(source_of(border))] = 1;
      is_used[static_cast<std::size_t>(target_of(border))] = 1;
    }
    for (std::size_t ring = 0; ring < rings_.kind.size(); ++ring) {  // lines without length stay as points
      if (rings_.kind_of(static_cast<std::int32_t>(ring)) != RingKind::line) continue;
      is_used[static_cast<std::size_t>(rank_[static_cast<std::size_t>(rings_.start[ring])])] = 1;
    }
    for (const PointHole& hole : point_holes_) is_used[static_cast<std::size_t>(hole.point)] = 1;
    number_.assign(set_.points.size(), -1);
    graph_.points.reserve(set_.points.size());
    graph_.point_vertex.reserve(set_.points.size());
    const auto add = [&](std::size_t point, std::int32_t vertex) {
      number_[point] = static_cast<std::int32_t>(graph_.points.size());
      graph_.points.push_back(set_.points[point]);
      graph_.point_vertex.push_back(vertex);
    };
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      const auto point = static_cast<std::size_t>(rank_[v]);
      if (is_used[point] != 0 && number_[point] < 0) add(point, static_cast<std::int32_t>(v));
    }
    for (std::size_t point = 0; point < set_.points.size(); ++point) {
      if (is_used[point] != 0 && number_[point] < 0) add(point, -1);
    }
  }

  // The vector along an edge.
  std::pair<std::int64_t, std::int64_t> vector_of(std::int32_t edge) const {
    const auto k = static_cast<std::size_t>(edge);
    const auto ring = static_cast<std::size_t>(ring_of_edge_[k]);
    const auto next =
        edge + 1 == rings_.start[ring + 1] ? static_cast<std::size_t>(rings_.start[ring]) : k + 1;
    return {std::int64_t{vertices_[next].x} - vertices_[k].x,
            std::int64_t{vertices_[next].y} - vertices_[k].y};
  }

  // Directs the borders as their first edges run, and sorts them along the edges. Both coordinates are
  // monotone along the pieces of an edge.
  void direct_borders() {
    for (Border& border : borders_) {
      const auto [dx, dy] = vector_of(border.edge);
      const LatticeSegment piece = set_.view().segment(border.segment);
      border.is_back =
          dx * (std::int64_t{piece.b.x} - piece.a.x) + dy * (std::int64_t{piece.b.y} - piece.a.y) < 0;
    }
    base::Groups<Border> by_edge(vertices_.size(), [&](const auto& add) {
      for (const Border& border : borders_) add(border.edge, border);
    });
    for (std::size_t edge = 0; edge < by_edge.size(); ++edge) sort_along_edge(by_edge[edge]);
    borders_ = by_edge.take();
  }

  void sort_along_edge(std::span<Border> borders) const {
    std::sort(borders.begin(), borders.end(), [this](const Border& s, const Border& t) {
      const LatticePoint a = set_.points[static_cast<std::size_t>(source_of(s))];
      const LatticePoint b = set_.points[static_cast<std::size_t>(source_of(t))];
      const auto [dx, dy] = vector_of(s.edge);
      if (a.x != b.x) return (a.x < b.x) == (dx > 0);
      return a.y != b.y && (a.y < b.y) == (dy > 0);
    });
  }

  std::int32_t source_of(const Border& border) const {
    const auto i = static_cast<std::size_t>(border.segment);
    return border.is_back ? set_.upper_end[i] : set_.lower_end[i];
  }

  std::int32_t target_of(const Border& border) const {
    const auto i = static_cast<std::size_t>(border.segment);
    return border.is_back ? set_.lower_end[i] : set_.upper_end[i];
  }

  void number_segments() {
    direct_borders();
    graph_.segments.reserve(borders_.size());
    graph_.source_start.reserve(borders_.size() + 1);
    graph_.source_edge.reserve(set_.source.size());
    graph_.source_start.push_back(0);
    for (const Border& border : borders_) {
      graph_.segments.push_back({number_[base::at(source_of(border))], number_[base::at(target_of(border))]});
      const auto edges = set_.sources_of(static_cast<std::size_t>(border.segment));
      graph_.source_edge.insert(graph_.source_edge.end(), edges.begin(), edges.end());
      graph_.source_start.push_back(static_cast<std::int32_t>(graph_.source_edge.size()));
    }
  }

  // Faces that only idle segments divide are one.
  void number_faces(const Faces& faces, const FacePolygons& inside) {
    std::vector<std::uint8_t> is_kept(set_.size(), 0);
    for (const Border& border : borders_) is_kept[static_cast<std::size_t>(border.segment)] = 1;
    base::DisjointSets<std::int32_t> joined(static_cast<std::size_t>(faces.count));
    for (std::size_t s = 0; s < set_.size(); ++s) {
      if (is_kept[s] == 0) joined.join(faces.left[s], faces.right[s]);
    }
    std::vector<std::int32_t> number(static_cast<std::size_t>(faces.count), -1);
    FacePolygons& lists = graph_.face_polygons;
    lists.start.push_back(0);
    const auto numbered = [&](std::int32_t face) {
      const std::int32_t root = joined.find(face);
      std::int32_t& known = number[static_cast<std::size_t>(root)];
      if (known < 0) {
        known = static_cast<std::int32_t>(lists.start.size()) - 1;
        const auto polygons = inside.of(root);
        lists.polygon.insert(lists.polygon.end(), polygons.begin(), polygons.end());
        lists.start.push_back(static_cast<std::int32_t>(lists.polygon.size()));
      }
      return known;
    };
    numbered(0);
    graph_.segment_faces.reserve(borders_.size());
    for (const Border& border : borders_) {
      const auto i = static_cast<std::size_t>(border.segment);
      const std::int32_t left = numbered(border.is_back ? faces.right[i] : faces.left[i]);
      graph_.segment_faces.push_back({left, numbered(border.is_back ? faces.left[i] : faces.right[i])});
    }
    for (const PointHole& hole : point_holes_) {
      graph_.point_holes.push_back(number_[static_cast<std::size_t>(hole.point)]);
      graph_.point_holes.push_back(numbered(hole.face));
      graph_.point_holes.push_back(hole.polygon);
    }
  }

  void report_empty_polygons() {
    std::vector<std::uint8_t> has_inside(
        rings_.polygon.empty() ? 0 : static_cast<std::size_t>(rings_.polygon.back()) + 1, 0);
    for (const std::int32_t polygon : graph_.face_polygons.polygon) {
      has_inside[static_cast<std::size_t>(polygon)] = 1;
    }
    for (std::size_t ring = 0; ring < rings_.kind.size(); ++ring) {
      if (rings_.kind_of(static_cast<std::int32_t>(ring)) != RingKind::shell) continue;
      if (has_inside[static_cast<std::size_t>(rings_.polygon[ring])] != 0) continue;
      count_repair(Repair::empty_polygon, static_cast<std::int32_t>(rings_.start[ring]), -1);
    }
  }

  std::span<const LatticePoint> vertices_;
  const Rings& rings_;
  const Monitor& monitor_;
  SegmentSet set_;
  std::vector<std::int32_t> ring_of_edge_;
  std::vector<std::int32_t> rank_;             // the point of each vertex
  std::vector<std::int32_t> vertex_of_point_;  // the first vertex at each point, or -1
  std::vector<std::int32_t> below_;
  std::vector<std::uint8_t> is_flat_hole_;  // [rings]
  std::vector<Border> borders_;
  std::vector<PointHole> point_holes_;  // in the order of the rings
  std::vector<std::int32_t> number_;    // of each point in the graph, or -1
  PlanarGraph graph_;
};

}  // namespace

PlanarGraph make_planar_graph(std::span<const LatticePoint> vertices, const Rings& rings,
                              const Monitor& monitor) {
  return Maker(vertices, rings, monitor).make();
}

}  // namespace vorotool::core::arrangement
