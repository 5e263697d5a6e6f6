// Which discs centered on an arc of a skeleton cover a place, and where pixels lie that they alone may cover.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/kernel/point.hpp"
#include "core/pruning/arc_profile.hpp"
#include "core/skeleton/bisector_arc.hpp"
#include "core/skeleton/skeleton_view.hpp"

namespace vorotool::core::thickness {

// Numbers from first to last; none where last is smaller.
struct Interval {
  double first, last;
};

// The node with the larger radius is the upper one; of equal ones that with the larger number. So from each
// node arcs lead up to one that is no lower node, a summit.
inline bool is_upper(const skeleton::SkeletonView& skeleton, std::int32_t node, std::int32_t other) {
  const double r = skeleton.radius[static_cast<std::size_t>(node)];
  const double s = skeleton.radius[static_cast<std::size_t>(other)];
  return r > s || (r == s && node > other);
}

// Where the discs of an arc are that the disc of its upper node does not cover: the crescent.
//
// All of them touch both sites. Let the upper disc do so at a' and b', and the lower one at a and b. A disc
// between them and the upper one share what is beyond their radical axis, which both feet of the upper disc
// are above and both of the lower one below. So the crescent is in the quadrilateral a a' b' b, and beyond
// the chord a b in the lower disc.
class Crescent {
 public:
  Crescent() = default;
  // By `margin` it is made wider: what is rounded may be wrong by so much.
  Crescent(const skeleton::ArcEnd& upper, const skeleton::ArcEnd& lower,
           const std::array<std::array<kernel::Point, 2>, 2>& feet, double margin);

  Interval rows() const { return rows_; }
  Interval columns(double y) const;

 private:
  void add_row(double y);
  bool is_beyond(const kernel::Point& p) const { return dot(p, outwards_) >= chord_; }

  std::array<kernel::Point, 4> quadrilateral_;  // in order around it
  kernel::Point center_, outwards_;             // of the lower disc; across the chord
  double radius_, chord_;                       // products with `outwards_` are larger beyond the chord
  double margin_;
  Interval rows_;
};

// An arc between its two nodes.
class CoveringArc {
 public:
  // Discs cover what is farther from them than `slack`, by rounding.
  CoveringArc(const skeleton::SkeletonView& skeleton, std::size_t arc, double slack);

  const skeleton::ArcEnd& upper() const { return upper_; }
  const skeleton::ArcEnd& lower() const { return lower_; }
  Crescent crescent(double margin) const;

  // The largest radius of a disc that covers a place which the upper disc does not; negative if none does.
  double radius_over(const kernel::Point& place) const;

 private:
  using Kind = pruning::ArcProfile::Kind;
  using Site = std::array<kernel::Point, 2>;

  void set_parabola();
  void set_lines();
  double between_points(const kernel::Point& place) const;
  double on_parabola(const kernel::Point& place) const;
  double between_lines(const kernel::Point& place) const;
  double on_parabola_at(double x) const;
  bool lower_covers(const kernel::Point& place) const;

  skeleton::ArcEnd upper_, lower_;
  std::array<Site, 2> sites_;  // of a parabola the focus first
  Kind kind_;
  double size_;            // as ArcProfile has it, as are
  double from_, to_;       // x at the ends, the smaller first; between two lines lengths from the lower node
  kernel::Point along_{};  // the directrix, the focus to its left; or the arc, upwards
  kernel::Point inwards_[2]{};  // across both lines
  double growth_ = 0;           // of the radius along the arc between two lines, k
  double width_ = 1;            // 1 - k^2
  double slack_;
};

}  // namespace vorotool::core::thickness
