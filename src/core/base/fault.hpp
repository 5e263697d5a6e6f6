// What checkers find.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "core/base/monitor.hpp"
#include "core/base/parallel.hpp"

namespace vorotool::core::base {

// What is wrong, in words; nothing if all is right.
using Fault = std::optional<std::string>;

// The fault of the smallest index, whatever the number of threads: check(i) gives that of item i.
template <class Check>
Fault first_fault(std::size_t count, const Check& check, unsigned threads, const Monitor& monitor) {
  constexpr std::size_t grain = 1 << 11, none = std::numeric_limits<std::size_t>::max();
  std::atomic<std::size_t> found{none};
  const auto search = [&](std::size_t piece) {
    const std::size_t end = std::min(count, (piece + 1) * grain);
    for (std::size_t i = piece * grain; i < end; ++i) {
      if (!check(i)) continue;
      std::size_t least = found.load();
      while (i < least && !found.compare_exchange_weak(least, i)) {
      }
      return;
    }
  };
  parallel_for(piece_count(count, grain), threads, search, monitor);
  return found == none ? std::nullopt : check(found);
}

}  // namespace vorotool::core::base
