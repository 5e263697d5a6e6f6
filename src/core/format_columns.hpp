// Columns to delimited text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/monitor.hpp"

namespace vorotool::core {

// A column and which of its fields do not exist (nonzero; empty: all exist). Those are written empty, and so
// are doubles that are not finite.
struct TextColumn {
  std::variant<std::span<const std::int64_t>, std::span<const std::uint64_t>, std::span<const double>,
               std::span<const std::string_view>>
      values;
  std::span<const std::uint8_t> missing;
};

// Comma-separated text of the rows, each ended by LF, in blocks to be written one after the other. All
// columns have the same length. Doubles have `precision` significant digits, or with 0 the shortest text that
// reads back the same. The text does not depend on the number of threads.
std::vector<std::string> format_columns(std::span<const TextColumn> columns, int precision, unsigned threads,
                                        const Monitor& monitor = {});

// A field as it stands in comma-separated text: in quotes where a reader would otherwise misread it.
void append_csv_field(std::string& out, std::string_view value);

}  // namespace vorotool::core
