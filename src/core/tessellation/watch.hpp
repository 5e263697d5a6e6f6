// An interrupt in the middle of a band of rows.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "core/base/monitor.hpp"

namespace vorotool::core::tessellation {

// Lets an interrupt end a band before it is complete: the calling thread asks the monitor between rows, the
// others look whether it has said no.
class Watch {
 public:
  explicit Watch(const base::Monitor& monitor) : monitor_(monitor), caller_(std::this_thread::get_id()) {}

  // Called by parallel_for between bands.
  base::Monitor monitor() {
    if (!monitor_) return {};
    return [this](double fraction) { return ask(fraction); };
  }

  void after_row(std::int32_t row) {
    if (!monitor_ || row % rows_between != 0) return;
    if (stopped_.load(std::memory_order_relaxed)) throw base::Interrupted();
    if (std::this_thread::get_id() == caller_ && !ask(fraction_)) throw base::Interrupted();
  }

 private:
  static constexpr std::int32_t rows_between = 16;

  bool ask(double fraction) {
    fraction_ = fraction;
    if (!stopped_ && !monitor_(fraction)) stopped_ = true;  // a monitor that has said no is not asked again
    return !stopped_;
  }

  const base::Monitor& monitor_;
  const std::thread::id caller_;
  double fraction_ = 0.0;  // of the calling thread only
  std::atomic<bool> stopped_{false};
};

}  // namespace vorotool::core::tessellation
