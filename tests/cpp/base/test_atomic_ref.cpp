// What stands for std::atomic_ref where the library has none.
#define VOROTOOL_OWN_ATOMIC_REF
#include "core/base/atomic_ref.hpp"

#include <cstdint>
#include <thread>
#include <vector>

#include "check.hpp"

using vorotool::core::base::atomic_ref;
using vorotool::tests::equal;

TEST(atomic_counts_of_several_threads_are_added) {
  std::uint32_t counter = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 10000; ++i) atomic_ref(counter).fetch_add(1, std::memory_order_relaxed);
    });
  }
  for (std::thread& thread : threads) thread.join();
  equal(counter, 40000U);
  equal(atomic_ref(counter).fetch_add(2, std::memory_order_relaxed), 40000U);
  equal(atomic_ref(counter).load(std::memory_order_acquire), 40002U);
}

TEST(atomic_exchange_tells_what_is_there) {
  double value = 3;
  const atomic_ref shared(value);
  double expected = 2;
  CHECK(!shared.compare_exchange_strong(expected, 1, std::memory_order_acquire));
  equal(expected, 3.0);
  CHECK(shared.compare_exchange_strong(expected, 1, std::memory_order_acquire));
  equal(value, 1.0);
  shared.store(5, std::memory_order_release);
  double found = 1;
  while (!shared.compare_exchange_weak(found, found + 1, std::memory_order_relaxed)) {
  }
  equal(value, 6.0);
}
