#include "core/pruning/critical_values.hpp"

#include <algorithm>
#include <limits>

#include "core/base/indices.hpp"
#include "core/graphs/pendant_trees.hpp"
#include "core/numbers/special_values.hpp"
#include "core/pruning/arc_profile.hpp"
#include "core/pruning/disc_enlargement.hpp"

namespace vorotool::core::pruning {

using base::at;
using base::Monitor;
using graphs::HangingArc;
using numbers::infinity;
using skeleton::SkeletonView;

namespace {

// The part that all criteria share: the trees, and where the values go.
class Pruner {
 public:
  Pruner(const SkeletonView& skeleton, const Monitor& monitor)
      : skeleton_(skeleton), monitor_(monitor), forest_(skeleton.arcs, skeleton.is_anchored) {
    values_.ends.assign(skeleton.arcs.size(), {infinity, infinity});
    values_.most.assign(skeleton.arcs.size(), infinity);
  }

  CriticalValues take() {
    std::sort(values_.kept.begin(), values_.kept.end(),
              [](const KeptPlace& a, const KeptPlace& b) { return a.arc < b.arc; });
    return std::move(values_);
  }

 protected:
  bool is_source(const HangingArc& hanging) const {
    return skeleton_.arcs[at(hanging.arc)][0] == hanging.outer;
  }
  const HangingArc& hanging(std::size_t k) const { return forest_.hanging()[k]; }
  std::size_t hanging_count() const { return forest_.hanging().size(); }

  void set(std::int32_t arc, double source, double target) {
    values_.ends[at(arc)] = {source, target};
    values_.most[at(arc)] = std::max(source, target);
  }

  // A component keeps a place on this arc, whatever the values at its ends are.
  void keep(std::int32_t arc, double parameter, double source, double target) {
    values_.ends[at(arc)] = {source, target};
    values_.most[at(arc)] = infinity;
    values_.kept.push_back({arc, parameter});
  }

  // Trees attached to an anchored end alone leave this end.
  void keep_lone_ends() {
    std::vector<bool> is_lone(skeleton_.vertices.size());
    for (const std::int32_t node : forest_.lone_ends()) is_lone[at(node)] = true;
    for (const auto& [arc, outer, inner] : forest_.hanging()) {
      if (!is_lone[at(inner)]) continue;
      is_lone[at(inner)] = false;  // one arc is enough, should there be more
      const auto [source, target] = values_.ends[at(arc)];
      keep(arc, skeleton_.arcs[at(arc)][0] == inner ? 0 : 1, source, target);
    }
  }

  void poll_at(std::size_t k, std::size_t count, double from, double to) const {
    constexpr std::size_t often = 1 << 14;  // arcs between two looks at the monitor: some milliseconds
    if (k % often == 0)
      base::report(monitor_, from + (to - from) * static_cast<double>(k) / static_cast<double>(count));
  }

  const SkeletonView& skeleton_;
  const Monitor& monitor_;
  graphs::PendantTrees forest_;
  CriticalValues values_;
};

// Angle and chord: a place is removed once all beyond it, and the place itself, have less than the threshold.
class LargestInPiece : public Pruner {
 public:
  using Measure = ArcProfile::Course (ArcProfile::*)() const;

  LargestInPiece(const SkeletonView& skeleton, const Monitor& monitor, Measure measure)
      : Pruner(skeleton, monitor), measure_(measure), courses_(skeleton.arcs.size()) {}

  void run() {
    find_kept_arcs();
    std::vector<double> beyond(skeleton_.vertices.size());  // most in what hangs on each node
    for (std::size_t k = 0; k < hanging_count(); ++k) {
      const auto [arc, outer, inner] = hanging(k);
      const ArcProfile::Course& course = courses_[at(arc)];
      const bool from_source = is_source(hanging(k));
      const double first = std::max(beyond[at(outer)], from_source ? course.at_source : course.at_target);
      const double last = std::max(beyond[at(outer)], course.most);
      from_source ? set(arc, first, last) : set(arc, last, first);
      if (kept_[at(forest_.tree(inner) + 1)] != arc) beyond[at(inner)] = std::max(beyond[at(inner)], last);
      poll_at(k, hanging_count(), 0.6, 1);
    }
    for (std::size_t tree = 1; tree < kept_.size(); ++tree) {
      const std::int32_t arc = kept_[tree];
      const ArcProfile::Course& course = courses_[at(arc)];
      const auto [source, target] = skeleton_.arcs[at(arc)];
      keep(arc, course.peak, std::max(beyond[at(source)], course.at_source),
           std::max(beyond[at(target)], course.at_target));
    }
    keep_lone_ends();
  }

 private:
  // The arc with most in each tree, of several that where the radius is largest.
  void find_kept_arcs() {
    kept_.assign(forest_.tree_count() + 1, -1);  // the first is for what is no tree
    std::vector<double> radius(kept_.size());
    for (std::size_t k = 0; k < hanging_count(); ++k) {
      const auto [arc, outer, inner] = hanging(k);
      const ArcProfile profile(skeleton_, at(arc));
      const ArcProfile::Course course = courses_[at(arc)] = (profile.*measure_)();
      poll_at(k, hanging_count(), 0, 0.6);
      const std::size_t tree = at(forest_.tree(inner) + 1);
      if (tree == 0) continue;
      const double own = profile.radius(course.peak);
      const double most = kept_[tree] < 0 ? -1 : courses_[at(kept_[tree])].most;
      if (course.most > most || (course.most == most && own > radius[tree])) {
        kept_[tree] = arc;
        radius[tree] = own;
      }
    }
    std::vector<std::int32_t> roots;
    for (std::size_t tree = 1; tree < kept_.size(); ++tree)
      roots.push_back(skeleton_.arcs[at(kept_[tree])][0]);
    forest_.set_roots(roots);
  }

  Measure measure_;
  std::vector<ArcProfile::Course> courses_;
  std::vector<std::int32_t> kept_;
};

// Length and ratio: by the longest path in a piece, where pieces hang on junctions and on the middle of a
// tree.
class LongestPath : public Pruner {
 public:
  LongestPath(const SkeletonView& skeleton, const Monitor& monitor, bool is_relative)
      : Pruner(skeleton, monitor), is_relative_(is_relative), value_(hanging_count()) {}

  void run() {
    find_middles();
    base::report(monitor_, 0.5);
    const std::vector<double> depth = depths();
    for (std::size_t k = hanging_count(); k-- > 0;) {
      const auto [arc, outer, inner] = hanging(k);
      const std::int32_t above = forest_.above(inner), tree = forest_.tree(inner);
      double value = above >= 0 ? value_[at(above)] : infinity;
      if (tree >= 0 && is_end(middles_[at(tree)].arc, inner)) value = middle_value(tree, depth);
      if (tree >= 0 && middles_[at(tree)].arc == arc) {
        value = middle_value(tree, depth);
      } else if (forest_.degree(inner) > 2) {
        const double path = depth[at(outer)] + skeleton_.length[at(arc)];
        value = std::min(value, is_relative_ ? path / skeleton_.radius[at(inner)] : path);
      }
      value_[k] = value;
      set(arc, value, value);
      poll_at(k, hanging_count(), 1, 0.5);
    }
    for (std::size_t tree = 0; tree < middles_.size(); ++tree) {
      const double value = middle_value(static_cast<std::int32_t>(tree), depth);
      keep(middles_[tree].arc, middles_[tree].parameter, value, value);
    }
  }

 private:
  struct Middle {
    std::int32_t arc = -1;
    double parameter = 0;
    double to_source = 0, to_target = 0;  // along the arc
  };

  bool is_end(std::int32_t arc, std::int32_t node) const {
    return skeleton_.arcs[at(arc)][0] == node || skeleton_.arcs[at(arc)][1] == node;
  }

  double middle_value(std::int32_t tree, const std::vector<double>& depth) const {
    const Middle& middle = middles_[at(tree)];
    const auto [source, target] = skeleton_.arcs[at(middle.arc)];
    const double path = std::max(depth[at(source)] + middle.to_source, depth[at(target)] + middle.to_target);
    return is_relative_ ? path / ArcProfile(skeleton_, at(middle.arc)).radius(middle.parameter) : path;
  }

  // The longest path from each node to a leaf that hangs on it; on the ends of a middle arc what lies beyond
  // the arc does not hang.
  std::vector<double> depths() const {
    std::vector<double> depth(skeleton_.vertices.size());
    for (std::size_t k = 0; k < hanging_count(); ++k) {
      const auto [arc, outer, inner] = hanging(k);
      const std::int32_t tree = forest_.tree(inner);
      if (tree >= 0 && arc == middles_[at(tree)].arc) continue;
      depth[at(inner)] = std::max(depth[at(inner)], depth[at(outer)] + skeleton_.length[at(arc)]);
    }
    return depth;
  }

  // Half-way along the longest path of each tree: the two deepest paths at some node, from there down the
  // deeper one.
  void find_middles() {
    struct Deep {
      double first = 0, second = 0;
      std::int32_t below = -1;  // in `hanging`: where the first is
    };
    std::vector<Deep> deep(skeleton_.vertices.size());
    std::vector<std::int32_t> top(forest_.tree_count(), -1);
    for (std::size_t k = 0; k < hanging_count(); ++k) {
      const auto [arc, outer, inner] = hanging(k);
      Deep& d = deep[at(inner)];
      const double path = deep[at(outer)].first + skeleton_.length[at(arc)];
      d.second = std::max(d.second, std::min(path, d.first));
      if (d.below < 0 || path > d.first) {
        d.first = path;
        d.below = static_cast<std::int32_t>(k);
      }
      const std::int32_t tree = forest_.tree(inner);
      if (tree < 0) continue;
      const std::int32_t best = top[at(tree)];
      if (best < 0 || d.first + d.second > deep[at(best)].first + deep[at(best)].second)
        top[at(tree)] = inner;
    }
    std::vector<std::int32_t> roots;
    for (const std::int32_t node : top) {
      double left = (deep[at(node)].first - deep[at(node)].second) / 2;
      std::int32_t k = deep[at(node)].below;
      while (left > skeleton_.length[at(hanging(at(k)).arc)] && deep[at(hanging(at(k)).outer)].below >= 0) {
        left -= skeleton_.length[at(hanging(at(k)).arc)];
        k = deep[at(hanging(at(k)).outer)].below;
      }
      middles_.push_back(middle_on(hanging(at(k)), left));
      roots.push_back(skeleton_.arcs[at(middles_.back().arc)][0]);
    }
    forest_.set_roots(roots);
  }

  // At a distance from the inner end.
  Middle middle_on(const HangingArc& hanging, double distance) const {
    const double length = skeleton_.length[at(hanging.arc)];
    distance = std::min(distance, length);
    const double from_source = is_source(hanging) ? length - distance : distance;
    const double parameter = ArcProfile(skeleton_, at(hanging.arc)).at_length(from_source);
    return {hanging.arc, parameter, from_source, length - from_source};
  }

  bool is_relative_;
  std::vector<double> value_;  // by place in `hanging`
  std::vector<Middle> middles_;
};

// Scale. Only nodes p count, and only nodes q of a piece. For a factor s let f(q) = |p - q| + s r(q) be less
// than s r(p) at the ends of an arc. Along a line, between lines or between points, |p - q| and r are convex,
// hence f is; along a parabola, by the parameter t of its tangent at the vertex, q'' is across that with
// |q''| = r'', so that |p - q|'' >= -r'', and f'' >= (s - 1) r'' >= 0 for s >= 1. So f is less inside too. As
// for p: that its neighbors in the piece do not hinder takes s |dr| >= |dp|, with r growing towards where
// the skeleton goes on; along an arc r'(p) grows with r, so that s r(p) - |p - q| does not decrease from
// there on, and the end of the arc is no worse than p.
//
// A place further out that needs less counts if that is less by 2^-26 of itself: along the teeth of a wedge
// all places need the same but for rounding, and telling them apart would mean to look at each pair.
class EnlargedDiscs : public Pruner {
 public:
  EnlargedDiscs(const SkeletonView& skeleton, const Monitor& monitor) : Pruner(skeleton, monitor) {}

  void run() {
    find_largest_discs();
    number_discs();
    base::report(monitor_, 0.2);
    const DiscEnlargement enlargement(discs(), rounding());
    base::report(monitor_, 0.4);
    using Need = DiscEnlargement::Need;
    std::vector<Need> least(hanging_count());
    for (std::size_t k = hanging_count(); k-- > 0;) {
      const auto [arc, outer, inner] = hanging(k);
      const std::int32_t above = forest_.above(inner);
      const Need best = above >= 0 ? least[at(above)] : Need{infinity, 0};
      const double enough = best.factor * (1 - 0x1p-26);
      const Need own = enlargement.factor(disc(inner), begin_[at(outer)], end_[at(outer)], enough, best.disc);
      least[k] = own.factor < enough ? own : Need{best.factor, own.disc};
      set(arc, least[k].factor, least[k].factor);
      poll_at(k, hanging_count(), 1, 0.4);
    }
    keep_roots();
    keep_lone_ends();
  }

 private:
  Disc disc(std::int32_t node) const {
    const kernel::Point& place = skeleton_.vertices[at(node)];
    return {place.x, place.y, skeleton_.radius[at(node)]};
  }

  void find_largest_discs() {
    roots_.assign(forest_.tree_count(), -1);
    for (std::size_t k = 0; k < skeleton_.vertices.size(); ++k) {
      const auto node = static_cast<std::int32_t>(k);
      const std::int32_t tree = forest_.tree(node);
      if (tree < 0) continue;
      std::int32_t& root = roots_[at(tree)];
      if (root < 0 || skeleton_.radius[k] > skeleton_.radius[at(root)]) root = node;
    }
    forest_.set_roots(roots_);
  }

  // So that what hangs beyond a node follows it.
  void number_discs() {
    std::vector<std::size_t> size(skeleton_.vertices.size(), 1);
    for (std::size_t k = 0; k < hanging_count(); ++k)
      size[at(hanging(k).inner)] += size[at(hanging(k).outer)];
    begin_.resize(size.size());
    end_.resize(size.size());
    constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::vector<std::size_t> next(size.size(), none);
    std::size_t count = 0;
    for (std::size_t k = hanging_count(); k-- > 0;) {
      const auto [arc, outer, inner] = hanging(k);
      if (next[at(inner)] == none) {  // a root, or a node of a core: it has no number itself
        next[at(inner)] = count;
        count += size[at(inner)] - 1;
      }
      begin_[at(outer)] = next[at(inner)];
      end_[at(outer)] = next[at(inner)] += size[at(outer)];
      next[at(outer)] = begin_[at(outer)] + 1;
    }
    disc_count_ = count;
  }

  std::vector<Disc> discs() const {
    std::vector<Disc> found(disc_count_, Disc{0, 0, 0});
    for (const auto& [arc, outer, inner] : forest_.hanging()) found[begin_[at(outer)]] = disc(outer);
    return found;
  }

  // Centers and radii are right to 32 ulp of the largest coordinate.
  double rounding() const { return 32 * std::numeric_limits<double>::epsilon() * skeleton_.reach; }

  // The root of a tree is on several arcs: on that which is removed last the place is kept.
  void keep_roots() {
    std::vector<std::int32_t> last(roots_.size(), -1);
    for (std::size_t k = hanging_count(); k-- > 0;) {
      const auto [arc, outer, inner] = hanging(k);
      if (forest_.above(inner) >= 0 || forest_.tree(inner) < 0) continue;
      std::int32_t& best = last[at(forest_.tree(inner))];
      if (best < 0 || values_.most[at(arc)] > values_.most[at(best)]) best = arc;
    }
    for (std::size_t tree = 0; tree < last.size(); ++tree) {
      const auto [source, target] = values_.ends[at(last[tree])];
      keep(last[tree], skeleton_.arcs[at(last[tree])][0] == roots_[tree] ? 0 : 1, source, target);
    }
  }

  std::vector<std::int32_t> roots_;
  std::vector<std::size_t> begin_, end_;  // of the discs from a node on
  std::size_t disc_count_ = 0;
};

}  // namespace

CriticalValues critical_values(const SkeletonView& skeleton, Criterion criterion, const Monitor& monitor) {
  base::report(monitor, 0);
  if (criterion == Criterion::scale) {
    EnlargedDiscs pruner(skeleton, monitor);
    pruner.run();
    return pruner.take();
  }
  if (criterion == Criterion::length || criterion == Criterion::ratio) {
    LongestPath pruner(skeleton, monitor, criterion == Criterion::ratio);
    pruner.run();
    return pruner.take();
  }
  const bool is_angle = criterion == Criterion::angle;
  LargestInPiece pruner(skeleton, monitor, is_angle ? &ArcProfile::angle : &ArcProfile::chord);
  pruner.run();
  return pruner.take();
}

}  // namespace vorotool::core::pruning
