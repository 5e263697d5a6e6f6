#include "core/segment_voronoi/discs/dyadic_disc.hpp"

#include <cmath>

#include "core/numbers/sign.hpp"

namespace vorotool::core::segment_voronoi::discs {

using kernel::LatticeVector;
using numbers::int128;

namespace {

constexpr std::int64_t scale = 4;
// |coordinates| of a center in units: with those of a lattice point they differ by less than 2^32, 2^34 in
// quarters.
constexpr double most_coordinate = 0x1p31;
// Squares of distances along with squares of lengths, and squares of products, are below 2^126.
constexpr int128 most_square = int128{1} << 63;
constexpr int128 most_product = int128{1} << 63;

int128 magnitude(int128 value) { return value < 0 ? -value : value; }

// Where a segment is seen from a center, in quarter units.
struct Sight {
  Sight(std::int64_t x, std::int64_t y, const SegmentSite& s) : direction(s.direction()) {
    const std::int64_t dx = x - scale * s.a.x, dy = y - scale * s.a.y;
    across = int128{direction.x} * dy - int128{direction.y} * dx;
    along = int128{direction.x} * dx + int128{direction.y} * dy;
  }
  int128 square_length() const { return kernel::dot(direction, direction); }
  bool is_between() const { return along > 0 && along < scale * square_length(); }

  LatticeVector direction;
  int128 across, along;  // times the length of the segment
};

}  // namespace

double DyadicDisc::x() const { return static_cast<double>(x_) / scale; }
double DyadicDisc::y() const { return static_cast<double>(y_) / scale; }
double DyadicDisc::radius() const { return std::sqrt(static_cast<double>(square_)) / scale; }

int128 DyadicDisc::square_distance(const kernel::LatticePoint& p) const {
  const int128 dx = x_ - scale * p.x, dy = y_ - scale * p.y;
  return dx * dx + dy * dy;
}

// The square of the distance from a site, rounded down: touches() is false if that was no integer. A corner
// of radius 0 is not meant here.
bool DyadicDisc::take_radius(const SegmentSites& sites, SiteIndex site) {
  if (sites.is_point(site)) {
    square_ = square_distance(sites.point(site));
  } else {
    const Sight sight(x_, y_, sites.segment(site));
    if (magnitude(sight.across) >= most_product) return false;
    square_ = sight.across * sight.across / sight.square_length();
  }
  return square_ > 0 && square_ < most_square;
}

bool DyadicDisc::touches(const SegmentSites& sites, SiteIndex site, bool is_left) const {
  if (sites.is_point(site)) return square_distance(sites.point(site)) == square_;
  const Sight sight(x_, y_, sites.segment(site));
  return magnitude(sight.across) < most_product && (sight.across > 0) == is_left &&
         sight.across * sight.across == square_ * sight.square_length();
}

// The way from the center to where the disc touches a site, times a positive number: below 2^35.
LatticeVector DyadicDisc::contact(const SegmentSites& sites, SiteIndex site, bool is_left) const {
  if (sites.is_point(site)) {
    const kernel::LatticePoint& p = sites.point(site);
    return {scale * p.x - x_, scale * p.y - y_};
  }
  const LatticeVector normal = kernel::left_of(sites.segment(site).direction());
  return is_left ? -normal : normal;
}

// Whether the contacts follow each other counter-clockwise: of the angles between three directions, which sum
// up to 360 degrees then and to 720 else, two at least are under 180. Where a point and its own segment are
// touched, at one place, there is no other disc, and the order does not matter.
bool DyadicDisc::is_in_order(const SegmentSites& sites, const VoronoiRecord& v) const {
  std::array<LatticeVector, 3> way;
  for (int i = 0; i < 3; ++i) {
    const SiteIndex site = v.sites[static_cast<std::size_t>(i)];
    if (sites.is_end(v.sites[static_cast<std::size_t>(following(i))], site) ||
        sites.is_end(v.sites[static_cast<std::size_t>(preceding(i))], site)) {
      return true;
    }
    way[static_cast<std::size_t>(i)] = contact(sites, site, v.is_left(i));
  }
  const auto turns_left = [](const LatticeVector& a, const LatticeVector& b) {
    return int128{a.x} * b.y - int128{a.y} * b.x > 0;
  };
  return turns_left(way[0], way[1]) + turns_left(way[1], way[2]) + turns_left(way[2], way[0]) >= 2;
}

int DyadicDisc::sign(const SegmentSite& query) const {
  const Sight sight(x_, y_, query);
  if (!sight.is_between()) return 1;  // its ends are not inside; touching one of them is as good as clear
  if (magnitude(sight.across) >= most_product) return numbers::undecided;
  const int128 difference = sight.across * sight.across - square_ * sight.square_length();
  return (difference > 0) - (difference < 0);
}

std::optional<DyadicDisc> dyadic_disc(const SegmentSites& sites, const VoronoiRecord& v) {
  if (!(std::abs(v.x) < most_coordinate && std::abs(v.y) < most_coordinate)) return std::nullopt;
  const double x = std::nearbyint(scale * v.x), y = std::nearbyint(scale * v.y);
  const double away = std::abs(x - scale * v.x) + std::abs(y - scale * v.y);
  if (!(away <= scale * static_cast<double>(v.position_error))) return std::nullopt;
  DyadicDisc disc;
  disc.x_ = static_cast<std::int64_t>(x);
  disc.y_ = static_cast<std::int64_t>(y);
  if (!disc.take_radius(sites, v.sites[0])) return std::nullopt;
  for (int i = 0; i < 3; ++i) {
    if (!disc.touches(sites, v.sites[static_cast<std::size_t>(i)], v.is_left(i))) return std::nullopt;
  }
  if (!disc.is_in_order(sites, v)) return std::nullopt;
  return disc;
}

}  // namespace vorotool::core::segment_voronoi::discs
