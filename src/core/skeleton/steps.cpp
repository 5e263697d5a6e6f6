#include "core/skeleton/steps.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "core/base/parallel.hpp"
#include "core/skeleton/arc_course.hpp"

namespace vorotool::core::skeleton {
namespace {

using kernel::Point;

constexpr std::size_t steps_a_piece = 4096;  // places, some milliseconds

// Operation by operation what SitePlaces.feet does.
Point foot(const std::array<Point, 2>& site, const Point& place) {
  const Point way{site[1].x - site[0].x, site[1].y - site[0].y};
  const double square = way.x * way.x + way.y * way.y;
  const double t = square > 0 ? ((place.x - site[0].x) * way.x + (place.y - site[0].y) * way.y) / square : 0;
  if (t > 1) return site[1];
  const double clipped = std::clamp(t, 0.0, 1.0);
  return {site[0].x + clipped * way.x, site[0].y + clipped * way.y};
}

class Walk {
 public:
  Walk(const SkeletonView& skeleton, std::span<const std::int64_t> first,
       std::span<const std::int64_t> counts, double every)
      : skeleton_(skeleton), first_(first), every_(every), until_(skeleton.arcs.size() + 1, 0.0) {
    for (std::size_t arc = 0; arc < skeleton.arcs.size(); ++arc) {
      until_[arc + 1] = until_[arc] + skeleton.length[arc];
    }
    start_.reserve(counts.size() + 1);
    start_.push_back(0);
    for (const std::int64_t count : counts) start_.push_back(start_.back() + static_cast<std::size_t>(count));
  }

  std::size_t count() const { return start_.back(); }

  void fill(std::size_t begin, std::size_t end, Steps& made) const {
    std::size_t branch =
        static_cast<std::size_t>(std::upper_bound(start_.begin(), start_.end(), begin) - start_.begin()) - 1;
    std::size_t arc = 0;
    std::optional<ArcCourse> course;
    for (std::size_t k = begin; k < end; ++k) {
      while (start_[branch + 1] <= k) ++branch;
      const double along = every_ * static_cast<double>(k - start_[branch]);
      const std::size_t found = arc_at(branch, along, arc);
      if (!course || found != arc) course.emplace(skeleton_, found);
      arc = found;
      const double walked = until_[arc] - until_[static_cast<std::size_t>(first_[branch])];
      const double u = course->at_length(std::clamp(along - walked, 0.0, skeleton_.length[arc]));
      const Point place = course->place(u);
      made.arc[k] = static_cast<std::int64_t>(arc);
      made.along[k] = along;
      made.place[k] = place;
      made.radius[k] = course->radius(u);
      for (const std::size_t hand : {0, 1}) {
        made.feet[k][hand] =
            foot(skeleton_.site_ends[static_cast<std::size_t>(skeleton_.sites[arc][hand])], place);
      }
    }
  }

 private:
  // The last arc of the branch that begins there or before; the one before is near.
  std::size_t arc_at(std::size_t branch, double along, std::size_t before) const {
    const std::size_t first = static_cast<std::size_t>(first_[branch]);
    const std::size_t end =
        branch + 1 < first_.size() ? static_cast<std::size_t>(first_[branch + 1]) : skeleton_.arcs.size();
    const double reached = until_[first] + along;
    std::size_t arc = std::clamp(before, first, end - 1);
    if (arc > first && until_[arc] > reached) arc = first;
    if (arc + 1 < end && until_[arc + 1] <= reached) {  // mostly the next one, else far away
      const auto from = until_.begin() + static_cast<std::ptrdiff_t>(arc + 1);
      const auto to = until_.begin() + static_cast<std::ptrdiff_t>(end);
      if (arc + 2 < end && until_[arc + 2] > reached) return arc + 1;
      arc = static_cast<std::size_t>(std::upper_bound(from, to, reached) - until_.begin()) - 1;
    }
    return arc;
  }

  const SkeletonView& skeleton_;
  std::span<const std::int64_t> first_;
  double every_;
  std::vector<double> until_;       // [a + 1] lengths of all arcs before
  std::vector<std::size_t> start_;  // [b + 1] of places
};

}  // namespace

Steps steps_along(const SkeletonView& skeleton, std::span<const std::int64_t> first,
                  std::span<const std::int64_t> counts, double every, unsigned threads,
                  const base::Monitor& monitor) {
  const Walk walk(skeleton, first, counts, every);
  const std::size_t count = walk.count();
  Steps made;
  made.arc.resize(count);
  made.along.resize(count);
  made.place.resize(count);
  made.radius.resize(count);
  made.feet.resize(count);
  base::for_pieces(count, steps_a_piece, threads, monitor,
                   [&](std::size_t, std::size_t begin, std::size_t end) { walk.fill(begin, end, made); });
  return made;
}

}  // namespace vorotool::core::skeleton
