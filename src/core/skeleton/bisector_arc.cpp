#include "core/skeleton/bisector_arc.hpp"

#include <array>
#include <cmath>

namespace vorotool::core::skeleton {

using kernel::LatticeSite;
using kernel::Point;

namespace {

// log(z + sqrt(1 + z^2)) by basic operations only: they give the same bits on every machine, and a
// mathematical library does not. asinh(z) = 2 asinh(z / sqrt(2 (1 + sqrt(1 + z^2)))) brings |z| below 1/4,
// where the terms of z - z^3/6 + 3 z^5/40 - ... from the 15th on are below 2^-62 z.
double inverse_sinh(double z) {
  double factor = 1;
  while (std::abs(z) > 0.25) {
    z /= std::sqrt(2 * (1 + std::sqrt(1 + z * z)));
    factor *= 2;
  }
  double sum = 0, coefficient = 1;
  std::array<double, 14> terms;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto n = static_cast<double>(k);
    terms[k] = coefficient / (2 * n + 1);
    coefficient *= -(2 * n + 1) / (2 * n + 2);
  }
  for (std::size_t k = terms.size(); k-- > 0;) sum = sum * z * z + terms[k];
  return factor * z * sum;
}

Parabola parabola_of(const kernel::LatticePoint& focus, const LatticeSite& segment) {
  kernel::LatticeVector along = segment.b - segment.a;
  std::int64_t height = kernel::cross(along, focus - segment.a);
  if (height < 0) {
    along = -along;
    height = -height;
  }
  const double length = std::sqrt(static_cast<double>(kernel::norm2(along)));
  return {{static_cast<double>(focus.x), static_cast<double>(focus.y)},
          static_cast<double>(along.x) / length,
          static_cast<double>(along.y) / length,
          static_cast<double>(height) / length};
}

double squared(double value) { return value * value; }

}  // namespace

BisectorArc::BisectorArc(const LatticeSite& left, const LatticeSite& right)
    : is_parabola(left.is_point() != right.is_point()), parabola{} {
  if (!is_parabola) return;
  parabola = left.is_point() ? parabola_of(left.a, right) : parabola_of(right.a, left);
  is_parabola = parabola.h > 0;
}

double Parabola::parameter(const ArcEnd& end) const {
  const double x = end.place.x - focus.x, y = end.place.y - focus.y;
  const double t = ux * x + uy * y;
  // t^2 = h (2 r - h): r is wrong by an ulp or so, which moves t by about h r ulp / |t|.
  if (h * end.radius >= std::abs(t) * (std::abs(end.place.x) + std::abs(end.place.y))) return t;
  return std::copysign(std::sqrt(std::fmax(0.0, h * (2 * end.radius - h))), t);
}

Point Parabola::place(double t) const {
  const double n = radius(t) - h;  // from the focus, away from the directrix
  return {focus.x + (t * ux - n * uy), focus.y + (t * uy + n * ux)};
}

// Along the directrix it is half-way. Across, the parabola's chord is half-way too, and the control point is
// (t1 - t0)^2 / (4 h) below that: a small difference for a short arc.
Point control_point(const Parabola& p, const ArcEnd& source, const ArcEnd& target) {
  const double below = squared(p.parameter(target) - p.parameter(source)) / (4 * p.h);
  return {(source.place.x + target.place.x) / 2 + below * p.uy,
          (source.place.y + target.place.y) / 2 - below * p.ux};
}

double arc_length(const Parabola& p, const ArcEnd& source, const ArcEnd& target) {
  return arc_length(p.h, p.parameter(source), p.parameter(target));
}

// With s = t / h the length is h times the integral of sqrt(1 + s^2), h/2 [s w + asinh s] with w = sqrt(1 +
// s^2). Both differences are written as (s1 - s0) times sums of positive numbers.
double arc_length(double h, double from, double to) {
  const double s0 = from / h, s1 = to / h;
  const double w0 = std::sqrt(1 + s0 * s0), w1 = std::sqrt(1 + s1 * s1);
  const double products = (w0 + w1) / 2 + squared(s0 + s1) / (2 * (w0 + w1));
  const double same = s0 * s1;
  const double outer = same > 0 ? (1 + s0 * s0 + s1 * s1) / (w0 * w1 + same) : w0 * w1 - same;
  const double step = std::abs(s1 - s0);
  return h / 2 * (step * products + inverse_sinh(step * (1 + outer) / (w0 + w1)));
}

double distance_to(const LatticeSite& site, const Point& place) {
  const double x = place.x - site.a.x, y = place.y - site.a.y;
  if (site.is_point()) return std::sqrt(x * x + y * y);
  const kernel::LatticeVector along = site.b - site.a;
  const double ux = static_cast<double>(along.x), uy = static_cast<double>(along.y);
  return std::abs(ux * y - uy * x) / std::sqrt(static_cast<double>(kernel::norm2(along)));
}

}  // namespace vorotool::core::skeleton
