// How far the nearest seed is at most, block by block of a volume.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/volumes/volume_sites.hpp"

namespace vorotool::core::volumes {

// Bounds for the voxels that a site may be nearest to: none is farther from it, along any axis.
class Coverage {
 public:
  Coverage(std::span<const Site> sites, const VolumeFrame& frame);

  double reach(const Site& site) const { return reach_[block_of(site)]; }
  // Of all sites.
  double farthest() const { return farthest_; }

 private:
  using Block = std::array<std::int64_t, 3>;

  void bound_blocks(std::span<const Site> sites);
  double bound(std::span<const Site> sites, std::span<const std::size_t> first, const Block& block) const;
  void spread_along(std::size_t axis, std::int64_t blocks);
  std::size_t block_of(const Site& site) const;
  std::size_t number(const Block& block) const {
    return static_cast<std::size_t>((block[2] * count_[1] + block[1]) * count_[0] + block[0]);
  }

  Block low_{}, side_{}, count_{};  // on the lattice, and in blocks
  std::vector<double> reach_;       // [blocks]
  double farthest_ = 0;
};

}  // namespace vorotool::core::volumes
