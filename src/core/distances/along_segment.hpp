// Places along a segment, by the share of the way that is behind them: where it meets another one, and where
// it is as far from one element as from another.
#pragma once

#include <span>
#include <vector>

#include "core/distances/element.hpp"

namespace vorotool::core::distances {

// Adds the shares at which a segment meets an element: none, one, or both ends of what they have in common.
// Whether they meet is decided exactly; the shares are rounded. The boxes of both are known to meet.
void add_meetings(const Element& segment, const Element& element, std::vector<double>& shares);

// Whether a segment is covered by elements that are in one line with it; exact.
bool is_covered(const Element& segment, std::span<const Element> elements);

// Between s, where e is not farther than f, and t, where f is not farther than e, a share at which both are
// equally far, as nearly as their distances are computed.
double equally_far(const Element& segment, const Element& e, const Element& f, double s, double t);

}  // namespace vorotool::core::distances
