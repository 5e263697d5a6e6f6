// Connected components of a mask that passes by twice in bands of rows: memory grows with the components and
// the width, not with the height. The first time finds which provisional components are one; the second time
// gives each band its numbers, apart from the other bands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/monitor.hpp"
#include "core/label_images/component_scan.hpp"
#include "core/label_images/connected_components.hpp"
#include "core/label_images/region_scan.hpp"

namespace vorotool::core::label_images {

class StreamingComponents {
 public:
  StreamingComponents(std::size_t width, Connectivity connectivity);
  StreamingComponents(const StreamingComponents&) = delete;  // the scan refers to the sets

  // The next rows of a mask of zeros and ones, from the top. Ones get provisional numbers from 1, in the
  // order in which runs of ones begin that no run above touches. Throws std::length_error beyond 2^32 - 2 of
  // them.
  void add(std::span<const std::uint8_t> mask, std::span<std::uint32_t> provisional,
           const base::Monitor& monitor);

  std::size_t width() const { return width_; }
  // How many provisional components there are so far.
  std::uint32_t size() const { return sets_.size(); }

  // The number of each provisional component, from 1 in raster order of the first pixels; [0] is 0. It has
  // size() + 1 elements. Returns how many components there are. No rows can be added after that.
  std::uint32_t settle(std::span<std::uint32_t> number);

 private:
  // ComponentSets counts from 0.
  struct FromOne {
    ComponentSets& sets;
    std::uint32_t add() { return sets.add() + 1; }
    void unite(std::uint32_t one, std::uint32_t other) { sets.unite(one - 1, other - 1); }
  };

  std::size_t width_;
  ComponentSets sets_;
  FromOne from_one_{sets_};
  ComponentScan<FromOne> scan_;
};

// Numbers the ones of a band: `above` has the numbers of the row above it, zeros before the first, and
// `fresh` the numbers of the provisional components that the band has added, in their order. Throws
// std::invalid_argument if those are not as many as the mask needs.
void number_band(std::span<const std::uint8_t> mask, Connectivity connectivity,
                 std::span<const std::uint32_t> above, std::span<const std::uint32_t> fresh,
                 std::span<std::uint32_t> numbers, const base::Monitor& monitor);

}  // namespace vorotool::core::label_images
