#include "core/arrangement/sound_polygons.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/arrangement/edge_tree.hpp"
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/kernel/predicates.hpp"

namespace vorotool::core::arrangement {
namespace {

using base::at;
using kernel::lexicographic_less;
using kernel::orient2d;
using kernel::Point;

constexpr std::size_t polygons_a_piece = 1 << 12;

// ---- pairs of edges -------------------------------------------------------------------------------
// Whether q and r lie on the same side of p on a line through all three.
bool same_way(const Point& p, const Point& q, const Point& r) {
  return lexicographic_less(p, q) == lexicographic_less(p, r);
}

// Whether two edges with the common end p, which go on to q and r, have more than p in common.
bool overlap(const Point& p, const Point& q, const Point& r) {
  return orient2d(p, q, r) == 0 && same_way(p, q, r);
}

// Whether two edges without a common end meet. Their boxes do: if all are in line, so do they.
bool meet(const Edge& e, const Edge& f) {
  return orient2d(e.a, e.b, f.a) * orient2d(e.a, e.b, f.b) <= 0 &&
         orient2d(f.a, f.b, e.a) * orient2d(f.a, f.b, e.b) <= 0;
}

// Whether two edges meet elsewhere than at one common end.
bool meet_badly(const Edge& e, const Edge& f) {
  const bool from_a = e.a == f.a, to_b = e.b == f.b, a_b = e.a == f.b, b_a = e.b == f.a;
  if ((from_a && to_b) || (a_b && b_a)) return true;
  if (from_a) return overlap(e.a, e.b, f.b);
  if (to_b) return overlap(e.b, e.a, f.a);
  if (a_b) return overlap(e.a, e.b, f.a);
  if (b_a) return overlap(e.b, e.a, f.b);
  return meet(e, f);
}

// ---- one ring -------------------------------------------------------------------------------------
// Whether a ring turns left or not at all at each vertex, and goes around once: it is simple then.
bool is_convex(std::span<const Point> ring) {
  const std::size_t n = ring.size();
  int reversals = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point &a = ring[i], &b = ring[(i + 1) % n], &c = ring[(i + 2) % n];
    const bool reverses = lexicographic_less(a, b) != lexicographic_less(b, c);
    const int turn = orient2d(a, b, c);
    if (turn < 0 || (turn == 0 && reverses)) return false;
    reversals += reverses;
  }
  return reversals == 2;
}

// Whether the first vertex in lexicographic order is a left turn; the ring is simple.
bool is_counter_clockwise(std::span<const Point> ring) {
  const std::size_t n = ring.size();
  std::size_t first = 0;
  for (std::size_t i = 1; i < n; ++i) {
    if (lexicographic_less(ring[i], ring[first])) first = i;
  }
  return orient2d(ring[(first + n - 1) % n], ring[first], ring[(first + 1) % n]) > 0;
}

// A ring as chains along which neither coordinate turns back: none meets itself, and the box of a part of one has the
// ends of the part as corners, so that pairs of parts whose boxes meet are halved until they are edges.
class MonotoneChains {
 public:
  explicit MonotoneChains(std::span<const Point> ring) : ring_(ring) {
    int right = 0, up = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point &a = ring[i], &b = vertex(i + 1);
      const int x = (a.x < b.x) - (b.x < a.x), y = (a.y < b.y) - (b.y < a.y);
      if (i == 0 || x * right < 0 || y * up < 0) {
        starts_.push_back(i);
        right = up = 0;
      }
      if (x != 0) right = x;
      if (y != 0) up = y;
    }
  }

  std::size_t size() const { return starts_.size(); }

  // Calls fits(i, j) with i < j for edges of different chains whose boxes meet, until it returns false.
  template <class Fits>
  bool all_pairs(const Fits& fits) const {
    for (std::size_t c = 0; c < size(); ++c) {
      for (std::size_t d = c + 1; d < size(); ++d) {
        if (!between(starts_[c], starts_[c + 1], starts_[d], d + 1 < size() ? starts_[d + 1] : ring_.size(),
                     fits)) {
          return false;
        }
      }
    }
    return true;
  }

 private:
  const Point& vertex(std::size_t i) const { return ring_[i < ring_.size() ? i : 0]; }

  static bool meet_along(double a, double b, double c, double d) {
    return std::min(a, b) <= std::max(c, d) && std::min(c, d) <= std::max(a, b);
  }

  template <class Fits>
  bool between(std::size_t i, std::size_t i_end, std::size_t j, std::size_t j_end, const Fits& fits) const {
    const Point &a = vertex(i), &b = vertex(i_end), &c = vertex(j), &d = vertex(j_end);
    if (!meet_along(a.x, b.x, c.x, d.x) || !meet_along(a.y, b.y, c.y, d.y)) return true;
    if (i_end - i == 1 && j_end - j == 1) return fits(i, j);
    if (i_end - i >= j_end - j) {
      const std::size_t middle = i + (i_end - i) / 2;
      return between(i, middle, j, j_end, fits) && between(middle, i_end, j, j_end, fits);
    }
    const std::size_t middle = j + (j_end - j) / 2;
    return between(i, i_end, j, middle, fits) && between(i, i_end, middle, j_end, fits);
  }

  std::span<const Point> ring_;
  std::vector<std::size_t> starts_;
};

// All pairs of so many chains are looked at.
constexpr std::size_t few_chains = 64;

bool is_simple(std::span<const Point> ring) {
  const std::size_t n = ring.size();
  const auto edge = [&](std::size_t i) { return Edge{ring[i], ring[i + 1 < n ? i + 1 : 0]}; };
  const auto fits = [&](std::size_t i, std::size_t j) {
    const Edge e = edge(i), f = edge(j);
    if (j == i + 1 || (i == 0 && j == n - 1)) return !meet_badly(e, f);
    return e.a != f.a && e.a != f.b && e.b != f.a && e.b != f.b && !meet(e, f);
  };
  if (const MonotoneChains chains(ring); chains.size() <= few_chains) return chains.all_pairs(fits);
  std::vector<Edge> edges;
  edges.reserve(n);
  for (std::size_t i = 0; i < n; ++i) edges.push_back(edge(i));
  return EdgeTree(edges).all_pairs(fits);
}

bool is_sound(std::span<const Point> ring) {
  if (ring.size() < 3 || ring.front() == ring.back()) return false;
  if (std::adjacent_find(ring.begin(), ring.end()) != ring.end()) return false;
  return is_convex(ring) || (is_simple(ring) && is_counter_clockwise(ring));
}

// ---- a coverage -----------------------------------------------------------------------------------
// Directed edges by their ends, whichever comes first.
class EdgeMatches {
 public:
  explicit EdgeMatches(std::vector<Edge>&& edges)
      : edges_(std::move(edges)), matched_(edges_.size()), slots_(std::bit_ceil(2 * edges_.size() + 2), -1) {}

  // Calls clash(i, j) for edges that have both ends in common and are not the only two, one either way.
  template <class Clash>
  void match(const Clash& clash) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      std::size_t slot = hash(edges_[e]) & mask;
      while (slots_[slot] >= 0 && !same_ends(e, at(slots_[slot]))) slot = (slot + 1) & mask;
      if (slots_[slot] < 0) {
        slots_[slot] = static_cast<std::int32_t>(e);
        continue;
      }
      const std::size_t other = at(slots_[slot]);
      if (matched_[other] || edges_[other].a == edges_[e].a) clash(e, other);
      matched_[e] = matched_[other] = 1;
    }
  }

  // The edges that match none, those of one neighborhood near each other.
  std::vector<std::int32_t> alone() const;
  const Edge& operator[](std::int32_t edge) const { return edges_[at(edge)]; }

 private:
  bool same_ends(std::size_t i, std::size_t j) const {
    const Edge &e = edges_[i], &f = edges_[j];
    return (e.a == f.b && e.b == f.a) || (e.a == f.a && e.b == f.b);
  }
  static std::size_t hash(const Point& p) {
    const auto x = std::bit_cast<std::uint64_t>(p.x + 0.0), y = std::bit_cast<std::uint64_t>(p.y + 0.0);
    std::uint64_t h = (x ^ std::rotl(y, 29)) * 0x9e3779b97f4a7c15;
    h = (h ^ h >> 29) * 0xbf58476d1ce4e5b9;
    return static_cast<std::size_t>(h ^ h >> 32);
  }
  static std::size_t hash(const Edge& edge) { return hash(edge.a) + hash(edge.b); }

  std::vector<Edge> edges_;
  std::vector<std::uint8_t> matched_;
  std::vector<std::int32_t> slots_;
};

// The bits of two numbers of 16 bits in turn: near each other for points that are.
std::uint32_t interleaved(std::uint32_t x, std::uint32_t y) {
  const auto spread = [](std::uint32_t v) {
    v = (v | v << 8) & 0x00ff00ff;
    v = (v | v << 4) & 0x0f0f0f0f;
    v = (v | v << 2) & 0x33333333;
    return (v | v << 1) & 0x55555555;
  };
  return spread(x) | spread(y) << 1;
}

std::vector<std::int32_t> EdgeMatches::alone() const {
  std::vector<std::pair<std::uint32_t, std::int32_t>> keyed;
  Point low{0, 0}, high{0, 0};
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (matched_[e]) continue;
    const Point& p = edges_[e].a;
    if (keyed.empty()) low = high = p;
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    keyed.push_back({0, static_cast<std::int32_t>(e)});
  }
  // halves: the difference of two finite doubles may be infinite. The key is for speed alone
  const double width = high.x / 2 - low.x / 2, height = high.y / 2 - low.y / 2;
  const auto part = [](double offset, double whole) {
    return whole > 0 ? static_cast<std::uint32_t>(offset / whole * 65535) : 0U;
  };
  for (auto& [key, edge] : keyed) {
    const Point& p = edges_[at(edge)].a;
    key = interleaved(part(p.x / 2 - low.x / 2, width), part(p.y / 2 - low.y / 2, height));
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::int32_t> result;
  result.reserve(keyed.size());
  for (const auto& [key, edge] : keyed) result.push_back(edge);
  return result;
}

// Marks the polygons that share an edge in the same direction, and those whose outer edges meet badly.
void mark_clashes(const PolygonRings& rings, std::vector<std::uint8_t>& faults) {
  std::vector<Edge> edges;
  std::vector<std::int32_t> polygon;
  edges.reserve(rings.points.size());
  polygon.reserve(rings.points.size());
  for (std::size_t p = 0; p + 1 < rings.polygon_start.size(); ++p) {
    for (auto r = rings.polygon_start[p]; r < rings.polygon_start[p + 1]; ++r) {
      const auto begin = static_cast<std::size_t>(rings.ring_start[static_cast<std::size_t>(r)]);
      const auto end = static_cast<std::size_t>(rings.ring_start[static_cast<std::size_t>(r) + 1]);
      for (std::size_t i = begin; i < end; ++i) {
        edges.push_back({rings.points[i], rings.points[i + 1 < end ? i + 1 : begin]});
        polygon.push_back(static_cast<std::int32_t>(p));
      }
    }
  }
  const auto blame = [&](std::size_t i, std::size_t j) {
    faults[at(polygon[i])] |= clashes;
    faults[at(polygon[j])] |= clashes;
  };
  EdgeMatches matches(std::move(edges));
  matches.match(blame);
  const std::vector<std::int32_t> alone = matches.alone();
  std::vector<Edge> outer;
  outer.reserve(alone.size());
  for (const std::int32_t edge : alone) outer.push_back(matches[edge]);
  EdgeTree(outer).all_pairs([&](std::size_t i, std::size_t j) {
    if (meet_badly(outer[i], outer[j])) blame(at(alone[i]), at(alone[j]));
    return true;
  });
}

}  // namespace

std::vector<std::uint8_t> find_polygon_faults(const PolygonRings& rings, bool is_coverage, unsigned threads,
                                              const base::Monitor& monitor) {
  const std::size_t count = rings.polygon_start.size() - 1;
  std::vector<std::uint8_t> faults(count);
  base::for_items(count, polygons_a_piece, threads, monitor, [&](std::size_t p) {
    const auto ring = static_cast<std::size_t>(rings.polygon_start[p]);
    const bool is_single = rings.polygon_start[p + 1] - rings.polygon_start[p] == 1;
    const auto begin = static_cast<std::size_t>(rings.ring_start[ring]);
    const auto size = static_cast<std::size_t>(rings.ring_start[ring + (is_single ? 1 : 0)]) - begin;
    if (!is_single || !is_sound(rings.points.subspan(begin, size))) faults[p] = unsound;
  });
  if (is_coverage) mark_clashes(rings, faults);
  return faults;
}

}  // namespace vorotool::core::arrangement
