// std::atomic_ref, and what stands for it where the library has none, as libc++ before 19 (that of macOS): the
// same by the atomic builtins of GCC and Clang, of what is used here.
#pragma once

#include <atomic>
#include <version>

namespace vorotool::core::base {

#if defined(__cpp_lib_atomic_ref) && !defined(VOROTOOL_OWN_ATOMIC_REF)

using std::atomic_ref;

#else

template <class T>
class atomic_ref {
 public:
  explicit atomic_ref(T& value) : value_(&value) {}

  T load(std::memory_order order) const {
    T value;
    __atomic_load(value_, &value, static_cast<int>(order));
    return value;
  }
  void store(T value, std::memory_order order) const {
    __atomic_store(value_, &value, static_cast<int>(order));
  }
  T fetch_add(T value, std::memory_order order) const {
    return __atomic_fetch_add(value_, value, static_cast<int>(order));
  }
  // Orders are relaxed, acquire or sequential: the same where it fails.
  bool compare_exchange_weak(T& expected, T wanted, std::memory_order order) const {
    return exchange(expected, wanted, order, true);
  }
  bool compare_exchange_strong(T& expected, T wanted, std::memory_order order) const {
    return exchange(expected, wanted, order, false);
  }

 private:
  bool exchange(T& expected, T& wanted, std::memory_order order, bool is_weak) const {
    const int as = static_cast<int>(order);
    return __atomic_compare_exchange(value_, &expected, &wanted, is_weak, as, as);
  }

  T* value_;
};

#endif

}  // namespace vorotool::core::base
