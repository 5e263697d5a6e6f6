#include "core/volumes/volume_tessellation.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/tessellation/label_ties.hpp"
#include "core/tessellation/row_output.hpp"
#include "core/tessellation/watch.hpp"
#include "core/volumes/brick_sweep.hpp"
#include "core/volumes/slab_sweep.hpp"

namespace vorotool::core::volumes {

using base::Monitor;
using numbers::uint128;
using tessellation::kernel_padding;
using tessellation::PixelRow;
using tessellation::RowKernel;

namespace {

// Outputs that do not fit a cache are written past it.
constexpr std::size_t streamed_bytes = std::size_t{1} << 22;
// A slab starts from all seeds: it has so many voxels that this costs little.
constexpr std::size_t voxels_a_seed = 64;
constexpr std::size_t least_slab_voxels = std::size_t{1} << 22;

std::int32_t slices_of_slab(const VolumeFrame& frame, std::size_t seeds, std::int32_t slices,
                            unsigned threads) {
  const auto slice =
      static_cast<std::size_t>(frame.plane.width) * static_cast<std::size_t>(frame.plane.height);
  const std::size_t voxels = std::max(least_slab_voxels, voxels_a_seed * seeds);
  const auto enough = static_cast<std::int64_t>(voxels / slice) + 1;
  const std::int64_t share = (slices + threads - 1) / threads;
  return static_cast<std::int32_t>(std::max<std::int64_t>(1, std::min(enough, share)));
}

// Calls emit(envelope, pixels, row buffer) for each row and copies the buffer to its place in `out`.
template <class Arithmetic, class Voxel, class Emit>
void write_slices(const VolumeSites& sites, const Coverage& coverage, const VolumeFrame& frame,
                  const RowKernel<Arithmetic>& kernel, std::int32_t first, std::int32_t slices, Voxel* out,
                  unsigned threads, const Monitor& monitor, Emit emit) {
  const auto width = static_cast<std::size_t>(frame.plane.width);
  const auto height = static_cast<std::size_t>(frame.plane.height);
  const std::size_t row_bytes = width * sizeof(Voxel);
  const bool stream = row_bytes * height * static_cast<std::size_t>(slices) > streamed_bytes;
  const std::int32_t step = slices_of_slab(frame, sites.sites.size(), slices, base::resolve_threads(threads));
  tessellation::Watch watch(monitor);
  const auto write_slab = [&](std::size_t slab) {
    const std::int32_t from = static_cast<std::int32_t>(slab) * step;
    const std::int32_t to = std::min(slices, from + step);
    SlabSweep<Arithmetic> sweep(sites, coverage, frame, kernel);
    std::vector<Voxel> buffer(width + kernel_padding);
    sweep.start(first + from, first + to - 1);
    for (std::int32_t slice = from; slice < to; ++slice) {
      sweep.next_slice();
      Voxel* target = out + static_cast<std::size_t>(slice) * height * width;
      for (std::int32_t row = 0; row < frame.plane.height; ++row, target += width) {
        emit(sweep.next_row(), sweep.pixels(), buffer.data());
        if (stream) {
          kernel.stream(target, buffer.data(), row_bytes);
        } else {
          std::copy_n(buffer.data(), width, target);
        }
        watch.after_row(row);
      }
    }
    if (stream) kernel.fence();
  };
  const auto slabs = static_cast<std::size_t>((slices + step - 1) / step);
  base::parallel_for(slabs, threads, write_slab, watch.monitor());
}

template <Product product, class Voxel>
void write_bricks(const SeedGrid& grid, const VolumeFrame& frame, tessellation::Simd level,
                  const BrickMeasure& measure, std::int32_t first, std::int32_t slices,
                  Written<Voxel, product>* out, unsigned threads, const Monitor& monitor) {
  const BrickKernels kernels = brick_kernels(level);
  const auto copies = tessellation::narrow_kernel(level);
  const auto parts = [](std::int32_t count) { return (count - 1) / block_side + 1; };
  const std::int32_t height = frame.plane.height, bands = parts(height);
  const auto write_block = [&](std::size_t number) {
    const auto row = static_cast<std::int32_t>(number % static_cast<std::size_t>(bands)) * block_side;
    const auto slice = static_cast<std::int32_t>(number / static_cast<std::size_t>(bands)) * block_side;
    BrickSweep<Voxel, product> sweep(grid, frame, kernels, copies.stream, measure, first, out);
    sweep.write({row, std::min(height, row + block_side) - 1, first + slice,
                 first + std::min(slices, slice + block_side) - 1});
    copies.fence();
  };
  base::parallel_for(static_cast<std::size_t>(bands) * static_cast<std::size_t>(parts(slices)), threads,
                     write_block, monitor);
}

}  // namespace

VolumeTessellation::VolumeTessellation(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                                       std::span<const std::int64_t> z, std::span<const std::uint32_t> label,
                                       const VolumeFrame& frame, tessellation::Simd level, Way way,
                                       unsigned threads)
    : frame_(frame), level_(level), way_(way), sites_(prepare_sites(x, y, z, label, frame, threads)) {}

const Coverage& VolumeTessellation::coverage() const {
  std::call_once(covered_, [&] { coverage_ = std::make_unique<const Coverage>(sites_.sites, frame_); });
  return *coverage_;
}

// The seeds by cells where bricks are quicker.
const SeedGrid* VolumeTessellation::grid(std::int32_t first, std::int32_t slices, unsigned threads) const {
  if (way_ == Way::rows) return nullptr;
  std::call_once(gridded_, [&] {
    if (SeedGrid::suits(sites_)) grid_ = std::make_unique<const SeedGrid>(sites_, frame_, threads);
  });
  if (!grid_ || way_ == Way::bricks) return grid_.get();
  // of a sweep by rows, fitted to uniform seeds on one thread
  const double voxels = double{1} * frame_.plane.width * frame_.plane.height * frame_.depth;
  const double by_rows = 0.15 + 190 * std::sqrt(static_cast<double>(sites_.sites.size()) / voxels);
  BrickSeeds bricks(*grid_, frame_, brick_kernels(level_));
  return bricks.nanoseconds_a_voxel(first, slices) < by_rows ? grid_.get() : nullptr;
}

template <class Label>
void VolumeTessellation::labels(std::int32_t first, std::int32_t slices, Label* out,
                                std::optional<uint128> most_squared, unsigned threads,
                                const Monitor& monitor) const {
  if (const SeedGrid* const seeds = grid(first, slices, threads)) {
    BrickMeasure measure;
    if (most_squared) measure.most_squared = tessellation::clamped<std::int64_t>(*most_squared);
    write_bricks<Product::labels, Label>(*seeds, frame_, level_, measure, first, slices, out, threads,
                                         monitor);
    return;
  }
  tessellation::with_kernel(
      is_wide(), tessellation::wide_kernel(), level_,
      [&]<class Arithmetic>(const RowKernel<Arithmetic>& kernel) {
        using Integer = typename Arithmetic::Integer;
        const Integer limit = most_squared ? tessellation::clamped<Integer>(*most_squared) : Integer{0};
        write_slices(sites_, coverage(), frame_, kernel, first, slices, out, threads, monitor,
                     [&](const auto& envelope, const PixelRow& pixels, Label* row) {
                       fill_labels(kernel, envelope, row);
                       settle_ties(envelope, row);
                       if (most_squared) clear_beyond(envelope, pixels, limit, row);
                     });
      });
}

template <class Square>
void VolumeTessellation::squared_distances(std::int32_t first, std::int32_t slices, Square* out,
                                           unsigned threads, const Monitor& monitor) const {
  if (const SeedGrid* const seeds = grid(first, slices, threads)) {
    write_bricks<Product::squares, Square>(*seeds, frame_, level_, {}, first, slices, out, threads, monitor);
    return;
  }
  tessellation::with_kernel(is_wide(), tessellation::wide_kernel(), level_,
                            [&]<class Arithmetic>(const RowKernel<Arithmetic>& kernel) {
                              write_slices(
                                  sites_, coverage(), frame_, kernel, first, slices, out, threads, monitor,
                                  [&](const auto& envelope, const PixelRow& pixels, Square* row) {
                                    for_each_square(envelope, pixels, [&](std::int32_t p, auto square) {
                                      row[p] = static_cast<Square>(square);
                                    });
                                  });
                            });
}

void VolumeTessellation::distances(std::int32_t first, std::int32_t slices, float* out, double square_of_step,
                                   unsigned threads, const Monitor& monitor) const {
  if (const SeedGrid* const seeds = grid(first, slices, threads)) {
    const BrickMeasure measure{{}, square_of_step};
    // squares are at most 12 N^2
    const bool is_short = sites_.largest_coordinate < std::int64_t{1} << 14;
    const auto write = is_short ? write_bricks<Product::distances, std::uint32_t>
                                : write_bricks<Product::distances, std::uint64_t>;
    write(*seeds, frame_, level_, measure, first, slices, out, threads, monitor);
    return;
  }
  tessellation::with_kernel(is_wide(), tessellation::wide_kernel(), level_,
                            [&]<class Arithmetic>(const RowKernel<Arithmetic>& kernel) {
                              write_slices(
                                  sites_, coverage(), frame_, kernel, first, slices, out, threads, monitor,
                                  [&](const auto& envelope, const PixelRow& pixels, float* row) {
                                    for_each_square(envelope, pixels, [&](std::int32_t p, auto square) {
                                      row[p] = distance_of(static_cast<double>(square), square_of_step);
                                    });
                                  });
                            });
}

template void VolumeTessellation::labels(std::int32_t, std::int32_t, std::uint8_t*, std::optional<uint128>,
                                         unsigned, const Monitor&) const;
template void VolumeTessellation::labels(std::int32_t, std::int32_t, std::uint16_t*, std::optional<uint128>,
                                         unsigned, const Monitor&) const;
template void VolumeTessellation::labels(std::int32_t, std::int32_t, std::uint32_t*, std::optional<uint128>,
                                         unsigned, const Monitor&) const;
template void VolumeTessellation::squared_distances(std::int32_t, std::int32_t, std::uint32_t*, unsigned,
                                                    const Monitor&) const;
template void VolumeTessellation::squared_distances(std::int32_t, std::int32_t, std::uint64_t*, unsigned,
                                                    const Monitor&) const;

}  // namespace vorotool::core::volumes
