// Exact digital Voronoi tessellation (paper, section 2.1): every pixel of a frame gets the label of its
// nearest seed, the smallest label where several are equally near.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/base/monitor.hpp"
#include "core/numbers/int128.hpp"
#include "core/tessellation/simd_level.hpp"
#include "core/tessellation/sorted_seeds.hpp"
#include "core/tessellation/sweep_arithmetic.hpp"

namespace vorotool::core::tessellation {

class Tessellation {
 public:
  // At least one seed; throws what prepare_sites throws. `level` must be supported by this machine.
  Tessellation(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
               std::span<const std::uint32_t> label, const FrameOnLattice& frame, Simd level);

  const FrameOnLattice& frame() const { return frame_; }
  std::size_t duplicates() const { return sites_.duplicates; }
  std::size_t columns() const { return sites_.column_x.size(); }
  // The narrowest arithmetic of sweep_arithmetic.hpp that is exact for these seeds.
  bool is_wide() const { return sites_.largest_coordinate > narrow_bound; }
  bool products_exact() const { return sites_.largest_coordinate <= exact_product_bound; }

  // Rows first ... first + rows - 1 into `out`, row after row. Label: uint8, uint16 or uint32, and large
  // enough. Pixels farther than the root of `most_squared` lattice steps from all seeds get 0.
  template <class Label>
  void labels(std::int32_t first, std::int32_t rows, Label* out, std::optional<numbers::uint128> most_squared,
              unsigned threads, const base::Monitor& monitor) const;

  // Squared distances to the nearest seed in lattice steps. Square: uint32 or uint64, and large enough, or double, whose
  // squares are the nearest ones.
  template <class Square>
  void squared_distances(std::int32_t first, std::int32_t rows, Square* out, unsigned threads,
                         const base::Monitor& monitor) const;

  // Distances to the nearest seed in the unit in which the square of a lattice step is
  // `square_of_step`: the float nearest to the root in double precision.
  void distances(std::int32_t first, std::int32_t rows, float* out, double square_of_step, unsigned threads,
                 const base::Monitor& monitor) const;

 private:
  FrameOnLattice frame_;
  Simd level_;
  Sites sites_;
};

}  // namespace vorotool::core::tessellation
