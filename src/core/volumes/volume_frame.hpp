// The voxels of a volume on the lattice of its seeds.
#pragma once

#include <array>
#include <cstdint>

#include "core/tessellation/sorted_seeds.hpp"

namespace vorotool::core::volumes {

// Voxel (c, r, s) has its center at scale * (x + c, y + r, z + s) in the coordinates of seeds; one of these along z is
// `unit_z` steps of the lattice on which squared distances are sums of squares.
struct VolumeFrame {
  tessellation::FrameOnLattice plane;
  std::int64_t z;
  std::int32_t depth;
  std::int32_t unit_z;

  std::int32_t middle_slice() const { return depth / 2; }
  // The side of a voxel along z.
  std::int64_t step_z() const { return plane.scale * unit_z; }
  // The sides of a voxel, which fit 32 bits: seeds of volumes lie on multiples of 1/256.
  std::array<std::int32_t, 3> sides() const {
    return {static_cast<std::int32_t>(plane.pixel().x), static_cast<std::int32_t>(plane.pixel().y),
            static_cast<std::int32_t>(step_z())};
  }
  // Lattice z of a slice, relative to the middle of the frame.
  std::int64_t slice_z(std::int64_t slice) const { return step_z() * (slice - middle_slice()); }
};

}  // namespace vorotool::core::volumes
