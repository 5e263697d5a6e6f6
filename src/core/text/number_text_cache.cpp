#include "core/text/number_text_cache.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.hpp"
#include "core/text/number_text.hpp"

namespace vorotool::core::text {

NumberTexts::NumberTexts(std::span<const double> values, int precision, unsigned threads,
                         const base::Monitor& monitor)
    : blocks_(base::piece_count(values.size(), kBlock)), ends_(values.size()) {
  base::parallel_for(
      blocks_.size(), threads,
      [&](std::size_t block) {
        std::string text;
        const std::size_t end = std::min(values.size(), (block + 1) * kBlock);
        for (std::size_t i = block * kBlock; i < end; ++i) {
          if (std::isfinite(values[i])) append_number(text, values[i], precision);
          ends_[i] = static_cast<std::uint32_t>(text.size());  // at most kBlock texts of 48 bytes
        }
        text.shrink_to_fit();
        blocks_[block] = std::move(text);
      },
      monitor);
}

}  // namespace vorotool::core::text
