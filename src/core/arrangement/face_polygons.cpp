#include "core/arrangement/face_polygons.hpp"

#include <algorithm>

#include "core/base/groups.hpp"

namespace vorotool::core::arrangement {
namespace {

constexpr std::size_t most_entries = std::size_t{1} << 26;  // 256 MB, and as much again at the end
constexpr std::size_t faces_between_polls = 4096;

// A place in the plane, as the rings have it.
class Position {
 public:
  Position(const Rings& rings, std::size_t polygons)
      : rings_(rings), in_ring_(rings.kind.size()), in_shell_(polygons), holes_(polygons) {}

  const std::vector<std::int32_t>& polygons() const { return polygons_; }

  void cross(std::int32_t ring) {
    const RingKind kind = rings_.kind_of(ring);
    if (kind == RingKind::line) return;
    const auto r = static_cast<std::size_t>(ring);
    const std::int32_t polygon = rings_.polygon[r];
    const bool before = is_in(polygon);
    in_ring_[r] ^= 1;
    if (kind == RingKind::shell) {
      in_shell_[static_cast<std::size_t>(polygon)] ^= 1;
    } else {
      holes_[static_cast<std::size_t>(polygon)] += in_ring_[r] != 0 ? 1 : -1;
    }
    if (is_in(polygon) == before) return;
    const auto at = std::lower_bound(polygons_.begin(), polygons_.end(), polygon);
    if (before) {
      polygons_.erase(at);
    } else {
      polygons_.insert(at, polygon);
    }
  }

 private:
  bool is_in(std::int32_t polygon) const {
    const auto p = static_cast<std::size_t>(polygon);
    return in_shell_[p] != 0 && holes_[p] == 0;
  }

  const Rings& rings_;
  std::vector<std::uint8_t> in_ring_, in_shell_;
  std::vector<std::int32_t> holes_;     // of each polygon, how many of its holes this is in
  std::vector<std::int32_t> polygons_;  // that this is in, ascending
};

// Walks over the faces, from the unbounded one, by a tree of segments; each face is reached once.
class Walk {
 public:
  Walk(const SegmentSet& set, const Faces& faces, std::span<const std::int32_t> ring_of_edge)
      : set_(set),
        faces_(faces),
        ring_of_edge_(ring_of_edge),
        border_(static_cast<std::size_t>(faces.count),
                [&](const auto& add) {
                  for (std::size_t s = 0; s < set.size(); ++s) {
                    for (const std::int32_t face : {faces.left[s], faces.right[s]})
                      add(face, static_cast<std::int32_t>(s));
                  }
                }),
        next_(border_.size()) {}

  // Calls arrive(face) with `position` as it is there.
  template <class Arrive>
  void run(Position& position, Arrive arrive) {
    std::vector<std::uint8_t> reached(static_cast<std::size_t>(faces_.count), 0);
    struct Step {
      std::int32_t face, segment;
    };
    std::vector<Step> way{{0, -1}};
    reached[0] = 1;
    arrive(0);
    while (!way.empty()) {
      const auto [face, came_over] = way.back();
      const auto f = static_cast<std::size_t>(face);
      if (next_[f] == border_[f].size()) {
        if (came_over >= 0) cross(position, came_over);
        way.pop_back();
        continue;
      }
      const std::int32_t segment = border_[f][next_[f]++];
      const auto s = static_cast<std::size_t>(segment);
      const std::int32_t other = faces_.left[s] == face ? faces_.right[s] : faces_.left[s];
      if (reached[static_cast<std::size_t>(other)] != 0) continue;
      reached[static_cast<std::size_t>(other)] = 1;
      cross(position, segment);
      arrive(other);
      way.push_back({other, segment});
    }
  }

 private:
  void cross(Position& position, std::int32_t segment) const {
    for (const std::int32_t edge : set_.sources_of(static_cast<std::size_t>(segment))) {
      position.cross(ring_of_edge_[static_cast<std::size_t>(edge)]);
    }
  }

  const SegmentSet& set_;
  const Faces& faces_;
  std::span<const std::int32_t> ring_of_edge_;
  base::Groups<std::int32_t> border_;  // segments of each face
  std::vector<std::size_t> next_;      // of these
};

}  // namespace

FacePolygons find_face_polygons(const SegmentSet& set, const Faces& faces, const Rings& rings,
                                std::span<const std::int32_t> ring_of_edge, const base::Monitor& monitor) {
  const std::size_t polygons = rings.polygon.empty() ? 0 : static_cast<std::size_t>(rings.polygon.back()) + 1;
  const auto count = static_cast<std::size_t>(faces.count);
  Position position(rings, polygons);
  std::vector<std::int32_t> place(count), length(count), found;  // of the faces as they are reached
  std::size_t reached = 0;
  Walk(set, faces, ring_of_edge).run(position, [&](std::int32_t face) {
    if (found.size() + position.polygons().size() > most_entries) throw TooManyOverlaps();
    place[static_cast<std::size_t>(face)] = static_cast<std::int32_t>(found.size());
    length[static_cast<std::size_t>(face)] = static_cast<std::int32_t>(position.polygons().size());
    found.insert(found.end(), position.polygons().begin(), position.polygons().end());
    ++reached;
    if (reached % faces_between_polls == 0)
      base::report(monitor, static_cast<double>(reached) / static_cast<double>(count));
  });
  FacePolygons result;
  result.start.push_back(0);
  for (std::size_t f = 0; f < count; ++f) {
    const auto begin = found.begin() + place[f];
    result.polygon.insert(result.polygon.end(), begin, begin + length[f]);
    result.start.push_back(static_cast<std::int32_t>(result.polygon.size()));
  }
  return result;
}

}  // namespace vorotool::core::arrangement
