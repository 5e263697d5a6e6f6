#include "core/volumes/brick_sweep.hpp"

#include <algorithm>
#include <cmath>

namespace vorotool::core::volumes {

namespace {

constexpr std::int32_t box_side = 2 * brick_side;
constexpr std::int32_t boxes_a_side = block_side / box_side;

LatticeBox relative_to(const std::array<std::int64_t, 3>& origin, const PlaceBox& box) {
  LatticeBox local{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    local.low[axis] = static_cast<float>(box.low[axis] - origin[axis]);
    local.high[axis] = static_cast<float>(box.high[axis] - origin[axis]);
  }
  return local;
}

}  // namespace

BrickSeeds::BrickSeeds(const SeedGrid& grid, const VolumeFrame& frame, const BrickKernels& kernels)
    : grid_(grid),
      frame_(frame),
      kernels_(kernels),
      size_{frame.plane.width, frame.plane.height, frame.depth},
      step_{frame.plane.pixel().x, frame.plane.pixel().y, frame.step_z()} {}

// The places of the voxels of a cube that are in the frame.
PlaceBox BrickSeeds::places(const Voxel& first, std::int32_t side) const {
  PlaceBox box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t last = std::min(std::int64_t{first[axis]} + side, std::int64_t{size_[axis]}) - 1;
    box.low[axis] = std::int64_t{step_[axis]} * (first[axis] - size_[axis] / 2);
    box.high[axis] = std::int64_t{step_[axis]} * (last - size_[axis] / 2);
  }
  return box;
}

// The nearest one to the middle of a box.
Rival BrickSeeds::rival_in(const SeedArrays& seeds, std::int32_t count, const LatticeBox& box) const {
  float middle[3];
  for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] = (box.low[axis] + box.high[axis]) / 2;
  const std::int32_t near = kernels_.near(seeds, count, middle);
  return {{seeds.x[near], seeds.y[near], seeds.z[near]}, 0};
}

double BrickSeeds::largest_square(const BoxSeeds& of, const PlaceBox& box) {
  const LatticeBox local = relative_to(of.origin, box);
  const SeedArrays seeds = listed_.from(of.first);
  float largest = 0;
  for (std::int32_t s = 0; s < of.count; ++s) {
    const auto farthest = [&](float at, std::size_t axis) {
      const float far = std::max(std::fabs(at - local.low[axis]), std::fabs(at - local.high[axis]));
      return far * far;
    };
    largest = std::max(largest, farthest(seeds.x[s], 0) + farthest(seeds.y[s], 1) + farthest(seeds.z[s], 2));
  }
  return static_cast<double>(largest) * (1 + 0x1p-20);
}

void BrickSeeds::start(const Rows& rows) {
  start_ = {0, rows.first_row, rows.first_slice};
  across_ = (size_[0] + block_side - 1) / block_side * boxes_a_side;
  boxes_.resize(static_cast<std::size_t>(across_) * boxes_a_side * boxes_a_side);
  listed_.count = 0;
  for (std::int32_t x = 0; x < size_[0]; x += block_side) divide_block({x, rows.first_row, rows.first_slice});
}

void BrickSeeds::divide_block(const Voxel& first) {
  const PlaceBox whole = places(first, block_side);
  const auto origin = whole.middle();
  looked_at_ += grid_.gather(whole, kernels_, block_, room_);
  const LatticeBox all = relative_to(origin, whole);
  double largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) largest = std::max<double>(largest, all.high[axis]);
  for (std::int32_t s = 0; s < block_.count; ++s) {
    const SeedArrays seeds = block_.from(0);
    largest = std::max<double>(
        largest, std::max({std::fabs(seeds.x[s]), std::fabs(seeds.y[s]), std::fabs(seeds.z[s])}));
  }
  const float slack = slack_of(largest + 1);
  for (std::int32_t z = 0; z < boxes_a_side; ++z) {
    for (std::int32_t y = 0; y < boxes_a_side; ++y) {
      for (std::int32_t x = 0; x < boxes_a_side; ++x) {
        const Voxel corner{first[0] + x * box_side, first[1] + y * box_side, first[2] + z * box_side};
        if (corner[0] >= size_[0] || corner[1] >= size_[1] || corner[2] >= size_[2]) continue;
        const PlaceBox box = places(corner, box_side);
        const LatticeBox local = relative_to(origin, box);
        Rival rival = rival_in(block_.from(0), block_.count, local);
        rival.slack = slack;
        listed_.make_room(block_.count);
        looked_at_ += block_.count;
        BoxSeeds made{listed_.count, 0, origin, slack, 0};
        listed_.count = kernels_.keep(block_.from(0), block_.count, local, rival, listed_.from(0), listed_.count);
        made.count = listed_.count - made.first;
        made.largest_square = largest_square(made, box);
        boxes_[static_cast<std::size_t>((z * boxes_a_side + y) * across_ + corner[0] / box_side)] = made;
      }
    }
  }
}

BrickSeeds::Brick BrickSeeds::brick(std::int32_t x, std::int32_t y, std::int32_t z) {
  const BoxSeeds& around = boxes_[static_cast<std::size_t>((z / 2 * boxes_a_side + y / 2) * across_ + x / 2)];
  const Voxel first{start_[0] + x * brick_side, start_[1] + y * brick_side, start_[2] + z * brick_side};
  const PlaceBox box = places(first, brick_side);
  Brick made{listed_.from(around.first), around.count, {}, around.largest_square};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    made.first[axis] = static_cast<std::int32_t>(box.low[axis] - around.origin[axis]);
  }
  if (around.count == 1) return made;
  const LatticeBox local = relative_to(around.origin, box);
  Rival rival = rival_in(made.seeds, made.count, local);
  rival.slack = around.slack;
  found_.make_room(around.count);
  looked_at_ += around.count;
  made.count = kernels_.keep(made.seeds, made.count, local, rival, found_.from(0), 0);
  made.seeds = found_.from(0);
  return made;
}

// Fitted on one thread to uniform seeds: tests of seeds, and seeds of bricks.
double BrickSeeds::nanoseconds_a_voxel(std::int32_t first, std::int32_t slices) {
  constexpr double a_test = 0.8, a_seed = 45, a_brick = 100;
  constexpr std::int32_t samples = 3;  // along each axis
  double sum = 0, voxels = 0;
  looked_at_ = 0;
  const auto place = [](std::int32_t sample, std::int32_t count) {
    const std::int32_t blocks = (count + block_side - 1) / block_side;
    return block_side * static_cast<std::int32_t>((2 * sample + 1) * std::int64_t{blocks} / (2 * samples));
  };
  for (std::int32_t k = 0; k < samples * samples * samples; ++k) {
    start_ = {0, place(k / samples % samples, size_[1]), first + place(k / samples / samples, slices)};
    const std::int32_t column = place(k % samples, size_[0]);
    across_ = (size_[0] + block_side - 1) / block_side * boxes_a_side;
    boxes_.resize(static_cast<std::size_t>(across_) * boxes_a_side * boxes_a_side);
    listed_.count = 0;
    divide_block({column, start_[1], start_[2]});
    constexpr std::int32_t bricks = block_side / brick_side;
    for (std::int32_t b = 0; b < bricks * bricks * bricks; ++b) {
      const Voxel at{column / brick_side + b % bricks, b / bricks % bricks, b / bricks / bricks};
      bool inside = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        inside = inside && start_[axis] + at[axis] * brick_side < size_[axis];
      }
      if (!inside) continue;
      sum += a_brick + a_seed * brick(at[0], at[1], at[2]).count;
      voxels += brick_voxels;
    }
  }
  return (sum + a_test * static_cast<double>(looked_at_)) / voxels;
}

template <class Voxel, Product product>
BrickSweep<Voxel, product>::BrickSweep(const SeedGrid& grid, const VolumeFrame& frame,
                                       const BrickKernels& kernels,
                                       void (*stream)(void*, const void*, std::size_t),
                                       std::optional<std::int64_t> most_squared, std::int32_t first,
                                       Voxel* out)
    : seeds_(grid, frame, kernels),
      frame_(frame),
      kernels_(kernels),
      stream_(stream),
      most_squared_(most_squared),
      label_bits_(grid.label_bits()),
      first_(first),
      out_(out),
      row_((frame.plane.width + brick_side - 1) / brick_side * brick_side),
      bar_(static_cast<std::size_t>(row_) * brick_side * brick_side) {}

template <class Voxel, Product product>
void BrickSweep<Voxel, product>::write(const Rows& rows) {
  const auto width = static_cast<std::size_t>(frame_.plane.width);
  const auto height = static_cast<std::size_t>(frame_.plane.height);
  seeds_.start(rows);
  for (std::int32_t z = 0; rows.first_slice + z * brick_side <= rows.last_slice; ++z) {
    for (std::int32_t y = 0; rows.first_row + y * brick_side <= rows.last_row; ++y) {
      for (std::int32_t x = 0; x * brick_side < frame_.plane.width; ++x) {
        fill_brick(seeds_.brick(x, y, z), bar_.data() + x * brick_side);
      }
      const std::int32_t slice = rows.first_slice + z * brick_side, row = rows.first_row + y * brick_side;
      const std::int32_t slices = std::min(brick_side, rows.last_slice - slice + 1);
      const std::int32_t count = std::min(brick_side, rows.last_row - row + 1);
      for (std::int32_t k = 0; k < slices * count; ++k) {
        const std::int32_t of_slice = k / count, of_row = k % count;
        const auto at = static_cast<std::size_t>(slice - first_ + of_slice) * height +
                        static_cast<std::size_t>(row + of_row);
        stream_(out_ + at * width, bar_.data() + (of_slice * brick_side + of_row) * row_,
                width * sizeof(Voxel));
      }
    }
  }
}

template <class Voxel, Product product>
void BrickSweep<Voxel, product>::fill_brick(const BrickSeeds::Brick& brick, Voxel* to) {
  if (product == Product::labels && brick.count == 1 && !most_squared_) {
    const auto label = static_cast<Voxel>(*brick.seeds.label);
    for (std::int32_t k = 0; k < brick_side * brick_side; ++k) std::fill_n(to + k * row_, brick_side, label);
    return;
  }
  if (brick.largest_square < std::ldexp(1.0, 32 - label_bits_)) {
    fill_with(brick, kernels_.narrow, narrow_, to);
  } else {
    fill_with(brick, kernels_.wide, wide_, to);
  }
}

template <class Voxel, Product product>
template <class Key>
void BrickSweep<Voxel, product>::fill_with(const BrickSeeds::Brick& brick, const BrickKernel<Key>& kernel,
                                           std::vector<Key>& squares, Voxel* to) {
  const std::size_t needed = static_cast<std::size_t>(brick.count) * 3 * brick_side;
  if (squares.size() < needed) squares.resize(2 * needed);
  const auto& plane = frame_.plane;
  const BrickLattice lattice{{brick.first[0], brick.first[1], brick.first[2]},
                             {plane.pixel().x, plane.pixel().y, frame_.step_z()},
                             label_bits_};
  alignas(64) Key keys[brick_voxels];
  kernel.nearest(brick.seeds, brick.count, lattice, squares.data(), keys);
  const std::ptrdiff_t slice = brick_side * row_;
  if constexpr (product == Product::labels) {
    constexpr Key all = ~Key{0};
    const bool limited =
        most_squared_ && static_cast<std::uint64_t>(*most_squared_) < static_cast<std::uint64_t>(all >> label_bits_);
    const Key limit = limited ? static_cast<Key>(*most_squared_ + 1) << label_bits_ : all;
    const Key mask = static_cast<Key>((std::uint64_t{1} << label_bits_) - 1);
    if constexpr (sizeof(Voxel) == 1) kernel.labels8(keys, limit, mask, to, row_, slice);
    if constexpr (sizeof(Voxel) == 2) kernel.labels16(keys, limit, mask, to, row_, slice);
    if constexpr (sizeof(Voxel) == 4) kernel.labels32(keys, limit, mask, to, row_, slice);
  } else {
    if constexpr (sizeof(Voxel) == 4) kernel.squares32(keys, label_bits_, to, row_, slice);
    if constexpr (sizeof(Voxel) == 8) kernel.squares64(keys, label_bits_, to, row_, slice);
  }
}

template class BrickSweep<std::uint8_t, Product::labels>;
template class BrickSweep<std::uint16_t, Product::labels>;
template class BrickSweep<std::uint32_t, Product::labels>;
template class BrickSweep<std::uint32_t, Product::squares>;
template class BrickSweep<std::uint64_t, Product::squares>;

}  // namespace vorotool::core::volumes
