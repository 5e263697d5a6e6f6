#include "core/volumes/brick_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vorotool::core::volumes {

namespace {

constexpr std::int32_t box_side = 2 * brick_side;
constexpr std::int32_t boxes_a_side = block_side / box_side;
// Of more seeds, halves of rows and slices have so much fewer that a look for them pays.
constexpr std::int32_t seeds_to_divide = 10;

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
      kernels_(kernels),
      size_{frame.plane.width, frame.plane.height, frame.depth},
      step_(frame.sides()) {}

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
  for (std::int32_t x = 0; x < size_[0]; x += block_side) divide({x, rows.first_row, rows.first_slice});
}

BrickSeeds::BoxSeeds& BrickSeeds::box_at(const Voxel& first) {
  const std::int32_t x = first[0] / box_side;
  const std::int32_t y = (first[1] - start_[1]) / box_side;
  const std::int32_t z = (first[2] - start_[2]) / box_side;
  return boxes_[static_cast<std::size_t>((z * boxes_a_side + y) * across_ + x)];
}

// The largest coordinate of a box and of seeds.
double BrickSeeds::widest(const LatticeBox& box, SeedList& list) const {
  float largest = std::max({box.high[0], box.high[1], box.high[2]});
  const SeedArrays seeds = list.from(0);
  for (std::int32_t s = 0; s < list.count; ++s) {
    largest = std::max({largest, std::fabs(seeds.x[s]), std::fabs(seeds.y[s]), std::fabs(seeds.z[s])});
  }
  return static_cast<double>(largest) + 1;
}

// The seeds of the boxes of a block: from those of the block, or where these are many each from the grid.
void BrickSeeds::divide(const Voxel& first) {
  const PlaceBox whole = places(first, block_side);
  const auto origin = whole.middle();
  const bool together = !grid_.is_dense(whole);
  if (together) looked_at_ += grid_.gather(whole, kernels_, block_, room_);
  float slack = together ? slack_of(widest(relative_to(origin, whole), block_)) : 0;
  for (std::int32_t k = 0; k < boxes_a_side * boxes_a_side * boxes_a_side; ++k) {
    const Voxel corner{first[0] + k % boxes_a_side * box_side,
                       first[1] + k / boxes_a_side % boxes_a_side * box_side,
                       first[2] + k / boxes_a_side / boxes_a_side * box_side};
    if (corner[0] >= size_[0] || corner[1] >= size_[1] || corner[2] >= size_[2]) continue;
    const PlaceBox box = places(corner, box_side);
    BoxSeeds made{listed_.count, 0, together ? origin : box.middle(), slack, 0};
    const LatticeBox local = relative_to(made.origin, box);
    if (!together) {
      looked_at_ += grid_.gather(box, kernels_, block_, room_);
      made.slack = slack_of(widest(local, block_));
    }
    Rival rival = rival_in(block_.from(0), block_.count, local);
    rival.slack = made.slack;
    listed_.make_room(block_.count);
    looked_at_ += block_.count;
    listed_.count = kernels_.keep(block_.from(0), block_.count, local, rival, listed_.from(0), listed_.count);
    made.count = listed_.count - made.first;
    made.largest_square = largest_square(made, box);
    box_at(corner) = made;
  }
}

BrickSeeds::Brick BrickSeeds::brick(std::int32_t x, std::int32_t y, std::int32_t z) {
  const Voxel first{x * brick_side, start_[1] + y * brick_side, start_[2] + z * brick_side};
  const BoxSeeds& around = box_at(first);
  const PlaceBox box = places(first, brick_side);
  Brick made{listed_.from(around.first),      around.count, {},
             relative_to(around.origin, box), {},           around.largest_square};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    made.first[axis] = static_cast<std::int32_t>(box.low[axis] - around.origin[axis]);
  }
  if (around.count == 1) return made;
  made.rival = rival_in(made.seeds, made.count, made.box);
  made.rival.slack = around.slack;
  found_.make_room(around.count);
  looked_at_ += around.count;
  made.count = kernels_.keep(made.seeds, made.count, made.box, made.rival, found_.from(0), 0);
  made.seeds = found_.from(0);
  return made;
}

std::int32_t BrickSeeds::number_part(const Brick& whole, std::int32_t row, std::int32_t slice,
                                     std::uint32_t* numbers) {
  LatticeBox box = whole.box;
  const std::int32_t from[] = {0, row, slice};
  for (std::size_t axis = 1; axis < 3; ++axis) {
    const std::int32_t first = whole.first[axis] + from[axis] * step_[axis];
    box.low[axis] = std::min(static_cast<float>(first), whole.box.high[axis]);
    box.high[axis] =
        std::min(static_cast<float>(first + (brick_side / 2 - 1) * step_[axis]), whole.box.high[axis]);
  }
  Rival rival = rival_in(whole.seeds, whole.count, box);
  rival.slack = whole.rival.slack;
  return kernels_.number(whole.seeds, whole.count, box, rival, numbers);
}

// Fitted on one thread to uniform seeds: tests of seeds, and seeds of bricks.
double BrickSeeds::nanoseconds_a_voxel(std::int32_t first, std::int32_t slices) {
  constexpr double a_test = 0.8, a_seed = 70, a_brick = 150;
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
    divide({column, start_[1], start_[2]});
    constexpr std::int32_t bricks = block_side / brick_side;
    for (std::int32_t b = 0; b < bricks * bricks * bricks; ++b) {
      const Voxel at{column / brick_side + b % bricks, b / bricks % bricks, b / bricks / bricks};
      bool inside = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        inside = inside && (axis > 0 ? start_[axis] : 0) + at[axis] * brick_side < size_[axis];
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
                                       const BrickMeasure& measure, std::int32_t first, Out* out)
    : seeds_(grid, frame, kernels),
      frame_(frame),
      kernels_(kernels),
      stream_(stream),
      measure_(measure),
      label_bits_(grid.label_bits()),
      first_(first),
      out_(out),
      row_((frame.plane.width + brick_side - 1) / brick_side * brick_side),
      bar_(static_cast<std::size_t>(row_) * brick_side * brick_side),
      roots_(product == Product::distances ? static_cast<std::size_t>(row_) : 0) {}

template <class Voxel, Product product>
void BrickSweep<Voxel, product>::write(const Rows& rows) {
  const auto width = static_cast<std::size_t>(frame_.plane.width);
  const auto height = static_cast<std::size_t>(frame_.plane.height);
  seeds_.start(rows);
  for (std::int32_t z = 0; rows.first_slice + z * brick_side <= rows.last_slice; ++z) {
    for (std::int32_t y = 0; rows.first_row + y * brick_side <= rows.last_row; ++y) {
      fill_bar(y, z);
      const std::int32_t slice = rows.first_slice + z * brick_side, row = rows.first_row + y * brick_side;
      const std::int32_t slices = std::min(brick_side, rows.last_slice - slice + 1);
      const std::int32_t count = std::min(brick_side, rows.last_row - row + 1);
      for (std::int32_t k = 0; k < slices * count; ++k) {
        const std::int32_t of_slice = k / count, of_row = k % count;
        const auto at = static_cast<std::size_t>(slice - first_ + of_slice) * height +
                        static_cast<std::size_t>(row + of_row);
        write_row(bar_.data() + (of_slice * brick_side + of_row) * row_, out_ + at * width);
      }
    }
  }
}

template <class Voxel, Product product>
void BrickSweep<Voxel, product>::write_row(const Voxel* row, Out* to) {
  const auto width = static_cast<std::size_t>(frame_.plane.width);
  if constexpr (product == Product::distances) {
    for (std::size_t x = 0; x < width; ++x) {
      // as signed, which is quicker: squares are less than 2^63
      const auto square = static_cast<double>(static_cast<std::int64_t>(row[x]));
      roots_[x] = distance_of(square, measure_.square_of_step);
    }
    stream_(to, roots_.data(), width * sizeof(Out));
  } else {
    stream_(to, row, width * sizeof(Out));
  }
}

// Fills the bricks along x; those that follow each other and have the same seed alone at once.
template <class Voxel, Product product>
void BrickSweep<Voxel, product>::fill_bar(std::int32_t y, std::int32_t z) {
  const auto bricks = static_cast<std::int32_t>(row_ / brick_side);
  const bool with_labels = product == Product::labels && !measure_.most_squared;
  std::int32_t first = 0;  // of those with one seed that are to be filled
  std::uint32_t label = 0;
  const auto fill_until = [&](std::int32_t end) {
    for (std::int32_t k = 0; first < end && k < brick_side * brick_side; ++k) {
      Voxel* const row = bar_.data() + k * row_;
      std::fill(row + first * brick_side, row + end * brick_side, static_cast<Voxel>(label));
    }
    first = end;
  };
  for (std::int32_t x = 0; x < bricks; ++x) {
    const BrickSeeds::Brick brick = seeds_.brick(x, y, z);
    const bool alone = with_labels && brick.count == 1;
    if (!alone || *brick.seeds.label != label) fill_until(x);
    if (alone) {
      label = *brick.seeds.label;
    } else {
      fill_brick(brick, bar_.data() + x * brick_side);
      first = x + 1;
    }
  }
  fill_until(bricks);
}

template <class Voxel, Product product>
void BrickSweep<Voxel, product>::fill_brick(const BrickSeeds::Brick& brick, Voxel* to) {
  if (label_bits_ < 32 && brick.largest_square < std::ldexp(1.0, 32 - label_bits_)) {
    fill_with(brick, kernels_.narrow, narrow_, to);
  } else {
    fill_with(brick, kernels_.wide, wide_, to);
  }
}

template <class Voxel, Product product>
template <class Key>
void BrickSweep<Voxel, product>::fill_with(const BrickSeeds::Brick& brick, const BrickKernel<Key>& kernel,
                                           std::vector<Key>& terms, Voxel* to) {
  const auto count = static_cast<std::size_t>(brick.count);
  if (terms.size() < count * 3 * brick_side) terms.resize(2 * count * 3 * brick_side);
  if (numbers_.size() < count + seed_padding) {
    numbers_.resize(2 * count + seed_padding);
    std::iota(numbers_.begin(), numbers_.end(), 0U);
    part_.resize(numbers_.size());
  }
  const auto sides = frame_.sides();
  BrickVoxels voxels{{brick.first[0], brick.first[1], brick.first[2]},
                     {sides[0], sides[1], sides[2]},
                     0,
                     brick_side,
                     0,
                     brick_side,
                     row_,
                     brick_side * row_};
  kernel.find_terms(brick.seeds, brick.count, voxels, label_bits_, terms.data());
  constexpr Key all = static_cast<Key>(-1);
  const bool limited =
      measure_.most_squared && *measure_.most_squared < static_cast<std::int64_t>(all >> label_bits_);
  const BrickProduct<Key> wanted{label_bits_,
                                 limited ? static_cast<Key>(*measure_.most_squared + 1) << label_bits_ : all};
  const auto write = [&](const BrickTerms<Key>& seeds, Voxel* out) {
    if constexpr (product == Product::labels) {
      if constexpr (sizeof(Voxel) == 1) kernel.labels8(seeds, voxels, wanted, out);
      if constexpr (sizeof(Voxel) == 2) kernel.labels16(seeds, voxels, wanted, out);
      if constexpr (sizeof(Voxel) == 4) kernel.labels32(seeds, voxels, wanted, out);
    } else {
      if constexpr (sizeof(Voxel) == 4) kernel.squares32(seeds, voxels, wanted, out);
      if constexpr (sizeof(Voxel) == 8) kernel.squares64(seeds, voxels, wanted, out);
    }
  };
  if (brick.count <= seeds_to_divide) {
    write({terms.data(), numbers_.data(), brick.count}, to);
    return;
  }
  voxels.rows = voxels.slices = brick_side / 2;
  for (const std::int32_t slice : {0, brick_side / 2}) {
    for (const std::int32_t row : {0, brick_side / 2}) {
      voxels.first_row = row;
      voxels.first_slice = slice;
      const std::int32_t kept = seeds_.number_part(brick, row, slice, part_.data());
      write({terms.data(), part_.data(), kept}, to + slice * voxels.slice + row * voxels.row);
    }
  }
}

template class BrickSweep<std::uint8_t, Product::labels>;
template class BrickSweep<std::uint16_t, Product::labels>;
template class BrickSweep<std::uint32_t, Product::labels>;
template class BrickSweep<std::uint32_t, Product::squares>;
template class BrickSweep<std::uint64_t, Product::squares>;
template class BrickSweep<std::uint32_t, Product::distances>;
template class BrickSweep<std::uint64_t, Product::distances>;

}  // namespace vorotool::core::volumes
