// Exact digital Voronoi tessellation of a volume: every voxel gets the label of its nearest seed, the smallest label
// where several are equally near.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "core/base/monitor.hpp"
#include "core/numbers/int128.hpp"
#include "core/tessellation/simd_level.hpp"
#include "core/volumes/coverage.hpp"
#include "core/volumes/seed_grid.hpp"
#include "core/volumes/volume_sites.hpp"

namespace vorotool::core::volumes {

// How voxels are found, which changes the time alone: by the rows of SlabSweep, or by BrickSweep where it suits.
enum class Way { quicker, rows, bricks };

class VolumeTessellation {
 public:
  // At least one seed; throws what prepare_sites throws. `level` must be supported by this machine. The seeds are sorted
  // by so many threads.
  VolumeTessellation(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                     std::span<const std::int64_t> z, std::span<const std::uint32_t> label,
                     const VolumeFrame& frame, tessellation::Simd level, Way way = Way::quicker,
                     unsigned threads = 1);

  const VolumeFrame& frame() const { return frame_; }
  std::size_t duplicates() const { return sites_.duplicates; }
  bool is_wide() const { return sites_.largest_coordinate > narrow_bound; }
  bool products_exact() const { return sites_.largest_coordinate <= exact_product_bound; }

  // Slices first ... first + slices - 1 into `out`, row after row. Label: uint8, uint16 or uint32, and large enough.
  // Voxels farther than the root of `most_squared` lattice steps from all seeds get 0.
  template <class Label>
  void labels(std::int32_t first, std::int32_t slices, Label* out,
              std::optional<numbers::uint128> most_squared, unsigned threads,
              const base::Monitor& monitor) const;

  // Squared distances to the nearest seed in lattice steps. Square: uint32 or uint64, and large enough.
  template <class Square>
  void squared_distances(std::int32_t first, std::int32_t slices, Square* out, unsigned threads,
                         const base::Monitor& monitor) const;

  // Distances to the nearest seed: roots of squares in lattice steps times `square_of_step`.
  void distances(std::int32_t first, std::int32_t slices, float* out, double square_of_step, unsigned threads,
                 const base::Monitor& monitor) const;

 private:
  const Coverage& coverage() const;
  const SeedGrid* grid(std::int32_t first, std::int32_t slices, unsigned threads) const;

  VolumeFrame frame_;
  tessellation::Simd level_;
  Way way_;
  VolumeSites sites_;
  // Made when they are first needed.
  mutable std::once_flag covered_, gridded_;
  mutable std::unique_ptr<const Coverage> coverage_;
  mutable std::unique_ptr<const SeedGrid> grid_;  // none if it does not suit
};

}  // namespace vorotool::core::volumes
