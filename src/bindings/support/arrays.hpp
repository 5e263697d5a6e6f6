// NumPy arrays in and out of the core: views of what comes in, owners of what goes out.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::bindings {

namespace nb = nanobind;
using namespace nb::literals;

// What type checkers call an array of such values; of void, of any.
template <class T>
constexpr auto array_name() {
  using nanobind::detail::const_name;
  if constexpr (std::is_void_v<T>) {
    return const_name("numpy.typing.NDArray[typing.Any]");
  } else {
    return const_name("numpy.typing.NDArray[numpy.") +
           nanobind::detail::dtype_traits<std::remove_cv_t<T>>::name + const_name("]");
  }
}

// A NumPy array that goes out.
template <class T>
class Array : public nanobind::object {
 public:
  static constexpr auto Name = array_name<T>();
  using nanobind::object::object;

  Array(T* data, std::initializer_list<std::size_t> shape, const nanobind::capsule& owner)
      : object(nanobind::cast(nanobind::ndarray<nanobind::numpy, T>(data, shape, owner))) {}
};

// Arrays by their names.
using Columns = nanobind::typed<nanobind::dict, nanobind::str, nanobind::any>;

// An array whose values lie where values of their type may lie. One that came in a file or a message may
// begin at any byte: such an array is copied where it is only read, and refused where it is written.
template <class... Arguments>
class Aligned : public nanobind::ndarray<Arguments...> {
 public:
  using Base = nanobind::ndarray<Arguments...>;
  using Base::Base;
  Aligned(const Base& array) : Base(array) {}

  bool is_aligned() const {
    if (!this->is_valid()) return true;
    return reinterpret_cast<std::uintptr_t>(this->data()) % this->itemsize() == 0;
  }
};

// C-contiguous arrays of exactly this type: nothing is converted unseen.
template <class T>
using Vector = Aligned<T, nanobind::ndim<1>, nanobind::c_contig, nanobind::device::cpu>;
template <class T>
using Matrix = Aligned<T, nanobind::ndim<2>, nanobind::c_contig, nanobind::device::cpu>;

using Indices = Vector<const std::int32_t>;
using IndexRows = Matrix<const std::int32_t>;
using Places = Matrix<const double>;

template <class Array>
auto view(const Array& array) {
  return std::span(array.data(), array.size());
}

// Keeps arrays alive for as long as views of them are in use.
template <class... Arrays>
std::shared_ptr<const void> keep(const Arrays&... arrays) {
  return std::make_shared<std::tuple<Arrays...>>(arrays...);
}

// Makes an array of what outlives it in a capsule.
template <class T, class Owner>
Array<T> owned(std::unique_ptr<Owner> kept, T* data, std::initializer_list<std::size_t> shape) {
  return {data, shape,
          nanobind::capsule(kept.release(), [](void* p) noexcept { delete static_cast<Owner*>(p); })};
}

// A 1-D NumPy array that takes over the values.
template <class T>
Array<T> to_numpy(std::vector<T>&& values) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  T* data = kept->data();
  const std::size_t size = kept->size();
  return owned(std::move(kept), data, {size});
}

// An (n, 2) array that takes over the values.
template <class Value, class Row>
Array<Value> two_columns(std::vector<Row>&& values) {
  static_assert(sizeof(Row) == 2 * sizeof(Value));
  auto kept = std::make_unique<std::vector<Row>>(std::move(values));
  Value* data = reinterpret_cast<Value*>(kept->data());
  const std::size_t size = kept->size();
  return owned(std::move(kept), data, {size, 2});
}
template <class Value>
Array<Value> two_columns(std::vector<std::array<Value, 2>>&& values) {
  return two_columns<Value, std::array<Value, 2>>(std::move(values));
}
inline Array<double> two_columns(std::vector<core::kernel::Point>&& values) {
  return two_columns<double, core::kernel::Point>(std::move(values));
}

// An (n, 2, 2) array that takes over the values.
inline Array<double> pairs_of_places(std::vector<std::array<core::kernel::Point, 2>>&& values) {
  auto kept = std::make_unique<std::vector<std::array<core::kernel::Point, 2>>>(std::move(values));
  double* data = reinterpret_cast<double*>(kept->data());
  const std::size_t size = kept->size();
  return owned(std::move(kept), data, {size, 2, 2});
}

// A NumPy array of the given shape that takes over the values.
template <class T>
Array<T> to_numpy(core::base::LargeArray<T>&& values, std::initializer_list<std::size_t> shape) {
  T* data = values.release();
  return {data, shape, nanobind::capsule(data, [](void* p) noexcept {
            core::base::LargeArray<T>::free(static_cast<T*>(p));
          })};
}

// The rows of an array, which has as many columns as a row has numbers.
template <class Row, class Array>
std::span<const Row> rows(const Array& array) {
  static_assert(sizeof(Row) % sizeof(*array.data()) == 0);
  if (array.shape(1) != sizeof(Row) / sizeof(*array.data()))
    throw std::invalid_argument("an array has a wrong number of columns");
  return {reinterpret_cast<const Row*>(array.data()), array.shape(0)};
}

// A 1-D NumPy array of `field(item)` for every item.
template <class T, class Items, class Field>
Array<T> column(const Items& items, Field field) {
  std::vector<T> values;
  values.reserve(items.size());
  for (const auto& item : items) values.push_back(static_cast<T>(field(item)));
  return to_numpy(std::move(values));
}

}  // namespace vorotool::bindings

namespace nanobind::detail {

template <class... Arguments>
struct type_caster<vorotool::bindings::Aligned<Arguments...>> {
  using Array = vorotool::bindings::Aligned<Arguments...>;
  using Caster = make_caster<typename Array::Base>;
  NB_TYPE_CASTER(Array, vorotool::bindings::array_name<typename Array::Scalar>())

  template <class Flags>
  bool from_python(handle source, Flags given, cleanup_list* cleanup) noexcept {
    const auto flags = static_cast<Flags>(given & ~static_cast<Flags>(cast_flags::convert));
    if (!take(source, flags, cleanup)) return false;
    if (value.is_aligned()) return true;
    if constexpr (std::is_const_v<typename Array::Scalar>) {
      try {
        return take(module_::import_("numpy").attr("array")(source), flags, cleanup);
      } catch (python_error&) {
      }
    }
    return false;
  }

 private:
  template <class Flags>
  bool take(handle source, Flags flags, cleanup_list* cleanup) noexcept {
    Caster caster;
    if (!caster.from_python(source, flags, cleanup)) return false;
    value = Array(caster.value);
    return true;
  }
};

}  // namespace nanobind::detail
