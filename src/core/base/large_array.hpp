// Memory for large flat arrays: not filled before it is used, and in large pages where the system has them.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace vorotool::core::base {

// An array of trivial items that are indeterminate until written. The thread that writes a page first pays
// for it, so filling costs nothing twice and is shared by the threads. Large pages save most of that, and
// misses of addresses.
template <class T>
class LargeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  LargeArray() = default;
  explicit LargeArray(std::size_t size) : size_(size), data_(allocate(size)) {}

  std::size_t size() const { return size_; }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  // The same memory for items of another kind, which are indeterminate, and of no more bytes.
  template <class Other>
  LargeArray<Other> reused(std::size_t size) && {
    LargeArray<Other> other;
    other.size_ = size, size_ = 0;
    other.data_.reset(reinterpret_cast<Other*>(data_.release()));
    return other;
  }
  // Gives the memory away; it is to be freed by LargeArray<T>::free.
  T* release() { return data_.release(); }
  static void free(T* data) { ::operator delete(data, alignment); }

 private:
  template <class Other>
  friend class LargeArray;

  static constexpr std::size_t page = 4096;
  static constexpr std::size_t large_page = std::size_t{1} << 21;
  static constexpr std::align_val_t alignment{page};  // madvise wants whole pages

  struct Free {
    void operator()(T* data) const { free(data); }
  };

  static T* allocate(std::size_t size) {
    const std::size_t bytes = size * sizeof(T);
    void* data = ::operator new(bytes, alignment);
#ifdef __linux__
    if (bytes >= large_page) madvise(data, bytes / page * page, MADV_HUGEPAGE);  // advice: it may be refused
#endif
    return static_cast<T*>(data);
  }

  std::size_t size_ = 0;
  std::unique_ptr<T[], Free> data_;
};

}  // namespace vorotool::core::base
