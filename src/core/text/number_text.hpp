// Decimal text to double and back, exactly and without regard to the locale.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vorotool::core::text {

enum class NumberStatus {
  good,
  not_number,  // not a decimal number: empty, letters, a decimal comma, more text after the number
  not_finite,  // NaN, infinity, or beyond the largest double
};

// Reads the whole of `text` as a decimal number, correctly rounded: [+-] digits [. digits] [e [+-] digits].
// What is too small for a double becomes zero.
NumberStatus parse_number(std::string_view text, double& value);

// Appends the shortest text that reads back as the same double: plain digits from 1e-5 to below 1e16 in
// magnitude, else with an exponent. With `precision` > 0, that many significant digits at most (as %g).
void append_number(std::string& out, double value, int precision = 0);
void append_number(std::string& out, std::int64_t value);
void append_number(std::string& out, std::uint64_t value);

}  // namespace vorotool::core::text
