// Decimal text to double and back, exactly and without regard to the locale.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/monitor.hpp"

namespace vorotool::core::text {

enum class NumberStatus {
  good,
  not_number,  // not a decimal number: empty, letters, a decimal comma, more text after the number
  not_finite,  // NaN, infinity, or beyond the largest double
};

// Reads the whole of `text` as a decimal number, correctly rounded: [+-] digits [. digits] [e [+-] digits].
// Numbers too small for a double become zero.
NumberStatus parse_number(std::string_view text, double& value);

// Appends the shortest text that reads back as the same double: plain digits from 1e-5 to below 1e16 in
// magnitude, else with an exponent. With `precision` > 0, that many significant digits at most (as %g).
void append_number(std::string& out, double value, int precision = 0);
void append_number(std::string& out, std::int64_t value);
void append_number(std::string& out, std::uint64_t value);

// The texts of numbers, made once for columns that show each number many times: about 20 bytes a number.
// Numbers that are not finite have an empty text.
class NumberTexts {
 public:
  NumberTexts(std::span<const double> values, int precision, unsigned threads,
              const base::Monitor& monitor = {});

  std::size_t size() const { return ends_.size(); }

  std::string_view operator[](std::size_t i) const {
    const std::size_t begin = i % block_size == 0 ? 0 : ends_[i - 1];
    return {blocks_[i / block_size].data() + begin, ends_[i] - begin};
  }

 private:
  static constexpr std::size_t block_size = std::size_t{1} << 13;

  std::vector<std::string> blocks_;  // texts of block_size numbers, one after the other
  std::vector<std::uint32_t> ends_;  // of each text in its block
};

}  // namespace vorotool::core::text
