// Delimited text to columns of numbers or of text, on several threads.
//
// Results and errors do not depend on the number of threads: of several errors, the first in the order of the
// text is thrown.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/text/csv_records.hpp"

namespace vorotool::core::text {

// How to read a text: its separator, the records before the data, and the columns that are wanted.
struct TextLayout {
  Delimiter delimiter = Delimiter::comma;
  std::size_t header_records = 0;    // skipped; blank lines and comments do not count
  std::vector<std::size_t> columns;  // 0-based and different, in the order of the result
  std::size_t fields = 0;  // fields every record must have; 0: as many as the first one after the header
};

// The first fault of a text, and its place.
struct TextError : std::runtime_error {
  enum class Kind {
    not_number,   // `text` in a wanted column is no number
    not_finite,   // `text` is NaN, infinite or too large
    field_count,  // a record of `found` instead of `expected` fields
    open_quote,   // `text` begins with a quote that is not closed before the next delimiter
  };

  TextError(Kind kind_, std::size_t line_, std::size_t column_, std::string text_, std::size_t found_ = 0,
            std::size_t expected_ = 0);

  Kind kind;
  std::size_t line;    // 1-based physical line on which the record begins
  std::size_t column;  // 0-based
  std::string text;    // at most the first 40 bytes of the field
  std::size_t found;
  std::size_t expected;
};

// rows x columns, row after row.
struct NumberTable {
  std::unique_ptr<double[]> values;
  std::size_t rows = 0;
  std::size_t columns = 0;
};

// Views into the text that was parsed; rows x columns, row after row.
struct FieldTable {
  std::vector<Field> fields;
  std::size_t rows = 0;
  std::size_t columns = 0;
};

// The wanted columns as finite numbers. Throws TextError.
NumberTable parse_numbers(std::string_view text, const TextLayout& layout, unsigned threads,
                          const base::Monitor& monitor = {});

// The wanted columns as text. Throws TextError (not for values).
FieldTable parse_fields(std::string_view text, const TextLayout& layout, unsigned threads,
                        const base::Monitor& monitor = {});

// Number of data records, without reading their fields and without memory for them.
std::size_t count_rows(std::string_view text, const TextLayout& layout, unsigned threads,
                       const base::Monitor& monitor = {});

// Physical line on which data record `row` (0-based) begins; 0 when there is none.
std::size_t line_of_row(std::string_view text, const TextLayout& layout, std::size_t row);

}  // namespace vorotool::core::text
