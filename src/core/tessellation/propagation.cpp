#include "core/tessellation/propagation.hpp"

#include <vector>

namespace vorotool::core::tessellation {

namespace {

// The image V of the paper. It holds seed numbers + 1 instead of labels, so that seeds may share a label; a
// frame of zeros one pixel wide stands around it.
class PropagationImage {
 public:
  PropagationImage(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                   std::span<const std::uint32_t> label, std::int32_t width, std::int32_t height)
      : x_(x), y_(y), label_(label), width_(width), height_(height), stride_(width + std::int64_t{2}) {
    seed_.assign(static_cast<std::size_t>(stride_ * (height + 2)), 0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      std::uint32_t& pixel = at(static_cast<std::int32_t>(x[i]), static_cast<std::int32_t>(y[i]));
      const auto number = static_cast<std::uint32_t>(i + 1);
      if (pixel == 0 || label[i] < label[pixel - 1]) pixel = number;
    }
  }

  // One row of a pass; `behind` is -1 in the first pass (the row above is done) and +1 in the second.
  void sweep_row(std::int32_t j, std::int32_t behind) {
    for (std::int32_t i = 0; i < width_; ++i) {
      std::uint32_t best = at(i, j);
      best = nearer(i, j, best, at(i - 1, j + behind));
      best = nearer(i, j, best, at(i, j + behind));
      best = nearer(i, j, best, at(i + 1, j + behind));
      best = nearer(i, j, best, at(i - 1, j));
      at(i, j) = best;
    }
    for (std::int32_t i = width_ - 1; i >= 0; --i) at(i, j) = nearer(i, j, at(i, j), at(i + 1, j));
  }

  void write_labels(std::uint32_t* out) const {
    for (std::int32_t j = 0; j < height_; ++j) {
      const std::uint32_t* row = seed_.data() + (j + std::int64_t{1}) * stride_ + 1;
      for (std::int32_t i = 0; i < width_; ++i) *out++ = row[i] == 0 ? 0 : label_[row[i] - 1];
    }
  }

 private:
  std::uint32_t& at(std::int32_t i, std::int32_t j) {
    return seed_[static_cast<std::size_t>((j + std::int64_t{1}) * stride_ + i + 1)];
  }

  // Of two seed numbers (0: none) the one nearer to pixel (i, j); of equally near ones that of smaller label.
  std::uint32_t nearer(std::int32_t i, std::int32_t j, std::uint32_t a, std::uint32_t b) const {
    if (b == 0 || a == b) return a;
    if (a == 0) return b;
    const std::int64_t to_a = squared_distance(i, j, a);
    const std::int64_t to_b = squared_distance(i, j, b);
    if (to_a != to_b) return to_b < to_a ? b : a;
    return label_[b - 1] < label_[a - 1] ? b : a;
  }

  std::int64_t squared_distance(std::int32_t i, std::int32_t j, std::uint32_t number) const {
    const std::int64_t dx = x_[number - 1] - i;
    const std::int64_t dy = y_[number - 1] - j;
    return dx * dx + dy * dy;
  }

  std::span<const std::int64_t> x_, y_;
  std::span<const std::uint32_t> label_;
  std::int32_t width_, height_;
  std::int64_t stride_;
  std::vector<std::uint32_t> seed_;  // [(height + 2) (width + 2)] seed number + 1, 0 for none
};

}  // namespace

void propagate(std::span<const std::int64_t> x, std::span<const std::int64_t> y,
               std::span<const std::uint32_t> label, std::int32_t width, std::int32_t height, int passes,
               std::uint32_t* out, const base::Monitor& monitor) {
  PropagationImage image(x, y, label, width, height);
  const double rows = static_cast<double>(height) * passes;
  const auto check = [&](std::int32_t done) { base::report(monitor, done / rows); };
  for (std::int32_t j = 0; j < height; ++j) {
    image.sweep_row(j, -1);
    check(j);
  }
  for (std::int32_t j = height - 1; passes > 1 && j >= 0; --j) {
    image.sweep_row(j, +1);
    check(2 * height - 1 - j);
  }
  image.write_labels(out);
}

}  // namespace vorotool::core::tessellation
