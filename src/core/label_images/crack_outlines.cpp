#include "core/label_images/crack_outlines.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>

#include "core/base/large_array.hpp"
#include "core/base/parallel.hpp"
#include "core/label_images/corner_scan.hpp"
#include "core/label_images/label_runs.hpp"

namespace vorotool::core::label_images {

using base::at;
using base::LargeArray;
using base::Monitor;

namespace {

constexpr std::size_t steps_between_polls = std::size_t{1}
                                            << 16;  // of work between two polls: a millisecond or so

// Directions along cracks, clockwise as an image is shown. Quadrant d of a corner is the pixel on the right
// hand of who leaves it in direction d, and quadrant d - 1 the one on the left hand.
enum Direction : int { east, south, west, north };

constexpr int turned(int direction, int quarters) { return (direction + quarters) & 3; }

// Which labels are around a corner, and which cracks end there.
class Quadrants {
 public:
  explicit Quadrants(const Corner& c) : label_{c.lower_right, c.lower_left, c.upper_left, c.upper_right} {}

  std::uint32_t operator[](int quadrant) const { return label_[static_cast<std::size_t>(quadrant & 3)]; }
  bool has_crack(int direction) const { return (*this)[direction] != (*this)[direction + 3]; }
  bool is_vertex() const {
    return (has_crack(north) || has_crack(south)) && (has_crack(west) || has_crack(east));
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

// Lines between the rows of an image: line y is above row y, and outside is label 0.
struct Lines {
  std::size_t first, last;
};

// Calls visit(y, row above, row below) for lines.
template <class Label, class Visit>
void for_each_line(std::span<const Label> image, std::size_t width, Lines lines, Visit visit) {
  const std::size_t height = image.size() / width;
  const std::vector<Label> outside(width, 0);
  const auto row = [&](bool is_inside, std::size_t number) {
    return is_inside ? image.subspan(number * width, width) : std::span<const Label>(outside);
  };
  for (std::size_t y = lines.first; y < lines.last; ++y) visit(y, row(y > 0, y - 1), row(y < height, y));
}

// Calls visit(x, y, quadrants) for the corners of lines where a crack goes up or down, line by line.
template <class Label, class Visit>
void scan_corners(std::span<const Label> image, std::size_t width, Lines lines, Visit visit) {
  RowPair rows(width);
  using Row = std::span<const Label>;
  for_each_line(image, width, lines, [&](std::size_t y, Row above, Row below) {
    const auto stretch = [](std::uint32_t, std::uint32_t) {};
    const auto corner = [&](std::size_t x, const Corner& c) { visit(x, y, Quadrants(c)); };
    visit(0, y, Quadrants({0, above.front(), below.front(), 0}));
    y == lines.first ? rows.walk(above, below, stretch, corner) : rows.walk_on(above, below, stretch, corner);
    visit(width, y, Quadrants({above.back(), 0, 0, below.back()}));
  });
}

// Vertices on a line, as Quadrants::is_vertex has them: a block at a time without a branch.
template <class Label>
std::size_t vertices_on_line(std::span<const Label> above, std::span<const Label> below) {
  constexpr std::size_t block = 128;  // a count of 8 bits holds as many
  const std::size_t width = above.size();
  std::size_t count = (above[0] != 0 || below[0] != 0) && above[0] != below[0];
  count += (above[width - 1] != 0 || below[width - 1] != 0) && above[width - 1] != below[width - 1];
  for (std::size_t from = 1; from < width; from += block) {
    const std::size_t to = std::min(width, from + block);
    Label found = 0;
    for (std::size_t x = from; x < to; ++x) {
      const auto along = static_cast<Label>((above[x] ^ above[x - 1]) | (below[x] ^ below[x - 1]));
      const auto across = static_cast<Label>((above[x] ^ below[x]) | (above[x - 1] ^ below[x - 1]));
      found = static_cast<Label>(found + ((along != 0) & (across != 0)));
    }
    count += found;
  }
  return count;
}

// The number of vertices on the lines of each piece.
template <class Label>
std::vector<std::size_t> vertices_of_pieces(std::span<const Label> image, std::size_t width, unsigned threads,
                                            const Monitor& monitor) {
  const std::size_t lines = image.size() / width + 1, lines_a_piece = rows_per_piece(width);
  std::vector<std::size_t> found(base::piece_count(lines, lines_a_piece));
  using Row = std::span<const Label>;
  const auto count = [&](std::size_t piece, std::size_t first, std::size_t last) {
    for_each_line(image, width, {first, last},
                  [&](std::size_t, Row above, Row below) { found[piece] += vertices_on_line(above, below); });
  };
  base::for_pieces(lines, lines_a_piece, threads, monitor, count);
  return found;
}

struct CrackVertex {
  std::int32_t x, y;
  std::array<std::int32_t, 4> next{-1, -1, -1, -1};  // the vertices at the other ends of cracks
  std::int32_t run_crack;  // the upper end of the crack that the run begins at which ends here, below
  std::uint8_t turns;      // two bits for each direction to come in: the one to leave in
  std::uint8_t is_open;    // a bit for each direction that an outline leaves in and was not walked yet
};

// Cracks between vertices on some lines, found line by line. What leads to vertices above these lines is
// linked by `join`.
class CrackBand {
 public:
  // `vertices` are those of the image, those of these lines begin at `first`.
  CrackBand(std::span<CrackVertex> vertices, std::size_t first, std::size_t width, CornerRule rule)
      : vertices_(vertices),
        next_(static_cast<std::int32_t>(first)),
        rule_(rule),
        above_(width + 1, unknown) {}

  void add(std::size_t x, std::size_t y, const Quadrants& around) {
    const auto column = static_cast<std::int32_t>(x), line = static_cast<std::int32_t>(y);
    if (column == 0) run_column_ = run_crack_ = -1;
    if (around.is_vertex()) add_vertex(column, line, around);
    if (around.has_crack(south)) {
      run_column_ = column;
      run_crack_ = above_[x];
    }
  }

  // The last line is done.
  void close() {
    for (std::size_t x = 0; x < above_.size(); ++x) {
      if (above_[x] != unknown) last_.push_back({static_cast<std::int32_t>(x), above_[x]});
    }
    above_ = {};
  }

  // Bands are joined from above: `above` has the last vertex in each column, and is brought down to here.
  void join(std::vector<std::int32_t>& above) const {
    for (const auto& [column, vertex] : from_above_) link(above[at(column)], south, vertex);
    for (const auto& [column, vertex] : runs_from_above_) vertices_[at(vertex)].run_crack = above[at(column)];
    for (const auto& [column, vertex] : last_) above[at(column)] = vertex;
  }

 private:
  static constexpr std::int32_t unknown = -1;

  struct Place {
    std::int32_t column, vertex;
  };

  void add_vertex(std::int32_t x, std::int32_t y, const Quadrants& around) {
    const std::int32_t vertex = next_++;
    if (run_column_ >= 0 && run_crack_ == unknown) runs_from_above_.push_back({run_column_, vertex});
    CrackVertex& made = vertices_[at(vertex)];
    made = {.x = x, .y = y, .run_crack = run_crack_, .turns = 0, .is_open = 0};
    for (int direction = 0; direction < 4; ++direction) {
      if (!around.has_crack(direction)) continue;
      const int came = turned(direction, 2);
      made.turns |= static_cast<std::uint8_t>(around.next_direction(came, rule_) << 2 * came);
      if (around[direction] != 0) made.is_open |= static_cast<std::uint8_t>(1 << direction);
    }
    if (around.has_crack(north)) link_up(x, vertex);
    if (around.has_crack(west)) link(before_, east, vertex);
    if (around.has_crack(south)) above_[at(x)] = vertex;
    if (around.has_crack(east)) before_ = vertex;
  }

  void link_up(std::int32_t column, std::int32_t vertex) {
    const std::int32_t above = above_[at(column)];
    above == unknown ? from_above_.push_back({column, vertex}) : link(above, south, vertex);
  }

  void link(std::int32_t from, int direction, std::int32_t to) const {
    vertices_[at(from)].next[at(direction)] = to;
    vertices_[at(to)].next[at(turned(direction, 2))] = from;
  }

  std::span<CrackVertex> vertices_;  // by lines
  std::int32_t next_;
  CornerRule rule_;
  std::vector<std::int32_t> above_;     // the last vertex in each column
  std::int32_t before_ = -1;            // the last vertex on the line
  std::int32_t run_column_ = -1;        // of the crack that the run at hand below begins at
  std::int32_t run_crack_ = -1;         // its upper end
  std::vector<Place> from_above_;       // cracks from above these lines, with their lower ends
  std::vector<Place> runs_from_above_;  // such cracks that the run of a vertex begins at
  std::vector<Place> last_;             // the last vertex in each column, where there is one
};

// The vertices of the image, with the cracks between them.
template <class Label>
LargeArray<CrackVertex> crack_graph(std::span<const Label> image, std::size_t width, CornerRule rule,
                                    unsigned threads, const Monitor& monitor) {
  const auto quarter = [&](double from) -> Monitor {
    if (!monitor) return {};
    return [&monitor, from](double fraction) { return monitor(from + fraction / 4); };
  };
  std::vector<std::size_t> start{0};
  for (const std::size_t count : vertices_of_pieces(image, width, threads, quarter(0)))
    start.push_back(start.back() + count);
  LargeArray<CrackVertex> vertices(start.back());
  std::vector<std::optional<CrackBand>> bands(start.size() - 1);
  const auto scan = [&](std::size_t piece, std::size_t first, std::size_t last) {
    CrackBand& band =
        bands[piece].emplace(std::span(vertices.data(), vertices.size()), start[piece], width, rule);
    scan_corners(image, width, {first, last},
                 [&](std::size_t x, std::size_t y, const Quadrants& around) { band.add(x, y, around); });
    band.close();
  };
  base::for_pieces(image.size() / width + 1, rows_per_piece(width), threads, quarter(0.25), scan);
  std::vector<std::int32_t> above(width + 1, -1);
  for (const std::optional<CrackBand>& band : bands) band->join(above);
  return vertices;
}

struct CrackRing {
  std::size_t begin, end;  // of its vertices
  bool is_hole;
  std::int32_t number;  // as it was walked
  std::int32_t object = -1;
};

class RingWalk {
 public:
  RingWalk(std::span<CrackVertex> vertices, CornerRule rule, const Monitor& monitor)
      : vertices_(vertices),
        divides_(rule == CornerRule::divided),
        monitor_(monitor),
        north_(vertices.size(), -1) {
    if (divides_) place_.assign(vertices.size(), -1);
    path.reserve(vertices.size());
  }

  // A ring leaves its first vertex to the east if it is a shell, to the south if it is a hole.
  void walk_all() {
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      for (const int direction : {east, south}) {
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
    rings.push_back({path.size(), path.size() + (steps_.size() - from), first->direction == south, number});
    const auto append = [this, number](const Step& step) {
      path.push_back(step.vertex);
      if (step.direction == north) north_[at(step.vertex)] = number;
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
        ring.object = object[at(north_[at(crack.next[south])])];
      } else {
        ring.object = objects++;
      }
      object[at(ring.number)] = ring.object;
    }
  }

  void poll() {
    if (++polled_ % steps_between_polls == 0) base::report(monitor_, 0.75);
  }

  std::span<CrackVertex> vertices_;
  bool divides_;  // where a vertex is visited again
  const Monitor& monitor_;
  std::vector<std::int32_t> north_;  // the ring that leaves each vertex to the north
  std::vector<std::int32_t> place_;  // of each vertex among the steps, or -1
  std::vector<Step> steps_;          // since the last ring
  std::size_t polled_ = 0;
};

// Puts the objects in the order of their labels, and the rings in that of their objects.
template <class Label>
CrackOutlines sorted_outlines(std::span<const CrackVertex> vertices, RingWalk& walk,
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
  const std::vector<std::size_t> found = vertices_of_pieces(image, width, threads, monitor);
  return std::accumulate(found.begin(), found.end(), std::size_t{0});
}

template <class Label>
CrackOutlines trace_cracks(std::span<const Label> image, std::size_t width, CornerRule rule, unsigned threads,
                           const Monitor& monitor) {
  LargeArray<CrackVertex> made = crack_graph(image, width, rule, threads, monitor);
  const std::span vertices(made.data(), made.size());
  RingWalk walk(vertices, rule, monitor);
  walk.walk_all();
  return sorted_outlines<Label>(vertices, walk, image, width);
}

template std::size_t count_crack_vertices(std::span<const std::uint8_t>, std::size_t, unsigned,
                                          const Monitor&);
template std::size_t count_crack_vertices(std::span<const std::uint16_t>, std::size_t, unsigned,
                                          const Monitor&);
template std::size_t count_crack_vertices(std::span<const std::uint32_t>, std::size_t, unsigned,
                                          const Monitor&);
template CrackOutlines trace_cracks(std::span<const std::uint8_t>, std::size_t, CornerRule, unsigned,
                                    const Monitor&);
template CrackOutlines trace_cracks(std::span<const std::uint16_t>, std::size_t, CornerRule, unsigned,
                                    const Monitor&);
template CrackOutlines trace_cracks(std::span<const std::uint32_t>, std::size_t, CornerRule, unsigned,
                                    const Monitor&);

}  // namespace vorotool::core::label_images
