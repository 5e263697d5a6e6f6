// Lets Ctrl-C and a progress callback reach a kernel that runs without the GIL.
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <functional>
#include <utility>

#include "core/base/monitor.hpp"

namespace vorotool::bindings {

// What is called with the fraction done, or None: bind it with none().
class Progress : public nanobind::object {
 public:
  static constexpr auto Name = nanobind::detail::const_name("collections.abc.Callable[[float], object]");
  using nanobind::object::object;
  static bool check_(nanobind::handle value) { return value.is_none() || PyCallable_Check(value.ptr()) != 0; }
};

// A Monitor that at most every 50 ms takes the GIL, lets Python handle signals, and calls `progress`
// with the fraction done. It returns false when a Python error is set. `progress` must outlive the monitor.
inline core::base::Monitor python_monitor(const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  static constexpr auto interval = std::chrono::milliseconds(50);
  return [&progress, next = Clock::now() + interval](double fraction) mutable {
    const auto now = Clock::now();
    if (now < next) return true;
    const nanobind::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) return false;
    if (progress.is_valid() && !progress.is_none()) {
      try {
        progress(fraction);
      } catch (nanobind::python_error& error) {
        error.restore();
        return false;
      }
    }
    next = Clock::now() + interval;
    return true;
  };
}

// Returns kernel(arguments..., monitor), called without the GIL. An interrupted kernel raises the Python error
// that stopped it. The kernel must touch no Python object, and its result must be no Python object either.
template <class Kernel, class... Arguments>
auto run_interruptible(const Progress& progress, Kernel&& kernel, Arguments&&... arguments) {
  const core::base::Monitor monitor = python_monitor(progress);
  try {
    const nanobind::gil_scoped_release no_gil;
    return std::invoke(std::forward<Kernel>(kernel), std::forward<Arguments>(arguments)..., monitor);
  } catch (const core::base::Interrupted&) {
    throw nanobind::python_error();
  }
}

}  // namespace vorotool::bindings
