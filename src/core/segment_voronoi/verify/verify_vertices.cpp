#include "core/segment_voronoi/verify/verify_vertices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>
#include <vector>

#include "core/kernel/lattice.hpp"
#include "core/numbers/int128.hpp"
#include "core/segment_voronoi/discs/certified_disc.hpp"
#include "core/segment_voronoi/discs/contact_order.hpp"
#include "core/segment_voronoi/discs/exact_signs.hpp"
#include "core/segment_voronoi/verify/verify_segment_voronoi.hpp"

namespace vorotool::core::segment_voronoi::verify {

using base::Fault;
using build::DiagramView;
using build::IncidentSegments;
using discs::DiscCondition;
using discs::ExactDisc;
using discs::touches;
using kernel::LatticePoint;
using kernel::LatticeSite;
using kernel::LatticeVector;
using kernel::norm2;
using numbers::DoubleDouble;
using numbers::int128;

namespace {

using Site = std::int32_t;

std::string number_text(double value) {
  std::array<char, 32> buffer;
  std::snprintf(buffer.data(), buffer.size(), "%.17g", value);
  return buffer.data();
}

// A length along a circle of radius 1, as it were: grows from 0 to 4 with the angle, continuously.
double diamond_angle(double x, double y) {
  const double t = y / (std::abs(x) + std::abs(y));
  if (x >= 0) return y >= 0 ? t : 4 + t;
  return 2 - t;
}

class Vertex {
 public:
  Vertex(const DiagramView& arrays, const IncidentSegments& incident, const ClosedSites* index,
         std::size_t vertex)
      : in_(arrays), incident_(incident), index_(index), vertex_(vertex), ring_(arrays.ring(vertex)) {
    if (ring_.size() > 16) {
      sorted_.assign(ring_.begin(), ring_.end());
      std::sort(sorted_.begin(), sorted_.end());
    }
  }

  ExactDisc exact_disc() {
    if (in_.radius[vertex_] == 0)
      return {std::make_shared<numbers::SqrtTower>(), in_.point(corner()), 0, 0, 1, 0};
    choose_base();
    return *exact();
  }

  Fault check() {
    if (in_.radius[vertex_] == 0) return check_corner();
    if (!(in_.radius[vertex_] > 0)) return fault("has the radius " + number_text(in_.radius[vertex_]));
    for (const auto step : {&Vertex::choose_base, &Vertex::locate, &Vertex::check_values, &Vertex::check_feet,
                            &Vertex::check_order, &Vertex::check_further_sites, &Vertex::check_others}) {
      if (Fault found = (this->*step)()) return found;
    }
    return {};
  }

 private:
  // A contact with the circle: where, as a diamond angle; at an end of a segment also which end, and where
  // the segment goes on.
  struct Contact {
    double angle;
    Site end;
    int turn;
  };

  Fault fault(const std::string& what) const {
    std::string sites;
    for (std::size_t i = 0; i < std::min<std::size_t>(ring_.size(), 8); ++i) {
      sites += (i == 0 ? "" : ", ") + std::to_string(ring_[i]);
    }
    if (ring_.size() > 8) sites += ", ...";
    return "vertex " + std::to_string(vertex_) + " of sites " + sites + " " + what;
  }

  bool in_ring(Site site) const {
    if (sorted_.empty()) return std::find(ring_.begin(), ring_.end(), site) != ring_.end();
    return std::binary_search(sorted_.begin(), sorted_.end(), site);
  }

  // The end at which the disc touches a segment of the ring, as that end is in the ring too; else -1.
  Site end_in_ring(Site site) const {
    if (in_.is_point(site)) return -1;
    for (const Site end : in_.ends(site)) {
      if (in_ring(end)) return end;
    }
    return -1;
  }

  // Corners.

  // The point in the ring, or the end that the first two segments share.
  Site corner() const {
    for (const Site site : ring_.first(2)) {
      if (in_.is_point(site)) return site;
    }
    const auto& ends = in_.ends(ring_[0]);
    return in_.is_end(ends[0], ring_[1]) ? ends[0] : ends[1];
  }

  Fault check_corner() const {
    const Site point = corner();
    const std::vector<Site> right = incident_.corner_ring(point);
    if (!std::ranges::equal(ring_, right))
      return fault("has radius 0, but these are not the cells at one corner");
    const LatticePoint& p = in_.point(point);
    if (in_.vertices[vertex_].x == p.x && in_.vertices[vertex_].y == p.y) return {};
    return fault("has radius 0, but is not at point " + std::to_string(point));
  }

  // The disc.

  // Three sites that determine the disc, in the order of the ring: not a segment whose end is in the ring, as
  // it touches at no place of its own; but where needed with that end.
  Fault choose_base() {
    std::vector<std::size_t> free, tied;
    for (std::size_t i = 0; i < ring_.size(); ++i) (end_in_ring(ring_[i]) < 0 ? free : tied).push_back(i);
    if (free.size() >= 3) {
      base_ = {free[0], free[free.size() / 3], free[2 * free.size() / 3]};
    } else if (free.size() == 2) {
      base_ = {free[0], free[1], tied[0]};
      std::sort(base_.begin(), base_.end());
    } else {
      return fault("touches too few places for a disc");
    }
    for (std::size_t i = 0; i < 3; ++i) base_sites_[i] = in_.site(ring_[base_[i]]);
    return {};
  }

  DiscCondition condition(std::size_t place) const {
    const Site site = ring_[place];
    const LatticeSite where = in_.site(site);
    const Site end = end_in_ring(site);
    if (where.is_point()) return {DiscCondition::Kind::point, where.a, where.a};
    if (end < 0) return {DiscCondition::Kind::tangent, where.a, where.b};
    const LatticePoint& p = in_.point(end);
    return {DiscCondition::Kind::across, p, p == where.a ? where.b : where.a};
  }

  const ExactDisc* exact() {
    if (!exact_tried_) exact_ = discs::find_exact_disc(base_sites_);
    exact_tried_ = true;
    return exact_ ? &*exact_ : nullptr;
  }

  // Which of the discs tangent to the base the certified one is, is settled by the order of its contacts and
  // by their feet; the exact one is right from the start.
  Fault locate() {
    const double x = in_.vertices[vertex_].x, y = in_.vertices[vertex_].y, r = in_.radius[vertex_];
    const auto found =
        discs::certify_disc({condition(base_[0]), condition(base_[1]), condition(base_[2])}, x, y, r);
    if (found) {
      disc_ = *found;
      return {};
    }
    if (exact() == nullptr || exact()->z.sign() == 0) {
      return fault("is no center of a disc: none touches three of the sites in this order");
    }
    const discs::RoundedDisc rounded_disc = discs::rounded(*exact());
    disc_ = {rounded_disc.x, rounded_disc.y, rounded_disc.radius,
             0x1p-51 * std::max({std::abs(rounded_disc.x), std::abs(rounded_disc.y), rounded_disc.radius})};
    return {};
  }

  Fault check_values() {
    const double x = in_.vertices[vertex_].x, y = in_.vertices[vertex_].y, r = in_.radius[vertex_];
    const double r_bound = value_error_bound * disc_.radius.head;
    const double bound = std::max(
        {r_bound, value_error_bound * std::abs(disc_.x.head), value_error_bound * std::abs(disc_.y.head)});
    auto apart = [](double value, const DoubleDouble& right) {
      return std::abs((DoubleDouble(value) - right).head);
    };
    if (apart(x, disc_.x) <= bound && apart(y, disc_.y) <= bound && apart(r, disc_.radius) <= r_bound)
      return {};
    return fault("is (" + number_text(x) + ", " + number_text(y) + "), radius " + number_text(r) + ", but (" +
                 number_text(disc_.x.head) + ", " + number_text(disc_.y.head) + "), radius " +
                 number_text(disc_.radius.head) + " would be right");
  }

  // The sites of the ring.

  struct Way {
    double x, y, length;
  };

  // From a lattice point to the center: the roundings of a double, and the error of the disc.
  Way way_from(const LatticePoint& p) const {
    const double x = (disc_.x - DoubleDouble(static_cast<double>(p.x))).head,
                 y = (disc_.y - DoubleDouble(static_cast<double>(p.y))).head;
    return {x, y, std::sqrt(x * x + y * y)};
  }

  // Bounds the errors of distances and of places along a segment that are computed from such ways: a few
  // roundings of products, 2^-50 or so.
  double tolerance(double length) const { return 0x1p-47 * (length + disc_.radius.head) + 4 * disc_.error; }

  // Where a foot is: how far inside a segment, seen from either end.
  struct Foot {
    double from_a, from_b, height, a_tolerance, b_tolerance, height_tolerance;

    bool inside() const { return from_a > a_tolerance && from_b > b_tolerance; }
    bool before_a() const { return from_a < -a_tolerance; }
    bool beyond_b() const { return from_b < -b_tolerance; }
  };

  Foot foot_on(const LatticeSite& s) const {
    const auto ux = static_cast<double>((s.b - s.a).x), uy = static_cast<double>((s.b - s.a).y);
    const double length = std::sqrt(ux * ux + uy * uy);
    const Way a = way_from(s.a), b = way_from(s.b);
    const Way& nearer = a.length < b.length ? a : b;
    return {(ux * a.x + uy * a.y) / length,
            -(ux * b.x + uy * b.y) / length,
            (ux * nearer.y - uy * nearer.x) / length,
            tolerance(a.length),
            tolerance(b.length),
            tolerance(nearer.length)};
  }

  Fault check_feet() {
    for (const Site site : ring_) {
      if (in_.is_point(site) || end_in_ring(site) >= 0) continue;
      const Foot foot = foot_on(in_.site(site));
      if (foot.inside()) continue;
      if (foot.before_a() || foot.beyond_b() || exact() == nullptr || !touches(*exact(), in_.site(site))) {
        return fault("does not touch segment site " + std::to_string(site) + ": the foot is not on it");
      }
      // a foot at an end: then the end is touched as well, and not in the ring
      for (const Site end : in_.ends(site)) {
        if (touches(*exact(), in_.site(end))) return fault("touches site " + std::to_string(end) + " too");
      }
    }
    return {};
  }

  Contact contact_of(Site site) const {
    const Site end = in_.is_point(site) ? site : end_in_ring(site);
    if (end < 0) {
      const LatticeSite s = in_.site(site);
      const double side = foot_on(s).height > 0 ? 1 : -1;
      const LatticeVector u = s.b - s.a;
      return {diamond_angle(side * static_cast<double>(u.y), -side * static_cast<double>(u.x)), -1, 0};
    }
    const Way way = way_from(in_.point(end));
    Contact contact{diamond_angle(-way.x, -way.y), end, 0};
    if (site != end) {
      const LatticeSite s = in_.site(site);
      const LatticeVector u = in_.point(end) == s.a ? s.b - s.a : s.a - s.b;
      contact.turn = static_cast<double>(u.x) * way.y - static_cast<double>(u.y) * way.x > 0 ? 1 : -1;
    }
    return contact;
  }

  // The contacts go round once. A way of length r or so has a relative error of 2^-50 and that of the disc;
  // diamond angles change by at most sqrt(2) times as much as angles.
  Fault check_order() {
    const double margin = 0x1p-46 + 8 * disc_.error / disc_.radius.head;
    double turned = 0;
    bool sure = margin < 0x1p-10;
    Contact before = contact_of(ring_.back());
    for (std::size_t i = 0; i < ring_.size() && sure; ++i) {
      const Contact next = contact_of(ring_[i]);
      double gap = next.angle - before.angle;
      if (gap < 0) gap += 4;
      if (next.end >= 0 && next.end == before.end) {
        gap = next.turn > before.turn ? 0 : 4;
      } else if (gap < margin || gap > 4 - margin) {
        sure = false;
      }
      turned += gap;
      before = next;
    }
    if (sure ? turned < 6 : exact_order()) return {};
    return fault("does not touch its sites in counter-clockwise order");
  }

  bool exact_order() {
    if (exact() == nullptr) return false;
    std::vector<LatticeSite> sites;
    for (const Site site : ring_) sites.push_back(in_.site(site));
    for (const LatticeSite& site : sites) {
      if (!touches(*exact(), site)) return false;
    }
    return discs::contacts_in_order(*exact(), sites);
  }

  Fault check_further_sites() {
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      if (std::find(base_.begin(), base_.end(), i) != base_.end()) continue;
      if (touches_with_base(ring_[i]) || touches_as_given(ring_[i])) continue;
      if (exact() == nullptr || !touches(*exact(), in_.site(ring_[i]))) {
        return fault("does not touch site " + std::to_string(ring_[i]));
      }
    }
    return {};
  }

  // A segment that is collinear with one of the base, at whose end the base is touched.
  bool touches_with_base(Site site) const {
    const Site end = end_in_ring(site);
    if (end < 0) return false;
    const LatticeSite s = in_.site(site);
    for (std::size_t i = 0; i < 3; ++i) {
      const Site other = ring_[base_[i]];
      if (in_.is_point(other) || end_in_ring(other) != end) continue;
      if (kernel::cross(s.b - s.a, base_sites_[i].b - base_sites_[i].a) == 0) return true;
    }
    return false;
  }

  // Whether the disc as given, a dyadic number of few bits, exactly touches the base and the site: then the
  // disc as given is the true one.
  bool touches_as_given(Site site) const {
    constexpr double unit = 0x1p10, limit = 0x1p31;
    const std::array<double, 3> given{in_.vertices[vertex_].x, in_.vertices[vertex_].y, in_.radius[vertex_]};
    std::array<std::int64_t, 3> whole;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(std::abs(given[i]) < limit) || std::rint(unit * given[i]) != unit * given[i]) return false;
      whole[i] = static_cast<std::int64_t>(unit * given[i]);
    }
    for (const LatticeSite& base : base_sites_) {
      if (!touches_exactly(whole, base)) return false;
    }
    return touches_exactly(whole, in_.site(site));
  }

  // Coordinates below 2^41 in units of 2^-10: products with a segment's direction, below 2^31, and squares
  // fit in 128 bits. A segment of irrational length is left to exact numbers.
  static bool touches_exactly(const std::array<std::int64_t, 3>& disc, const LatticeSite& s) {
    const int128 x = disc[0] - 1024 * std::int64_t{s.a.x}, y = disc[1] - 1024 * std::int64_t{s.a.y};
    const int128 r = disc[2];
    if (s.is_point()) return x * x + y * y == r * r;
    const LatticeVector u = s.b - s.a;
    const int128 along = x * u.x + y * u.y, height = x * u.y - y * u.x;
    const auto length = static_cast<std::int64_t>(std::llrint(std::sqrt(static_cast<double>(norm2(u)))));
    if (int128{length} * length != norm2(u)) return false;
    return along >= 0 && along <= int128{1024} * norm2(u) && (height == r * length || height == -r * length);
  }

  // All other sites.

  Fault check_others() {
    Fault found;
    const double reach = disc_.radius.head + 2 * tolerance(disc_.radius.head);
    index_->near(disc_.x.head, disc_.y.head, reach, [&](Site site) {
      found = in_.is_point(site) ? check_point(site) : check_segment(site);
      return !found;
    });
    return found;
  }

  Fault check_point(Site point) {
    if (in_ring(point)) return {};
    const Way way = way_from(in_.point(point));
    if (way.length - disc_.radius.head > tolerance(way.length)) return {};
    return check_exactly(point);
  }

  Fault check_exactly(Site site) {
    if (exact() == nullptr) return fault("is no center of a disc");
    const int sign = discs::clearance_sign(*exact(), in_.site(site));
    if (sign < 0) return fault("is nearer to site " + std::to_string(site) + " than its radius");
    if (sign > 0 || !touches(*exact(), in_.site(site))) return {};
    return fault("touches site " + std::to_string(site) + " too");
  }

  Fault check_segment(Site site) {
    const Foot foot = foot_on(in_.site(site));
    if (foot.before_a()) return check_point(in_.ends(site)[0]);
    if (foot.beyond_b()) return check_point(in_.ends(site)[1]);
    if (foot.inside()) {
      if (in_ring(site) || std::abs(foot.height) - disc_.radius.head > foot.height_tolerance) return {};
      return check_exactly(site);
    }
    for (const Site end : in_.ends(site)) {
      if (Fault found = check_point(end)) return found;
    }
    if (in_ring(site) || std::abs(foot.height) - disc_.radius.head > 2 * foot.height_tolerance) return {};
    return check_exactly(site);
  }

  const DiagramView& in_;
  const IncidentSegments& incident_;
  const ClosedSites* index_;  // null where others do not matter
  std::size_t vertex_;
  std::span<const Site> ring_;
  std::vector<Site> sorted_;  // the ring, if it is long

  std::array<std::size_t, 3> base_{};
  std::array<LatticeSite, 3> base_sites_{};
  discs::CertifiedDisc disc_{};
  bool exact_tried_ = false;
  std::optional<ExactDisc> exact_;
};

}  // namespace

Fault find_vertex_fault(const DiagramView& arrays, const IncidentSegments& incident, const ClosedSites& index,
                        std::size_t vertex) {
  return Vertex(arrays, incident, &index, vertex).check();
}

ExactDisc exact_disc_of(const DiagramView& arrays, const IncidentSegments& incident, std::size_t vertex) {
  return Vertex(arrays, incident, nullptr, vertex).exact_disc();
}

}  // namespace vorotool::core::segment_voronoi::verify
