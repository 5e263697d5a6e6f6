// Returns unused pages to the system, so that no more memory is held than is used. Where it cannot be told
// nothing happens.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/large_array.hpp"

#ifdef __linux__
#include <sys/mman.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace vorotool::core::base {

// Less memory than this is soon used again, by the next of many small diagrams for one: to give it back and
// to get it anew, page by page and filled with zeros, would take a third as long as the work on it.
constexpr std::size_t worth_returning = std::size_t{1} << 23;  // bytes

// Memory that was freed and is kept for later goes back to the system, if there was so much in use.
inline void return_freed_memory(std::size_t bytes) {
#ifdef __GLIBC__
  if (bytes >= worth_returning) malloc_trim(0);
#else
  static_cast<void>(bytes);
#endif
}

#ifdef __linux__
// Advises on the whole pages among items begin ... end - 1.
template <class T>
void advise(LargeArray<T>& array, std::size_t begin, std::size_t end, int advice) {
  constexpr std::uintptr_t page = 4096;
  char* const data = reinterpret_cast<char*>(array.data());
  const std::uintptr_t before = reinterpret_cast<std::uintptr_t>(data) % page;  // from the start of its page
  const std::uintptr_t first = (before + begin * sizeof(T) + page - 1) / page * page;
  const std::uintptr_t last = (before + end * sizeof(T)) / page * page;
  if (first < last) madvise(data + (first - before), last - first, advice);  // it may be refused
}
#endif

// Gives back items begin ... end - 1 of a large array, which are indeterminate then, but for a page at either
// end.
template <class T>
void discard(LargeArray<T>& array, std::size_t begin, std::size_t end) {
#ifdef __linux__
  if (array.size() * sizeof(T) >= worth_returning) advise(array, begin, end, MADV_DONTNEED);
#else
  static_cast<void>(array), static_cast<void>(begin), static_cast<void>(end);
#endif
}

// For an array that is filled in several places at once: its large pages would all be there before they are
// full.
template <class T>
LargeArray<T> with_small_pages(std::size_t size) {
  LargeArray<T> array(size);
#ifdef __linux__
  advise(array, 0, size, MADV_NOHUGEPAGE);
#endif
  return array;
}

}  // namespace vorotool::core::base
