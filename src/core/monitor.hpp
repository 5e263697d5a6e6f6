// How a long kernel reports progress and learns that it should stop.
#pragma once

#include <functional>
#include <stdexcept>

namespace vorotool::core {

// Called on the calling thread, every few milliseconds of work, with the fraction done in [0, 1].
// Returns false to stop; the kernel then throws Interrupted. An empty Monitor never stops a kernel.
using Monitor = std::function<bool(double)>;

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace vorotool::core
