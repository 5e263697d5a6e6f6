#include "core/text/csv_columns.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/text/number_text.hpp"

namespace vorotool::core::text {

using base::Monitor;

namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 18;  // about a millisecond of parsing
constexpr std::size_t unwanted = std::numeric_limits<std::size_t>::max();
constexpr std::size_t quoted_bytes = 40;

// The text after the header, cut into pieces, and the row with which each piece begins.
struct Plan {
  std::vector<TextPiece> pieces;
  std::vector<std::size_t> first_row;  // one more than pieces: the last is the number of rows
  std::size_t fields = 0;              // that each record must have

  std::size_t rows() const { return first_row.back(); }
};

std::size_t count_records(const TextPiece& piece, Delimiter delimiter) {
  RecordReader reader(piece.text, delimiter, piece.first_line);
  std::size_t count = 0;
  for (Record record; reader.next(record);) ++count;
  return count;
}

Plan make_plan(std::string_view text, const TextLayout& layout, unsigned threads, const Monitor& monitor) {
  RecordReader reader(text, layout.delimiter);
  Record record;
  for (std::size_t i = 0; i < layout.header_records; ++i) reader.next(record);
  Plan plan;
  plan.pieces = split_records(text.substr(reader.position()), layout.delimiter, reader.line(), piece_bytes);
  std::vector<std::size_t> counts(plan.pieces.size() + 1);
  base::parallel_for(
      plan.pieces.size(), threads,
      [&](std::size_t i) { counts[i] = count_records(plan.pieces[i], layout.delimiter); }, monitor);
  plan.first_row.resize(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), plan.first_row.begin(), std::size_t{0});
  plan.fields = layout.fields;
  if (plan.fields == 0 && reader.next(record)) {
    plan.fields = split_fields(record.text, layout.delimiter).size();
  }
  return plan;
}

// For each field of a record the place of its value in the result, or unwanted.
std::vector<std::size_t> places_of_fields(const TextLayout& layout, std::size_t fields) {
  std::vector<std::size_t> places(fields, unwanted);
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    if (layout.columns[i] >= fields) {
      throw std::out_of_range("column " + std::to_string(layout.columns[i] + 1) + " of records of " +
                              std::to_string(fields) + " fields");
    }
    places[layout.columns[i]] = i;
  }
  return places;
}

TextError field_error(TextError::Kind kind, const Record& record, std::size_t column, const Field& field) {
  return {kind, record.first_line, column, std::string(field.text.substr(0, quoted_bytes))};
}

// Calls take(row, place, record, column, field) for each wanted field of a piece.
template <class Take>
void read_piece(const TextPiece& piece, Delimiter delimiter, const std::vector<std::size_t>& places,
                std::size_t row, const Take& take) {
  RecordReader records(piece.text, delimiter, piece.first_line);
  Field field;
  for (Record record; records.next(record); ++row) {
    FieldReader fields(record.text, delimiter);
    std::size_t column = 0;
    for (; fields.next(field); ++column) {
      if (field.broken) throw field_error(TextError::Kind::open_quote, record, column, field);
      if (column < places.size() && places[column] != unwanted) {
        take(row, places[column], record, column, field);
      }
    }
    if (column != places.size()) {
      throw TextError(TextError::Kind::field_count, record.first_line, column, "", column, places.size());
    }
  }
}

template <class Take>
void read_rows(const Plan& plan, const TextLayout& layout, unsigned threads, const Monitor& monitor,
               const Take& take) {
  if (plan.rows() == 0) return;
  const std::vector<std::size_t> places = places_of_fields(layout, plan.fields);
  base::parallel_for(
      plan.pieces.size(), threads,
      [&](std::size_t i) { read_piece(plan.pieces[i], layout.delimiter, places, plan.first_row[i], take); },
      monitor);
}

}  // namespace

TextError::TextError(Kind kind_, std::size_t line_, std::size_t column_, std::string text_,
                     std::size_t found_, std::size_t expected_)
    : std::runtime_error("line " + std::to_string(line_) + ", column " + std::to_string(column_ + 1)),
      kind(kind_),
      line(line_),
      column(column_),
      text(std::move(text_)),
      found(found_),
      expected(expected_) {}

NumberTable parse_numbers(std::string_view text, const TextLayout& layout, unsigned threads,
                          const Monitor& monitor) {
  const Plan plan = make_plan(text, layout, threads, monitor);
  const std::size_t columns = layout.columns.size();
  NumberTable table{std::make_unique_for_overwrite<double[]>(plan.rows() * columns), plan.rows(), columns};
  double* const values = table.values.get();
  read_rows(
      plan, layout, threads, monitor,
      [=](std::size_t row, std::size_t place, const Record& record, std::size_t column, const Field& field) {
        const NumberStatus status = parse_number(field.text, values[row * columns + place]);
        if (status == NumberStatus::good) return;
        const bool number = status == NumberStatus::not_finite;
        const auto kind = number ? TextError::Kind::not_finite : TextError::Kind::not_number;
        throw field_error(kind, record, column, field);
      });
  return table;
}

FieldTable parse_fields(std::string_view text, const TextLayout& layout, unsigned threads,
                        const Monitor& monitor) {
  const Plan plan = make_plan(text, layout, threads, monitor);
  const std::size_t columns = layout.columns.size();
  FieldTable table{std::vector<Field>(plan.rows() * columns), plan.rows(), columns};
  Field* const fields = table.fields.data();
  read_rows(plan, layout, threads, monitor,
            [=](std::size_t row, std::size_t place, const Record&, std::size_t, const Field& field) {
              fields[row * columns + place] = field;
            });
  return table;
}

std::size_t count_rows(std::string_view text, const TextLayout& layout, unsigned threads,
                       const Monitor& monitor) {
  return make_plan(text, layout, threads, monitor).rows();
}

std::size_t line_of_row(std::string_view text, const TextLayout& layout, std::size_t row) {
  RecordReader reader(text, layout.delimiter);
  Record record;
  for (std::size_t i = 0; i <= layout.header_records + row; ++i) {
    if (!reader.next(record)) return 0;
  }
  return record.first_line;
}

}  // namespace vorotool::core::text
