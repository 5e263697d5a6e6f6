// The predicates for the points of one set, whose extent bounds the roundings of all calls.
#pragma once

#include <cmath>
#include <span>

#include "core/numbers/sign.hpp"
#include "core/tetrahedra/predicates.hpp"
#include "core/tetrahedra/sphere_batch.hpp"

namespace vorotool::core::tetrahedra {

// A static filter comes first: a bound for all calls. Where it cannot tell, a bound from the differences of the call is
// next, which on integers (after move_to_integers) also tells whether the determinant is exact, zeros included.
class SetPredicates {
 public:
  explicit SetPredicates(std::span<const Point3> points);

  int orient(const Point3& a, const Point3& b, const Point3& c, const Point3& d) const {
    const double value = orient3d_determinant(differences(d, a, b, c));
    if (std::abs(value) > orient_bound_) return numbers::sign_of(value);
    return orient_exact_ ? 0 : orient3d(a, b, c, d);
  }

  // Whether a point is beyond facets of a positive tetrahedron: bit k, of those asked for, is that of the facet opposite
  // to corner k.
  unsigned beyond(const std::array<const Point3*, 4>& corners, const Point3& p, unsigned asked) const {
    const auto [a, b, c, d] = corners;
    const auto [bcd, cda, dab, abc] = cofactors(differences(p, *a, *b, *c, *d));
    unsigned found = 0, unsure = 0;
    for (unsigned k = 0; const double inside : {bcd, -cda, dab, -abc}) {  // without a branch
      found |= static_cast<unsigned>(inside < -orient_bound_) << k;
      unsure |= static_cast<unsigned>(!(std::abs(inside) > orient_bound_)) << k++;
    }
    found &= asked, unsure &= asked;
    return unsure == 0 || orient_exact_ ? found : near_beyond(corners, p, found, unsure);
  }
  // The same where the filter cannot tell of some.
  static unsigned near_beyond(const std::array<const Point3*, 4>& corners, const Point3& p, unsigned found,
                              unsigned unsure);

  // With ties broken.
  int in_sphere(const Point3& a, const Point3& b, const Point3& c, const Point3& d, const Point3& e) const {
    const double value = in_sphere_determinant(differences(e, a, b, c, d));
    return std::abs(value) > sphere_bound_.all ? numbers::sign_of(value) : near_sphere({&a, &b, &c, &d, &e});
  }
  // The same where the static filter cannot tell.
  int near_sphere(const std::array<const Point3*, 5>& points) const;

  const SphereBound& sphere_bound() const { return sphere_bound_; }

 private:
  double orient_bound_;
  SphereBound sphere_bound_;
  bool orient_exact_ = false;  // what is within the bound is 0
};

}  // namespace vorotool::core::tetrahedra
