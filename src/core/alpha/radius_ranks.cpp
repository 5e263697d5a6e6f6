#include "core/alpha/radius_ranks.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/parallel.hpp"

namespace vorotool::core::alpha {

using base::LargeArray;
using base::Monitor;
using base::parallel_for;
using numbers::DoubleDouble;

namespace {

constexpr std::size_t ranks_a_piece = std::size_t{1} << 16;  // items: about a millisecond of work

// Bits of a non-negative double increase with it. Those of a sample of the values, cut to the leading 16 of their range,
// choose buckets of about so many items, which stay in the cache while they are sorted, by the leading bits of the range
// of each. Values that agree in these are rare, and compared afterwards.
constexpr std::size_t items_a_bucket = std::size_t{1} << 13;
constexpr std::size_t most_buckets = std::size_t{1} << 11;
constexpr std::size_t most_samples = std::size_t{1} << 15;
constexpr std::size_t outer_part = 512;  // of the sample, less or greater than the range
constexpr int sample_bits = 13, digit_bits = 9;
constexpr int word_bits = 31;  // of positions; the key is above them
constexpr std::uint16_t left_out = 0xffff;

std::uint64_t bits_of(double value) { return std::bit_cast<std::uint64_t>(value + 0.0); }  // -0 becomes 0

// Bits of the range of keys beyond those given.
int excess_bits(std::uint64_t least, std::uint64_t most, int bits) {
  return std::max(0, static_cast<int>(std::bit_width(most - least)) - bits);
}

// Buckets of values, in their order.
class Buckets {
 public:
  explicit Buckets(std::vector<std::uint64_t> sample, std::size_t items)
      : count_(std::clamp<std::size_t>(items / items_a_bucket, 1, most_buckets)), bucket_(1) {
    if (sample.empty()) return;
    const auto few = static_cast<std::ptrdiff_t>(sample.size() / outer_part);
    std::nth_element(sample.begin(), sample.begin() + few, sample.end());
    least_ = sample[static_cast<std::size_t>(few)];
    std::nth_element(sample.begin(), sample.end() - 1 - few, sample.end());
    most_ = sample[sample.size() - 1 - static_cast<std::size_t>(few)];
    shift_ = excess_bits(least_, most_, sample_bits);
    std::vector<std::size_t> ends(place(most_) + 1);
    for (const std::uint64_t bits : sample) ++ends[place(std::clamp(bits, least_, most_))];
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    bucket_.resize(ends.size());
    for (std::size_t i = 1; i < ends.size(); ++i)
      bucket_[i] = static_cast<std::uint16_t>(ends[i - 1] * count_ / (sample.size() + 1));
  }

  std::size_t size() const { return count_; }
  std::uint16_t of(std::uint64_t bits) const { return bucket_[place(std::clamp(bits, least_, most_))]; }

 private:
  std::size_t place(std::uint64_t bits) const { return (bits - least_) >> shift_; }

  std::size_t count_;
  std::uint64_t least_ = 0, most_ = 0;
  int shift_ = 0;
  std::vector<std::uint16_t> bucket_;
};

// A digit of words: how many have each value of it, then where these go.
class Digits {
 public:
  explicit Digits(int low) : low_(low) {}

  void count(std::uint64_t word) { ++start_[digit_of(word)]; }

  // Sorts the words that were counted, with memory for as many, which is where they are afterwards.
  void sort(std::unique_ptr<std::uint64_t[]>& words, std::unique_ptr<std::uint64_t[]>& other,
            std::size_t size) {
    if (start_[digit_of(words[0])] == size) return;
    std::exclusive_scan(start_.begin(), start_.end(), start_.begin(), 0U);
    for (std::size_t i = 0; i < size; ++i) other[start_[digit_of(words[i])]++] = words[i];
    words.swap(other);
  }

 private:
  std::size_t digit_of(std::uint64_t word) const { return word >> low_ & (start_.size() - 1); }

  int low_;
  std::array<std::uint32_t, std::size_t{1} << digit_bits> start_{};
};

class Sorter {
 public:
  Sorter(std::span<const double> values, const CompareItems& compare, unsigned threads,
         const Monitor& monitor, int open_bits, const RefineItem& refine, double unit)
      : values_(values),
        open_bits_(open_bits),
        compare_(compare),
        refine_(refine),
        unit_(unit),
        threads_(threads),
        passes_(monitor, 5),
        buckets_(sample(), values.size()),
        counts_(base::piece_count(values.size(), ranks_a_piece)),
        start_(buckets_.size() + 1),
        distinct_(buckets_.size()),
        bucket_(values.size()) {}

  RadiusRanks run(LargeArray<double>&& values) {
    count();
    fill();
    const std::size_t size = 2 * values_.size();  // half of it for words
    rank_ =
        values.size() != 0 ? std::move(values).reused<std::int32_t>(size) : LargeArray<std::int32_t>(size);
    words_ = {reinterpret_cast<std::uint32_t*>(rank_.data() + values_.size()), start_.back()};
    for_buckets([&](std::size_t b) { sort_bucket(b); });
    settle_long_runs();
    return write();
  }

 private:
  using Words = std::span<std::uint32_t>;

  // What counts of a value.
  std::uint64_t key(double value) const {
    return bits_of(open_bits_ == 0 ? value : rounded_by(open_bits_, value));
  }
  std::uint64_t key(std::uint32_t word) const { return key(sorted_[word]); }

  template <class Body>
  void for_buckets(const Body& body) {
    parallel_for(buckets_.size(), threads_, body, passes_.next());
  }

  std::vector<std::uint64_t> sample() const {
    std::vector<std::uint64_t> bits;
    for (std::size_t i = 0; i < values_.size(); i += 1 + values_.size() / most_samples) {
      if (!(values_[i] < 0)) bits.push_back(key(values_[i]));
    }
    return bits;
  }

  // How many items of each piece go to each bucket, then where they go.
  void count() {
    base::for_pieces(values_.size(), ranks_a_piece, threads_, passes_.next(),
                     [&](std::size_t piece, std::size_t begin, std::size_t end) {
                       counts_[piece].resize(buckets_.size());
                       std::uint32_t* const counted = counts_[piece].data();
                       for (std::size_t i = begin; i < end; ++i) {  // without a branch
                         const unsigned is_left_out = values_[i] < 0 ? 1 : 0;
                         const std::uint16_t bucket = buckets_.of(key(values_[i]));
                         bucket_[i] = static_cast<std::uint16_t>(bucket | (0U - is_left_out));
                         counted[bucket] += 1 - is_left_out;
                       }
                     });
    std::size_t sum = 0;
    for (std::size_t b = 0; b < buckets_.size(); ++b) {
      start_[b] = sum;
      for (auto& counts : counts_) {
        const std::size_t here = counts[b];
        counts[b] = static_cast<std::uint32_t>(sum);
        sum += here;
      }
    }
    start_.back() = sum;
  }

  // Calls visit(item, place) for the items that take part, in the order of their numbers in each bucket.
  template <class Visit>
  void visit_places(std::size_t begin, std::size_t end, const Visit& visit) const {
    std::vector<std::uint32_t> places = counts_[begin / ranks_a_piece];
    std::array<std::uint16_t, 256> taken;  // those of some items, found without a branch
    for (std::size_t first = begin; first < end; first += taken.size()) {
      const std::size_t items = std::min(taken.size(), end - first);
      std::size_t count = 0;
      for (std::size_t k = 0; k < items; ++k) {
        taken[count] = static_cast<std::uint16_t>(k);
        count += static_cast<std::size_t>(bucket_[first + k] != left_out);
      }
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = first + taken[k];
        visit(i, places[bucket_[i]]++);
      }
    }
  }

  void fill() {
    sorted_ = LargeArray<double>(start_.back());
    item_ = LargeArray<std::int32_t>(start_.back());
    base::for_pieces(values_.size(), ranks_a_piece, threads_, passes_.next(),
                     [&](std::size_t, std::size_t begin, std::size_t end) {
                       visit_places(begin, end, [&](std::size_t i, std::uint32_t place) {
                         sorted_[place] = values_[i];
                         item_[place] = static_cast<std::int32_t>(i);
                       });
                     });
  }

  // Puts the places of a bucket in the order of their exact values, marked where a value begins, and gathers them. Where
  // there are long runs of equal doubles, these and the gathering are left for settle_long_runs.
  void sort_bucket(std::size_t bucket) {
    const std::size_t begin = start_[bucket], end = start_[bucket + 1];
    if (begin == end) return;
    auto keyed = std::make_unique_for_overwrite<std::uint64_t[]>(end - begin);
    std::uint64_t least = ~std::uint64_t{0}, most = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint64_t bits = keyed[i - begin] = key(sorted_[i]);
      least = std::min(least, bits), most = std::max(most, bits);
    }
    const int shift = excess_bits(least, most, 64 - word_bits);
    const int high = word_bits + static_cast<int>(std::bit_width((most - least) >> shift));
    const int low = std::max(word_bits, high - 2 * digit_bits);
    Digits first(low), second(low + digit_bits);
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint64_t word = keyed[i - begin] = (keyed[i - begin] - least) >> shift << word_bits | i;
      first.count(word), second.count(word);
    }
    auto other = std::make_unique_for_overwrite<std::uint64_t[]>(end - begin);
    first.sort(keyed, other, end - begin), second.sort(keyed, other, end - begin);
    other.reset();
    const Words words(words_.data() + begin, end - begin);
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = static_cast<std::uint32_t>(keyed[i]) | starts;
    std::vector<Words> long_runs;
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
      if ((keyed[i] ^ keyed[i + 1]) >> low != 0) continue;  // nearly always
      std::size_t next = i + 2;
      while (next < words.size() && keyed[next] >> low == keyed[i] >> low) ++next;
      settle_key(words.subspan(i, next - i), long_runs);
      i = next - 1;
    }
    if (long_runs.empty()) return gather(bucket);
    const std::lock_guard lock(mutex_);
    open_buckets_.push_back(bucket);
    long_runs_.insert(long_runs_.end(), long_runs.begin(), long_runs.end());
  }

  // Sorts words with one key by value, and runs of equal values exactly.
  void settle_key(Words words, std::vector<Words>& long_runs) {
    for (std::uint32_t& word : words) word &= ~starts;
    const auto comes_before = [&](std::uint32_t a, std::uint32_t b) {
      return key(a) != key(b) ? key(a) < key(b) : a < b;
    };
    if (!std::is_sorted(words.begin(), words.end(), comes_before))
      std::sort(words.begin(), words.end(), comes_before);
    for (std::size_t i = 0; i < words.size();) {
      std::size_t end = i + 1;
      while (end < words.size() && key(words[end]) == key(words[i])) ++end;
      settle_equal(words.subspan(i, end - i), long_runs);
      i = end;
    }
  }

  void settle_equal(Words words, std::vector<Words>& long_runs) {
    if (words.size() == 1) {
      words[0] |= starts;
    } else if (words.size() <= long_run) {
      settle_run(words, 1, {});
    } else {
      long_runs.push_back(words);
    }
  }

  // On all threads together, since there may be but one such run; and the monitor is served.
  void settle_long_runs() {
    const Monitor monitor = passes_.same();
    for (const Words words : long_runs_) settle_run(words, threads_, monitor);
    const auto finish = [&](std::size_t k) { gather(open_buckets_[k]); };
    parallel_for(open_buckets_.size(), threads_, finish, passes_.next());
  }

  // Sorts a run by the exact values, by fine estimates first if there are some, and marks where values begin.
  void settle_run(Words words, unsigned threads, const Monitor& monitor) {
    const auto item = [&](std::uint32_t i) { return static_cast<std::uint32_t>(item_[words[i]]); };
    const auto compare_exactly = [&](std::uint32_t j) {
      return [&item, compare = compare_(item(j))](std::uint32_t i) { return compare(item(i)); };
    };
    std::vector<std::uint32_t> order(words.size());
    std::iota(order.begin(), order.end(), 0U);
    if (!refine_ || words.size() < short_run) {
      sort_exactly(order, compare_exactly, threads, monitor);
    } else {
      std::vector<std::uint32_t> sorted = order, place(words.size());
      for (const auto& [begin, end] : sort_finely(words, sorted, threads, monitor))
        sort_exactly(Words(sorted).subspan(begin, end - begin), compare_exactly, threads, monitor);
      std::uint32_t last = 0;
      for (const std::uint32_t i : sorted) place[i & ~starts] = last += (i & starts) != 0;
      const auto compare_places = [&](std::uint32_t j) {
        return [&place, at = place[j]](std::uint32_t i) { return (place[i] > at) - (place[i] < at); };
      };
      sort_exactly(order, compare_places, 1, {});
    }
    const std::vector<std::uint32_t> given(words.begin(), words.end());
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = given[order[i] & ~starts] | (order[i] & starts);
  }

  // Sorts numbers of words by fine estimates. Gives the parts of which no two words are in doubt.
  std::vector<std::pair<std::size_t, std::size_t>> sort_finely(Words words, Words order, unsigned threads,
                                                               const Monitor& monitor) const {
    std::vector<FineRadius> fine(words.size());
    base::for_items(words.size(), long_run, threads, monitor,
                    [&](std::size_t i) { fine[i] = refine_(static_cast<std::uint32_t>(item_[words[i]])); });
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
      const auto &p = fine[i].square, &q = fine[j].square;
      return p < q || (!(q < p) && i < j);
    });
    const auto bound = [&](std::size_t k, double side) {
      const FineRadius& p = fine[order[k]];
      const DoubleDouble error(side * p.error);
      return p.error < std::numeric_limits<double>::infinity() ? p.square + error : error;
    };
    std::vector<DoubleDouble> least(order.size());  // of what comes there or later
    for (std::size_t k = order.size(); k-- > 0;) {
      least[k] = bound(k, -1);
      if (k + 1 < order.size() && least[k + 1] < least[k]) least[k] = least[k + 1];
    }
    std::vector<std::pair<std::size_t, std::size_t>> parts;
    DoubleDouble most;  // of what comes before
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k == 0 || most < least[k]) parts.emplace_back(k, k);
      parts.back().second = k + 1;
      if (most < bound(k, 1)) most = bound(k, 1);
    }
    return parts;
  }

  // Sorts numbers of words by what compare(j)(i) tells of them, and marks where others begin. Parts of them are sorted by
  // their middle ones; the smaller part by recursion, so that its depth is logarithmic.
  template <class Compare>
  void sort_exactly(Words order, const Compare& compare, unsigned threads, const Monitor& monitor) const {
    std::vector<std::int8_t> signs;
    while (!order.empty()) {
      if (order.size() == 1) {  // nearly always, after fine estimates
        order[0] |= starts;
        return;
      }
      std::swap(order[0], order[order.size() / 2]);
      signs.assign(order.size(), 0);
      const auto sign_of = compare(order[0]);
      const auto find = [&](std::size_t i) {
        if (i > 0) signs[i] = static_cast<std::int8_t>(sign_of(order[i]));
      };
      base::for_items(order.size(), long_run, threads, monitor, find);
      const auto [before, after] = part(order, signs);
      sort_exactly(before.size() < after.size() ? before : after, compare, threads, monitor);
      order = before.size() < after.size() ? after : before;
    }
  }

  // Words whose values are less than, equal to and greater than that of the first one, by the signs; the
  // first and the last part remain to be sorted.
  static std::pair<Words, Words> part(Words words, const std::vector<std::int8_t>& signs) {
    std::array<std::vector<std::uint32_t>, 3> parts;
    for (std::size_t i = 0; i < words.size(); ++i)
      parts[static_cast<std::size_t>(signs[i] + 1)].push_back(words[i]);
    parts[1][0] |= starts;
    auto place = words.begin();
    for (const auto& one : parts) place = std::copy(one.begin(), one.end(), place);
    return {words.first(parts[0].size()), words.last(parts[2].size())};
  }

  // What is left of a bucket: its values, each once, with an item of each, and the number of its own value among these
  // for each place.
  void gather(std::size_t bucket) {
    const std::size_t begin = start_[bucket], end = start_[bucket + 1];
    const std::vector<std::uint32_t> words(words_.data() + begin, words_.data() + end);
    const std::vector<double> values(sorted_.data() + begin, sorted_.data() + end);
    const std::vector<std::int32_t> items(item_.data() + begin, item_.data() + end);
    std::size_t next = begin;
    double most = 0;  // estimates of exact values that round to the same need not increase
    for (const std::uint32_t word : words) {
      const std::size_t place = word & ~starts;
      if ((word & starts) != 0) {
        most = std::max(most, values[place - begin]);
        sorted_[next] = most * unit_;
        item_[next] = items[place - begin];
        ++next;
      }
      words_[place] = static_cast<std::uint32_t>(next - 1 - begin);
    }
    distinct_[bucket] = next - begin;
  }

  RadiusRanks write() {
    std::vector<std::size_t> first(buckets_.size() + 1);
    std::partial_sum(distinct_.begin(), distinct_.end(), first.begin() + 1);
    const std::size_t sum = first.back();
    RadiusRanks out;
    if (sum == start_.back()) {
      out.value = std::move(sorted_), out.witness = std::move(item_);
    } else {
      out.value = LargeArray<double>(sum), out.witness = LargeArray<std::int32_t>(sum);
      for_buckets([&](std::size_t b) {
        std::copy_n(sorted_.data() + start_[b], distinct_[b], out.value.data() + first[b]);
        std::copy_n(item_.data() + start_[b], distinct_[b], out.witness.data() + first[b]);
      });
      sorted_ = {}, item_ = {};
    }
    out.rank = std::move(rank_);
    base::for_pieces(values_.size(), ranks_a_piece, threads_, passes_.next(),
                     [&](std::size_t, std::size_t begin, std::size_t end) {
                       std::fill(out.rank.data() + begin, out.rank.data() + end,
                                 static_cast<std::int32_t>(sum));
                       visit_places(begin, end, [&](std::size_t i, std::uint32_t place) {
                         out.rank[i] = static_cast<std::int32_t>(first[bucket_[i]] + words_[place]);
                       });
                     });
    return out;
  }

  static constexpr std::size_t long_run = std::size_t{1} << 12;  // some milliseconds of exact comparisons
  static constexpr std::size_t short_run = 8;                    // which fine estimates would not make faster
  static constexpr std::uint32_t starts = std::uint32_t{1} << word_bits;

  std::span<const double> values_;
  int open_bits_;
  const CompareItems& compare_;
  const RefineItem& refine_;
  double unit_;
  unsigned threads_;
  base::Passes passes_;
  Buckets buckets_;
  std::vector<std::vector<std::uint32_t>> counts_;  // [pieces][buckets]
  std::vector<std::size_t> start_;                  // [buckets + 1]
  std::vector<std::size_t> distinct_;               // [buckets]
  LargeArray<std::uint16_t> bucket_;                // [items]
  LargeArray<double> sorted_;                       // by buckets; of each, in the end, its values
  LargeArray<std::int32_t> item_;                   // of these
  LargeArray<std::int32_t> rank_;                   // [2 items]
  Words words_;                                     // of it, the second half: places of sorted_
  std::vector<Words> long_runs_;                    // in any order
  std::vector<std::size_t> open_buckets_;           // which have them
  std::mutex mutex_;                                // guards both
};

}  // namespace

RadiusRanks rank_radii(std::span<const double> values, const CompareItems& compare, unsigned threads,
                       const Monitor& monitor, int open_bits, const RefineItem& refine, double unit) {
  return Sorter(values, compare, threads, monitor, open_bits, refine, unit).run({});
}

RadiusRanks rank_radii(LargeArray<double>&& values, const CompareItems& compare, unsigned threads,
                       const Monitor& monitor, int open_bits, const RefineItem& refine, double unit) {
  const std::span<const double> all(values.data(), values.size());
  return Sorter(all, compare, threads, monitor, open_bits, refine, unit).run(std::move(values));
}

}  // namespace vorotool::core::alpha
