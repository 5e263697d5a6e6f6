// How deep brackets nest, counted before a recursive parser sees a text.
#pragma once

#include <cstddef>
#include <string_view>

namespace vorotool::core::text {

// Offset of the first of ( [ { that opens a level beyond `limit`, or npos. Brackets inside JSON strings do
// not count. Closing brackets that nothing opened are left to the parser.
std::size_t find_too_deep(std::string_view text, std::size_t limit);

}  // namespace vorotool::core::text
