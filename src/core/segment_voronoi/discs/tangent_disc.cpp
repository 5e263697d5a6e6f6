#include "core/segment_voronoi/discs/tangent_disc.hpp"

#include <algorithm>
#include <cmath>

#include "core/kernel/lattice.hpp"

// Lines carry the direction that has the disc on its left: u along the line, n = u turned left. Distances of
// lattice points from lines and the sines and cosines between lines come from exact integers K = d x w,
// X = d1 x d2, D = d1 . d2, divided by lengths, so that their relative errors are small however small they
// are; no formula below subtracts numbers of the same sign unless it says so.
//
// Errors are counted in roundings: (k) after a value means a relative error of at most k roundoff<Real>, to
// first order; products of errors are covered by rounding the counts up. Basic values: an integer converted
// (1), a length (1.5), a component of u (3), a product of two lengths (4), K / length (4).

namespace vorotool::core::segment_voronoi::discs {

using kernel::cross;
using kernel::dot;
using kernel::LatticePoint;
using kernel::LatticeVector;
using numbers::DoubleDouble;
using numbers::int128;

namespace {

template <class Real>
Real real(int128 value) {
  return Real(value);
}
template <>
double real<double>(int128 value) {
  return static_cast<double>(value);
}
template <class Real>
Real real(std::int64_t value) {
  return Real(int128{value});
}
template <>
double real<double>(std::int64_t value) {
  return static_cast<double>(value);
}

double rough(double value) { return value; }
double rough(const DoubleDouble& value) { return value.head; }

using std::sqrt;

template <class Real>
struct Line {
  std::array<SiteIndex, 2> ends;
  LatticePoint start, end;
  Real ux, uy, length;

  LatticeVector direction() const { return end - start; }
  std::int64_t side(const LatticePoint& p) const { return cross(direction(), p - start); }  // K
  Real distance(const LatticePoint& p) const { return real<Real>(side(p)) / length; }       // (4)
  bool ends_at(SiteIndex p) const { return ends[0] == p || ends[1] == p; }
};

Line<double> directed(const SegmentSite& s, double) { return {s.ends, s.a, s.b, s.ux, s.uy, s.length}; }

Line<DoubleDouble> directed(const SegmentSite& s, DoubleDouble) {
  const LatticeVector d = s.direction();
  const DoubleDouble length = numbers::sqrt(real<DoubleDouble>(dot(d, d)));
  return {s.ends, s.a, s.b, real<DoubleDouble>(d.x) / length, real<DoubleDouble>(d.y) / length, length};
}

template <class Real>
Line<Real> line_of(const SegmentSite& s, bool disc_is_left) {
  const Line<Real> line = directed(s, Real{});
  if (disc_is_left) return line;
  return {{line.ends[1], line.ends[0]}, line.end, line.start, -line.ux, -line.uy, line.length};
}

// Two lines: with the angle t from the first direction to the second, counter-clockwise in [0, 2 pi).
template <class Real>
struct Angle {
  std::int64_t X, D;
  Real ll;  // the product of the lengths (4)

  Angle(const Line<Real>& first, const Line<Real>& second)
      : X(cross(first.direction(), second.direction())),
        D(dot(first.direction(), second.direction())),
        ll(first.length * second.length) {}

  Real sine() const { return real<Real>(X) / ll; }  // (6)
  // sin(t / 2) >= 0 (8): 1 - cos t = sin^2 t / (1 + cos t) where the difference would cancel.
  Real half_sine() const {
    const Real d = real<Real>(D);
    if (D <= 0) return sqrt((ll - d) / (ll + ll));
    return real<Real>(X < 0 ? -X : X) / sqrt((ll + ll) * (ll + d));
  }
  // cos(t / 2), with its sign (8).
  Real half_cosine() const {
    const Real d = real<Real>(D);
    if (D > 0) {
      const Real size = sqrt((ll + d) / (ll + ll));
      return X < 0 ? -size : size;
    }
    return real<Real>(X) / sqrt((ll + ll) * (ll - d));
  }
};

template <class Real>
class Solver {
 public:
  using Disc = TangentDisc<Real>;

  Solver(const SegmentSites& sites, const std::array<SiteIndex, 3>& triple, std::uint8_t left)
      : sites_(sites), triple_(triple), left_(left) {}

  Disc solve() const {
    int points = 0, first_point = 0, first_segment = 0;
    for (int i = 2; i >= 0; --i) {
      const bool is_point = sites_.is_point(site(i));
      points += is_point;
      (is_point ? first_point : first_segment) = i;
    }
    if (points == 3) return circumscribed();
    if (points == 2) return two_points(first_segment);
    if (points == 1) return one_point(first_point);
    return three_lines();
  }

 private:
  static constexpr double u = roundoff<Real>;

  SiteIndex site(int i) const { return triple_[static_cast<std::size_t>(i % 3)]; }
  const LatticePoint& point(int i) const { return sites_.point(site(i)); }
  Line<Real> line(int i) const { return line_of<Real>(sites_.segment(site(i)), (left_ >> (i % 3) & 1) != 0); }

  // The numerators have 2 + 31 + 63 bits at most.
  Disc circumscribed() const {
    const int least = static_cast<int>(std::min_element(triple_.begin(), triple_.end()) - triple_.begin());
    const LatticePoint& a = point(least);
    const LatticeVector b = point(least + 1) - a, c = point(least + 2) - a;
    const int128 bb = dot(b, b), cc = dot(c, c);
    const Real area = real<Real>(2 * int128{cross(b, c)});  // (1)
    const Real x = real<Real>(c.y * bb - b.y * cc) / area;  // (3)
    const Real y = real<Real>(b.x * cc - c.x * bb) / area;  // (3)
    const Real r = sqrt(x * x + y * y);                     // (5)
    return {a, x, y, r, 4 * u * rough(r), 6 * u * rough(r)};
  }

  Disc two_points(int segment) const {
    const Line<Real> s = line(segment);
    const int p = segment + 1, q = segment + 2;
    if (s.ends_at(site(p))) return at_end(point(p), s, point(q));
    if (s.ends_at(site(q))) return at_end(point(q), s, point(p));
    return through_points(s, point(p), point(q));
  }

  Disc one_point(int p) const {
    const Line<Real> s = line(p + 1), t = line(p + 2);
    const bool at_s = s.ends_at(site(p)), at_t = t.ends_at(site(p));
    if (at_s && at_t) return {point(p), Real{}, Real{}, Real{}, 0, 0};  // the corner itself
    if (at_s) return at_end(point(p), s, t);
    if (at_t) return at_end(point(p), t, s);
    for (const SiteIndex end : s.ends) {
      if (t.ends_at(end)) return in_wedge(sites_.point(end), s, t, point(p));
    }
    return through_point(point(p), s, t);
  }

  // The center at distance t above p, an end of the line; t is known within k roundings.
  static Disc above_end(const LatticePoint& p, const Line<Real>& line, const Real& t, double k) {
    const double scale = u * rough(t);
    return {p, -(t * line.uy), t * line.ux, t, (k + 4) * scale, k * scale};
  }

  // Touches a line at its end p and goes through q: |w|^2 = 2 t (n . w), w = q - p.
  static Disc at_end(const LatticePoint& p, const Line<Real>& line, const LatticePoint& q) {
    const LatticeVector w = q - p;
    const Real t = real<Real>(dot(w, w)) * line.length / real<Real>(2 * int128{cross(line.direction(), w)});
    return above_end(p, line, t, 6);
  }

  // Touches a line at its end p, and another line at distance e = K / l' from p: e + t (n . n') = t, where n
  // . n' = D / (l l'). Lengths, which err most, come in as seldom as can be.
  static Disc at_end(const LatticePoint& p, const Line<Real>& line, const Line<Real>& other) {
    const std::int64_t D = dot(line.direction(), other.direction());
    const Real K = real<Real>(other.side(p)), d = real<Real>(D);
    if (D <= 0) return above_end(p, line, K / (other.length - d / line.length), 8);  // (6.5)
    const Real X = real<Real>(cross(line.direction(), other.direction()));
    const Real square = real<Real>(dot(line.direction(), line.direction()));
    const Real sum = square * other.length + line.length * d;  // l (l l' + D) (4.5)
    return above_end(p, line, K * sum / (X * X), 12);          // (10.5)
  }

  // Two points p, q at heights h <= h' above the line; (line, p, q) are counter-clockwise. The disc touches
  // the line at the foot of the nearer one plus y, with its radius (y^2 + h^2) / (2 h), and the same seen
  // from the farther one: a y^2 + 2 h b y = h (a h' + b^2), where (b, a) leads from the nearer to the
  // farther. The product of the roots has no difference in it, since a >= 0. Turning counter-clockwise, h b +
  // a y is negative if p is the nearer one, positive if it is the farther.
  static Disc through_points(const Line<Real>& line, const LatticePoint& p, const LatticePoint& q) {
    const bool p_is_near = line.side(p) <= line.side(q);
    const LatticePoint &near = p_is_near ? p : q, &far = p_is_near ? q : p;
    const LatticeVector w = far - near, d = line.direction();
    const Real h = line.distance(near), h_far = line.distance(far);
    const Real a = real<Real>(cross(d, w)) / line.length;                   // (4)
    Real b = real<Real>(dot(d, w)) / line.length;                           // (4)
    if (p_is_near) b = -b;                                                  // mirrored: h b + a y > 0
    const Real root = sqrt(real<Real>(dot(w, w))) * sqrt(h * h_far);        // (8)
    const Real y = rough(b) > 0 ? h * (h_far * a + b * b) / (root + h * b)  // (26)
                                : (root - h * b) / a;                       // (16)
    const Real r = (y * y + h * h) / (h + h);                               // (60)
    const Real rise = r - h;
    const Real along = p_is_near ? -y : y;
    // |y| <= r and h <= 2 r: u y (30 r), n (r - h) (60 + 8 + 10 r)
    return {near,
            along * line.ux - rise * line.uy,
            along * line.uy + rise * line.ux,
            r,
            110 * u * rough(r),
            60 * u * rough(r)};
  }

  // Two segments s, t that share an end o, and a point q between them: the center is r g, where g has
  // distance 1 from both lines and |g|^2 = G = 1 + cot^2 of half the angle between them. g . w = (e1 + e2) G
  // / 2 for w = q - o at distances e1, e2, and the discriminant of |r g - w| = r is G e1 e2. The small root
  // has q beyond the chord of its touching points, as seen from o; then (q, left side, right side) are
  // counter-clockwise.
  static Disc in_wedge(const LatticePoint& o, const Line<Real>& s, const Line<Real>& t,
                       const LatticePoint& q) {
    const Angle<Real> angle(s, t);
    const Real X = real<Real>(angle.X < 0 ? -angle.X : angle.X);
    // Seen from o, one of the lines runs outward and one inward: the cosine of the wedge is -D / ll.
    const Real cosine = -real<Real>(angle.D);
    const bool acute = angle.D <= 0;
    const Real tangent = acute ? X / (angle.ll + cosine) : (angle.ll - cosine) / X;  // of half the wedge (7)
    const Real square = tangent * tangent;                                           // (15)
    const Real G = Real(1.0) + Real(1.0) / square;                                   // (17)
    const Real e1 = s.distance(q), e2 = t.distance(q);
    const Real sum = (e1 + e2) * G * Real(0.5) + sqrt(G * (e1 * e2));  // (25)
    const LatticeVector w = q - o;
    const Real r = angle.X > 0 ? real<Real>(dot(w, w)) / sum : sum * square;  // (27), (41)
    return in_wedge_at(o, s, t, angle, acute, r, G);
  }

  // g is the sum of the outward directions over the sine of the wedge, or that of the normals over 1 -
  // cosine: the one that does not cancel. A component errs by 3 of each unit vector, 6 of the divisor and
  // 3: (12) |g|.
  static Disc in_wedge_at(const LatticePoint& o, const Line<Real>& s, const Line<Real>& t,
                          const Angle<Real>& angle, bool acute, const Real& r, const Real& G) {
    Real gx, gy;
    if (acute) {
      const Real scale = angle.ll / real<Real>(angle.X < 0 ? -angle.X : angle.X);
      const bool s_outward = s.start == o;
      gx = (s_outward ? s.ux - t.ux : t.ux - s.ux) * scale;
      gy = (s_outward ? s.uy - t.uy : t.uy - s.uy) * scale;
    } else {
      const Real scale = angle.ll / (angle.ll + real<Real>(angle.D));
      gx = -(s.uy + t.uy) * scale;
      gy = (s.ux + t.ux) * scale;
    }
    return {o, r * gx, r * gy, r, 64 * u * rough(r) * std::sqrt(rough(G)), 48 * u * rough(r)};
  }

  // A point p at distances e1, e2 from two lines whose directions differ by the angle t. In the frame of the
  // first line, (y, r) has r = (y^2 + e1^2) / (2 e1), and the distance from the second gives
  //   y = (-e1 cos(t / 2) +- sqrt(e1 e2)) / sin(t / 2),
  // plus if (p, first, second) are counter-clockwise; in the frame of the second line the same holds with
  // y -> -y. The line farther from p is the better base. The difference may cancel: the error is bounded by
  // the terms.
  static Disc through_point(const LatticePoint& p, const Line<Real>& s, const Line<Real>& t) {
    const Angle<Real> angle(s, t);
    const Real sine = angle.half_sine(), cosine = angle.half_cosine();
    const Real e1 = s.distance(p), e2 = t.distance(p);
    const bool first = rough(e1) >= rough(e2);
    const Line<Real>& base = first ? s : t;
    const Real& e = first ? e1 : e2;
    const Real swing = e * cosine, root = sqrt(e1 * e2);  // (13), (5.5)
    Real y = (root - swing) / sine;                       // terms (14), quotient (9)
    if (!first) y = -y;
    const Real r = (y * y + e * e) / (e + e);
    const Real rise = r - e;
    const double y_error = 24 * u * (std::abs(rough(swing)) + rough(root)) / rough(sine);
    // r moves by y / e times the error of y, and by 12 roundings
    const double r_error = std::abs(rough(y)) / rough(e) * y_error + 12 * u * rough(r);
    const double size = std::abs(rough(y)) + rough(r) + rough(e);
    return {p, y * base.ux - rise * base.uy,      y * base.uy + rise * base.ux,
            r, y_error + r_error + 12 * u * size, r_error};
  }

  // Where the anchor of three lines is: an end of line k.
  struct Anchor {
    LatticePoint place;
    int k = 0;
    double terms = std::numeric_limits<double>::infinity();
  };

  // h_i + n_i . x = r for the distances h_i of the anchor: multiplied by the sines s_jk of the opposite
  // pairs, r (s_12 + s_23 + s_31) = h_1 s_23 + h_2 s_31 + h_3 s_12, and the sum of sines is four times the
  // product of the half sines (25). Of the six ends the one with the smallest terms is taken; its own h is
  // zero, and that of a second line if they share it.
  Disc three_lines() const {
    const int least = static_cast<int>(std::min_element(triple_.begin(), triple_.end()) - triple_.begin());
    const std::array<Line<Real>, 3> lines{line(least), line(least + 1), line(least + 2)};
    const std::array<Angle<Real>, 3> angles{Angle<Real>(lines[1], lines[2]), Angle<Real>(lines[2], lines[0]),
                                            Angle<Real>(lines[0], lines[1])};  // opposite to each line
    const Anchor anchor = best_anchor(lines, angles);
    const auto [i, j, k] = std::array<std::size_t, 3>{static_cast<std::size_t>((anchor.k + 1) % 3),
                                                      static_cast<std::size_t>((anchor.k + 2) % 3),
                                                      static_cast<std::size_t>(anchor.k)};
    const std::array<Real, 3> half{angles[0].half_sine(), angles[1].half_sine(), angles[2].half_sine()};
    const Real h_i = lines[i].distance(anchor.place), h_j = lines[j].distance(anchor.place);
    const Real det = Real(4.0) * half[0] * half[1] * half[2];                // (26)
    const Real r = (h_i * angles[i].sine() + h_j * angles[j].sine()) / det;  // (12 + 27) of the terms
    const double r_error = 40 * u * anchor.terms / rough(det);
    const Foot by_i = foot(h_i, angles[j], half[j], r, r_error, true);
    const Foot by_j = foot(h_j, angles[i], half[i], r, r_error, false);
    const Foot& best = by_i.error <= by_j.error ? by_i : by_j;
    const Line<Real>& base = lines[k];
    return {anchor.place,
            best.y * base.ux - r * base.uy,
            best.y * base.uy + r * base.ux,
            r,
            best.error + r_error + 4 * u * (std::abs(rough(best.y)) + rough(r)),
            r_error};
  }

  static Anchor best_anchor(const std::array<Line<Real>, 3>& lines,
                            const std::array<Angle<Real>, 3>& angles) {
    Anchor best;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>((k + 1) % 3), j = static_cast<std::size_t>((k + 2) % 3);
      const double s_i = std::abs(rough(angles[i].sine())), s_j = std::abs(rough(angles[j].sine()));
      const double l_i = rough(lines[i].length), l_j = rough(lines[j].length);
      for (const LatticePoint& end :
           {lines[static_cast<std::size_t>(k)].start, lines[static_cast<std::size_t>(k)].end}) {
        const double terms = std::abs(static_cast<double>(lines[i].side(end))) / l_i * s_i +
                             std::abs(static_cast<double>(lines[j].side(end))) / l_j * s_j;
        if (terms < best.terms) best = {end, k, terms};
      }
    }
    return best;
  }

  // Where the disc touches line k, from its anchor on; the error of that.
  struct Foot {
    Real y;
    double error;
  };

  // From the distance h to another line: h + (n' . u) y + (n' . n) r = r. With the half sine of the angle
  // between the lines 1 - n' . n = 2 half^2 (18); n' . u is the sine from the other line to line k.
  static Foot foot(const Real& h, const Angle<Real>& angle, const Real& half, const Real& r, double r_error,
                   bool from_k) {
    const Real sine = from_k ? -angle.sine() : angle.sine();
    const Real gap = Real(2.0) * half * half;
    const Real y = (r * gap - h) / sine;
    const double error =
        (4 * u * std::abs(rough(h)) + rough(gap) * (r_error + 20 * u * rough(r))) / std::abs(rough(sine)) +
        8 * u * std::abs(rough(y));
    return {y, error};
  }

  const SegmentSites& sites_;
  const std::array<SiteIndex, 3>& triple_;
  std::uint8_t left_;
};

}  // namespace

template <class Real>
TangentDisc<Real> tangent_disc(const SegmentSites& sites, std::array<SiteIndex, 3> triple,
                               std::uint8_t left) {
  return Solver<Real>(sites, triple, left).solve();
}

template TangentDisc<double> tangent_disc(const SegmentSites&, std::array<SiteIndex, 3>, std::uint8_t);
template TangentDisc<DoubleDouble> tangent_disc(const SegmentSites&, std::array<SiteIndex, 3>, std::uint8_t);

}  // namespace vorotool::core::segment_voronoi::discs
