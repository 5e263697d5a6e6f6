// Points and rows of indices as the core takes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "arrays.hpp"
#include "core/predicates.hpp"

namespace vorotool::bindings {

using Indices = Vector<const std::int32_t>;
using IndexRows = Matrix<const std::int32_t>;

inline std::span<const core::Point> as_points(const Matrix<const double>& array) {
  if (array.shape(1) != 2) throw std::invalid_argument("points must have two columns");
  static_assert(sizeof(core::Point) == 2 * sizeof(double));
  return {reinterpret_cast<const core::Point*>(array.data()), array.shape(0)};
}

inline std::span<const std::int32_t> rows_of(const IndexRows& array, std::size_t columns) {
  if (array.shape(1) != columns)
    throw std::invalid_argument("an array of indices has a wrong number of columns");
  return view(array);
}

}  // namespace vorotool::bindings
