// The lexical rules of delimited text: where a record ends, and what its fields are.
//
// A record is a line, or several lines where a quoted field spans them. Blank lines and lines whose first
// visible character is '#' are no records. A line ends with LF or CRLF. Fields lose the blanks around them.
// A quoted field begins with '"', ends with '"', and holds '"' as '""'; a quote elsewhere is an ordinary
// character. In whitespace-delimited text any run of blanks and tabs separates, and a field that begins with
// '#' starts a comment.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vorotool::core::text {

enum class Delimiter { comma, semicolon, tab, whitespace };

struct Record {
  std::string_view text;       // without its end of line
  std::size_t first_line = 0;  // 1-based physical line on which it begins
};

struct Field {
  std::string_view text;  // without the surrounding blanks and quotes; inner quotes are still doubled
  bool quoted = false;
  bool broken = false;  // begins with a quote that is not closed before the next delimiter
};

// Reads the records of a text one after the other.
class RecordReader {
 public:
  RecordReader(std::string_view text, Delimiter delimiter, std::size_t first_line = 1);

  bool next(Record& record);

  // Physical line that follows the last record read.
  std::size_t line() const { return line_; }
  // Offset of that line in the text.
  std::size_t position() const { return position_; }

 private:
  std::size_t record_end(std::size_t begin, std::size_t line_end) const;

  std::string_view text_;
  Delimiter delimiter_;
  std::size_t position_ = 0;
  std::size_t line_;
  bool has_quotes_;
};

// Reads the fields of a record one after the other.
class FieldReader {
 public:
  FieldReader(std::string_view record, Delimiter delimiter) : rest_(record), delimiter_(delimiter) {}

  bool next(Field& field);

 private:
  std::string_view rest_;
  Delimiter delimiter_;
  bool ended_ = false;
};

// Fields of one record.
std::vector<Field> split_fields(std::string_view record, Delimiter delimiter);

// The text that a field stands for: doubled quotes made single.
std::string field_value(const Field& field);

// A part of a text that begins and ends at the border of a record.
struct TextPiece {
  std::string_view text;
  std::size_t first_line;
};

// Cuts a text into pieces of about `grain` bytes; the cuts depend on the text alone.
std::vector<TextPiece> split_records(std::string_view text, Delimiter delimiter, std::size_t first_line,
                                     std::size_t grain);

}  // namespace vorotool::core::text
