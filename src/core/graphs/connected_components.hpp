// Which vertices of a graph are connected.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/indices.hpp"

namespace vorotool::core::graphs {

// [vertices] the smallest vertex that each is connected with.
std::vector<std::int32_t> connected_components(std::span<const base::IndexPair> edges, std::size_t vertices);

}  // namespace vorotool::core::graphs
