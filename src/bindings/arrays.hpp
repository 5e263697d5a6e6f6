// NumPy arrays in and out of the core: views of what comes in, owners of what goes out.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/large_array.hpp"
#include "core/kernel/point.hpp"

namespace vorotool::bindings {

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

// C-contiguous arrays of exactly this type: bind them with noconvert(), so that nothing is converted unseen.
template <class T>
using Vector = Aligned<T, nanobind::ndim<1>, nanobind::c_contig, nanobind::device::cpu>;
template <class T>
using Matrix = Aligned<T, nanobind::ndim<2>, nanobind::c_contig, nanobind::device::cpu>;

template <class Array>
auto view(const Array& array) {
  return std::span(array.data(), array.size());
}

// A 1-D NumPy array that takes over the values.
template <class T>
nanobind::object to_numpy(std::vector<T>&& values) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  T* data = kept->data();
  const std::size_t size = kept->size();
  const nanobind::capsule owner(kept.release(),
                                [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nanobind::cast(nanobind::ndarray<nanobind::numpy, T, nanobind::ndim<1>>(data, {size}, owner));
}

// An (n, 2) array that takes over the values.
template <class Value, class Row>
nanobind::object two_columns(std::vector<Row>&& values) {
  static_assert(sizeof(Row) == 2 * sizeof(Value));
  auto kept = std::make_unique<std::vector<Row>>(std::move(values));
  Value* data = reinterpret_cast<Value*>(kept->data());
  const std::size_t size = kept->size();
  const nanobind::capsule owner(kept.release(),
                                [](void* p) noexcept { delete static_cast<std::vector<Row>*>(p); });
  return nanobind::cast(nanobind::ndarray<nanobind::numpy, Value>(data, {size, 2}, owner));
}

template <class Value>
nanobind::object two_columns(std::vector<std::array<Value, 2>>&& values) {
  return two_columns<Value, std::array<Value, 2>>(std::move(values));
}
inline nanobind::object two_columns(std::vector<core::kernel::Point>&& values) {
  return two_columns<double, core::kernel::Point>(std::move(values));
}

// A NumPy array of the given shape that takes over the values.
template <class T>
nanobind::object to_numpy(core::base::LargeArray<T>&& values, std::initializer_list<std::size_t> shape) {
  T* data = values.release();
  const nanobind::capsule owner(
      data, [](void* p) noexcept { core::base::LargeArray<T>::free(static_cast<T*>(p)); });
  return nanobind::cast(nanobind::ndarray<nanobind::numpy, T>(data, shape, owner));
}

// The rows of an array with so many columns of numbers.
template <class Row, std::size_t columns = 2, class Array>
std::span<const Row> rows(const Array& array) {
  static_assert(sizeof(Row) == columns * sizeof(*array.data()));
  if (array.shape(1) != columns) throw std::invalid_argument("an array has a wrong number of columns");
  return {reinterpret_cast<const Row*>(array.data()), array.shape(0)};
}

// A 1-D NumPy array of `field(item)` for every item.
template <class T, class Items, class Field>
nanobind::object column(const Items& items, Field field) {
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
  NB_TYPE_CASTER(Array, Caster::Name)

  template <class Flags>
  bool from_python(handle source, Flags flags, cleanup_list* cleanup) noexcept {
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
