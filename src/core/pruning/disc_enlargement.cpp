#include "core/pruning/disc_enlargement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/numbers/special_values.hpp"

namespace vorotool::core::pruning {
using numbers::infinity;

namespace {}  // namespace

struct DiscEnlargement::Search {
  const Disc& disc;
  std::size_t first, last;
  double enough;
  Need found{};

  bool is_done() const { return found.factor >= enough; }
};

DiscEnlargement::DiscEnlargement(std::vector<Disc> discs, double rounding)
    : discs_(std::move(discs)), rounding_(rounding) {
  std::size_t count = discs_.size(), width = leaf_size;
  do {
    std::vector<Box>& level = levels_.emplace_back((count + width - 1) / width);
    for (std::size_t k = 0; k < level.size(); ++k) {
      level[k] = box_of(k * width, std::min(count, (k + 1) * width));
    }
    count = level.size();
    width = std::size_t{1} << fan_bits;
  } while (count > 1);
}

DiscEnlargement::Box DiscEnlargement::box_of(std::size_t first, std::size_t last) const {
  Box box{infinity, -infinity, infinity, -infinity, -infinity};
  const auto extend = [&](double least_x, double most_x, double least_y, double most_y, double radius) {
    box.least_x = std::min(box.least_x, least_x);
    box.most_x = std::max(box.most_x, most_x);
    box.least_y = std::min(box.least_y, least_y);
    box.most_y = std::max(box.most_y, most_y);
    box.most_radius = std::max(box.most_radius, radius);
  };
  for (std::size_t k = first; k < last; ++k) {
    if (levels_.size() == 1) {
      const Disc& d = discs_[k];
      extend(d.x, d.x, d.y, d.y, d.radius);
    } else {
      const Box& b = levels_[levels_.size() - 2][k];
      extend(b.least_x, b.most_x, b.least_y, b.most_y, b.most_radius);
    }
  }
  return box;
}

// Of discs so close to each other that rounding tells, as small as rounding lets it be: they do not hinder.
double DiscEnlargement::pair_factor(double squared_distance, double difference) const {
  double distance = std::sqrt(squared_distance);
  if (distance < 0x1p16 * rounding_) {
    distance -= rounding_;
    difference += rounding_;
  }
  if (distance <= 0) return 0;
  return difference > 0 ? distance / difference : infinity;
}

DiscEnlargement::Need DiscEnlargement::factor(const Disc& disc, std::size_t first, std::size_t last,
                                              double enough, std::size_t likely) const {
  Search task{disc, first, last, enough};
  if (likely >= first && likely < last) visit(task, likely, likely + 1);
  if (last - first <= leaf_size) {
    visit(task, first, last);
  } else {
    search(task, levels_.size() - 1, 0);
  }
  return task.found;
}

void DiscEnlargement::visit(Search& task, std::size_t first, std::size_t last) const {
  for (std::size_t k = first; k < last && !task.is_done(); ++k) {
    const double x = task.disc.x - discs_[k].x, y = task.disc.y - discs_[k].y;
    const double factor = pair_factor(x * x + y * y, task.disc.radius - discs_[k].radius);
    if (factor > task.found.factor) task.found = {factor, k};
  }
}

// That of the farthest corner of a box, with its largest radius: no disc in it needs more.
double DiscEnlargement::bound(const Disc& d, const Box& box) const {
  const double x = std::max(d.x - box.least_x, box.most_x - d.x);
  const double y = std::max(d.y - box.least_y, box.most_y - d.y);
  return pair_factor(x * x + y * y, d.radius - box.most_radius);
}

// The box that may need most comes first.
void DiscEnlargement::search(Search& task, std::size_t level, std::size_t number) const {
  const std::size_t discs = leaf_size << (fan_bits * level);  // in a box of this level
  const std::size_t first = std::max(task.first, number * discs);
  const std::size_t last = std::min(task.last, (number + 1) * discs);
  if (level == 0) return visit(task, first, last);
  const std::size_t below = discs >> fan_bits;
  std::array<std::pair<double, std::size_t>, 1 << fan_bits> boxes;
  std::size_t count = 0;
  for (std::size_t k = first / below; k * below < last; ++k) {
    boxes[count++] = {-bound(task.disc, levels_[level - 1][k]), k};
  }
  std::sort(boxes.begin(), boxes.begin() + count);
  for (std::size_t k = 0; k < count && !task.is_done(); ++k) {
    if (-boxes[k].first > task.found.factor) search(task, level - 1, boxes[k].second);
  }
}

}  // namespace vorotool::core::pruning
