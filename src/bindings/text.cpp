// Text columns: parsing, formatting, and the count of nesting.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <any>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/text/csv_columns.hpp"
#include "core/text/nesting_depth.hpp"
#include "core/text/row_writer.hpp"

namespace vorotool::bindings {
namespace {

template <class T>
using InputArray = Aligned<const T, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

using Texts = nb::typed<nb::list, nb::str>;

std::string_view view_of(const nb::bytes& text) { return {text.c_str(), text.size()}; }

core::text::Delimiter delimiter_of(const std::string& name) {
  if (name == ",") return core::text::Delimiter::comma;
  if (name == ";") return core::text::Delimiter::semicolon;
  if (name == "\t") return core::text::Delimiter::tab;
  if (name == " ") return core::text::Delimiter::whitespace;
  throw nb::value_error("the delimiter must be one of ',' ';' '\\t' ' '");
}

// Bytes that are not UTF-8 become replacement characters: the text goes into messages and names.
nb::str decoded(std::string_view text) {
  return nb::steal<nb::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace"));
}

const char* name_of(core::text::TextError::Kind kind) {
  switch (kind) {
    case core::text::TextError::Kind::not_number:
      return "not_number";
    case core::text::TextError::Kind::not_finite:
      return "not_finite";
    case core::text::TextError::Kind::field_count:
      return "field_count";
    case core::text::TextError::Kind::open_quote:
      break;
  }
  return "open_quote";
}

// core::TextError as TextError(kind, line, column, text, found, expected).
void bind_text_error(nb::module_& room) {
  PyObject* const type = PyErr_NewException("vorotool._core.text.TextError", PyExc_ValueError, nullptr);
  room.attr("TextError") = nb::borrow(type);
  nb::register_exception_translator(
      [](const std::exception_ptr& failure, void* payload) {
        try {
          std::rethrow_exception(failure);
        } catch (const core::text::TextError& e) {
          const nb::tuple arguments =
              nb::make_tuple(name_of(e.kind), e.line, e.column, decoded(e.text), e.found, e.expected);
          PyErr_SetObject(static_cast<PyObject*>(payload), arguments.ptr());
        }
      },
      type);
}

auto parse_numbers(const nb::bytes& text, const std::string& delimiter, std::vector<std::size_t> columns,
                   std::size_t header_records, std::size_t fields, unsigned threads) {
  const std::string_view view = view_of(text);
  const core::text::TextLayout layout{delimiter_of(delimiter), header_records, std::move(columns), fields};
  core::text::NumberTable table = run_interruptible({}, core::text::parse_numbers, view, layout, threads);
  double* const values = table.values.release();
  const nb::capsule owner(values, [](void* p) noexcept { delete[] static_cast<double*>(p); });
  return Array<double>(values, {table.rows, table.columns}, owner);
}

auto parse_fields(const nb::bytes& text, const std::string& delimiter, std::vector<std::size_t> columns,
                  std::size_t header_records, std::size_t fields, unsigned threads) {
  const std::string_view view = view_of(text);
  const core::text::TextLayout layout{delimiter_of(delimiter), header_records, std::move(columns), fields};
  const core::text::FieldTable table = run_interruptible({}, core::text::parse_fields, view, layout, threads);
  std::vector<Texts> result;
  for (std::size_t column = 0; column < table.columns; ++column) {
    const auto values = nb::steal<Texts>(PyList_New(static_cast<Py_ssize_t>(table.rows)));
    for (std::size_t row = 0; row < table.rows; ++row) {
      const core::text::Field& field = table.fields[row * table.columns + column];
      nb::str value = decoded(field.quoted ? core::text::field_value(field) : field.text);
      PyList_SetItem(values.ptr(), static_cast<Py_ssize_t>(row), value.release().ptr());
    }
    result.push_back(values);
  }
  return result;
}

std::size_t count_rows(const nb::bytes& text, const std::string& delimiter, std::size_t header_records,
                       unsigned threads) {
  const std::string_view view = view_of(text);
  const core::text::TextLayout layout{delimiter_of(delimiter), header_records, {}, 0};
  return run_interruptible({}, core::text::count_rows, view, layout, threads);
}

std::size_t line_of_row(const nb::bytes& text, const std::string& delimiter, std::size_t header_records,
                        std::size_t row) {
  const std::string_view view = view_of(text);
  const core::text::TextLayout layout{delimiter_of(delimiter), header_records, {}, 0};
  const nb::gil_scoped_release no_gil;
  return core::text::line_of_row(view, layout, row);
}

std::optional<std::tuple<std::size_t, nb::str, Texts>> first_record(const nb::bytes& text,
                                                                    const std::string& delimiter) {
  core::text::RecordReader reader(view_of(text), delimiter_of(delimiter));
  core::text::Record record;
  if (!reader.next(record)) return std::nullopt;
  Texts fields;
  for (const core::text::Field& field : core::text::split_fields(record.text, delimiter_of(delimiter))) {
    fields.append(decoded(core::text::field_value(field)));
  }
  return std::tuple(std::size_t{record.first_line}, decoded(record.text), fields);
}

std::optional<std::size_t> find_too_deep(const nb::bytes& text, std::size_t limit) {
  const std::string_view view = view_of(text);
  std::size_t found = 0;
  {
    const nb::gil_scoped_release no_gil;
    found = core::text::find_too_deep(view, limit);
  }
  return found == std::string_view::npos ? std::nullopt : std::optional(found);
}

using IndexArray = Aligned<const std::int32_t, nb::ndim<1>, nb::device::cpu>;

// Polygons of rows, and the arrays that hold them.
class PolygonRows {
 public:
  using Starts = InputArray<std::int64_t>;

  PolygonRows(const Matrix<const double>& vertices, const Starts& rings, const Starts& polygons,
              const Starts& of_rows, core::text::PolygonStyle style)
      : vertices_(vertices),
        rings_(rings),
        polygons_(polygons),
        rows_(of_rows),
        texts_{rows<core::kernel::Point>(vertices), checked(rings, vertices.shape(0)),
               checked(polygons, rings.size() - 1), checked(of_rows, polygons.size() - 1), style} {}

  const core::text::PolygonTexts& texts() const { return texts_; }

 private:
  // What begins somewhere among so many; the core reads without looking.
  static std::span<const std::int64_t> checked(const Starts& starts, std::size_t count) {
    const std::span<const std::int64_t> values(starts.data(), starts.size());
    const bool fits = !values.empty() && std::is_sorted(values.begin(), values.end()) &&
                      values.front() >= 0 && static_cast<std::size_t>(values.back()) <= count;
    if (!fits) throw nb::value_error("beginnings of rings, polygons or rows are out of order or of range");
    return values;
  }

  Matrix<const double> vertices_;
  Starts rings_, polygons_, rows_;
  core::text::PolygonTexts texts_;
};

// Holds what the columns of one call point into.
struct ColumnStore {
  std::vector<core::text::TextColumn> columns;
  std::vector<std::vector<std::string_view>> texts;
  std::vector<std::any> owners;  // objects of Python, and arrays that may be copies of what came

  std::string_view utf8(nb::handle value) {
    Py_ssize_t size = 0;
    if (const char* data = PyUnicode_AsUTF8AndSize(value.ptr(), &size)) {
      return {data, static_cast<std::size_t>(size)};
    }
    PyErr_Clear();  // surrogates of undecodable bytes go out as the bytes they came from
    PyObject* const encoded = PyUnicode_AsEncodedString(value.ptr(), "utf-8", "surrogateescape");
    if (encoded == nullptr) throw nb::python_error();
    owners.emplace_back(nb::object(nb::steal(encoded)));
    return {PyBytes_AsString(encoded), static_cast<std::size_t>(PyBytes_Size(encoded))};
  }

  template <class T>
  bool add_array(nb::handle values) {
    InputArray<T> array;
    if (!nb::try_cast(values, array, false)) return false;
    columns.push_back({std::span<const T>(array.data(), array.size()), {}});
    owners.emplace_back(array);
    return true;
  }

  bool add_numbers(nb::handle values) {
    const core::text::NumberTexts* numbers = nullptr;
    if (!nb::try_cast(values, numbers, false) || numbers == nullptr) return false;
    columns.push_back({numbers, {}});
    owners.emplace_back(nb::object(nb::borrow(values)));
    return true;
  }

  bool add_polygons(nb::handle values) {
    const PolygonRows* polygons = nullptr;
    if (!nb::try_cast(values, polygons, false) || polygons == nullptr) return false;
    columns.push_back({&polygons->texts(), {}});
    owners.emplace_back(nb::object(nb::borrow(values)));
    return true;
  }

  void add_texts(const nb::list& values) {
    std::vector<std::string_view> views;
    views.reserve(values.size());
    for (const nb::handle value : values) views.push_back(utf8(value));
    columns.push_back({std::span<const std::string_view>(views), {}});
    texts.push_back(std::move(views));  // moving a vector leaves its elements where they are
    owners.emplace_back(nb::object(values));
  }

  void add_values(nb::handle values) {
    if (nb::isinstance<nb::list>(values)) {
      add_texts(nb::borrow<nb::list>(values));
    } else if (!add_array<double>(values) && !add_array<std::int64_t>(values) &&
               !add_array<std::uint64_t>(values) && !add_numbers(values) && !add_polygons(values)) {
      throw nb::type_error(
          "a column must be a float64, int64 or uint64 array, a list of str, NumberTexts or PolygonTexts");
    }
  }

  // Every index is checked here: the core reads without looking.
  void add_index(nb::handle values, std::size_t limit) {
    const auto array = nb::cast<IndexArray>(values, false);
    const core::text::StridedIndices index{array.data(), array.size(),
                                           static_cast<std::ptrdiff_t>(array.stride(0))};
    for (std::size_t row = 0; row < index.size; ++row) {
      if (index[row] >= limit) throw nb::index_error("an index of a column is out of range");
    }
    columns.back().index = index;
    owners.emplace_back(array);
  }

  // A column is an array or a list, or a pair of values and the indices of those to show.
  void add(nb::handle column, const std::optional<InputArray<bool>>& missing) {
    const bool looks_up = nb::isinstance<nb::tuple>(column);
    add_values(looks_up ? nb::handle(column[0]) : column);
    const std::size_t values = core::text::value_count(columns.back());
    if (missing && missing->size() != values) throw nb::value_error("columns and masks must have one length");
    if (looks_up) add_index(column[1], values);
    if (core::text::row_count(columns.back()) != core::text::row_count(columns.front())) {
      throw nb::value_error("columns and masks must have one length");
    }
    if (missing) {
      columns.back().missing = {reinterpret_cast<const std::uint8_t*>(missing->data()), values};
    }
  }
};

// Around, separator and missing; without one, delimited text.
using ShapeTexts = nb::typed<nb::tuple, nb::typed<nb::tuple, nb::str, nb::ellipsis>, nb::str, nb::str>;

core::text::RowShape shape_of(const std::optional<ShapeTexts>& shape, std::size_t columns, bool by_tabs,
                              ColumnStore& store) {
  if (!shape) return core::text::delimited_shape(columns, by_tabs ? '\t' : ',');
  core::text::RowShape result;
  for (const nb::handle text : nb::cast<nb::tuple>((*shape)[0])) result.around.push_back(store.utf8(text));
  if (result.around.size() != columns + 1) throw nb::value_error("a row has one text more than columns");
  result.separator = store.utf8((*shape)[1]);
  result.missing = store.utf8((*shape)[2]);
  return result;
}

auto format_rows(const nb::typed<nb::list, nb::any>& values,
                 const std::vector<std::optional<InputArray<bool>>>& missing, const std::vector<int>& digits,
                 unsigned threads, const std::optional<ShapeTexts>& shape, bool by_tabs) {
  if (values.size() != missing.size()) throw nb::value_error("one mask, or None, a column");
  if (!digits.empty() && digits.size() != values.size())
    throw nb::value_error("one number of digits a column");
  ColumnStore store;
  for (std::size_t i = 0; i < missing.size(); ++i) store.add(values[i], missing[i]);
  for (std::size_t i = 0; i < digits.size(); ++i) store.columns[i].digits = digits[i];
  const core::text::RowShape row = shape_of(shape, missing.size(), by_tabs, store);
  const std::vector<std::string> blocks =
      run_interruptible({}, core::text::format_rows, store.columns, row, threads);
  nb::typed<nb::list, nb::bytes> result;
  for (const std::string& block : blocks) result.append(nb::bytes(block.data(), block.size()));
  return result;
}

void make_number_texts(core::text::NumberTexts* self, const InputArray<double>& values, int precision,
                       unsigned threads) {
  run_interruptible({}, [&](const core::base::Monitor& monitor) {
    new (self) core::text::NumberTexts({values.data(), values.size()}, precision, threads, monitor);
  });
}

}  // namespace

void bind_text(nb::module_& room) {
  bind_text_error(room);
  room.def("parse_numbers", &parse_numbers, "text"_a, "delimiter"_a, "columns"_a, "header_records"_a = 0,
           "fields"_a = 0, "threads"_a = 0);
  room.def("parse_fields", &parse_fields, "text"_a, "delimiter"_a, "columns"_a, "header_records"_a = 0,
           "fields"_a = 0, "threads"_a = 0);
  room.def("count_rows", &count_rows, "text"_a, "delimiter"_a, "header_records"_a = 0, "threads"_a = 0);
  room.def("line_of_row", &line_of_row, "text"_a, "delimiter"_a, "header_records"_a, "row"_a);
  room.def("first_record", &first_record, "text"_a, "delimiter"_a, "Its line, its text and its fields.");
  room.def("find_too_deep", &find_too_deep, "text"_a, "limit"_a);
  room.def("format_rows", &format_rows, "values"_a, "missing"_a, "digits"_a = std::vector<int>(),
           "threads"_a = 0, "shape"_a = nb::none(), "by_tabs"_a = false);
  nb::class_<core::text::NumberTexts>(room, "NumberTexts")
      .def("__init__", &make_number_texts, "values"_a, "precision"_a = 0, "threads"_a = 0)
      .def("__len__", &core::text::NumberTexts::size);
  nb::enum_<core::text::PolygonStyle>(room, "PolygonStyle")
      .value("wkt", core::text::PolygonStyle::wkt)
      .value("geojson", core::text::PolygonStyle::geojson)
      .value("json", core::text::PolygonStyle::json)
      .value("wkt_lines", core::text::PolygonStyle::wkt_lines)
      .value("geojson_lines", core::text::PolygonStyle::geojson_lines);
  nb::class_<PolygonRows>(room, "PolygonTexts",
                          "A column of polygons: each row from its first polygon to that of the next.")
      .def(nb::init<const Matrix<const double>&, const PolygonRows::Starts&, const PolygonRows::Starts&,
                    const PolygonRows::Starts&, core::text::PolygonStyle>(),
           "vertices"_a, "rings"_a, "polygons"_a, "rows"_a, "style"_a)
      .def("__len__", [](const PolygonRows& rows) { return rows.texts().size(); });
}

}  // namespace vorotool::bindings
