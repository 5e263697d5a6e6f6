// What both kinds of skeletons take from Python and give to it.
#pragma once

#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

#include "bindings/support/arrays.hpp"
#include "core/skeleton/extraction.hpp"

namespace vorotool::bindings {

using Box = std::tuple<double, double, double, double>;  // least and most x, then y, on the lattice
using Clipped = std::optional<std::pair<std::int32_t, Box>>;

inline std::optional<core::skeleton::ClippedGroup> clipped_group(const Clipped& clipped) {
  if (!clipped) return std::nullopt;
  const auto [least_x, most_x, least_y, most_y] = clipped->second;
  return core::skeleton::ClippedGroup{clipped->first, {least_x, most_x, least_y, most_y}};
}

inline Columns as_dict(core::skeleton::SkeletonArrays&& made) {
  Columns result;
  result["vertices"] = two_columns(std::move(made.vertices));
  result["radius"] = to_numpy(std::move(made.radius));
  result["frame_side"] = to_numpy(std::move(made.side));
  result["arcs"] = two_columns(std::move(made.arcs));
  result["control"] = two_columns(std::move(made.control));
  result["sites"] = two_columns(std::move(made.sites));
  result["group"] = to_numpy(std::move(made.group));
  result["branch"] = to_numpy(std::move(made.branch));
  result["length"] = to_numpy(std::move(made.length));
  return result;
}

}  // namespace vorotool::bindings
