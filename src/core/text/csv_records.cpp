#include "core/text/csv_records.hpp"

#include <algorithm>

namespace vorotool::core::text {
namespace {

constexpr auto none = std::string_view::npos;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// Whether a blank surrounds fields rather than separating them.
bool is_padding(char c, Delimiter delimiter) {
  return is_blank(c) && !(c == '\t' && delimiter == Delimiter::tab);
}

bool separates(char c, Delimiter delimiter) {
  switch (delimiter) {
    case Delimiter::comma:
      return c == ',';
    case Delimiter::semicolon:
      return c == ';';
    case Delimiter::tab:
      return c == '\t';
    case Delimiter::whitespace:
      break;
  }
  return is_blank(c);
}

std::size_t skip_padding(std::string_view text, std::size_t begin, Delimiter delimiter) {
  while (begin < text.size() && is_padding(text[begin], delimiter)) ++begin;
  return begin;
}

std::size_t find_separator(std::string_view text, std::size_t begin, std::size_t end, Delimiter delimiter) {
  while (begin < end && !separates(text[begin], delimiter)) ++begin;
  return begin;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::size_t find_line_end(std::string_view text, std::size_t begin) {
  const std::size_t found = text.find('\n', begin);
  return found == none ? text.size() : found;
}

// Offset of the quote that closes the one at `open`, or npos when there is none or more than blanks stand
// between it and the next delimiter. A quote that is never closed therefore stops at the next quoted field
// instead of swallowing rows, and looking for it costs no more than the way to there.
std::size_t closing_quote(std::string_view text, std::size_t open, Delimiter delimiter) {
  std::size_t close = open + 1;
  for (;; close += 2) {
    close = text.find('"', close);
    if (close == none) return none;
    if (close + 1 >= text.size() || text[close + 1] != '"') break;
  }
  std::size_t next = close + 1;
  if (delimiter != Delimiter::whitespace) next = skip_padding(text, next, delimiter);
  const bool ends = next >= text.size() || text[next] == '\n' || separates(text[next], delimiter);
  return ends ? close : none;
}

bool is_comment_or_blank(std::string_view line) {
  const auto visible = std::find_if_not(line.begin(), line.end(), is_blank);
  return visible == line.end() || *visible == '#';
}

}  // namespace

RecordReader::RecordReader(std::string_view text, Delimiter delimiter, std::size_t first_line)
    : text_(text), delimiter_(delimiter), line_(first_line), has_quotes_(text.find('"') != none) {}

bool RecordReader::next(Record& record) {
  while (position_ < text_.size()) {
    const std::size_t begin = position_;
    std::size_t end = find_line_end(text_, begin);
    record.first_line = line_;
    const bool skipped = is_comment_or_blank(text_.substr(begin, end - begin));
    if (has_quotes_ && !skipped) end = record_end(begin, end);
    record.text = text_.substr(begin, end - begin);
    position_ = std::min(end + 1, text_.size());
    line_ += 1 + (has_quotes_ ? std::count(record.text.begin(), record.text.end(), '\n') : 0);
    if (!skipped) return true;
  }
  return false;
}

// Follows the quoted fields from `begin` to the end of the line on which the last one closes.
std::size_t RecordReader::record_end(std::size_t begin, std::size_t line_end) const {
  while (begin < line_end) {
    begin = skip_padding(text_, begin, delimiter_);
    if (begin < line_end && text_[begin] == '#' && delimiter_ == Delimiter::whitespace) return line_end;
    if (begin < line_end && text_[begin] == '"') {
      const std::size_t close = closing_quote(text_, begin, delimiter_);
      if (close != none) begin = close + 1;
      if (begin > line_end) line_end = find_line_end(text_, begin);
    }
    begin = find_separator(text_, begin, line_end, delimiter_) + 1;
  }
  return line_end;
}

bool FieldReader::next(Field& field) {
  if (ended_) return false;
  rest_.remove_prefix(skip_padding(rest_, 0, delimiter_));
  field = Field{};
  if (delimiter_ == Delimiter::whitespace && (rest_.empty() || rest_.front() == '#')) {
    ended_ = true;
    return false;
  }
  std::size_t begin = 0;
  if (!rest_.empty() && rest_.front() == '"') {
    const std::size_t close = closing_quote(rest_, 0, delimiter_);
    field.quoted = close != none;
    field.broken = !field.quoted;
    if (field.quoted) {
      field.text = rest_.substr(1, close - 1);
      begin = close + 1;
    }
  }
  const std::size_t end = find_separator(rest_, begin, rest_.size(), delimiter_);
  if (!field.quoted) field.text = trimmed(rest_.substr(0, end));
  ended_ = end == rest_.size();
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  return true;
}

std::vector<Field> split_fields(std::string_view record, Delimiter delimiter) {
  std::vector<Field> fields;
  FieldReader reader(record, delimiter);
  for (Field field; reader.next(field);) fields.push_back(field);
  return fields;
}

std::string field_value(const Field& field) {
  std::string value(field.text);
  if (!field.quoted) return value;
  for (std::size_t at = value.find("\"\""); at != none; at = value.find("\"\"", at + 1)) value.erase(at, 1);
  return value;
}

std::vector<TextPiece> split_records(std::string_view text, Delimiter delimiter, std::size_t first_line,
                                     std::size_t grain) {
  std::vector<TextPiece> pieces;
  if (text.find('"') == none) {
    while (!text.empty()) {
      const std::size_t end = text.size() <= grain ? text.size() : find_line_end(text, grain);
      const std::size_t size = std::min(end + 1, text.size());
      pieces.push_back({text.substr(0, size), first_line});
      first_line += std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size), '\n');
      text.remove_prefix(size);
    }
    return pieces;
  }
  RecordReader reader(text, delimiter, first_line);
  std::size_t begin = 0;
  Record record;
  for (bool more = true; more;) {
    more = reader.next(record);
    if (reader.position() - begin < grain && more) continue;
    if (reader.position() == begin) break;
    pieces.push_back({text.substr(begin, reader.position() - begin), first_line});
    begin = reader.position();
    first_line = reader.line();
  }
  return pieces;
}

}  // namespace vorotool::core::text
