// What is written by hand in the core, beside the libraries that do it: numbers, a map, a sort, threads,
// texts of numbers. Each line is the least time of some runs, in nanoseconds an item; libraries of which
// there is no header are left out. The folder LIBRARIES holds ankerl/unordered_dense.h and
// fast_float/fast_float.h.
//
//   g++ -std=c++20 -O3 -ffp-contract=off -DVOROTOOL_STREAM_NUMBERS -Isrc -ILIBRARIES
//       tests/benchmarks/core_parts.cpp src/core/numbers/big_integer.cpp src/core/base/radix_sort.cpp
//       src/core/base/parallel.cpp src/core/text/number_text.cpp -lgmp -pthread -o build/core_parts
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/base/flat_map.hpp"
#include "core/base/parallel.hpp"
#include "core/base/radix_sort.hpp"
#include "core/numbers/big_integer.hpp"
#include "core/numbers/fixed_integer.hpp"
#include "core/numbers/rounded_quotient.hpp"
#include "core/text/number_text.hpp"
#if __has_include(<boost/multiprecision/cpp_int.hpp>)
#include <boost/multiprecision/cpp_int.hpp>
#include <boost/sort/spreadsort/spreadsort.hpp>
#define HAS_BOOST
#endif
#if __has_include(<gmp.h>)
#include <gmp.h>
#endif
#if __has_include(<ankerl/unordered_dense.h>)
#include <ankerl/unordered_dense.h>
#endif
#if __has_include(<fast_float/fast_float.h>)
#include <fast_float/fast_float.h>
#endif

using namespace vorotool::core;

namespace {

volatile std::uint64_t sink;
std::mt19937_64 bits(1);

// work() gives a number that depends on all that it has done.
template <class Work>
void time(const char* name, std::size_t items, Work work) {
  double least = 1e300;
  for (int run = 0; run < 7; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    sink = work();
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begin;
    least = std::min(least, taken.count() / static_cast<double>(items));
  }
  std::printf("%-44s %10.1f ns\n", name, least);
}

// The determinant of incircle, of differences in so many limbs.
template <class Integer>
auto determinant(const std::array<Integer, 6>& v) {
  const auto lift = [&](std::size_t i) { return v[i] * v[i] + v[i + 3] * v[i + 3]; };
  const auto minor = [&](std::size_t i, std::size_t j) { return v[i] * v[j + 3] - v[j] * v[i + 3]; };
  return lift(0) * minor(1, 2) + lift(1) * minor(2, 0) + lift(2) * minor(0, 1);
}

constexpr std::size_t calls = 1000;

template <std::size_t limbs>
void fixed_integers() {
  using Fixed = numbers::FixedInteger<limbs>;
  std::vector<std::array<Fixed, 6>> drawn(calls);
  for (auto& call : drawn) {
    for (Fixed& value : call) {
      for (auto& limb : value.limb) limb = bits();
      value.limb[limbs - 1] =
          static_cast<std::uint64_t>(static_cast<std::int64_t>(value.limb[limbs - 1]) >> 3);
    }
  }
  std::printf("incircle in integers of %zu limbs\n", limbs);
  time("  FixedInteger", calls, [&] {
    std::uint64_t sum = 0;
    for (const auto& call : drawn) sum += static_cast<std::uint64_t>(determinant(call).sign() + 2);
    return sum;
  });
#ifdef HAS_BOOST
  namespace mp = boost::multiprecision;
  using Boost =
      mp::number<mp::cpp_int_backend<256 * limbs, 256 * limbs, mp::signed_magnitude, mp::unchecked, void>,
                 mp::et_off>;
  std::vector<std::array<Boost, 6>> same(calls);
  for (std::size_t i = 0; i < calls; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      const bool is_negative = drawn[i][j].is_negative();
      const Fixed size = is_negative ? Fixed{} - drawn[i][j] : drawn[i][j];
      Boost value = 0;
      for (std::size_t k = limbs; k-- > 0;) value = (value << 64) + size.limb[k];
      same[i][j] = is_negative ? Boost(-value) : value;
    }
  }
  time("  boost::multiprecision::cpp_int, fixed", calls, [&] {
    std::uint64_t sum = 0;
    for (const auto& call : same) sum += static_cast<std::uint64_t>(determinant(call).sign() + 2);
    return sum;
  });
#endif
}

// What a number with roots does to its coefficients: c += a b, compared with another such sum.
void big_integers(std::size_t limbs) {
  std::vector<std::array<std::vector<std::uint64_t>, 4>> drawn(calls);
  for (auto& call : drawn) {
    for (auto& value : call) {
      for (std::size_t i = 0; i < limbs; ++i) value.push_back(bits());
    }
  }
  std::printf("sign of a b - c d, integers of %zu bits\n", 64 * limbs);
  std::vector<std::array<numbers::BigInteger, 4>> ours(calls);
  for (std::size_t i = 0; i < calls; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = limbs; k-- > 0;) {
        ours[i][j] = (ours[i][j] << 64) + numbers::BigInteger(static_cast<numbers::int128>(drawn[i][j][k]));
      }
    }
  }
  time("  BigInteger", calls, [&] {
    std::uint64_t sum = 0;
    for (const auto& [a, b, c, d] : ours) sum += static_cast<std::uint64_t>((a * b - c * d).sign() + 2);
    return sum;
  });
#ifdef HAS_BOOST
  using Boost = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<1152>,
                                              boost::multiprecision::et_off>;
  std::vector<std::array<Boost, 4>> boosts(calls);
  for (std::size_t i = 0; i < calls; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = limbs; k-- > 0;) boosts[i][j] = (boosts[i][j] << 64) + drawn[i][j][k];
    }
  }
  time("  boost::multiprecision::cpp_int", calls, [&] {
    std::uint64_t sum = 0;
    for (const auto& [a, b, c, d] : boosts)
      sum += static_cast<std::uint64_t>(Boost(a * b - c * d).sign() + 2);
    return sum;
  });
#endif
#ifdef __GNU_MP__
  struct Values {
    mpz_t of[4];
  };
  std::vector<Values> gmps(calls);
  for (std::size_t i = 0; i < calls; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      mpz_init(gmps[i].of[j]);
      mpz_import(gmps[i].of[j], limbs, -1, 8, 0, 0, drawn[i][j].data());
    }
  }
  time("  GMP, a new number for each result", calls, [&] {
    std::uint64_t sum = 0;
    for (const auto& [of] : gmps) {
      mpz_t left, right, difference;
      mpz_inits(left, right, difference, nullptr);
      mpz_mul(left, of[0], of[1]);
      mpz_mul(right, of[2], of[3]);
      mpz_sub(difference, left, right);
      sum += static_cast<std::uint64_t>(mpz_sgn(difference) + 2);
      mpz_clears(left, right, difference, nullptr);
    }
    return sum;
  });
#endif
}

template <class Map>
std::uint64_t counted(const std::vector<std::uint64_t>& keys) {
  Map map;
  for (const std::uint64_t key : keys) ++map[key];
  std::uint64_t sum = map.size();
  for (const std::uint64_t key : keys) sum += map[key];
  return sum;
}

// As digital triangulations and regions meet them: pairs of labels that are near each other, many times each.
void maps() {
  for (const std::uint64_t labels : {std::uint64_t{1} << 10, std::uint64_t{1} << 20}) {
    std::vector<std::uint64_t> keys(std::size_t{1} << 22);
    for (std::uint64_t& key : keys) {
      const std::uint64_t label = 1 + bits() % labels;
      key = label << 32 | (label + bits() % 6);
    }
    std::printf("counting and finding pairs of %llu labels\n", static_cast<unsigned long long>(labels));
    time("  FlatMap", keys.size(), [&] { return counted<base::FlatMap>(keys); });
#ifdef ANKERL_UNORDERED_DENSE_VERSION_MAJOR
    time("  ankerl::unordered_dense::map", keys.size(),
         [&] { return counted<ankerl::unordered_dense::map<std::uint64_t, std::uint64_t>>(keys); });
#endif
    time("  std::unordered_map", keys.size(),
         [&] { return counted<std::unordered_map<std::uint64_t, std::uint64_t>>(keys); });
  }
}

void sorts() {
  for (const int width : {33, 52}) {
    std::vector<base::Keyed> items(std::size_t{1} << 22);
    for (std::uint32_t i = 0; i < items.size(); ++i) items[i] = {bits() >> (64 - width), i};
    std::printf("sorting items by %d bits\n", width);
    const auto sorted = [&](auto sort) {
      return [&items, sort] {
        auto copy = items;
        sort(copy);
        return copy[copy.size() / 2].key;
      };
    };
    time("  radix_sort", items.size(), sorted([width](auto& copy) { base::radix_sort(copy, width); }));
    const auto is_less = [](const base::Keyed& a, const base::Keyed& b) { return a.key < b.key; };
    time("  std::stable_sort", items.size(),
         sorted([&](auto& copy) { std::stable_sort(copy.begin(), copy.end(), is_less); }));
#ifdef HAS_BOOST
    const auto shift = [](const base::Keyed& item, unsigned offset) { return item.key >> offset; };
    time("  boost::sort::spreadsort, not stable", items.size(), sorted([&](auto& copy) {
           boost::sort::spreadsort::integer_sort(copy.begin(), copy.end(), shift, is_less);
         }));
#endif
  }
}

void threads() {
  std::printf("a call of parallel_for with pieces that do nothing\n");
  for (const unsigned count : {1U, 2U, 8U}) {
    const std::string name = "  of " + std::to_string(count) + " threads";
    time(name.c_str(), 200, [&] {
      for (int i = 0; i < 200; ++i) base::parallel_for(64, count, [](std::size_t piece) { sink = piece; });
      return std::uint64_t{0};
    });
  }
}

void texts() {
  std::vector<std::string> drawn(100000);
  for (std::string& text : drawn) text::append_number(text, static_cast<double>(bits() >> 11) * 0x1p-40);
  std::printf("reading doubles of 17 digits\n");
  time("  parse_number by streams", drawn.size(), [&] {
    double sum = 0, value = 0;
    for (const std::string& text : drawn) sum += (text::parse_number(text, value), value);
    return static_cast<std::uint64_t>(sum);
  });
  const auto read = [&](auto from_chars) {
    return [&drawn, from_chars] {
      double sum = 0, value = 0;
      for (const std::string& text : drawn)
        sum += (from_chars(text.data(), text.data() + text.size(), value), value);
      return static_cast<std::uint64_t>(sum);
    };
  };
#if defined(__cpp_lib_to_chars)
  time("  std::from_chars", drawn.size(),
       read([](const char* from, const char* to, double& value) { std::from_chars(from, to, value); }));
#endif
#ifdef FASTFLOAT_FAST_FLOAT_H
  time("  fast_float", drawn.size(), read([](const char* from, const char* to, double& value) {
         fast_float::from_chars(from, to, value);
       }));
#endif
  std::vector<double> values(drawn.size());
  for (std::size_t i = 0; i < values.size(); ++i) text::parse_number(drawn[i], values[i]);
  std::printf("writing them\n");
  time("  append_number by streams", values.size(), [&] {
    std::string out;
    for (const double value : values) text::append_number(out, value);
    return static_cast<std::uint64_t>(out.size());
  });
}

}  // namespace

int main() {
  fixed_integers<2>();
  fixed_integers<4>();
  fixed_integers<8>();
  for (const std::size_t limbs : {1U, 4U, 8U, 16U, 32U}) big_integers(limbs);
  maps();
  sorts();
  threads();
  texts();
}
