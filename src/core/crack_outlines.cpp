#include "core/crack_outlines.hpp"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <tuple>

#include "core/corner_scan.hpp"
#include "core/label_runs.hpp"
#include "core/parallel.hpp"

namespace vorotool::core {
namespace {

constexpr std::size_t kSteps = std::size_t{1} << 16;  // of work between two polls: a millisecond or so

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

// Directions along cracks, clockwise as an image is shown. Quadrant d of a corner is the pixel on the right
// hand of who leaves it in direction d, and quadrant d - 1 the one on the left hand.
enum Direction : int { kEast, kSouth, kWest, kNorth };

constexpr int turned(int direction, int quarters) { return (direction + quarters) & 3; }

// Which labels are around a corner, and which cracks end there.
class Quadrants {
 public:
  explicit Quadrants(const Corner& c) : label_{c.lower_right, c.lower_left, c.upper_left, c.upper_right} {}

  std::uint32_t operator[](int quadrant) const { return label_[static_cast<std::size_t>(quadrant & 3)]; }
  bool has_crack(int direction) const { return (*this)[direction] != (*this)[direction + 3]; }
  bool is_vertex() const {
    return (has_crack(kNorth) || has_crack(kSouth)) && (has_crack(kWest) || has_crack(kEast));
  }

  // How an outline goes on that comes in a direction, its object on the right hand.
  int next_direction(int came, CornerRule rule) const {
    const std::uint32_t object = (*this)[came + 1], ahead = (*this)[came], beyond = (*this)[came + 3];
    if (ahead == object) return beyond == object ? turned(came, 3) : came;
    return beyond == object && goes_through(object, ahead, rule) ? turned(came, 3) : turned(came, 1);
  }

 private:
  // Two pixels of the object meet at this corner only, `other` is one of those between.
  bool goes_through(std::uint32_t object, std::uint32_t other, CornerRule rule) const {
    if (rule != CornerRule::yielding) return rule == CornerRule::joined;
    const bool is_crossing = label_[0] == label_[2] && label_[1] == label_[3];
    return !is_crossing || other == 0 || object < other;
  }

  std::array<std::uint32_t, 4> label_;
};

// Calls visit(x, y, quadrants) for the corners of lines [first, last) between rows where a crack goes up or
// down, line by line; outside the image is label 0. Line y is above row y.
template <class Label, class Visit>
void scan_corners(std::span<const Label> image, std::size_t width, std::size_t first, std::size_t last,
                  Visit visit) {
  const std::size_t height = image.size() / width;
  const std::vector<Label> outside(width, 0);
  RowPair rows(width);
  for (std::size_t y = first; y < last; ++y) {
    const auto row = [&](bool is_inside, std::size_t number) {
      return is_inside ? image.subspan(number * width, width) : std::span<const Label>(outside);
    };
    const std::span<const Label> above = row(y > 0, y - 1), below = row(y < height, y);
    visit(0, y, Quadrants({0, above.front(), below.front(), 0}));
    rows.walk(
        above, below, [](std::uint32_t, std::uint32_t) {},
        [&](std::size_t x, const Corner& corner) { visit(x, y, Quadrants(corner)); });
    visit(width, y, Quadrants({above.back(), 0, 0, below.back()}));
  }
}

struct CrackVertex {
  std::int32_t x, y;
  std::array<std::int32_t, 4> next{-1, -1, -1, -1};  // the vertices at the other ends of cracks
  std::int32_t run_crack;  // the upper end of the crack that the run begins at which ends here, below
  std::uint8_t turns;      // two bits for each direction to come in: the one to leave in
  std::uint8_t is_open;    // a bit for each direction that an outline leaves in and was not walked yet
};

// Cracks between vertices, found line by line.
class CrackGraph {
 public:
  CrackGraph(std::size_t width, CornerRule rule, std::size_t count) : rule_(rule), above_(width + 1, -1) {
    vertices.reserve(count);
  }

  void add(std::size_t x, std::size_t y, const Quadrants& around) {
    const auto column = static_cast<std::int32_t>(x), line = static_cast<std::int32_t>(y);
    if (column == 0) run_crack_ = -1;
    if (around.is_vertex()) add_vertex(column, line, around);
    if (around.has_crack(kSouth)) run_crack_ = above_[x];
  }

  std::vector<CrackVertex> vertices;  // by lines

 private:
  void add_vertex(std::int32_t x, std::int32_t y, const Quadrants& around) {
    const auto vertex = static_cast<std::int32_t>(vertices.size());
    vertices.push_back({.x = x, .y = y, .run_crack = run_crack_, .turns = 0, .is_open = 0});
    CrackVertex& made = vertices.back();
    for (int direction = 0; direction < 4; ++direction) {
      if (!around.has_crack(direction)) continue;
      const int came = turned(direction, 2);
      made.turns |= static_cast<std::uint8_t>(around.next_direction(came, rule_) << 2 * came);
      if (around[direction] != 0) made.is_open |= static_cast<std::uint8_t>(1 << direction);
    }
    if (around.has_crack(kNorth)) link(above_[at(x)], kSouth, vertex);
    if (around.has_crack(kWest)) link(before_, kEast, vertex);
    if (around.has_crack(kSouth)) above_[at(x)] = vertex;
    if (around.has_crack(kEast)) before_ = vertex;
  }

  void link(std::int32_t from, int direction, std::int32_t to) {
    vertices[at(from)].next[at(direction)] = to;
    vertices[at(to)].next[at(turned(direction, 2))] = from;
  }

  CornerRule rule_;
  std::vector<std::int32_t> above_;  // the last vertex in each column
  std::int32_t before_ = -1;         // the last vertex on the line
  std::int32_t run_crack_ = -1;      // the upper end of the crack that the run at hand below begins at
};

struct CrackRing {
  std::size_t begin, end;  // of its vertices
  bool is_hole;
  std::int32_t number;  // as it was walked
  std::int32_t object = -1;
};

class RingWalk {
 public:
  RingWalk(std::vector<CrackVertex>& vertices, CornerRule rule, const Monitor& monitor)
      : vertices_(vertices),
        divides_(rule == CornerRule::divided),
        monitor_(monitor),
        north_(vertices.size(), -1) {
    if (divides_) place_.assign(vertices.size(), -1);
  }

  // A ring leaves its first vertex to the east if it is a shell, to the south if it is a hole.
  void walk_all() {
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      for (const int direction : {kEast, kSouth}) {
        if (is_open(v, direction)) walk(static_cast<std::int32_t>(v), direction);
      }
    }
    std::sort(rings.begin(), rings.end(), [this](const CrackRing& a, const CrackRing& b) {
      return std::tuple(path[a.begin], a.is_hole) < std::tuple(path[b.begin], b.is_hole);
    });
    find_objects();
  }

  std::vector<CrackRing> rings;    // by their first vertices
  std::vector<std::int32_t> path;  // vertices along the rings
  std::int32_t objects = 0;

 private:
  struct Step {
    std::int32_t vertex;
    int direction;
  };

  bool is_open(std::size_t vertex, int direction) const {
    return (vertices_[vertex].is_open >> direction & 1) != 0;
  }

  void walk(std::int32_t vertex, int direction) {
    while (is_open(at(vertex), direction)) {
      poll();
      CrackVertex& here = vertices_[at(vertex)];
      here.is_open &= static_cast<std::uint8_t>(~(1 << direction));
      if (divides_) place_[at(vertex)] = static_cast<std::int32_t>(steps_.size());
      steps_.push_back({vertex, direction});
      vertex = here.next[at(direction)];
      direction = vertices_[at(vertex)].turns >> 2 * direction & 3;
      if (divides_ && place_[at(vertex)] >= 0) take_ring(at(place_[at(vertex)]));
    }
    if (!steps_.empty()) take_ring(0);
  }

  // Turns the last steps into a ring.
  void take_ring(std::size_t from) {
    const auto begin = steps_.begin() + static_cast<std::ptrdiff_t>(from);
    const auto first = std::min_element(begin, steps_.end(),
                                        [](const Step& a, const Step& b) { return a.vertex < b.vertex; });
    const auto number = static_cast<std::int32_t>(rings.size());
    rings.push_back({path.size(), path.size() + (steps_.size() - from), first->direction == kSouth, number});
    const auto append = [this, number](const Step& step) {
      path.push_back(step.vertex);
      if (step.direction == kNorth) north_[at(step.vertex)] = number;
      if (divides_) place_[at(step.vertex)] = -1;
    };
    std::for_each(first, steps_.end(), append);
    std::for_each(begin, first, append);
    steps_.resize(from);
  }

  // A hole belongs to the object of the run beside its first pixel, on the left. That run begins at a crack
  // of the same object, whose ring has its first vertex before that of the hole.
  void find_objects() {
    std::vector<std::int32_t> object(rings.size());  // of rings as they were walked
    for (CrackRing& ring : rings) {
      if (ring.is_hole) {
        const CrackVertex& crack = vertices_[at(vertices_[at(path[ring.begin])].run_crack)];
        ring.object = object[at(north_[at(crack.next[kSouth])])];
      } else {
        ring.object = objects++;
      }
      object[at(ring.number)] = ring.object;
    }
  }

  void poll() {
    if (++polled_ % kSteps == 0 && monitor_ && !monitor_(0.75)) throw Interrupted();
  }

  std::vector<CrackVertex>& vertices_;
  bool divides_;  // where a vertex is visited again
  const Monitor& monitor_;
  std::vector<std::int32_t> north_;  // the ring that leaves each vertex to the north
  std::vector<std::int32_t> place_;  // of each vertex among the steps, or -1
  std::vector<Step> steps_;          // since the last ring
  std::size_t polled_ = 0;
};

// Puts the objects in the order of their labels, and the rings in that of their objects.
template <class Label>
CrackOutlines sorted_outlines(const std::vector<CrackVertex>& vertices, RingWalk& walk,
                              std::span<const Label> image, std::size_t width) {
  std::vector<std::uint32_t> label;  // of objects by their first pixels
  for (const CrackRing& ring : walk.rings) {
    const CrackVertex& first = vertices[at(walk.path[ring.begin])];
    if (!ring.is_hole) label.push_back(image[at(first.y) * width + at(first.x)]);
  }
  std::vector<std::int32_t> order(label.size()), rank(label.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::int32_t a, std::int32_t b) { return label[at(a)] < label[at(b)]; });
  for (std::size_t k = 0; k < order.size(); ++k) rank[at(order[k])] = static_cast<std::int32_t>(k);
  for (CrackRing& ring : walk.rings) ring.object = rank[at(ring.object)];
  std::stable_sort(walk.rings.begin(), walk.rings.end(), [](const CrackRing& a, const CrackRing& b) {
    return std::tie(a.object, a.is_hole) < std::tie(b.object, b.is_hole);
  });
  CrackOutlines made;
  for (const std::int32_t object : order) made.labels.push_back(label[at(object)]);
  made.corners.reserve(walk.path.size());
  made.start.push_back(0);
  for (const CrackRing& ring : walk.rings) {
    for (std::size_t k = ring.begin; k < ring.end; ++k) {
      const CrackVertex& vertex = vertices[at(walk.path[k])];
      made.corners.push_back({vertex.x, vertex.y});
    }
    made.start.push_back(static_cast<std::int64_t>(made.corners.size()));
    made.is_hole.push_back(ring.is_hole ? 1 : 0);
    made.ring_object.push_back(ring.object);
  }
  return made;
}

}  // namespace

template <class Label>
std::size_t count_crack_vertices(std::span<const Label> image, std::size_t width, unsigned threads,
                                 const Monitor& monitor) {
  const std::size_t lines = image.size() / width + 1, piece_lines = rows_per_piece(width);
  std::atomic<std::size_t> count = 0;
  parallel_for(
      piece_count(lines, piece_lines), threads,
      [&](std::size_t piece) {
        const std::size_t first = piece * piece_lines;
        std::size_t found = 0;
        scan_corners(image, width, first, std::min(lines, first + piece_lines),
                     [&](std::size_t, std::size_t, const Quadrants& around) { found += around.is_vertex(); });
        count += found;
      },
      monitor);
  return count;
}

template <class Label>
CrackOutlines trace_cracks(std::span<const Label> image, std::size_t width, CornerRule rule,
                           std::size_t vertices, const Monitor& monitor) {
  const std::size_t lines = image.size() / width + 1, piece_lines = rows_per_piece(width);
  CrackGraph graph(width, rule, vertices);
  for (std::size_t first = 0; first < lines; first += piece_lines) {
    scan_corners(image, width, first, std::min(lines, first + piece_lines),
                 [&](std::size_t x, std::size_t y, const Quadrants& around) { graph.add(x, y, around); });
    if (monitor && !monitor(0.5 * static_cast<double>(first) / static_cast<double>(lines)))
      throw Interrupted();
  }
  RingWalk walk(graph.vertices, rule, monitor);
  walk.walk_all();
  return sorted_outlines(graph.vertices, walk, image, width);
}

template std::size_t count_crack_vertices(std::span<const std::uint8_t>, std::size_t, unsigned,
                                          const Monitor&);
template std::size_t count_crack_vertices(std::span<const std::uint16_t>, std::size_t, unsigned,
                                          const Monitor&);
template std::size_t count_crack_vertices(std::span<const std::uint32_t>, std::size_t, unsigned,
                                          const Monitor&);
template CrackOutlines trace_cracks(std::span<const std::uint8_t>, std::size_t, CornerRule, std::size_t,
                                    const Monitor&);
template CrackOutlines trace_cracks(std::span<const std::uint16_t>, std::size_t, CornerRule, std::size_t,
                                    const Monitor&);
template CrackOutlines trace_cracks(std::span<const std::uint32_t>, std::size_t, CornerRule, std::size_t,
                                    const Monitor&);

}  // namespace vorotool::core
