#include "core/segment_voronoi/discs/contact_order.hpp"

#include <cstddef>
#include <utility>

#include "core/kernel/lattice.hpp"

namespace vorotool::core::segment_voronoi::discs {

using kernel::LatticeVector;
using numbers::RootNumber;

namespace {

// The way from the center to the contact, times some positive number; and at the end of a segment, whether it
// goes on counter-clockwise (1) or clockwise (-1).
struct Contact {
  RootNumber x, y;
  int turn;
};

Contact contact_of(const ExactDisc& disc, const kernel::LatticeSite& site) {
  const LatticeVector shift = disc.origin - site.a;
  const RootNumber x = disc.x + disc.w * RootNumber(shift.x), y = disc.y + disc.w * RootNumber(shift.y);
  if (site.is_point()) return {-x, -y, 0};
  const LatticeVector u = site.b - site.a, n = kernel::left_of(u);
  const RootNumber along = x * RootNumber(u.x) + y * RootNumber(u.y);
  const int side = (x * RootNumber(n.x) + y * RootNumber(n.y)).sign();  // of the line, where the center is
  const LatticeVector way = side > 0 ? -n : n;
  // the foot turns counter-clockwise along u if the center is to the left
  const int turn = along.sign() == 0                                             ? side
                   : (along - disc.w * RootNumber(kernel::norm2(u))).sign() == 0 ? -side
                                                                                 : 0;
  return {RootNumber(way.x), RootNumber(way.y), turn};
}

int turn_sign(const Contact& a, const Contact& b) { return (a.x * b.y - a.y * b.x).sign(); }

// Where a contact is, going counter-clockwise from the first: 0 there, 1 in the next half turn, 2 opposite, 3
// in the other half turn, 4 back at the first.
int quarter(const Contact& first, const Contact& contact) {
  const int turn = turn_sign(first, contact);
  if (turn != 0) return turn > 0 ? 1 : 3;
  if ((first.x * contact.x + first.y * contact.y).sign() < 0) return 2;
  return contact.turn > first.turn ? 0 : 4;
}

}  // namespace

bool contacts_in_order(const ExactDisc& disc, std::span<const kernel::LatticeSite> sites) {
  const Contact first = contact_of(disc, sites[0]);
  Contact before = first;
  int last = 0;
  for (std::size_t i = 1; i < sites.size(); ++i) {
    Contact next = contact_of(disc, sites[i]);
    const int place = quarter(first, next);
    if (place < last) return false;
    if (place == last) {
      const int turn = turn_sign(before, next);
      if (turn < 0 || (turn == 0 && next.turn <= before.turn)) return false;
    }
    before = std::move(next);
    last = place;
  }
  return true;
}

}  // namespace vorotool::core::segment_voronoi::discs
