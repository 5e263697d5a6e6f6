// Columns to text, one row after the other: delimited text, JSON, and any other format with one record a row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/text/number_text.hpp"
#include "core/text/polygon_text.hpp"

namespace vorotool::core::text {

// Values read at a distance: `data[i * stride]`, as the columns of a matrix lie in memory.
struct StridedIndices {
  const std::int32_t* data;
  std::size_t size;
  std::ptrdiff_t stride;

  std::size_t operator[](std::size_t row) const {
    return static_cast<std::size_t>(data[static_cast<std::ptrdiff_t>(row) * stride]);
  }
};

// A column and which of its fields do not exist (nonzero; empty: all exist). Doubles that are not finite do
// not exist either. With `index`, row i shows values[index[i]], and `missing` is about values too.
struct TextColumn {
  std::variant<std::span<const std::int64_t>, std::span<const std::uint64_t>, std::span<const double>,
               std::span<const std::string_view>, const NumberTexts*, const PolygonTexts*>
      values;
  std::span<const std::uint8_t> missing;
  std::optional<StridedIndices> index = {};
  int digits = 0;  // significant ones of doubles; 0: the shortest text that reads back the same
};

std::size_t value_count(const TextColumn& column);
std::size_t row_count(const TextColumn& column);

// The text of a row around its fields.
struct RowShape {
  std::vector<std::string_view> around;  // before the first field, between fields, after the last one
  std::string_view separator;            // between rows
  std::string_view missing;              // instead of a field that does not exist
  char delimiter = '\0';  // of fields: texts are put in quotes where a reader would misread them; or none
};

// The shape of text with `columns` columns, a comma or a tab between them, each row ended by LF.
RowShape delimited_shape(std::size_t columns, char delimiter);

// The text of the rows in blocks to be written one after the other. All columns have the same length. The
// text does not depend on the number of threads.
std::vector<std::string> format_rows(std::span<const TextColumn> columns, const RowShape& shape,
                                     unsigned threads, const base::Monitor& monitor = {});

// A field as it stands in delimited text: in quotes where a reader would otherwise misread it.
void append_csv_field(std::string& out, std::string_view value, char delimiter = ',');

}  // namespace vorotool::core::text
