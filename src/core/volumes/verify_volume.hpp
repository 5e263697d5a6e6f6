// An exact check of the tessellation of a volume that shares nothing with the sweep.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/monitor.hpp"
#include "core/numbers/int128.hpp"

namespace vorotool::core::volumes {

// Seeds on a lattice; several may share a label. Labels are at least 1. What is by axis is x, y, z.
struct LatticeVolumeSeeds {
  std::array<std::span<const std::int64_t>, 3> places;
  std::span<const std::uint32_t> labels;
};

// Voxel v of the volume is at side[axis] * (origin[axis] + v[axis]) of the lattice.
struct VoxelsOnLattice {
  std::array<std::int64_t, 3> origin;
  std::array<std::size_t, 3> size;
  std::array<std::int64_t, 3> side;
};

struct WrongVoxels {
  std::uint64_t count = 0;
  std::array<std::size_t, 3> first{};  // the first one by slice, row and column, when there is one
  std::uint32_t right = 0;             // its right label
};

// Compares every voxel with the label of the lexicographic minimum of (squared distance, label) over all seeds;
// with `limit`, a voxel whose squared lattice distance exceeds it must be 0. Exact: squared distances are at most
// 3 * 2^82, and are computed in 64 bits where coordinates differ by at most 2^31, else in 128. Throws
// std::out_of_range beyond tessellation::lattice_limit.
template <class Label>
WrongVoxels verify_volume(std::span<const Label> volume, const VoxelsOnLattice& voxels,
                          const LatticeVolumeSeeds& seeds, std::optional<numbers::uint128> limit,
                          unsigned threads, const base::Monitor& monitor);

}  // namespace vorotool::core::volumes
