// The texts of numbers, made once for columns that show each number many times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/monitor.hpp"

namespace vorotool::core::text {

// About 20 bytes a number. What is not finite has an empty text.
class NumberTexts {
 public:
  NumberTexts(std::span<const double> values, int precision, unsigned threads,
              const base::Monitor& monitor = {});

  std::size_t size() const { return ends_.size(); }

  std::string_view operator[](std::size_t i) const {
    const std::size_t begin = i % kBlock == 0 ? 0 : ends_[i - 1];
    return {blocks_[i / kBlock].data() + begin, ends_[i] - begin};
  }

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 13;

  std::vector<std::string> blocks_;  // texts of kBlock numbers, one after the other
  std::vector<std::uint32_t> ends_;  // of each text in its block
};

}  // namespace vorotool::core::text
