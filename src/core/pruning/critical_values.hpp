// The critical value of every place of a skeleton: the threshold above which pruning removes it.
//
// Pieces hang on a place p: the arcs beyond it, seen from where the skeleton goes on. A criterion gives each
// piece a value, and a place q is removed for a threshold above the smallest value of the pieces that hold
// it: so what is left for a higher threshold is a part of what is left for a lower one, and no order of
// peeling is chosen.
//   angle   the largest angle between the two feet in the piece (Attali and Montanvert 1996; Foskey, Lin and
//           Manocha 2003), here the tangent of half of it
//   chord   the largest distance between the two feet in the piece (Malandain and Fernandez-Vidal 1998)
//   scale   the smallest factor by which all discs must be enlarged for that of p to hold those of the piece
//           (after Giesen, Miklos, Pauly and Wormser 2009): max |p - q| / (r_p - r_q)
//   length  the longest path from p to a leaf of the piece (Liu, Chambers, Letscher and Ju 2011), where
//           pieces hang on junctions alone, so that branches stay whole
//   ratio   that length over the radius of p
// Cycles, and what leads from one to another or to an anchored end, are never removed. A component without
// these keeps at least one place: its anchored end if there is one, else that with the largest angle or
// chord, of several the one with the largest radius; for scale the center of the largest disc; for length and
// ratio the middle of the longest path, on which pieces may hang too. What hangs on a place is away from
// there.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/skeleton/skeleton_view.hpp"

namespace vorotool::core::pruning {

enum class Criterion : std::int8_t { angle, chord, scale, length, ratio };

// A place that a component keeps.
struct KeptPlace {
  std::int32_t arc;
  double parameter;
};

// Along an arc values do not decrease to where it has most, from either end.
struct CriticalValues {
  std::vector<std::array<double, 2>> ends;  // [a] close to the source and the target
  std::vector<double> most;                 // [a] infinite where something is kept
  std::vector<KeptPlace> kept;              // one for each component without a core; by arc
};

CriticalValues critical_values(const skeleton::SkeletonView& skeleton, Criterion criterion,
                               const base::Monitor& monitor);

}  // namespace vorotool::core::pruning
