#include "core/base/parallel.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace vorotool::core::base {
namespace {

constexpr auto poll_interval = std::chrono::milliseconds(20);
// More threads than this never help a kernel bound by memory, and a typing error should not start a million.
constexpr unsigned most_threads = 1024;

// One parallel_for: the pieces not yet taken, what went wrong, and the threads still at work.
class Crew {
 public:
  Crew(std::size_t count, const std::function<void(std::size_t)>& body, const Monitor& monitor)
      : count_(count), body_(body), monitor_(monitor) {}

  void run(unsigned threads) {
    std::vector<std::thread> workers;
    start(workers, threads - 1);
    work([this] { poll(); });
    wait();
    for (std::thread& worker : workers) worker.join();
    if (failure_) std::rethrow_exception(failure_);
    if (interrupted_) throw Interrupted();
  }

 private:
  // A system short of threads is no error: those that could be started share the work with the caller.
  void start(std::vector<std::thread>& workers, unsigned wanted) {
    workers.reserve(wanted);
    for (unsigned i = 0; i < wanted; ++i) {
      {
        const std::lock_guard lock(mutex_);
        ++running_;
      }
      try {
        workers.emplace_back([this] {
          work([] {});
          const std::lock_guard lock(mutex_);
          --running_;
          ended_.notify_one();
        });
      } catch (const std::system_error&) {
        const std::lock_guard lock(mutex_);
        --running_;
        return;
      }
    }
  }

  // `stop_` is looked at before an index is taken, never after: a taken index is always run, hence every
  // index below a failed one has been run too.
  template <class Between>
  void work(Between between) {
    while (!stop_.load(std::memory_order_relaxed)) {
      const std::size_t index = next_.fetch_add(1, std::memory_order_relaxed);
      if (index >= count_) return;
      try {
        body_(index);
      } catch (...) {
        fail(index, std::current_exception());
      }
      done_.fetch_add(1, std::memory_order_relaxed);
      between();
    }
  }

  void fail(std::size_t index, std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    if (index >= failed_index_) return;
    failed_index_ = index;
    failure_ = std::move(failure);
  }

  // On the calling thread. A monitor that throws is treated as a piece after all others that failed.
  void poll() {
    if (!monitor_ || interrupted_) return;
    try {
      const double fraction =
          static_cast<double>(done_.load(std::memory_order_relaxed)) / static_cast<double>(count_);
      if (monitor_(fraction)) return;
      interrupted_ = true;
      stop_ = true;
    } catch (...) {
      fail(count_, std::current_exception());
    }
  }

  void wait() {
    std::unique_lock lock(mutex_);
    while (!ended_.wait_for(lock, poll_interval, [this] { return running_ == 0; })) {
      lock.unlock();  // the monitor may take its time, and fail() takes the lock
      poll();
      lock.lock();
    }
  }

  const std::size_t count_;
  const std::function<void(std::size_t)>& body_;
  const Monitor& monitor_;
  std::atomic<std::size_t> next_{0};
  std::atomic<std::size_t> done_{0};
  std::atomic<bool> stop_{false};
  bool interrupted_ = false;  // of the calling thread only
  std::mutex mutex_;          // guards the members below
  std::condition_variable ended_;
  unsigned running_ = 0;
  std::size_t failed_index_ = std::numeric_limits<std::size_t>::max();
  std::exception_ptr failure_;
};

}  // namespace

unsigned resolve_threads(unsigned threads) {
  if (threads == 0) threads = std::thread::hardware_concurrency();
  return std::clamp(threads, 1U, most_threads);
}

void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body,
                  const Monitor& monitor) {
  if (count == 0) return;
  const std::size_t useful = std::min<std::size_t>(resolve_threads(threads), count);
  Crew(count, body, monitor).run(static_cast<unsigned>(useful));
}

}  // namespace vorotool::core::base
