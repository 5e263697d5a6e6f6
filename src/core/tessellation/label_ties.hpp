// The tie rule: a pixel or voxel that is equally near to several seeds has the smallest of their labels.
//
// Of seeds at one place sorted_seeds.cpp keeps the one with the smallest label.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/tessellation/row_kernel.hpp"

namespace vorotool::core::tessellation {

// All candidates equally near to a pixel are neighbors in the envelope, and the pixel holds the label of one
// of them: the smallest over the ties at that pixel is the smallest of all.
template <class Arithmetic, class Label>
void settle_ties(const Envelope<Arithmetic>& envelope, Label* row) {
  for (std::int32_t t = 0; t < envelope.tie_count; ++t) {
    const std::int32_t i = envelope.ties[t];
    const std::uint32_t smaller = std::min(envelope.label_of(i), envelope.label_of(i + 1));
    Label& pixel = row[envelope.end[i]];
    pixel = std::min(pixel, static_cast<Label>(smaller));
  }
}

}  // namespace vorotool::core::tessellation
