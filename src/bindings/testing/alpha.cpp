// Critical radii of edges and triangles, and their exact comparison.
#include "core/alpha/critical_radius.hpp"

#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings/support/arrays.hpp"
#include "bindings/testing/rooms.hpp"

namespace vorotool::bindings::testing {
namespace {

namespace nb = nanobind;
using namespace nb::literals;

// Supports are rows of three points, or of two with the first one repeated.
core::alpha::Support support_of(const double* p) {
  const bool is_edge = p[0] == p[4] && p[1] == p[5];
  return {{p[0], p[1]}, {p[2], p[3]}, {p[4], p[5]}, !is_edge};
}

auto critical_radii(const Matrix<const double>& supports) {
  if (supports.shape(1) != 6) throw std::invalid_argument("supports must have six columns");
  std::vector<double> radii(supports.shape(0));
  for (std::size_t i = 0; i < radii.size(); ++i)
    radii[i] = core::alpha::critical_radius(support_of(supports.data() + 6 * i));
  return to_numpy(std::move(radii));
}

auto compare_radii(const Matrix<const double>& p, const Matrix<const double>& q) {
  if (p.shape(1) != 6 || q.shape(1) != 6 || p.shape(0) != q.shape(0)) {
    throw std::invalid_argument("supports must have six columns, as many of both");
  }
  std::vector<std::int8_t> signs(p.shape(0));
  for (std::size_t i = 0; i < signs.size(); ++i) {
    signs[i] = static_cast<std::int8_t>(
        core::alpha::compare_radii(support_of(p.data() + 6 * i), support_of(q.data() + 6 * i)));
  }
  return to_numpy(std::move(signs));
}

}  // namespace

void bind_alpha(nb::module_& room) {
  room.def("critical_radii", &critical_radii, "supports"_a,
           "Of rows of six: three points, or two and the first again for an edge.");
  room.def("compare_radii", &compare_radii, "p"_a, "q"_a, "Signs of the differences of rows as above.");
}

}  // namespace vorotool::bindings::testing
