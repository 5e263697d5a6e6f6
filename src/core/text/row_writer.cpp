#include "core/text/row_writer.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.hpp"

namespace vorotool::core::text {
namespace {

constexpr std::size_t block_rows = std::size_t{1} << 13;

// Writes a field and tells whether it exists.
struct FieldWriter {
  std::string& out;
  std::size_t row;
  int digits;
  char delimiter;

  bool operator()(std::span<const std::int64_t> values) const {
    append_number(out, values[row]);
    return true;
  }
  bool operator()(std::span<const std::uint64_t> values) const {
    append_number(out, values[row]);
    return true;
  }
  bool operator()(std::span<const double> values) const {
    if (!std::isfinite(values[row])) return false;
    append_number(out, values[row], digits);
    return true;
  }
  bool operator()(std::span<const std::string_view> values) const {
    if (delimiter != '\0') {
      append_csv_field(out, values[row], delimiter);
    } else {
      out += values[row];
    }
    return true;
  }
  bool operator()(const NumberTexts* texts) const {
    const std::string_view text = (*texts)[row];
    out += text;
    return !text.empty();
  }
  bool operator()(const PolygonTexts* polygons) const {
    const std::size_t begin = out.size();
    const bool is_csv = delimiter == ',';  // commas abound
    if (is_csv) out += '"';
    const bool exists = polygons->append(out, row);
    if (is_csv) out += '"';
    if (!exists) out.resize(begin);
    return exists;
  }
};

void append_field(std::string& out, const TextColumn& column, std::size_t row, const RowShape& shape) {
  if (column.index) row = (*column.index)[row];
  const bool exists = column.missing.empty() || column.missing[row] == 0;
  if (!exists || !std::visit(FieldWriter{out, row, column.digits, shape.delimiter}, column.values)) {
    out += shape.missing;
  }
}

// A row of one empty field would be a blank line, which readers of CSV skip: it is written as "".
void append_row(std::string& out, std::span<const TextColumn> columns, std::size_t row,
                const RowShape& shape) {
  out += shape.around.front();
  const std::size_t begin = out.size();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i > 0) out += shape.around[i];
    append_field(out, columns[i], row, shape);
  }
  if (shape.delimiter != '\0' && out.size() == begin) out += "\"\"";
  out += shape.around.back();
}

std::size_t size_of(const NumberTexts* texts) { return texts->size(); }
std::size_t size_of(const PolygonTexts* polygons) { return polygons->size(); }

template <class T>
std::size_t size_of(std::span<T> values) {
  return values.size();
}

bool is_blank_of_row(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

// Commas and semicolons would make a reader of comma-separated text take them for delimiters; beside tabs, which
// are looked for first, they are texts like others.
bool needs_quotes(std::string_view value, char delimiter) {
  if (value.empty()) return false;
  return is_blank_of_row(value.front()) || is_blank_of_row(value.back()) || value.front() == '#' ||
         value.find_first_of(delimiter == '\t' ? "\t\"\r\n" : ",;\t\"\r\n") != std::string_view::npos;
}

}  // namespace

std::size_t value_count(const TextColumn& column) {
  return std::visit([](const auto& values) { return size_of(values); }, column.values);
}

std::size_t row_count(const TextColumn& column) {
  return column.index ? column.index->size : value_count(column);
}

RowShape delimited_shape(std::size_t columns, char delimiter) {
  const std::string_view between = delimiter == '\t' ? "\t" : ",";
  RowShape shape{std::vector<std::string_view>(columns + 1, between), "", "", between.front()};
  shape.around.front() = "";
  shape.around.back() = "\n";
  return shape;
}

std::vector<std::string> format_rows(std::span<const TextColumn> columns, const RowShape& shape,
                                     unsigned threads, const base::Monitor& monitor) {
  const std::size_t rows = columns.empty() ? 0 : row_count(columns.front());
  std::vector<std::string> blocks(base::piece_count(rows, block_rows));
  const auto write = [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      if (row > 0) blocks[block] += shape.separator;
      append_row(blocks[block], columns, row, shape);
    }
  };
  base::for_pieces(rows, block_rows, threads, monitor, write);
  return blocks;
}

void append_csv_field(std::string& out, std::string_view value, char delimiter) {
  if (!needs_quotes(value, delimiter)) {
    out += value;
    return;
  }
  out += '"';
  for (const char c : value) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

}  // namespace vorotool::core::text
