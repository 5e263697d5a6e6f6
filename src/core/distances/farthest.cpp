#include "core/distances/farthest.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/distances/along_segment.hpp"

namespace vorotool::core::distances {

using kernel::Point;

namespace {

// Shares of sums of rounded lengths: what is shorter than this is shorter.
constexpr double surely = 1 - 0x1p-40;

// The farthest place so far.
struct Best {
  double d2 = -1;
  Point from{0, 0};
  std::uint32_t element = 0;  // the nearest, but where d2 is 0

  void take(const Best& other) {
    if (other.d2 > d2) *this = other;
  }
};

struct End {
  Nearest nearest;
  bool is_inside;

  double d2() const { return is_inside ? 0 : nearest.d2; }
};

struct Ends {
  End a, b;
};

// No place between p and q, with the nearest elements there, is farther from what is nearest to it: a square.
double bound_between(const Shape& to, const Point& p, const Nearest& at_p, const Point& q,
                     const Nearest& at_q) {
  if (at_p.element == at_q.element) return std::max(at_p.d2, at_q.d2);
  return std::min(std::max(at_p.d2, square_distance(to.elements()[at_p.element], q)),
                  std::max(at_q.d2, square_distance(to.elements()[at_q.element], p)));
}

// Asks what is nearest at one place after another, which are mostly near each other.
class Walk {
 public:
  explicit Walk(const Shape& to) : to_(to) {}

  const End& to(const Point& p) {
    if (has_last_ && last_.at == p) return last_.end;
    End end{{}, false};
    if (has_last_) {
      const std::uint32_t before = last_.end.nearest.element;
      end.nearest = {square_distance(to_.elements()[before], p), before};
    }
    end.nearest = to_.tree().nearest(p, end.nearest);
    end.is_inside = to_.is_filled() && is_inside(p, end.nearest);
    last_ = {p, end};
    has_last_ = true;
    return last_.end;
  }

 private:
  struct Stop {
    Point at;
    End end;
  };

  // Outlines do not come into the disc around a place that reaches to the nearest of them.
  bool is_inside(const Point& p, const Nearest& nearest) const {
    if (has_last_ && square(p - last_.at) < surely * std::max(nearest.d2, last_.end.nearest.d2))
      return last_.end.is_inside;
    return to_.contains(p);
  }

  const Shape& to_;
  Stop last_{};
  bool has_last_ = false;
};

// Looks along one segment for places that are farther than the best.
class SegmentSearch {
 public:
  SegmentSearch(const Shape& to, const Element& segment, const Ends& ends, const Best& best)
      : to_(to), segment_(segment), ends_(ends), best_(best) {}

  Best run() {
    if (is_part_of_it()) return best_;
    const std::vector<double> cuts = outline_cuts();
    if (cuts.empty()) {
      if (!ends_.a.is_inside) between({0, ends_.a.nearest}, {1, ends_.b.nearest});
      return best_;
    }
    Place before{0, ends_.a.nearest};
    for (const double cut : cuts) {
      if (!(cut > before.share)) continue;
      const Place here = cut < 1 ? place_at(cut, before.nearest) : Place{1, ends_.b.nearest};
      if (is_worth_it(before, here) && !to_.contains(segment_.at(std::midpoint(before.share, here.share))))
        between(before, here);
      before = here;
    }
    return best_;
  }

 private:
  struct Place {
    double share;
    Nearest nearest;
  };

  // Whether all of the segment is on elements, as it is where both shapes are the same there.
  bool is_part_of_it() const {
    if (ends_.a.nearest.d2 != 0 || ends_.b.nearest.d2 != 0) return false;
    std::vector<Element> near;
    to_.tree().meeting(Box::of(segment_),
                       [&](const ElementTree::Item& item) { near.push_back(item.element); });
    return is_covered(segment_, near);
  }

  // Where the segment meets outlines of polygons, and its second end; nothing if it does not meet them.
  std::vector<double> outline_cuts() const {
    std::vector<double> cuts;
    if (!to_.is_filled()) return cuts;
    to_.tree().meeting(Box::of(segment_), [&](const ElementTree::Item& item) {
      if (to_.is_bound(item.number)) add_meetings(segment_, item.element, cuts);
    });
    if (cuts.empty()) return cuts;
    cuts.push_back(1);
    std::sort(cuts.begin(), cuts.end());
    return cuts;
  }

  Place place_at(double share, const Nearest& likely) const {
    const Point p = segment_.at(share);
    const Nearest start{square_distance(to_.elements()[likely.element], p), likely.element};
    return {share, to_.tree().nearest(p, start)};
  }

  bool is_worth_it(const Place& s, const Place& t) const {
    return bound_between(to_, segment_.at(s.share), s.nearest, segment_.at(t.share), t.nearest) > best_.d2;
  }

  void between(const Place& first, const Place& last) {
    std::vector<std::array<Place, 2>> open{{first, last}};
    while (!open.empty()) {
      const auto [s, t] = open.back();
      open.pop_back();
      if (s.nearest.element == t.nearest.element || !is_worth_it(s, t)) continue;
      const Element& e = to_.elements()[s.nearest.element];
      const Element& f = to_.elements()[t.nearest.element];
      const double share = equally_far(segment_, e, f, s.share, t.share);
      if (!(share > s.share && share < t.share)) continue;
      const Place found = place_at(share, s.nearest);
      const Point p = segment_.at(share);
      best_.take({found.nearest.d2, p, found.nearest.element});
      const double farther = std::max(square_distance(e, p), square_distance(f, p));
      // Nothing is nearer, and both are equally far but for rounding.
      if (found.nearest.d2 >= (1 - 0x1p-50) * farther) continue;
      open.push_back({s, found});
      open.push_back({found, t});
    }
  }

  const Shape& to_;
  const Element& segment_;
  const Ends& ends_;
  Best best_;
};

class Search {
 public:
  Search(const Shape& from, const Shape& to, unsigned threads, const base::Monitor& monitor)
      : from_(from.elements()), to_(to), threads_(threads), monitor_(monitor), ends_(from_.size()) {}

  Farthest run() {
    look_at_ends();
    look_along_segments();
    if (best_.d2 < 0) return {-1, {0, 0}, {0, 0}};
    if (best_.d2 == 0) return {0, best_.from, best_.from};
    return {std::sqrt(best_.d2), best_.from, nearest_place(to_.elements()[best_.element], best_.from)};
  }

 private:
  void look_at_ends() {
    constexpr std::size_t grain = 1 << 10;  // elements a piece: some milliseconds
    std::vector<Best> found(base::piece_count(from_.size(), grain));
    base::for_pieces(from_.size(), grain, threads_, monitor_,
                     [&](std::size_t piece, std::size_t begin, std::size_t end) {
                       Walk walk(to_);
                       for (std::size_t i = begin; i < end; ++i) {
                         const Element& own = from_[i];
                         ends_[i].a = walk.to(own.a);
                         ends_[i].b = walk.to(own.b);
                         found[piece].take({ends_[i].a.d2(), own.a, ends_[i].a.nearest.element});
                         found[piece].take({ends_[i].b.d2(), own.b, ends_[i].b.nearest.element});
                       }
                     });
    for (const Best& each : found) best_.take(each);
  }

  double bound_of(std::size_t i) const {
    const Element& own = from_[i];
    const auto& [a, b] = ends_[i];
    if (a.is_inside && b.is_inside) {
      const double reach = std::sqrt(a.nearest.d2) + std::sqrt(b.nearest.d2);
      if (square(own.b - own.a) < surely * reach * reach) return 0;
    }
    return bound_between(to_, own.a, a.nearest, own.b, b.nearest);
  }

  struct Open {
    double bound;
    std::uint32_t segment;
  };

  std::vector<Open> open_segments() const {
    std::vector<Open> open;
    for (std::size_t i = 0; i < from_.size(); ++i) {
      base::report_item(monitor_, i, from_.size());
      if (from_[i].is_point()) continue;
      const double bound = bound_of(i);
      if (bound > best_.d2) open.push_back({bound, static_cast<std::uint32_t>(i)});
    }
    std::sort(open.begin(), open.end(), [](const Open& i, const Open& j) {
      return i.bound != j.bound ? i.bound > j.bound : i.segment < j.segment;
    });
    return open;
  }

  // In rounds that are larger and larger; in each, all start from the best of the rounds before.
  void look_along_segments() {
    const std::vector<Open> open = open_segments();
    constexpr std::size_t most = 1 << 14;
    std::vector<Best> found;
    for (std::size_t begin = 0, size = 16; begin < open.size() && open[begin].bound > best_.d2;) {
      found.assign(std::min(size, open.size() - begin), best_);
      base::for_items(found.size(), 16, threads_, monitor_, [&](std::size_t i) {
        const auto [bound, segment] = open[begin + i];
        if (bound > best_.d2) found[i] = SegmentSearch(to_, from_[segment], ends_[segment], best_).run();
      });
      for (const Best& each : found) best_.take(each);
      begin += found.size();
      size = std::min(2 * size, most);
    }
  }

  std::span<const Element> from_;
  const Shape& to_;
  unsigned threads_;
  const base::Monitor& monitor_;
  std::vector<Ends> ends_;
  Best best_;
};

}  // namespace

Farthest farthest_place(const Shape& from, const Shape& to, unsigned threads, const base::Monitor& monitor) {
  return Search(from, to, threads, monitor).run();
}

}  // namespace vorotool::core::distances
