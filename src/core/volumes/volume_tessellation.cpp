#include "core/volumes/volume_tessellation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/tessellation/row_output.hpp"
#include "core/tessellation/watch.hpp"
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

}  // namespace

VolumeTessellation::VolumeTessellation(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                                       std::span<const std::int64_t> z, std::span<const std::uint32_t> label,
                                       const VolumeFrame& frame, tessellation::Simd level)
    : frame_(frame),
      level_(level),
      sites_(prepare_sites(x, y, z, label, frame)),
      coverage_(sites_.sites, frame) {}

template <class Label>
void VolumeTessellation::labels(std::int32_t first, std::int32_t slices, Label* out,
                                std::optional<uint128> most_squared, unsigned threads,
                                const Monitor& monitor) const {
  tessellation::with_kernel(is_wide(), level_, [&]<class Arithmetic>(const RowKernel<Arithmetic>& kernel) {
    using Integer = typename Arithmetic::Integer;
    const Integer limit = most_squared ? tessellation::clamped<Integer>(*most_squared) : Integer{0};
    write_slices(sites_, coverage_, frame_, kernel, first, slices, out, threads, monitor,
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
  tessellation::with_kernel(is_wide(), level_, [&]<class Arithmetic>(const RowKernel<Arithmetic>& kernel) {
    write_slices(sites_, coverage_, frame_, kernel, first, slices, out, threads, monitor,
                 [&](const auto& envelope, const PixelRow& pixels, Square* row) {
                   for_each_square(envelope, pixels, [&](std::int32_t p, auto square) {
                     row[p] = static_cast<Square>(square);
                   });
                 });
  });
}

void VolumeTessellation::distances(std::int32_t first, std::int32_t slices, float* out, double square_of_step,
                                   unsigned threads, const Monitor& monitor) const {
  tessellation::with_kernel(is_wide(), level_, [&]<class Arithmetic>(const RowKernel<Arithmetic>& kernel) {
    write_slices(sites_, coverage_, frame_, kernel, first, slices, out, threads, monitor,
                 [&](const auto& envelope, const PixelRow& pixels, float* row) {
                   for_each_square(envelope, pixels, [&](std::int32_t p, auto square) {
                     row[p] = static_cast<float>(std::sqrt(static_cast<double>(square) * square_of_step));
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
