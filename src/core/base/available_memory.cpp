#include "core/base/available_memory.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace vorotool::core::base {

#ifdef __linux__
namespace {

// The number after a word of a file, which is "" for the first of all.
std::optional<std::size_t> number_in(const char* path, const std::string& word) {
  std::ifstream file(path);
  std::string next;
  if (!word.empty()) {
    while (file >> next && next != word) {
    }
  }
  std::size_t value = 0;
  return file >> value ? std::optional(value) : std::nullopt;
}

std::size_t left(std::size_t limit, std::size_t used) { return limit - std::min(limit, used); }

std::size_t left_in_system() {
  const auto available = number_in("/proc/meminfo", "MemAvailable:");
  if (!available) return SIZE_MAX;
  return 1024 * (*available + number_in("/proc/meminfo", "SwapFree:").value_or(0));
}

// Files that are kept in memory are let go first.
std::size_t left_in_group() {
  if (const auto limit = number_in("/sys/fs/cgroup/memory.max", "")) {
    const std::size_t files = number_in("/sys/fs/cgroup/memory.stat", "inactive_file").value_or(0);
    return left(*limit, left(number_in("/sys/fs/cgroup/memory.current", "").value_or(0), files));
  }
  if (const auto limit = number_in("/sys/fs/cgroup/memory/memory.limit_in_bytes", "")) {
    const std::size_t files =
        number_in("/sys/fs/cgroup/memory/memory.stat", "total_inactive_file").value_or(0);
    return left(*limit,
                left(number_in("/sys/fs/cgroup/memory/memory.usage_in_bytes", "").value_or(0), files));
  }
  return SIZE_MAX;
}

std::size_t left_of_addresses() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return SIZE_MAX;
  const std::size_t page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return left(limit.rlim_cur, page * number_in("/proc/self/statm", "").value_or(0));
}

}  // namespace

std::size_t available_memory() { return std::min({left_in_system(), left_in_group(), left_of_addresses()}); }
#else
std::size_t available_memory() { return SIZE_MAX; }
#endif

}  // namespace vorotool::core::base
