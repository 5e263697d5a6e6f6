#include "core/alpha/radius_ranks.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <mutex>
#include <utility>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/radix_sort.hpp"

namespace vorotool::core::alpha {

using base::LargeArray;
using base::Monitor;
using base::parallel_for;

namespace {

constexpr std::size_t ranks_a_piece = std::size_t{1} << 16;  // items: about a millisecond of work

// Bits of a non-negative double increase with it. Less the bits of the smallest value they are cut to the
// leading 33; the item's number goes below, in the other 31. Values that agree in these bits are rare, and
// compared afterwards. The highest 11 of the 33 choose a bucket; within it two passes of 11 bits sort.
constexpr int item_bits = 31;
constexpr int key_bits = 33;
constexpr int bucket_bits = 11;
constexpr int digit_bits = key_bits - bucket_bits;
constexpr std::size_t buckets = std::size_t{1} << bucket_bits;

std::uint64_t bits_of(double value) { return std::bit_cast<std::uint64_t>(value + 0.0); }  // -0 becomes 0

class Sorter {
 public:
  Sorter(std::span<const double> values, const CompareItems& compare, unsigned threads,
         const Monitor& monitor, int open_bits)
      : values_(values),
        open_bits_(open_bits),
        compare_(compare),
        threads_(threads),
        monitor_(monitor),
        counts_(base::piece_count(values.size(), ranks_a_piece)),
        distinct_(buckets) {}

  RadiusRanks run() {
    find_range();
    count();
    LargeArray<std::uint64_t> words(start_[buckets]);
    fill(words);
    parallel_for(buckets, threads_, [&](std::size_t b) { sort_bucket(b, words); }, monitor_);
    settle_long_runs();
    LargeArray<double> sorted(start_[buckets]);
    parallel_for(buckets, threads_, [&](std::size_t b) { gather(b, words, sorted); }, monitor_);
    return write(words, sorted);
  }

 private:
  // Calls visit(piece, item) for the items that take part.
  template <class Visit>
  void visit_items(std::size_t piece, Visit visit) const {
    const std::size_t end = std::min(values_.size(), (piece + 1) * ranks_a_piece);
    for (std::size_t i = piece * ranks_a_piece; i < end; ++i) {
      if (!(values_[i] < 0)) visit(i);
    }
  }

  // What counts of the value of an item.
  double value_of(std::size_t item) const {
    return open_bits_ == 0 ? values_[item] : rounded_by(open_bits_, values_[item]);
  }
  std::uint64_t key(std::size_t item) const { return (bits_of(value_of(item)) - least_) >> shift_; }

  void find_range() {
    std::vector<std::uint64_t> least(counts_.size(), ~std::uint64_t{0}), most(counts_.size(), 0);
    const auto find = [&](std::size_t piece) {
      visit_items(piece, [&](std::size_t i) {
        least[piece] = std::min(least[piece], bits_of(value_of(i)));
        most[piece] = std::max(most[piece], bits_of(value_of(i)));
      });
    };
    parallel_for(counts_.size(), threads_, find, monitor_);
    std::uint64_t last = 0;
    for (std::size_t piece = 0; piece < counts_.size(); ++piece) {
      least_ = std::min(least_, least[piece]);
      last = std::max(last, most[piece]);
    }
    if (last >= least_) shift_ = std::max(0, static_cast<int>(std::bit_width(last - least_)) - key_bits);
  }

  // How many items of each piece go to each bucket, then where they go.
  void count() {
    const auto count_piece = [&](std::size_t piece) {
      counts_[piece].fill(0);
      visit_items(piece, [&](std::size_t i) { ++counts_[piece][key(i) >> digit_bits]; });
    };
    parallel_for(counts_.size(), threads_, count_piece, monitor_);
    std::size_t sum = 0;
    for (std::size_t b = 0; b < buckets; ++b) {
      start_[b] = sum;
      for (auto& counts : counts_) {
        const std::size_t here = counts[b];
        counts[b] = static_cast<std::uint32_t>(sum);
        sum += here;
      }
    }
    start_[buckets] = sum;
  }

  void fill(LargeArray<std::uint64_t>& words) {
    const auto fill_piece = [&](std::size_t piece) {
      auto& places = counts_[piece];
      visit_items(piece, [&](std::size_t i) {
        const std::uint64_t k = key(i);
        words[places[k >> digit_bits]++] = k << item_bits | i;
      });
    };
    parallel_for(counts_.size(), threads_, fill_piece, monitor_);
  }

  static std::uint32_t item_of(std::uint64_t word) { return static_cast<std::uint32_t>(word & 0x7fffffff); }

  // Puts the words of a bucket in the order of the exact values. What is left of them are the numbers of the
  // items, marked where a value begins; long runs of equal doubles are left for settle_long_runs.
  void sort_bucket(std::size_t bucket, LargeArray<std::uint64_t>& words) {
    const std::span<std::uint64_t> place(words.data() + start_[bucket], words.data() + start_[bucket + 1]);
    if (place.empty()) return;
    std::vector<std::uint64_t> chosen(place.begin(), place.end());
    base::radix_sort(chosen, item_bits, item_bits + digit_bits);
    std::copy(chosen.begin(), chosen.end(), place.begin());
    for (std::size_t i = 0; i < place.size();) {
      std::size_t end = i + 1;
      while (end < place.size() && place[end] >> item_bits == place[i] >> item_bits) ++end;
      settle_key(place.subspan(i, end - i));
      i = end;
    }
  }

  double value(std::uint64_t word) const { return value_of(item_of(word)); }

  // Sorts words with one key by value, and runs of equal values exactly.
  void settle_key(std::span<std::uint64_t> words) {
    for (std::uint64_t& word : words) word = item_of(word);
    if (words.size() == 1) {  // nearly always
      words[0] |= starts;
      return;
    }
    const auto comes_before = [&](std::uint64_t a, std::uint64_t b) {
      return value(a) != value(b) ? value(a) < value(b) : a < b;
    };
    if (!std::is_sorted(words.begin(), words.end(), comes_before))
      std::sort(words.begin(), words.end(), comes_before);
    for (std::size_t i = 0; i < words.size();) {
      std::size_t end = i + 1;
      while (end < words.size() && value(words[end]) == value(words[i])) ++end;
      settle_equal(words.subspan(i, end - i));
      i = end;
    }
  }

  void settle_equal(std::span<std::uint64_t> words) {
    if (words.size() > long_run) {
      const std::lock_guard lock(mutex_);
      long_runs_.push_back(words);
      return;
    }
    std::vector<std::int8_t> signs;
    while (!words.empty()) {
      std::swap(words[0], words[words.size() / 2]);
      signs.resize(words.size());
      for (std::size_t i = 0; i < words.size(); ++i) signs[i] = compared(words, i);
      const auto [before, after] = part(words, signs);
      // The smaller part by recursion: its depth is logarithmic.
      settle_equal(before.size() < after.size() ? before : after);
      words = before.size() < after.size() ? after : before;
    }
  }

  // On all threads together, since there may be but one such run; and the monitor is served.
  void settle_long_runs() {
    std::vector<std::int8_t> signs;
    while (!long_runs_.empty()) {
      const std::span<std::uint64_t> words = long_runs_.back();
      long_runs_.pop_back();
      std::swap(words[0], words[words.size() / 2]);
      signs.resize(words.size());
      base::for_items(words.size(), long_run, threads_, monitor_,
                      [&](std::size_t i) { signs[i] = compared(words, i); });
      const auto [before, after] = part(words, signs);
      settle_equal(before);
      settle_equal(after);
    }
  }

  std::int8_t compared(std::span<const std::uint64_t> words, std::size_t i) const {
    return i == 0 ? std::int8_t{0} : static_cast<std::int8_t>(compare_(item_of(words[i]), item_of(words[0])));
  }

  // Words whose values are less than, equal to and greater than that of the first one, by the signs; the
  // first and the last part remain to be settled.
  static std::pair<std::span<std::uint64_t>, std::span<std::uint64_t>> part(
      std::span<std::uint64_t> words, const std::vector<std::int8_t>& signs) {
    std::array<std::vector<std::uint64_t>, 3> parts;
    for (std::size_t i = 0; i < words.size(); ++i)
      parts[static_cast<std::size_t>(signs[i] + 1)].push_back(words[i]);
    parts[1][0] |= starts;
    auto place = words.begin();
    for (const auto& one : parts) place = std::copy(one.begin(), one.end(), place);
    return {words.first(parts[0].size()), words.last(parts[2].size())};
  }

  void gather(std::size_t bucket, const LargeArray<std::uint64_t>& words, LargeArray<double>& sorted) {
    for (std::size_t i = start_[bucket]; i < start_[bucket + 1]; ++i) {
      sorted[i] = values_[item_of(words[i])];
      distinct_[bucket] += (words[i] & starts) != 0;
    }
  }

  RadiusRanks write(const LargeArray<std::uint64_t>& words, const LargeArray<double>& sorted) {
    std::size_t sum = 0;
    for (std::size_t& distinct : distinct_) sum += std::exchange(distinct, sum);
    RadiusRanks out{LargeArray<double>(sum), LargeArray<std::int32_t>(sum),
                    LargeArray<std::int32_t>(values_.size())};
    base::for_items(values_.size(), ranks_a_piece, threads_, monitor_, [&](std::size_t i) {
      if (values_[i] < 0) out.rank[i] = static_cast<std::int32_t>(sum);
    });
    const auto write_bucket = [&](std::size_t bucket) {
      std::size_t next = distinct_[bucket];
      for (std::size_t i = start_[bucket]; i < start_[bucket + 1]; ++i) {
        const std::uint32_t item = item_of(words[i]);
        if (words[i] & starts) {
          out.value[next] = sorted[i];
          out.witness[next] = static_cast<std::int32_t>(item);
          ++next;
        }
        out.rank[item] = static_cast<std::int32_t>(next - 1);
      }
    };
    parallel_for(buckets, threads_, write_bucket, monitor_);
    return out;
  }

  static constexpr std::size_t long_run = std::size_t{1} << 12;  // some milliseconds of exact comparisons
  static constexpr std::uint64_t starts = std::uint64_t{1} << item_bits;  // once sorted the key is not needed

  std::span<const double> values_;
  int open_bits_;
  const CompareItems& compare_;
  unsigned threads_;
  const Monitor& monitor_;
  std::uint64_t least_ = ~std::uint64_t{0};
  int shift_ = 0;
  std::vector<std::array<std::uint32_t, buckets>> counts_;  // [pieces]
  std::array<std::size_t, buckets + 1> start_{};
  std::vector<std::span<std::uint64_t>> long_runs_;  // in any order
  std::mutex mutex_;                                 // guards them
  std::vector<std::size_t> distinct_;  // values of each bucket; once all are sorted, of those before it
};

}  // namespace

RadiusRanks rank_radii(std::span<const double> values, const CompareItems& compare, unsigned threads,
                       const Monitor& monitor, int open_bits) {
  return Sorter(values, compare, threads, monitor, open_bits).run();
}

}  // namespace vorotool::core::alpha
