#include "core/arrangement/segment_intersections.hpp"

#include <algorithm>
#include <queue>

#include "core/arrangement/sweep_status.hpp"

namespace vorotool::core::arrangement {

using base::Monitor;

namespace {

constexpr std::int32_t none = SweepStatus::none;
constexpr std::size_t most_meetings = std::size_t{1} << 28;
constexpr std::size_t events_between_polls = 4096;

class Sweep {
 public:
  Sweep(const SortedSegments& segments, const Monitor& monitor)
      : segments_(segments),
        monitor_(monitor),
        place_of_(segments.lower_end.size(), none),
        ending_(segments.points.size(), none) {
    result_.below.assign(segments.points.size(), none);
    for (std::size_t s = 0; s < segments.upper_end.size(); ++s) {
      ending_[static_cast<std::size_t>(segments.upper_end[s])] = static_cast<std::int32_t>(s);
    }
  }

  SweepResult run() {
    const std::size_t points = segments_.points.size();
    for (std::size_t i = 0; i < points; ++i) {
      while (!events_.empty() && compare(events_.top().at, segments_.points[i]) < 0) pass_crossing();
      while (!events_.empty() && compare(events_.top().at, segments_.points[i]) == 0) events_.pop();
      pass_point(static_cast<std::int32_t>(i));
      poll(i);
    }
    return std::move(result_);
  }

 private:
  // Two segments that were neighbors before they cross; by then others may have come between them, all of
  // which pass through the same place.
  struct Event {
    RationalPoint at;
    std::int32_t segment;

    friend bool operator<(const Event& a, const Event& b) { return compare(a.at, b.at) > 0; }  // least on top
  };

  struct Run {
    std::int32_t first, last;
  };

  void poll(std::size_t point) {
    if (++events_passed_ % events_between_polls != 0) return;
    base::report(monitor_, static_cast<double>(point) / static_cast<double>(segments_.points.size()));
  }

  kernel::LatticePoint point(std::int32_t i) const { return segments_.points[static_cast<std::size_t>(i)]; }
  std::int32_t end_of(std::int32_t segment) const {
    return segments_.upper_end[static_cast<std::size_t>(segment)];
  }

  // All places whose segments pass through `at`, given one of them: they are neighbors.
  template <class Place>
  Run run_through(std::int32_t place, const Place& at) {
    const auto holds = [&](std::int32_t other) {
      return other != none && side_of(segments_.segment(status_.segment(other)), at) == 0;
    };
    Run run{place, place};
    while (holds(status_.below(run.first))) run.first = status_.below(run.first);
    while (holds(status_.above(run.last))) run.last = status_.above(run.last);
    return run;
  }

  void record(std::int32_t segment, std::int32_t place) {
    if (result_.meetings.size() == most_meetings) throw TooManyCrossings();
    result_.meetings.push_back({segment, place});
  }

  void pass_crossing() {
    const Event event = events_.top();
    while (!events_.empty() && compare(events_.top().at, event.at) == 0) events_.pop();
    const auto number = static_cast<std::int32_t>(segments_.points.size() + result_.crossings.size());
    result_.crossings.push_back(event.at);
    const Run run = run_through(place_of_[static_cast<std::size_t>(event.segment)], event.at);
    passing_.clear();
    for (std::int32_t at = run.first;; at = status_.above(at)) {
      passing_.push_back(status_.segment(at));
      if (at == run.last) break;
    }
    for (std::int32_t at = run.first; !passing_.empty(); at = status_.above(at)) {  // from below: reversed
      record(passing_.back(), number);
      put(at, passing_.back());
      passing_.pop_back();
    }
    look_for_crossing(status_.below(run.first), run.first);
    look_for_crossing(run.last, status_.above(run.last));
    poll(0);
  }

  void pass_point(std::int32_t i) {
    const auto index = static_cast<std::size_t>(i);
    const std::int32_t begin = segments_.start[index], end = segments_.start[index + 1];
    std::int32_t at = none, below = none, above = none;
    if (ending_[index] != none) {
      at = place_of_[static_cast<std::size_t>(ending_[index])];
    } else {
      const SweepStatus::Found found =
          status_.find([&](std::int32_t segment) { return side_of(segments_.segment(segment), point(i)); });
      at = found.at;
      below = found.below;
      above = found.above;
    }
    if (at == none) {
      if (below != none) result_.below[index] = status_.segment(below);
      passing_.clear();
      insert_between(below, above, begin, end);
      return;
    }
    const Run run = run_through(at, point(i));
    below = status_.below(run.first);
    above = status_.above(run.last);
    replace_run(run, i, begin, end);
    insert_between(below, above, begin, end);
  }

  // Takes the segments through point i out of the status, but for places that are used again at once: the
  // list passing_ keeps those that go on, from the lowest slope, and reused_ the places from below.
  void replace_run(const Run& run, std::int32_t i, std::int32_t begin, std::int32_t end) {
    passing_.clear();
    reused_.clear();
    for (std::int32_t at = run.first;; at = status_.above(at)) {
      reused_.push_back(at);
      const std::int32_t segment = status_.segment(at);
      if (end_of(segment) != i) {
        record(segment, i);
        passing_.push_back(segment);
      }
      if (at == run.last) break;
    }
    std::reverse(passing_.begin(), passing_.end());
    const std::size_t wanted = passing_.size() + static_cast<std::size_t>(end - begin);
    while (reused_.size() > wanted) {
      status_.erase(reused_.back());
      reused_.pop_back();
    }
  }

  // Puts the segments passing_ and begin ... end - 1, all from one point, between two neighbors in the order
  // of their slopes: first into the places reused_.
  void insert_between(std::int32_t below, std::int32_t above, std::int32_t begin, std::int32_t end) {
    std::size_t used = 0, passed = 0;
    std::int32_t last = below;
    while (passed < passing_.size() || begin < end) {
      const bool takes_passing =
          begin == end || (passed < passing_.size() && !is_lower(begin, passing_[passed]));
      const std::int32_t segment = takes_passing ? passing_[passed++] : begin++;
      if (used < reused_.size()) {
        last = reused_[used++];
      } else {
        last = status_.insert(segment, last, above);
      }
      put(last, segment);
    }
    reused_.clear();
    if (last == below) {
      look_for_crossing(below, above);
      return;
    }
    look_for_crossing(below, below == none ? none : status_.above(below));
    look_for_crossing(last, above);
  }

  bool is_lower(std::int32_t s, std::int32_t t) const {
    const LatticeSegment a = segments_.segment(s), b = segments_.segment(t);
    const std::int64_t ax = std::int64_t{a.b.x} - a.a.x, ay = std::int64_t{a.b.y} - a.a.y;
    const std::int64_t bx = std::int64_t{b.b.x} - b.a.x, by = std::int64_t{b.b.y} - b.a.y;
    return ax * by - ay * bx > 0;
  }

  void put(std::int32_t place, std::int32_t segment) {
    status_.segment(place) = segment;
    place_of_[static_cast<std::size_t>(segment)] = place;
  }

  // Two neighbors cross further on if the one that ends first ends on the wrong side of the other. Where it
  // ends on the other, or both end together, that is found at the point.
  void look_for_crossing(std::int32_t lower, std::int32_t upper) {
    if (lower == none || upper == none) return;
    const std::int32_t s = status_.segment(lower), t = status_.segment(upper);
    const std::int32_t s_end = end_of(s), t_end = end_of(t);
    const bool crosses = s_end < t_end   ? side_of(segments_.segment(t), point(s_end)) > 0
                         : t_end < s_end ? side_of(segments_.segment(s), point(t_end)) < 0
                                         : false;
    if (crosses) events_.push({crossing_of(segments_.segment(s), segments_.segment(t)), s});
    if (events_.size() > 2 * most_meetings) throw TooManyCrossings();
  }

  const SortedSegments& segments_;
  const Monitor& monitor_;
  std::size_t events_passed_ = 0;
  SweepStatus status_;
  std::vector<std::int32_t> place_of_;  // of each segment in the status, while it is there
  std::vector<std::int32_t> ending_;    // a segment with each point as its upper end, or none
  std::priority_queue<Event> events_;
  std::vector<std::int32_t> passing_, reused_;
  SweepResult result_;
};

}  // namespace

SweepResult sweep_segments(const SortedSegments& segments, const Monitor& monitor) {
  return Sweep(segments, monitor).run();
}

}  // namespace vorotool::core::arrangement
