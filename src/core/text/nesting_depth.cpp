#include "core/text/nesting_depth.hpp"

namespace vorotool::core::text {
namespace {

// Offset of the quote that ends the JSON string opened at `open`, or the end of the text.
std::size_t string_end(std::string_view text, std::size_t open) {
  std::size_t at = open + 1;
  while (at < text.size() && text[at] != '"') at += text[at] == '\\' ? 2 : 1;
  return at;
}

}  // namespace

std::size_t find_too_deep(std::string_view text, std::size_t limit) {
  std::size_t depth = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') {
      at = string_end(text, at);
    } else if (c == '(' || c == '[' || c == '{') {
      if (++depth > limit) return at;
    } else if ((c == ')' || c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
  return std::string_view::npos;
}

}  // namespace vorotool::core::text
