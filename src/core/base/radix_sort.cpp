#include "core/base/radix_sort.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/parallel.hpp"

namespace vorotool::core::base {

namespace {

// 11 bits a digit at most: 2048 counters stay in the first-level cache, and 33 bits take three passes.
constexpr int digit_bits = 11;
constexpr std::size_t digits = std::size_t{1} << digit_bits;

// Fewer items are not worth a thread.
constexpr std::size_t items_a_thread = std::size_t{1} << 16;

// Each thread has a part of the items, and for each digit its own place to put them: behind those of the parts before.
template <class Item, class KeyOf>
void sort_by(std::span<Item> items, int low, int high, unsigned threads, KeyOf key_of) {
  const std::size_t count = items.size();
  const std::size_t enough = std::min<std::size_t>(resolve_threads(threads), count / items_a_thread);
  const std::size_t part = count / std::max<std::size_t>(enough, 1) + 1;
  std::vector<std::array<std::size_t, digits>> starts(piece_count(count, part));
  const auto in_parts = [&](const auto& body) { for_pieces(count, part, threads, {}, body); };
  const auto other = std::make_unique_for_overwrite<Item[]>(count);
  Item* from = items.data();
  Item* to = other.get();
  const int passes = (high - low + digit_bits - 1) / digit_bits;
  const int step = passes == 0 ? 0 : (high - low + passes - 1) / passes;  // digits of about the same size
  for (int shift = low; shift < high; shift += step) {
    const std::uint64_t mask = (std::uint64_t{1} << std::min(step, high - shift)) - 1;
    in_parts([&](std::size_t piece, std::size_t begin, std::size_t end) {
      auto& start = starts[piece];
      std::fill_n(start.begin(), mask + 1, std::size_t{0});
      for (std::size_t i = begin; i < end; ++i) ++start[key_of(from[i]) >> shift & mask];
    });
    std::size_t sum = 0;
    for (std::size_t digit = 0; digit <= mask; ++digit) {
      for (auto& start : starts) sum += std::exchange(start[digit], sum);
    }
    in_parts([&](std::size_t piece, std::size_t begin, std::size_t end) {
      auto& start = starts[piece];
      for (std::size_t i = begin; i < end; ++i) to[start[key_of(from[i]) >> shift & mask]++] = from[i];
    });
    std::swap(from, to);
  }
  if (from == items.data()) return;
  in_parts([&](std::size_t, std::size_t begin, std::size_t end) {
    std::copy(from + begin, from + end, items.data() + begin);
  });
}

}  // namespace

void radix_sort(std::span<Keyed> items, int bits, unsigned threads) {
  sort_by(items, 0, bits, threads, [](const Keyed& item) { return item.key; });
}

void radix_sort(std::span<std::uint64_t> words, int low, int high, unsigned threads) {
  sort_by(words, low, high, threads, [](std::uint64_t word) { return word; });
}

}  // namespace vorotool::core::base
