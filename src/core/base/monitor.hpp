// How a long kernel reports progress and learns that it should stop.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>

namespace vorotool::core::base {

// Called on the calling thread, every few milliseconds of work, with the fraction done in [0, 1].
// Returns false to stop; the kernel then throws Interrupted. An empty Monitor never stops a kernel.
using Monitor = std::function<bool(double)>;

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

// Lets the monitor know at every 2^16th item, which should take some tens of nanoseconds each.
inline void report_item(const Monitor& monitor, std::size_t item) {
  if (item % (std::size_t{1} << 16) == 0 && monitor && !monitor(0)) throw Interrupted();
}

}  // namespace vorotool::core::base
