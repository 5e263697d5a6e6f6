#include "core/spectrum.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <vector>

#include "core/parallel.hpp"
#include "core/radix_sort.hpp"

namespace vorotool::core {
namespace {

constexpr std::size_t piece_size = std::size_t{1} << 16;  // items: about a millisecond of work

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
         const Monitor& monitor)
      : values_(values),
        compare_(compare),
        threads_(threads),
        monitor_(monitor),
        counts_(piece_count(values.size(), piece_size)),
        distinct_(buckets) {}

  Spectrum run() {
    find_range();
    count();
    LargeArray<std::uint64_t> words(start_[buckets]);
    fill(words);
    LargeArray<double> sorted(start_[buckets]);
    parallel_for(buckets, threads_, [&](std::size_t b) { sort_bucket(b, words, sorted.data()); }, monitor_);
    return write(words, sorted);
  }

 private:
  // Calls visit(piece, item) for the items that take part.
  template <class Visit>
  void visit_items(std::size_t piece, Visit visit) const {
    const std::size_t end = std::min(values_.size(), (piece + 1) * piece_size);
    for (std::size_t i = piece * piece_size; i < end; ++i) {
      if (!(values_[i] < 0)) visit(i);
    }
  }

  std::uint64_t key(std::size_t item) const { return (bits_of(values_[item]) - least_) >> shift_; }

  void find_range() {
    std::vector<std::uint64_t> least(counts_.size(), ~std::uint64_t{0}), most(counts_.size(), 0);
    const auto find = [&](std::size_t piece) {
      visit_items(piece, [&](std::size_t i) {
        least[piece] = std::min(least[piece], bits_of(values_[i]));
        most[piece] = std::max(most[piece], bits_of(values_[i]));
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

  // Puts the words of a bucket in the order of the exact values, and what is left of them are the numbers of
  // the items, marked where a value begins.
  void sort_bucket(std::size_t bucket, LargeArray<std::uint64_t>& words, double* sorted) {
    const std::size_t begin = start_[bucket], end = start_[bucket + 1];
    if (begin == end) return;
    std::vector<std::uint64_t> chosen(words.data() + begin, words.data() + end);
    radix_sort(chosen, item_bits, item_bits + digit_bits);
    settle(chosen, 0, chosen.size());
    std::size_t distinct = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      words[begin + i] = chosen[i];
      sorted[begin + i] = values_[item_of(chosen[i])];
      distinct += (chosen[i] & starts) != 0;
    }
    distinct_[bucket] = distinct;
  }

  // Sorts runs of words with equal keys by value, and of these runs with equal values exactly.
  void settle(std::vector<std::uint64_t>& words, std::size_t begin, std::size_t end) const {
    const auto value = [&](std::uint64_t word) { return values_[item_of(word)]; };
    for (std::size_t i = begin; i < end;) {
      std::size_t run = i + 1;
      while (run < end && words[run] >> item_bits == words[i] >> item_bits) ++run;
      const auto same_key = std::span(words).subspan(i, run - i);
      for (std::uint64_t& word : same_key) word = item_of(word);
      const auto comes_before = [&](std::uint64_t a, std::uint64_t b) {
        return value(a) != value(b) ? value(a) < value(b) : a < b;
      };
      if (!std::is_sorted(same_key.begin(), same_key.end(), comes_before)) {
        std::sort(same_key.begin(), same_key.end(), comes_before);
      }
      for (std::size_t j = i; j < run;) {
        std::size_t equal = j + 1;
        while (equal < run && value(words[equal]) == value(words[j])) ++equal;
        settle_equal(std::span(words).subspan(j, equal - j));
        j = equal;
      }
      i = run;
    }
  }

  // Items with one double: those less than one in the middle, those equal to it, those greater, and so on
  // within both; the smaller part by recursion, so that its depth is logarithmic.
  void settle_equal(std::span<std::uint64_t> words) const {
    while (!words.empty()) {
      std::swap(words[0], words[words.size() / 2]);
      std::vector<std::uint64_t> less, greater;
      std::size_t equal = 1;
      for (const std::uint64_t word : words.subspan(1)) {
        const int sign = compare_(item_of(word), item_of(words[0]));
        if (sign == 0) {
          words[equal++] = word;
        } else {
          (sign < 0 ? less : greater).push_back(word);
        }
      }
      const auto middle = words.subspan(less.size(), equal);
      std::copy_backward(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(equal), middle.end());
      std::copy(less.begin(), less.end(), words.begin());
      std::copy(greater.begin(), greater.end(), middle.end());
      middle[0] |= starts;
      const auto before = words.first(less.size()), after = words.last(greater.size());
      settle_equal(before.size() < after.size() ? before : after);
      words = before.size() < after.size() ? after : before;
    }
  }

  Spectrum write(const LargeArray<std::uint64_t>& words, const LargeArray<double>& sorted) {
    std::size_t sum = 0;
    for (std::size_t& distinct : distinct_) {
      const std::size_t here = distinct;
      distinct = sum;
      sum += here;
    }
    Spectrum out{LargeArray<double>(sum), LargeArray<std::int32_t>(sum),
                 LargeArray<std::int32_t>(values_.size())};
    const auto leave_out = [&](std::size_t piece) {
      const std::size_t end = std::min(values_.size(), (piece + 1) * piece_size);
      for (std::size_t i = piece * piece_size; i < end; ++i) {
        if (values_[i] < 0) out.rank[i] = static_cast<std::int32_t>(sum);
      }
    };
    parallel_for(counts_.size(), threads_, leave_out, monitor_);
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

  static constexpr std::uint64_t starts = std::uint64_t{1} << item_bits;  // once sorted the key is not needed

  std::span<const double> values_;
  const CompareItems& compare_;
  unsigned threads_;
  const Monitor& monitor_;
  std::uint64_t least_ = ~std::uint64_t{0};
  int shift_ = 0;
  std::vector<std::array<std::uint32_t, buckets>> counts_;  // [pieces]
  std::array<std::size_t, buckets + 1> start_{};
  std::vector<std::size_t> distinct_;  // values of each bucket; once all are sorted, of those before it
};

}  // namespace

Spectrum make_spectrum(std::span<const double> values, const CompareItems& compare, unsigned threads,
                       const Monitor& monitor) {
  return Sorter(values, compare, threads, monitor).run();
}

}  // namespace vorotool::core
