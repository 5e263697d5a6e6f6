#include "core/format_columns.hpp"

#include <algorithm>
#include <cmath>

#include "core/number_text.hpp"
#include "core/parallel.hpp"

namespace vorotool::core {
namespace {

constexpr std::size_t kBlockRows = std::size_t{1} << 13;

struct FieldWriter {
  std::string& out;
  std::size_t row;
  int precision;

  void operator()(std::span<const std::int64_t> values) const { append_number(out, values[row]); }
  void operator()(std::span<const std::uint64_t> values) const { append_number(out, values[row]); }
  void operator()(std::span<const double> values) const {
    if (std::isfinite(values[row])) append_number(out, values[row], precision);
  }
  void operator()(std::span<const std::string_view> values) const { append_csv_field(out, values[row]); }
};

// A row of one empty field would be a blank line, which readers skip: it is written as "".
void append_row(std::string& out, std::span<const TextColumn> columns, std::size_t row, int precision) {
  const std::size_t begin = out.size();
  for (const TextColumn& column : columns) {
    if (&column != &columns.front()) out += ',';
    const bool exists = column.missing.empty() || column.missing[row] == 0;
    if (exists) std::visit(FieldWriter{out, row, precision}, column.values);
  }
  if (out.size() == begin) out += "\"\"";
  out += '\n';
}

std::size_t row_count(std::span<const TextColumn> columns) {
  if (columns.empty()) return 0;
  return std::visit([](const auto& values) { return values.size(); }, columns.front().values);
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

bool needs_quotes(std::string_view value) {
  if (value.empty()) return false;
  return is_blank(value.front()) || is_blank(value.back()) || value.front() == '#' ||
         value.find_first_of(",;\t\"\r\n") != std::string_view::npos;
}

}  // namespace

std::vector<std::string> format_columns(std::span<const TextColumn> columns, int precision, unsigned threads,
                                        const Monitor& monitor) {
  const std::size_t rows = row_count(columns);
  std::vector<std::string> blocks(piece_count(rows, kBlockRows));
  parallel_for(
      blocks.size(), threads,
      [&](std::size_t block) {
        const std::size_t end = std::min(rows, (block + 1) * kBlockRows);
        for (std::size_t row = block * kBlockRows; row < end; ++row) {
          append_row(blocks[block], columns, row, precision);
        }
      },
      monitor);
  return blocks;
}

void append_csv_field(std::string& out, std::string_view value) {
  if (!needs_quotes(value)) {
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

}  // namespace vorotool::core
