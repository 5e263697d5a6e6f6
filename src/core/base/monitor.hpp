// How a long kernel reports progress and learns that it should stop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>

namespace vorotool::core::base {

// Called on the calling thread, every few milliseconds of work, with the fraction done in [0, 1].
// Returns false to stop; the kernel then throws Interrupted. An empty Monitor never stops a kernel.
using Monitor = std::function<bool(double)>;

struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

// Lets the monitor know which fraction is done.
inline void report(const Monitor& monitor, double fraction) {
  if (monitor && !monitor(fraction)) throw Interrupted();
}

// The monitor of a part of the work, which is the whole from one fraction to another. It holds no copy.
inline Monitor part_of(const Monitor& whole, double from, double to) {
  if (!whole) return {};
  return [&whole, from, to](double part) { return whole(from + (to - from) * part); };
}

// The monitors of equal shares of the work, one after the other. It holds no copy.
class Passes {
 public:
  Passes(const Monitor& whole, int count) : whole_(whole), share_(1.0 / count) {}

  Monitor next() {
    const double from = share_ * done_++;
    return part_of(whole_, from, share_ * done_);
  }

  // Tells of no progress: of what belongs to the share before, and is long at times.
  Monitor same() const { return part_of(whole_, share_ * done_, share_ * done_); }

 private:
  const Monitor& whole_;
  double share_;
  int done_ = 0;
};

// Lets the monitor know at every 2^16th item, which should take some tens of nanoseconds each; of how many
// items, where that is known.
inline void report_item(const Monitor& monitor, std::size_t item, std::size_t items = SIZE_MAX) {
  if (item % (std::size_t{1} << 16) == 0)
    report(monitor, static_cast<double>(item) / static_cast<double>(items));
}

}  // namespace vorotool::core::base
