#include "core/segment_voronoi/discs/certified_disc.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/numbers/int128.hpp"

namespace vorotool::core::segment_voronoi::discs {

using numbers::DoubleDouble;

namespace {

// One equation linearized: value + (nx, ny, nr) * (step) = 0.
struct Row {
  double nx, ny, nr;
  double value, error;  // of the value
};

// Sums and products of double-doubles have relative errors below 2^-103, roots and quotients below 2^-102
// (core/numbers/double_double.hpp). Differences of the center and a lattice point have no other error, being
// sums of two exact numbers; so each value below is wrong by a few times 2^-102 of the lengths that make it
// up.
constexpr double value_error = 0x1p-98;

DoubleDouble whole(std::int32_t value) { return DoubleDouble(static_cast<double>(value)); }

Row point_row(const DiscCondition& condition, const CertifiedDisc& disc) {
  const DoubleDouble dx = disc.x - whole(condition.a.x), dy = disc.y - whole(condition.a.y);
  const DoubleDouble distance = numbers::sqrt(dx * dx + dy * dy);
  const double d = distance.head;
  return {dx.head / d, dy.head / d, -1, (distance - disc.radius).head, value_error * (d + disc.radius.head)};
}

Row line_row(const DiscCondition& condition, const CertifiedDisc& disc) {
  // seen from the nearer end, so that little is lost in a long segment
  auto apart = [&](const kernel::LatticePoint& p) {
    return std::abs(disc.x.head - p.x) + std::abs(disc.y.head - p.y);
  };
  const bool across = condition.kind == DiscCondition::Kind::across;
  const kernel::LatticePoint& end =
      across || apart(condition.a) <= apart(condition.b) ? condition.a : condition.b;
  const kernel::LatticeVector u = condition.b - condition.a;
  const DoubleDouble ux(static_cast<double>(u.x)), uy(static_cast<double>(u.y));
  const DoubleDouble dx = disc.x - whole(end.x), dy = disc.y - whole(end.y);
  const DoubleDouble length = numbers::sqrt(DoubleDouble(numbers::int128{kernel::norm2(u)}));
  const double unit_x = ux.head / length.head, unit_y = uy.head / length.head;
  const double error = value_error * (std::abs(dx.head) + std::abs(dy.head) + disc.radius.head);
  if (across) return {unit_x, unit_y, 0, ((ux * dx + uy * dy) / length).head, error};
  const DoubleDouble height = (ux * dy - uy * dx) / length;
  const double side = height.head < 0 ? -1 : 1;
  return {-side * unit_y, side * unit_x, -1, (numbers::abs(height) - disc.radius).head, error};
}

Row row_of(const DiscCondition& condition, const CertifiedDisc& disc) {
  return condition.kind == DiscCondition::Kind::point ? point_row(condition, disc)
                                                      : line_row(condition, disc);
}

using Rows = std::array<Row, 3>;

struct Inverse {
  std::array<std::array<double, 3>, 3> entry;
  double norm;  // bounds the largest sum of absolute values in a row of the true inverse
};

// The entries of the rows have relative errors of at most 2^-49, the determinant of at most 2^-44 in absolute
// value: from 2^-34 on the inverse is right to 2^-8 or so.
std::optional<Inverse> invert(const Rows& rows) {
  const auto& [p, q, s] = rows;
  auto cofactors = [](const Row& a, const Row& b) {
    return std::array{a.ny * b.nr - a.nr * b.ny, a.nr * b.nx - a.nx * b.nr, a.nx * b.ny - a.ny * b.nx};
  };
  const std::array columns{cofactors(q, s), cofactors(s, p), cofactors(p, q)};
  const double determinant = p.nx * columns[0][0] + p.ny * columns[0][1] + p.nr * columns[0][2];
  if (!(std::abs(determinant) >= 0x1p-34)) return std::nullopt;
  Inverse inverse{{}, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    double sum = 0x1p-30;
    for (std::size_t j = 0; j < 3; ++j) {
      inverse.entry[i][j] = columns[j][i] / determinant;
      sum += std::abs(inverse.entry[i][j]);
    }
    inverse.norm = std::max(inverse.norm, 1.0625 * sum);
  }
  return inverse;
}

Rows rows_of(const std::array<DiscCondition, 3>& conditions, const CertifiedDisc& disc) {
  return {row_of(conditions[0], disc), row_of(conditions[1], disc), row_of(conditions[2], disc)};
}

double largest_value(const Rows& rows) {
  double largest = 0;
  for (const Row& row : rows) largest = std::max(largest, std::abs(row.value) + row.error);
  return largest;
}

void step(const Rows& rows, const Inverse& inverse, CertifiedDisc& disc) {
  std::array<double, 3> change{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) change[i] -= inverse.entry[i][j] * rows[j].value;
  }
  disc.x = disc.x + DoubleDouble(change[0]);
  disc.y = disc.y + DoubleDouble(change[1]);
  disc.radius = disc.radius + DoubleDouble(change[2]);
}

// Kantorovich's theorem (in the norm of the largest component): if |J^-1| <= beta and |J^-1 F| <= beta eps at
// a place, and J changes by at most kappa |step| with h = beta kappa beta eps <= 1/2, then F has a root
// within 2 beta eps, and no other within (1 + sqrt(1 - 2 h)) / (beta kappa). The gradient of a distance d
// changes by |step| sqrt(2) / d, its components' sum by at most 2 |step| / d; lines and fixed directions do
// not change. Within the radius asked for, d >= r / 2: kappa = 4 / r.
constexpr int most_steps = 5;

}  // namespace

std::optional<CertifiedDisc> certify_disc(const std::array<DiscCondition, 3>& conditions, double x, double y,
                                          double radius) {
  CertifiedDisc disc{DoubleDouble(x), DoubleDouble(y), DoubleDouble(radius), 0};
  if (!(radius > 0)) return std::nullopt;
  for (int i = 0; i < most_steps; ++i) {
    const Rows rows = rows_of(conditions, disc);
    const auto inverse = invert(rows);
    if (!inverse) return std::nullopt;
    const double eps = largest_value(rows), bound = inverse->norm * eps, r = disc.radius.head;
    disc.error = 2 * bound;
    const bool contracts = inverse->norm * bound * 4 / r <= 0.125;
    if (contracts && disc.error <= 0x1p-56 * r) return disc;
    step(rows, *inverse, disc);
    if (!(disc.radius.head > 0)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace vorotool::core::segment_voronoi::discs
