#include "core/volumes/verify_volume.hpp"

#include <algorithm>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/spatial/kd_tree.hpp"
#include "core/tessellation/row_check.hpp"

namespace vorotool::core::volumes {

using base::Monitor;
using numbers::uint128;
using tessellation::RowCheck;

namespace {

// Rows of one piece, in the order of the volume.
void note(WrongVoxels& wrong, const std::array<std::size_t, 3>& place, std::uint32_t right) {
  const bool same_row = wrong.first[1] == place[1] && wrong.first[2] == place[2];
  if (wrong.count++ > 0 && !(same_row && place[0] < wrong.first[0])) return;
  wrong.first = place;
  wrong.right = right;
}

WrongVoxels joined(std::span<const WrongVoxels> pieces) {
  WrongVoxels all;
  for (const WrongVoxels& piece : pieces) {
    const std::uint64_t count = all.count + piece.count;
    if (all.count == 0) all = piece;
    all.count = count;
  }
  return all;
}

template <class Distance, class Label>
WrongVoxels verify(std::span<const Label> volume, const VoxelsOnLattice& voxels,
                   const LatticeVolumeSeeds& seeds, std::optional<uint128> limit, unsigned threads,
                   const Monitor& monitor) {
  const spatial::KdTree<std::int64_t, Distance, 3> tree(seeds.places, seeds.labels, monitor);
  const std::size_t width = voxels.size[0], height = voxels.size[1], depth = voxels.size[2];
  // At a query a voxel, of labels that are noise, 2^15 voxels are some tens of milliseconds.
  const std::size_t rows = std::max<std::size_t>(1, (std::size_t{1} << 15) / width);
  std::vector<WrongVoxels> wrong(base::piece_count(height * depth, rows));
  const auto check = [&](std::size_t piece, std::size_t begin, std::size_t end) {
    RowCheck<Distance, 3> row_check(tree, voxels.side[0], limit);
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t y = k % height, z = k / height;
      const auto at = [&](std::size_t axis, std::size_t index) {
        return voxels.side[axis] * (voxels.origin[axis] + static_cast<std::int64_t>(index));
      };
      row_check.check(volume.subspan(k * width, width), {at(0, 0), at(1, y), at(2, z)},
                      [&](std::size_t x, std::uint32_t right) { note(wrong[piece], {x, y, z}, right); });
    }
  };
  base::for_pieces(height * depth, rows, threads, monitor, check);
  return joined(wrong);
}

}  // namespace

template <class Label>
WrongVoxels verify_volume(std::span<const Label> volume, const VoxelsOnLattice& voxels,
                          const LatticeVolumeSeeds& seeds, std::optional<uint128> limit, unsigned threads,
                          const Monitor& monitor) {
  if (volume.empty()) return {};
  const auto extent = [&](std::size_t axis) {
    return tessellation::lattice_extent(seeds.places[axis], voxels.origin[axis], voxels.size[axis],
                                        voxels.side[axis]);
  };
  if (tessellation::is_narrow(extent(0), extent(1), extent(2)))
    return verify<std::uint64_t>(volume, voxels, seeds, limit, threads, monitor);
  return verify<uint128>(volume, voxels, seeds, limit, threads, monitor);
}

#define VOROTOOL_INSTANTIATE(Label)                                                               \
  template WrongVoxels verify_volume(std::span<const Label>, const VoxelsOnLattice&,              \
                                     const LatticeVolumeSeeds&, std::optional<uint128>, unsigned, \
                                     const Monitor&);
VOROTOOL_INSTANTIATE(std::uint8_t)
VOROTOOL_INSTANTIATE(std::uint16_t)
VOROTOOL_INSTANTIATE(std::uint32_t)
#undef VOROTOOL_INSTANTIATE

}  // namespace vorotool::core::volumes
