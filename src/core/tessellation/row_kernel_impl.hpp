// The row kernel, written once over a type of lanes (lanes_*.hpp): its width, loads, comparisons and
// compression. Everything is a template over Lanes, and each Lanes type lives in one file, so no two files
// share an instance.
#pragma once

#include "core/tessellation/row_kernel.hpp"

namespace vorotool::core::tessellation {

template <class Lanes>
struct RowKernelOn {
  using Arithmetic = typename Lanes::Arithmetic;
  using Value = typename Arithmetic::Value;
  using Coordinate = typename Arithmetic::Coordinate;
  using Mask = std::uint32_t;
  static constexpr std::int32_t width = Lanes::width;
  static constexpr Mask all = (width == 32) ? ~Mask{0} : (Mask{1} << width) - 1;

  // Pruning in rounds ends soon on almost every row; a chain of rounds longer than this is cut by one stack
  // scan.
  static constexpr int most_rounds = 8;

  // Collecting.

  // Takes the nearer seed of each column. A seed above that is farther than the one below is hidden for good;
  // at equal distance both have the same parabola, and the smaller label stands for both. Arrays are passed
  // by value, here and below: the compiler then keeps their addresses in registers.
  static std::int32_t collect(const ActiveColumnArrays<Arithmetic> live, Coordinate row,
                              const Candidates<Arithmetic> out) {
    std::int32_t n = 0;
    for (std::int32_t i = 0; i < live.count; i += width) {
      const Mask valid = valid_lanes(live.count - i);
      const auto above = Lanes::above(row, live.above_y + i);
      const auto below = Lanes::below(row, live.below_y + i);
      const Mask hidden = Lanes::less(below, above) & valid;
      const auto nearer = Lanes::choose(hidden, above, below);
      const Mask present = Lanes::less(nearer, Lanes::broadcast(Arithmetic::far / 2)) & valid;
      const auto label_a = Lanes::load_index(live.above_label + i);
      const auto label_b = Lanes::load_index(live.below_label + i);
      auto label = Lanes::choose_index(hidden, label_a, label_b);
      label = Lanes::choose_index(Lanes::equal(above, below), label, Lanes::min_index(label_a, label_b));
      Lanes::store_index(live.nearer_label + i, label);
      if (hidden != 0) Lanes::set_coordinates(live.above_y + i, hidden, -Arithmetic::far);
      const auto x = Lanes::load(live.x + i);
      Lanes::compress(out.x + n, present, x);
      if constexpr (Arithmetic::filtered) {
        Lanes::compress(out.value + n, present, nearer);
      } else {
        Lanes::compress(out.value + n, present, sum_of_squares(x, nearer));
      }
      Lanes::compress_index(out.entry + n, present, Lanes::count_from(i));
      n += __builtin_popcount(present);
    }
    return n;
  }

  template <class Lane>
  static Lane sum_of_squares(Lane x, Lane dy) {
    return Lanes::add(Lanes::mul(x, x), Lanes::mul(dy, dy));
  }

  static Mask valid_lanes(std::int32_t left) { return left >= width ? all : (Mask{1} << left) - 1; }

  // F of candidates, rounded where the arithmetic is filtered, and exact.
  static auto values(const Candidates<Arithmetic> c, std::int32_t i) {
    const auto value = Lanes::load(c.value + i);
    if constexpr (Arithmetic::filtered) {
      return sum_of_squares(Lanes::load(c.x + i), value);
    } else {
      return value;
    }
  }

  static numbers::int128 exact_value(const Candidates<Arithmetic> c, std::int32_t i) {
    if constexpr (Arithmetic::filtered) {
      const auto dy = static_cast<std::int64_t>(c.value[i]);
      return numbers::int128{exact_x(c, i)} * exact_x(c, i) + numbers::int128{dy} * dy;
    } else {
      return static_cast<numbers::int128>(c.value[i]);
    }
  }

  static std::int64_t exact_x(const Candidates<Arithmetic> c, std::int32_t i) {
    return static_cast<std::int64_t>(c.x[i]);
  }

  // Pruning.

  // Candidate i is strictly above the lower envelope of its neighbors a and b everywhere, hence nowhere
  // nearest, when its boundary with b lies left of its boundary with a. A tie keeps it: its label may be the
  // smallest.
  static bool hidden_exactly(const Candidates<Arithmetic> c, std::int32_t a, std::int32_t i, std::int32_t b) {
    const numbers::int128 value = exact_value(c, i);
    return (exact_value(c, b) - value) * (exact_x(c, i) - exact_x(c, a)) <
           (value - exact_value(c, a)) * (exact_x(c, b) - exact_x(c, i));
  }

  static Mask hidden_lanes(const Candidates<Arithmetic> c, std::int32_t i, Mask valid, bool products_exact) {
    const auto x = Lanes::load(c.x + i);
    const auto before = values(c, i - 1);
    const auto value = values(c, i);
    const auto after = values(c, i + 1);
    const auto from = Lanes::sub(x, Lanes::load(c.x + i - 1));
    const auto to = Lanes::sub(Lanes::load(c.x + i + 1), x);
    const auto left = Lanes::mul(Lanes::sub(after, value), from);
    const auto right = Lanes::mul(Lanes::sub(value, before), to);
    const Mask hidden = Lanes::less(left, right) & valid;
    if constexpr (Arithmetic::filtered) {
      const auto sums =
          Lanes::add(Lanes::mul(Lanes::add(after, value), from), Lanes::mul(Lanes::add(value, before), to));
      const auto error = Lanes::times(sums, filter_error);
      const Mask certain =
          Lanes::less(error, Lanes::sub(left, right)) | Lanes::less(error, Lanes::sub(right, left));
      return (hidden & certain) | hidden_in_doubt(c, i, valid & ~certain);
    } else if (!products_exact) {
      return hidden | hidden_in_doubt(c, i, Lanes::equal(left, right) & valid);
    }
    return hidden;
  }

  static Mask hidden_in_doubt(const Candidates<Arithmetic> c, std::int32_t i, Mask doubt) {
    Mask hidden = 0;
    for (; doubt != 0; doubt &= doubt - 1) {
      const std::int32_t lane = __builtin_ctz(doubt);
      if (hidden_exactly(c, i + lane - 1, i + lane, i + lane + 1)) hidden |= Mask{1} << lane;
    }
    return hidden;
  }

  // One round: copies the candidates that are not hidden by their neighbors. All hidden ones may go at once:
  // what hides a candidate at some x is lower there, and the lowest is hidden by nothing.
  template <bool tells>
  static std::int32_t prune_round(const Candidates<Arithmetic> from, std::int32_t n, bool products_exact,
                                  const Candidates<Arithmetic> to, const Envelope<Arithmetic>& envelope,
                                  std::int32_t& dead_count) {
    copy_one(from, 0, to, 0);
    std::int32_t kept = 1;
    for (std::int32_t i = 1; i < n - 1; i += width) {
      const Mask valid = valid_lanes(n - 1 - i);
      const Mask hidden = hidden_lanes(from, i, valid, products_exact);
      const Mask keep = valid & ~hidden;
      const auto entry = Lanes::load_index(from.entry + i);
      Lanes::compress(to.x + kept, keep, Lanes::load(from.x + i));
      Lanes::compress(to.value + kept, keep, Lanes::load(from.value + i));
      Lanes::compress_index(to.entry + kept, keep, entry);
      kept += __builtin_popcount(keep);
      if (hidden != 0) {
        Lanes::compress_index(envelope.dead + dead_count, hidden, entry);
        if constexpr (tells) {
          Lanes::compress_index(envelope.dead_left + dead_count, hidden,
                                Lanes::load_index(from.entry + i - 1));
          Lanes::compress_index(envelope.dead_right + dead_count, hidden,
                                Lanes::load_index(from.entry + i + 1));
        }
        dead_count += __builtin_popcount(hidden);
      }
    }
    copy_one(from, n - 1, to, kept);
    return kept + 1;
  }

  static void copy_one(const Candidates<Arithmetic> from, std::int32_t i, const Candidates<Arithmetic> to,
                       std::int32_t j) {
    to.x[j] = from.x[i];
    to.value[j] = from.value[i];
    to.entry[j] = from.entry[i];
  }

  // The whole envelope in one pass: time linear in the candidates, whatever they are.
  template <bool tells>
  static std::int32_t prune_by_stack(const Candidates<Arithmetic> c, std::int32_t n,
                                     const Envelope<Arithmetic>& envelope, std::int32_t& dead_count) {
    std::int32_t kept = 0;
    for (std::int32_t i = 0; i < n; ++i) {
      copy_one(c, i, c, kept);
      while (kept >= 2 && hidden_exactly(c, kept - 2, kept - 1, kept)) {
        if constexpr (tells) {
          envelope.dead_left[dead_count] = c.entry[kept - 2];
          envelope.dead_right[dead_count] = c.entry[kept];
        }
        envelope.dead[dead_count++] = c.entry[kept - 1];
        copy_one(c, kept, c, kept - 1);
        --kept;
      }
      ++kept;
    }
    return kept;
  }

  static void prune(const ActiveColumnArrays<Arithmetic>& live, Coordinate row, const PixelRow& pixels,
                    Envelope<Arithmetic>& envelope) {
    envelope.collected = collect(live, row, envelope.candidates);
    envelope.nearer_label = live.nearer_label;
    reduce<false>(envelope.collected, pixels, envelope);
  }

  static void list(const ListedSeeds<Arithmetic>& live, Coordinate row, const PixelRow& pixels,
                   Envelope<Arithmetic>& envelope) {
    const Candidates<Arithmetic> out = envelope.candidates;
    for (std::int32_t i = 0; i < live.count; i += width) {
      const auto dy = Lanes::above(row, live.y + i);
      Lanes::compress(out.x + i, all, Lanes::load(live.x + i));
      Lanes::compress(out.value + i, all, Lanes::add(Lanes::load(live.base + i), Lanes::mul(dy, dy)));
      Lanes::compress_index(out.entry + i, all, Lanes::count_from(i));
    }
    reduce<true>(live.count, pixels, envelope);
  }

  // Drops the candidates that are nowhere nearest on the row.
  template <bool tells>
  static void reduce(std::int32_t n, const PixelRow& pixels, Envelope<Arithmetic>& envelope) {
    std::int32_t dead_count = 0;
    for (int round = 0; n > 2; ++round) {
      if (round == most_rounds) {
        n = prune_by_stack<tells>(envelope.candidates, n, envelope, dead_count);
        break;
      }
      const std::int32_t kept = prune_round<tells>(envelope.candidates, n, pixels.products_exact,
                                                   envelope.spare, envelope, dead_count);
      if (kept == n) break;
      const Candidates<Arithmetic> pruned = envelope.spare;
      envelope.spare = envelope.candidates;
      envelope.candidates = pruned;
      n = kept;
    }
    envelope.count = n;
    envelope.dead_count = dead_count;
  }

  // Boundaries.

  // Behind the last boundary a lane may hold anything; its result is overwritten or never read.
  static Mask bound_lanes(const Candidates<Arithmetic> c, std::int32_t i, Mask valid, const PixelRow& pixels,
                          std::int32_t* end) {
    const auto value = values(c, i);
    const auto after = values(c, i + 1);
    const auto rise = Lanes::sub(after, value);
    const auto run =
        Lanes::scale(Lanes::sub(Lanes::load(c.x + i + 1), Lanes::load(c.x + i)), 2 * pixels.steps);
    if constexpr (Arithmetic::filtered) {
      Mask ties = 0;
      const auto error = Lanes::times(Lanes::add(after, value), filter_error);
      for (Mask doubt = Lanes::bracket(rise, run, error, pixels, end + i) & valid; doubt != 0;
           doubt &= doubt - 1) {
        const std::int32_t lane = __builtin_ctz(doubt);
        if (bound_exactly(c, i + lane, pixels, end)) ties |= Mask{1} << lane;
      }
      return ties;
    } else {
      return Lanes::divide(rise, run, valid, pixels, end + i);
    }
  }

  // Sets one boundary; tells whether it is a pixel.
  static bool bound_exactly(const Candidates<Arithmetic> c, std::int32_t i, const PixelRow& pixels,
                            std::int32_t* end) {
    const numbers::int128 rise = exact_value(c, i + 1) - exact_value(c, i);
    const numbers::int128 run = numbers::int128{2 * pixels.steps} * (exact_x(c, i + 1) - exact_x(c, i));
    const numbers::int128 remainder = rise % run;
    const numbers::int128 pixel = rise / run - (remainder < 0) + pixels.middle;
    const std::int32_t last = pixels.width - 1;
    end[i] = pixel < -1 ? -1 : pixel > last ? last : static_cast<std::int32_t>(pixel);
    return remainder == 0 && pixel >= 0 && pixel <= last;
  }

  static void bound(const PixelRow& pixels, Envelope<Arithmetic>& envelope) {
    const Candidates<Arithmetic> c = envelope.candidates;
    const std::int32_t n = envelope.count;
    std::int32_t* const end = envelope.end;
    std::int32_t* const tied = envelope.ties;
    std::int32_t tie_count = 0;
    for (std::int32_t i = 0; i < n - 1; i += width) {
      const Mask valid = valid_lanes(n - 1 - i);
      const Mask ties = bound_lanes(c, i, valid, pixels, end) & valid;
      if (ties != 0) {
        Lanes::compress_index(reinterpret_cast<std::uint32_t*>(tied + tie_count), ties, Lanes::count_from(i));
        tie_count += __builtin_popcount(ties);
      }
    }
    if (n > 0) end[n - 1] = pixels.width - 1;
    envelope.tie_count = tie_count;
  }

  // Filling.

  // Spans are written in whole vectors from left to right: each overwrites what the one before wrote too far.
  // The first `ahead` vectors of a span are written without asking, which spares it a branch that cannot be
  // foreseen.
  template <int ahead, class Label>
  static void fill_spans(const Envelope<Arithmetic>& envelope, Label* row) {
    typedef Label Block __attribute__((vector_size(Lanes::bytes), aligned(sizeof(Label)), may_alias));
    constexpr std::int32_t step = Lanes::bytes / static_cast<std::int32_t>(sizeof(Label));
    const std::uint32_t* const labels = envelope.nearer_label;
    const std::uint32_t* const entries = envelope.candidates.entry;
    const std::int32_t* const ends = envelope.end;
    std::int32_t start = 0;
    for (std::int32_t i = 0, count = envelope.count; i < count; ++i) {
      const std::int32_t end = ends[i];
      const Block block = static_cast<Label>(labels[entries[i]]) - Block{};
      for (int k = 0; k < ahead; ++k) *reinterpret_cast<Block*>(row + start + k * step) = block;
      for (std::int32_t p = start + ahead * step; p <= end; p += step)
        *reinterpret_cast<Block*>(row + p) = block;
      start = end + 1;
    }
  }

  // Writing ahead pays where spans are longer than a vector on the average.
  template <class Label>
  static void fill(const Envelope<Arithmetic>& envelope, Label* row) {
    constexpr std::int32_t step = Lanes::bytes / static_cast<std::int32_t>(sizeof(Label));
    const std::int32_t pixels = envelope.end[envelope.count - 1] + 1;
    if (pixels / envelope.count > step) {
      fill_spans<3>(envelope, row);
    } else {
      fill_spans<1>(envelope, row);
    }
  }

  static RowKernel<Arithmetic> table() {
    RowKernel<Arithmetic> kernel{
        prune,         nullptr,     bound, fill<std::uint8_t>, fill<std::uint16_t>, fill<std::uint32_t>,
        Lanes::stream, Lanes::fence};
    if constexpr (!Arithmetic::filtered) kernel.list = list;
    return kernel;
  }
};

}  // namespace vorotool::core::tessellation
