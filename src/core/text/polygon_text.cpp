#include "core/text/polygon_text.hpp"

#include <vector>

#include "core/text/number_text.hpp"

namespace vorotool::core::text {
namespace {

// The text around and between the parts of a polygon.
struct Marks {
  const char *list_opens, *list_closes, *between_lists;
  const char *point_opens, *between_numbers, *point_closes, *between_points;
  bool closes_rings;  // by their first vertex
};

constexpr Marks marks_of_wkt{"(", ")", ", ", "", " ", "", ", ", true};
constexpr Marks marks_of_geojson{"[", "]", ",", "[", ",", "]", ",", true};
constexpr Marks marks_of_json{"[", "]", ",", "[", ",", "]", ",", false};
constexpr Marks marks_of_wkt_lines{"(", ")", ", ", "", " ", "", ", ", false};

class Writer {
 public:
  Writer(std::string& out, const PolygonTexts& texts, const Marks& marks)
      : out_(out), texts_(texts), marks_(marks) {}

  // A list of the items from `first` to `last - 1`, each appended by item(number).
  template <class Item>
  void list(std::int64_t first, std::int64_t last, Item item) {
    out_ += marks_.list_opens;
    for (std::int64_t i = first; i < last; ++i) {
      if (i > first) out_ += marks_.between_lists;
      item(i);
    }
    out_ += marks_.list_closes;
  }

  void polygon(std::int64_t number) {
    const auto at = static_cast<std::size_t>(number);
    list(texts_.polygons[at], texts_.polygons[at + 1], [this](std::int64_t k) { ring(k); });
  }

  void ring(std::int64_t number) {
    const auto at = static_cast<std::size_t>(number);
    const auto begin = static_cast<std::size_t>(texts_.rings[at]);
    const auto end = static_cast<std::size_t>(texts_.rings[at + 1]);
    out_ += marks_.list_opens;
    for (std::size_t k = begin; k < end; ++k) {
      if (k > begin) out_ += marks_.between_points;
      point(texts_.vertices[k]);
    }
    if (marks_.closes_rings) {
      out_ += marks_.between_points;
      point(texts_.vertices[begin]);
    }
    out_ += marks_.list_closes;
  }

 private:
  void point(const kernel::Point& p) {
    out_ += marks_.point_opens;
    append_number(out_, p.x);
    out_ += marks_.between_numbers;
    append_number(out_, p.y);
    out_ += marks_.point_closes;
  }

  std::string& out_;
  const PolygonTexts& texts_;
  const Marks& marks_;
};

bool has_length(const PolygonTexts& texts, std::int64_t line) {
  const auto begin = static_cast<std::size_t>(texts.rings[static_cast<std::size_t>(line)]);
  const auto end = static_cast<std::size_t>(texts.rings[static_cast<std::size_t>(line) + 1]);
  for (std::size_t k = begin + 1; k < end; ++k) {
    if (texts.vertices[k] != texts.vertices[begin]) return true;
  }
  return false;
}

bool append_lines(std::string& out, const PolygonTexts& texts, std::int64_t first, std::int64_t last) {
  const bool is_wkt = texts.style == PolygonStyle::wkt_lines;
  std::vector<std::int64_t> lines;
  for (std::int64_t line = texts.polygons[static_cast<std::size_t>(first)];
       line < texts.polygons[static_cast<std::size_t>(last)]; ++line) {
    if (has_length(texts, line)) lines.push_back(line);
  }
  if (lines.empty()) return false;
  const bool is_multi = lines.size() > 1;
  Writer writer(out, texts, is_wkt ? marks_of_wkt_lines : marks_of_json);
  if (is_wkt) {
    out += is_multi ? "MULTILINESTRING " : "LINESTRING ";
  } else {
    out += is_multi ? "{\"type\":\"MultiLineString\",\"coordinates\":"
                    : "{\"type\":\"LineString\",\"coordinates\":";
  }
  if (is_multi) {
    writer.list(0, static_cast<std::int64_t>(lines.size()),
                [&](std::int64_t k) { writer.ring(lines[static_cast<std::size_t>(k)]); });
  } else {
    writer.ring(lines.front());
  }
  if (!is_wkt) out += '}';
  return true;
}

}  // namespace

bool PolygonTexts::append(std::string& out, std::size_t row) const {
  const std::int64_t first = rows[row], last = rows[row + 1];
  if (style == PolygonStyle::json) {
    if (first == last) {
      out += "\"shell\":[],\"holes\":[]";
      return true;
    }
    Writer writer(out, *this, marks_of_json);
    const auto at = static_cast<std::size_t>(first);
    out += "\"shell\":";
    writer.ring(polygons[at]);
    out += ",\"holes\":";
    writer.list(polygons[at] + 1, polygons[at + 1], [&](std::int64_t k) { writer.ring(k); });
    return true;
  }
  if (style == PolygonStyle::wkt_lines || style == PolygonStyle::geojson_lines) {
    return append_lines(out, *this, first, last);
  }
  if (first == last) return false;
  const bool is_wkt = style == PolygonStyle::wkt, is_multi = last - first > 1;
  Writer writer(out, *this, is_wkt ? marks_of_wkt : marks_of_geojson);
  if (is_wkt) {
    out += is_multi ? "MULTIPOLYGON " : "POLYGON ";
  } else {
    out +=
        is_multi ? "{\"type\":\"MultiPolygon\",\"coordinates\":" : "{\"type\":\"Polygon\",\"coordinates\":";
  }
  if (is_multi) {
    writer.list(first, last, [&](std::int64_t k) { writer.polygon(k); });
  } else {
    writer.polygon(first);
  }
  if (!is_wkt) out += '}';
  return true;
}

}  // namespace vorotool::core::text
