#include "core/volumes/tile_sweep.hpp"

#include <algorithm>
#include <cmath>

namespace vorotool::core::volumes {

namespace {

// Where more than one voxel in so many is looked up, a larger distance is quicker.
constexpr std::int64_t voxels_a_look_up = 256;
constexpr std::int64_t look_ups_to_spare = 64;
constexpr double growth = 1.4;

}  // namespace

template <class Voxel, Product product>
std::int64_t TileSweep<Voxel, product>::largest_square(std::int32_t distance) const {
  const std::int64_t across = std::int64_t{distance} + group * std::int64_t{tiles_.frame().plane.pixel().x};
  return across * across + 2 * std::int64_t{distance} * distance;
}

template <class Voxel, Product product>
void TileSweep<Voxel, product>::write(const Box& box) {
  double distance = std::ceil(tiles_.likely_reach(box));
  if (most_squared_) distance = std::min(distance, std::ceil(std::sqrt(static_cast<double>(*most_squared_))));
  for (bool written = false; !written; distance = std::ceil(distance * growth)) {
    const auto within = static_cast<std::int32_t>(std::min(distance, 0x1p20));
    const bool fits = largest_square(within) < std::int64_t{1} << (31 - label_bits_);
    written = fits ? write_within(box, within, kernels_.narrow, narrow_)
                   : write_within(box, within, kernels_.wide, wide_);
  }
}

// False where the distance is too small for too many voxels.
template <class Voxel, Product product>
template <class Key>
bool TileSweep<Voxel, product>::write_within(const Box& box, std::int32_t distance,
                                             const NearestKernel<Key>& kernel, std::vector<Key>& planes) {
  const VolumeFrame& frame = tiles_.frame();
  const std::int32_t reach = distance / frame.step_z();
  const std::int32_t around = 2 * reach + 1;
  tiles_.gather(box, distance, seeds_, first_);
  planes.resize(static_cast<std::size_t>(around) * tile_voxels);
  std::vector<const Key*> stack(static_cast<std::size_t>(around));
  std::vector<Key> squares(static_cast<std::size_t>(reach) + 1);
  for (std::int32_t k = 0; k <= reach; ++k) {
    const std::int64_t dz = std::int64_t{k} * frame.step_z();
    squares[static_cast<std::size_t>(k)] = static_cast<Key>(dz * dz) << label_bits_;
  }
  const auto plane = [&](std::int32_t number) {
    return planes.data() + static_cast<std::size_t>(number % around) * tile_voxels;
  };
  const auto make = [&](std::int32_t number) {
    make_plane(box, distance, static_cast<std::size_t>(number), kernel, plane(number));
  };
  for (std::int32_t number = 0; number < around - 1; ++number) make(number);

  // keys from here on are of seeds that are not surely nearest
  const Key limit = static_cast<Key>(std::int64_t{distance} * distance + 1) << label_bits_;
  const bool needed = !most_squared_ || *most_squared_ > std::int64_t{distance} * distance;
  std::int64_t left = look_ups_to_spare + std::int64_t{box.columns.count()} * box.rows.count() *
                                              box.slices.count() / voxels_a_look_up;
  alignas(64) Key keys[chunk];
  Voxel line[tile_width];
  const auto width = static_cast<std::size_t>(frame.plane.width);
  const auto height = static_cast<std::size_t>(frame.plane.height);
  for (std::int32_t slice = box.slices.first; slice <= box.slices.last; ++slice) {
    const std::int32_t number = slice - box.slices.first;
    make(number + around - 1);
    for (std::int32_t k = 0; k < around; ++k) stack[static_cast<std::size_t>(k)] = plane(number + k);
    Voxel* target = out_ + static_cast<std::size_t>(slice - slices_.first) * height * width +
                    static_cast<std::size_t>(box.rows.first) * width +
                    static_cast<std::size_t>(box.columns.first);
    for (std::int32_t row = 0; row < box.rows.count(); ++row, target += width) {
      for (std::int32_t column = 0; column < box.columns.count(); column += chunk) {
        const Key largest =
            kernel.merge({stack.data(), reach, squares.data()}, row * tile_width + column, keys);
        if (largest >= limit && needed) {
          const std::int32_t count = std::min(chunk, box.columns.count() - column);
          left -= std::count_if(keys, keys + count, [&](Key key) { return key >= limit; });
          if (left < 0) return false;
          if (!look_up(box.columns.first + column, box.rows.first + row, slice, count, limit, keys))
            return false;
        }
        put(kernel, keys, line + column);
      }
      stream_(target, line, static_cast<std::size_t>(box.columns.count()) * sizeof(Voxel));
    }
  }
  return true;
}

template <class Voxel, Product product>
template <class Key>
void TileSweep<Voxel, product>::make_plane(const Box& box, std::int32_t distance, std::size_t number,
                                           const NearestKernel<Key>& kernel, Key* plane) const {
  std::fill(plane, plane + tile_voxels, no_seed<Key>);
  const auto [step_x, step_y] = tiles_.frame().plane.pixel();
  const std::int32_t left = tiles_.x_of(box.columns.first);
  const std::int32_t top = tiles_.y_of(box.rows.first);
  const auto down = [](std::int32_t a, std::int32_t b) { return a < 0 ? -((b - 1 - a) / b) : a / b; };
  for (std::int32_t s = first_[number]; s < first_[number + 1]; ++s) {
    const TileSeed& seed = seeds_[static_cast<std::size_t>(s)];
    const std::int32_t x = seed.x - left;
    const std::int32_t y = seed.y - top;
    const std::int32_t first_column = std::max(0, -down(distance - x, step_x));
    const std::int32_t last_column = std::min(tile_width - 1, down(x + distance, step_x));
    const std::int32_t first_row = std::max(0, -down(distance - y, step_y));
    const std::int32_t last_row = std::min(tile_height - 1, down(y + distance, step_y));
    if (first_column > last_column || first_row > last_row) continue;
    kernel.add_disc(
        {first_column, last_column - first_column + 1, first_row, last_row - first_row + 1,
         first_column * step_x - x, step_x, first_row * step_y - y, step_y, seed.label, label_bits_},
        plane);
  }
}

// Finds the seeds of the voxels that the distance was too small for; false if a key does not hold one.
template <class Voxel, Product product>
template <class Key>
bool TileSweep<Voxel, product>::look_up(std::int32_t column, std::int32_t row, std::int32_t slice,
                                        std::int32_t count, Key limit, Key* keys) const {
  for (std::int32_t q = 0; q < count; ++q) {
    if (keys[q] < limit) continue;
    const Nearest found = tiles_.nearest(column + q, row, slice);
    if (found.square >= static_cast<std::int64_t>(no_seed<Key> >> label_bits_)) return false;
    keys[q] = static_cast<Key>(found.square) << label_bits_ | found.label;
  }
  return true;
}

template <class Voxel, Product product>
template <class Key>
void TileSweep<Voxel, product>::put(const NearestKernel<Key>& kernel, const Key* keys, Voxel* voxels) const {
  if constexpr (product == Product::labels) {
    const auto most = static_cast<std::int64_t>(no_seed<Key> >> label_bits_);
    const bool limited = most_squared_ && *most_squared_ < most - 1;
    const Key limit = limited ? static_cast<Key>(*most_squared_ + 1) << label_bits_ : no_seed<Key>;
    const Key mask = (Key{1} << label_bits_) - 1;
    if constexpr (sizeof(Voxel) == 1) kernel.labels8(keys, limit, mask, voxels);
    if constexpr (sizeof(Voxel) == 2) kernel.labels16(keys, limit, mask, voxels);
    if constexpr (sizeof(Voxel) == 4) kernel.labels32(keys, limit, mask, voxels);
  } else {
    if constexpr (sizeof(Voxel) == 4) kernel.squares32(keys, label_bits_, voxels);
    if constexpr (sizeof(Voxel) == 8) kernel.squares64(keys, label_bits_, voxels);
  }
}

template class TileSweep<std::uint8_t, Product::labels>;
template class TileSweep<std::uint16_t, Product::labels>;
template class TileSweep<std::uint32_t, Product::labels>;
template class TileSweep<std::uint32_t, Product::squares>;
template class TileSweep<std::uint64_t, Product::squares>;

}  // namespace vorotool::core::volumes
