#include "core/text/number_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>
#include <version>

#include "core/base/parallel.hpp"

// Some libraries lack the conversions of doubles; slower ones by streams then give the same texts and
// values. A number is read in 650 ns so, by from_chars in 19 and by fast_float in 14, and written in 29
// microseconds (tests/benchmarks/core_parts.cpp): fast_float writes none, so it would mend the lesser
// part, for libc++ before 20.
#if defined(__cpp_lib_to_chars) && !defined(VOROTOOL_STREAM_NUMBERS)
#define VOROTOOL_EXACT_CHARS
#endif

namespace vorotool::core::text {
namespace {

// Plain notation needs at most 5 zeros and 17 digits, or 16 digits and a sign; an exponent needs 24
// characters. `precision` is cut to 17 digits, which every double can bear.
constexpr std::size_t number_size = 48;
constexpr int most_digits = 17;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool looks_decimal(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    return is_digit(c) || c == '.' || c == '+' || c == '-' || c == 'e' || c == 'E';
  });
}

// nan, inf, infinity, with a sign or not, in any case.
bool names_non_finite(std::string_view text) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  std::string lower(text.substr(0, 9));
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower == "nan" || lower == "inf" || lower == "infinity";
}

// The slow way, for numbers out of range and for libraries without from_chars: a stream in the C locale.
// Streams give 0 for what is too small and fail, with the largest double, for what is too large.
NumberStatus parse_by_stream(std::string_view text, double& value) {
  std::istringstream stream{std::string(text)};
  stream.imbue(std::locale::classic());
  stream >> value;
  const bool too_large = stream.fail() && std::abs(value) > 1.0;
  if (too_large || (!stream.fail() && !std::isfinite(value))) return NumberStatus::not_finite;
  return stream.fail() || stream.peek() != std::istringstream::traits_type::eof() ? NumberStatus::not_number
                                                                                  : NumberStatus::good;
}

#if !defined(VOROTOOL_EXACT_CHARS)
std::string streamed(double value, std::ios_base::fmtflags form, int precision) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream.setf(form, std::ios_base::floatfield);
  stream << std::setprecision(precision) << value;
  return stream.str();
}

// The fewest digits that read back the same; 17 always do.
std::string shortest_by_stream(double value, bool plain) {
  std::string text;
  int decimals = -1;
  double back = 0.0;
  do {
    text = streamed(value, std::ios_base::scientific, ++decimals);
    parse_number(text, back);
  } while (back != value && decimals + 1 < most_digits);
  if (!plain) return text;
  const int exponent = std::stoi(text.substr(text.find('e') + 1));
  return streamed(value, std::ios_base::fixed, std::max(0, decimals - exponent));
}
#endif

}  // namespace

NumberStatus parse_number(std::string_view text, double& value) {
  std::string_view digits = text;  // from_chars takes no plus sign
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-' && digits[1] != '+') digits.remove_prefix(1);
#if defined(VOROTOOL_EXACT_CHARS)
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc{} && end == digits.data() + digits.size() && std::isfinite(value)) {
    return NumberStatus::good;
  }
  if (error == std::errc::result_out_of_range && looks_decimal(digits)) return parse_by_stream(digits, value);
#else
  if (!digits.empty() && looks_decimal(digits)) return parse_by_stream(digits, value);
#endif
  return names_non_finite(text) ? NumberStatus::not_finite : NumberStatus::not_number;
}

void append_number(std::string& out, double value, int precision) {
  precision = std::min(precision, most_digits);
  const double size = std::abs(value);
  const bool plain = size == 0.0 || (size >= 1e-5 && size < 1e16);
#if defined(VOROTOOL_EXACT_CHARS)
  char buffer[number_size];
  char* const end = buffer + number_size;
  const auto form = plain ? std::chars_format::fixed : std::chars_format::scientific;
  const auto result = precision > 0 ? std::to_chars(buffer, end, value, std::chars_format::general, precision)
                                    : std::to_chars(buffer, end, value, form);
  out.append(buffer, result.ptr);
#else
  out += precision > 0 ? streamed(value, std::ios_base::fmtflags{}, precision)
                       : shortest_by_stream(value, plain);
#endif
}

void append_number(std::string& out, std::int64_t value) {
  char buffer[number_size];
  out.append(buffer, std::to_chars(buffer, buffer + number_size, value).ptr);
}

void append_number(std::string& out, std::uint64_t value) {
  char buffer[number_size];
  out.append(buffer, std::to_chars(buffer, buffer + number_size, value).ptr);
}

NumberTexts::NumberTexts(std::span<const double> values, int precision, unsigned threads,
                         const base::Monitor& monitor)
    : blocks_(base::piece_count(values.size(), block_size)), ends_(values.size()) {
  const auto write = [&](std::size_t block, std::size_t begin, std::size_t end) {
    std::string text;
    for (std::size_t i = begin; i < end; ++i) {
      if (std::isfinite(values[i])) append_number(text, values[i], precision);
      ends_[i] = static_cast<std::uint32_t>(text.size());  // at most block_size texts of 48 bytes
    }
    text.shrink_to_fit();
    blocks_[block] = std::move(text);
  };
  base::for_pieces(values.size(), block_size, threads, monitor, write);
}

}  // namespace vorotool::core::text
