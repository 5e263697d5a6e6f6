// What checkers find.
#pragma once

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

inline constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

// The smallest index below `count` that is bad, or none, whatever the number of threads.
template <class Bad>
std::size_t first_bad(std::size_t count, std::size_t grain, const Bad& bad, unsigned threads,
                      const Monitor& monitor) {
  std::atomic<std::size_t> found{none};
  for_pieces(count, grain, threads, monitor, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!bad(i)) continue;
      std::size_t least = found.load();
      while (i < least && !found.compare_exchange_weak(least, i)) {
      }
      return;
    }
  });
  return found;
}

// The fault of the smallest index: check(i) gives that of item i.
template <class Check>
Fault first_fault(std::size_t count, const Check& check, unsigned threads, const Monitor& monitor) {
  const auto bad = [&](std::size_t i) { return check(i).has_value(); };
  const std::size_t found = first_bad(count, std::size_t{1} << 11, bad, threads, monitor);
  return found == none ? std::nullopt : check(found);
}

}  // namespace vorotool::core::base
