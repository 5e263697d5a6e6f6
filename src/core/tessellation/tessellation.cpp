#include "core/tessellation/tessellation.hpp"

#include <memory>
#include <mutex>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/tessellation/label_ties.hpp"
#include "core/tessellation/row_output.hpp"
#include "core/tessellation/row_sweep.hpp"
#include "core/tessellation/watch.hpp"

namespace vorotool::core::tessellation {

using base::Monitor;
using numbers::uint128;

namespace {

// Rows of a band: enough pixels to outweigh its start, few enough for an interrupt to be felt at once.
constexpr std::int64_t band_pixels = std::int64_t{1} << 22;
constexpr std::int64_t least_band_rows = 64;
// A band's start looks at the columns once; with this many rows a column that costs a few percent.
constexpr std::int64_t columns_a_row = 64;
// Outputs that do not fit a cache are written past it.
constexpr std::size_t streamed_bytes = std::size_t{1} << 22;

std::int64_t rows_of_band(const FrameOnLattice& frame, std::size_t columns, std::int64_t rows,
                          unsigned threads) {
  std::int64_t height = std::max(least_band_rows, band_pixels / frame.width);
  height = std::max(height, static_cast<std::int64_t>(columns) / columns_a_row);
  const std::int64_t share = (rows + threads - 1) / threads;
  return std::max<std::int64_t>(1, std::min(height, share));
}

// Sweeps that are not in use: a band takes one and gives it back, so there are never more than threads.
template <class Arithmetic>
class SweepPool {
 public:
  SweepPool(const Sites& sites, const FrameOnLattice& frame, const RowKernel<Arithmetic>& kernel)
      : sites_(sites), frame_(frame), kernel_(kernel) {}

  std::unique_ptr<Sweep<Arithmetic>> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        auto sweep = std::move(idle_.back());
        idle_.pop_back();
        return sweep;
      }
    }
    return std::make_unique<Sweep<Arithmetic>>(sites_, frame_, kernel_);
  }

  void give_back(std::unique_ptr<Sweep<Arithmetic>> sweep) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(sweep));
  }

 private:
  const Sites& sites_;
  const FrameOnLattice& frame_;
  const RowKernel<Arithmetic> kernel_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Sweep<Arithmetic>>> idle_;
};

// Calls emit(envelope, pixels, row buffer) for each row and copies the buffer to its place in `out`.
template <class Arithmetic, class Pixel, class Emit>
void write_rows(const Sites& sites, const FrameOnLattice& frame, const RowKernel<Arithmetic>& kernel,
                std::int32_t first, std::int32_t rows, Pixel* out, unsigned threads, const Monitor& monitor,
                Emit emit) {
  const auto width = static_cast<std::size_t>(frame.width);
  const std::size_t row_bytes = width * sizeof(Pixel);
  const bool stream = row_bytes * static_cast<std::size_t>(rows) > streamed_bytes;
  const std::int64_t height =
      rows_of_band(frame, sites.column_x.size(), rows, base::resolve_threads(threads));
  SweepPool<Arithmetic> pool(sites, frame, kernel);
  Watch watch(monitor);
  const auto write_band = [&](std::size_t band) {
    const auto from = static_cast<std::int32_t>(static_cast<std::int64_t>(band) * height);
    const auto to = static_cast<std::int32_t>(std::min<std::int64_t>(rows, from + height));
    auto sweep = pool.take();
    std::vector<Pixel> buffer(width + kernel_padding);
    sweep->start(first + from, first + to - 1);
    for (std::int32_t row = from; row < to; ++row) {
      emit(sweep->next_row(), sweep->pixels(), buffer.data());
      Pixel* target = out + static_cast<std::size_t>(row) * width;
      if (stream) {
        kernel.stream(target, buffer.data(), row_bytes);
      } else {
        std::copy_n(buffer.data(), width, target);
      }
      watch.after_row(row);
    }
    if (stream) kernel.fence();
    pool.give_back(std::move(sweep));
  };
  const auto bands = static_cast<std::size_t>((rows + height - 1) / height);
  base::parallel_for(bands, threads, write_band, watch.monitor());
}

}  // namespace

Tessellation::Tessellation(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                           std::span<const std::uint32_t> label, const FrameOnLattice& frame, Simd level)
    : frame_(frame), level_(level), sites_(prepare_sites(x, y, label, frame)) {}

template <class Label>
void Tessellation::labels(std::int32_t first, std::int32_t rows, Label* out,
                          std::optional<uint128> most_squared, unsigned threads,
                          const Monitor& monitor) const {
  with_kernel(is_wide(), filtered_kernel(level_), level_,
              [&]<class Arithmetic>(const RowKernel<Arithmetic>& kernel) {
                using Integer = typename Arithmetic::Integer;
                const Integer limit = most_squared ? clamped<Integer>(*most_squared) : Integer{0};
                write_rows(sites_, frame_, kernel, first, rows, out, threads, monitor,
                           [&](const Envelope<Arithmetic>& envelope, const PixelRow& pixels, Label* row) {
                             fill_labels(kernel, envelope, row);
                             settle_ties(envelope, row);
                             if (most_squared) clear_beyond(envelope, pixels, limit, row);
                           });
              });
}

template <class Square>
void Tessellation::squared_distances(std::int32_t first, std::int32_t rows, Square* out, unsigned threads,
                                     const Monitor& monitor) const {
  with_kernel(is_wide(), filtered_kernel(level_), level_,
              [&]<class Arithmetic>(const RowKernel<Arithmetic>& kernel) {
                write_rows(sites_, frame_, kernel, first, rows, out, threads, monitor,
                           [&](const Envelope<Arithmetic>& envelope, const PixelRow& pixels, Square* row) {
                             for_each_square(envelope, pixels, [&](std::int32_t p, auto square) {
                               row[p] = static_cast<Square>(square);
                             });
                           });
              });
}

void Tessellation::distances(std::int32_t first, std::int32_t rows, float* out, double square_of_step,
                             unsigned threads, const Monitor& monitor) const {
  with_kernel(
      is_wide(), filtered_kernel(level_), level_, [&]<class Arithmetic>(const RowKernel<Arithmetic>& kernel) {
        write_rows(sites_, frame_, kernel, first, rows, out, threads, monitor,
                   [&](const Envelope<Arithmetic>& envelope, const PixelRow& pixels, float* row) {
                     for_each_square(envelope, pixels, [&](std::int32_t p, auto square) {
                       row[p] = static_cast<float>(std::sqrt(static_cast<double>(square) * square_of_step));
                     });
                   });
      });
}

template void Tessellation::labels(std::int32_t, std::int32_t, std::uint8_t*, std::optional<uint128>,
                                   unsigned, const Monitor&) const;
template void Tessellation::labels(std::int32_t, std::int32_t, std::uint16_t*, std::optional<uint128>,
                                   unsigned, const Monitor&) const;
template void Tessellation::labels(std::int32_t, std::int32_t, std::uint32_t*, std::optional<uint128>,
                                   unsigned, const Monitor&) const;
template void Tessellation::squared_distances(std::int32_t, std::int32_t, std::uint32_t*, unsigned,
                                              const Monitor&) const;
template void Tessellation::squared_distances(std::int32_t, std::int32_t, std::uint64_t*, unsigned,
                                              const Monitor&) const;
template void Tessellation::squared_distances(std::int32_t, std::int32_t, double*, unsigned,
                                              const Monitor&) const;

}  // namespace vorotool::core::tessellation
