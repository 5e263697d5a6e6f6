#include "core/digital/connected_regions.hpp"

#include <algorithm>
#include <cstdlib>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "core/label_images/label_runs.hpp"
#include "core/label_images/region_measures.hpp"
#include "core/label_images/region_scan.hpp"
#include "core/numbers/int128.hpp"

namespace vorotool::core::digital {

using base::Monitor;
using tessellation::PixelFrame;

namespace {

using Label = std::uint32_t;
using Square = numbers::uint128;  // squared distances below 2^84: see lattice_limit

constexpr std::size_t steps_between_polls = std::size_t{1} << 14;

class Connector {
 public:
  Connector(std::span<Label> image, const PixelFrame& frame, std::span<const std::int64_t> x,
            std::span<const std::int64_t> y, std::int64_t scale, const Monitor& monitor)
      : image_(image), frame_(frame), x_(x), y_(y), scale_(scale), monitor_(monitor) {}

  Reconnection run(unsigned threads) {
    Reconnection done;
    const std::vector<bool> split = find_split(threads, done);
    if (done.regions == 0) return done;
    gather_runs(split);
    free_islands();
    done.pixels = free_.size();
    flood();
    return done;
  }

 private:
  // A stretch of a region that is not connected.
  struct Stretch {
    std::size_t row;
    std::uint32_t start, end;
    Label label;
    std::uint32_t part;  // a component
  };

  // A label that could spread to a pixel. `late` is when it gets there: paths need not come ever farther from
  // the site, and a label that had to go round waits for none of the pixels that are nearer again.
  struct Front {
    Square late;
    Label label;
    Square own;
    std::size_t pixel;

    friend bool operator>(const Front& f, const Front& g) {
      return std::tie(f.late, f.label, f.own, f.pixel) > std::tie(g.late, g.label, g.own, g.pixel);
    }
  };

  void poll() {
    if (++steps_ % steps_between_polls == 0) base::report(monitor_, 0.5);
  }

  Square square(std::size_t column, std::size_t row, Label label) const {
    const std::int64_t dx = scale_ * (frame_.x + static_cast<std::int64_t>(column)) - x_[label - 1];
    const std::int64_t dy = scale_ * (frame_.y + static_cast<std::int64_t>(row)) - y_[label - 1];
    const auto wide_x = static_cast<Square>(std::abs(dx)), wide_y = static_cast<Square>(std::abs(dy));
    return wide_x * wide_x + wide_y * wide_y;
  }

  Square square(std::size_t pixel, Label label) const {
    return square(pixel % frame_.width, pixel / frame_.width, label);
  }

  std::vector<bool> find_split(unsigned threads, Reconnection& done) const {
    std::vector<bool> split(x_.size() + 1, false);
    const label_images::Regions found = label_images::measure_regions<Label>(
        std::span<const Label>(image_), frame_.width, frame_.height, threads, monitor_);
    for (std::size_t k = 0; k < found.labels.size(); ++k) {
      split[found.labels[k]] = found.regions[k].components > 1;
      done.regions += found.regions[k].components > 1;
    }
    return split;
  }

  // Stretches of the split regions, row by row; those of one label that share columns are one component.
  void gather_runs(const std::vector<bool>& split) {
    label_images::RunStarts starts(frame_.width);
    std::size_t above = 0, above_end = 0;  // the stretches of the row above, but for those passed
    for (std::size_t row = 0; row < frame_.height; ++row) {
      const std::span<const Label> labels = image_.subspan(row * frame_.width, frame_.width);
      const std::size_t count = starts.cut(labels);
      for (std::size_t k = 0; k < count; ++k) {
        poll();
        const Label label = labels[starts[k]];
        if (!split[label]) continue;
        Stretch stretch{row, starts[k], starts[k + 1], label, parts_.add()};
        while (above < above_end && stretches_[above].end <= stretch.start) ++above;
        for (std::size_t i = above; i < above_end && stretches_[i].start < stretch.end; ++i) {
          if (stretches_[i].label == label) parts_.unite(stretch.part, stretches_[i].part);
        }
        stretches_.push_back(stretch);
      }
      above = above_end;
      above_end = stretches_.size();
    }
  }

  // The part of each label that holds the pixel nearest to its site stays; the pixels of the others get label
  // 0.
  void free_islands() {
    struct Nearest {
      Square square;
      std::uint32_t part;
    };
    std::unordered_map<Label, Nearest> nearest;
    for (const Stretch& s : stretches_) {
      const std::int64_t column = x_[s.label - 1] / scale_ - frame_.x;
      // The pixel next to the site on either side: one of them is the nearest of a long stretch.
      for (const std::int64_t beside : {column - 1, column, column + 1}) {
        const auto at = std::clamp<std::int64_t>(beside, s.start, s.end - 1);
        const Square found = square(static_cast<std::size_t>(at), s.row, s.label);
        const auto [best, first] = nearest.try_emplace(s.label, Nearest{found, parts_.find(s.part)});
        if (!first && found < best->second.square) best->second = {found, parts_.find(s.part)};
      }
    }
    for (const Stretch& s : stretches_) {
      if (parts_.find(s.part) == nearest.at(s.label).part) continue;
      for (std::size_t pixel = s.row * frame_.width + s.start; pixel < s.row * frame_.width + s.end;
           ++pixel) {
        image_[pixel] = 0;
        free_.push_back(pixel);
      }
    }
  }

  template <class Visit>
  void for_neighbors(std::size_t pixel, Visit visit) const {
    const std::size_t column = pixel % frame_.width;
    if (pixel >= frame_.width) visit(pixel - frame_.width);
    if (column > 0) visit(pixel - 1);
    if (column + 1 < frame_.width) visit(pixel + 1);
    if (pixel + frame_.width < image_.size()) visit(pixel + frame_.width);
  }

  void flood() {
    std::priority_queue<Front, std::vector<Front>, std::greater<>> fronts;
    const auto push = [&](std::size_t pixel, Label label, Square late) {
      const Square own = square(pixel, label);
      fronts.push({std::max(own, late), label, own, pixel});
    };
    for (const std::size_t pixel : free_) {
      for_neighbors(pixel, [&](std::size_t from) {
        const Label label = image_[from];
        if (label != 0) push(pixel, label, square(from, label));
      });
    }
    while (!fronts.empty()) {
      poll();
      const Front front = fronts.top();
      fronts.pop();
      if (image_[front.pixel] != 0) continue;
      image_[front.pixel] = front.label;
      for_neighbors(front.pixel, [&](std::size_t to) {
        if (image_[to] == 0) push(to, front.label, front.late);
      });
    }
  }

  std::span<Label> image_;
  const PixelFrame& frame_;
  std::span<const std::int64_t> x_, y_;
  std::int64_t scale_;
  const Monitor& monitor_;
  std::size_t steps_ = 0;
  std::vector<Stretch> stretches_;
  label_images::ComponentSets parts_;
  std::vector<std::size_t> free_;  // pixels of the islands
};

}  // namespace

Reconnection connect_regions(std::span<std::uint32_t> image, const PixelFrame& frame,
                             std::span<const std::int64_t> x, std::span<const std::int64_t> y,
                             std::int64_t scale, unsigned threads, const Monitor& monitor) {
  return Connector(image, frame, x, y, scale, monitor).run(threads);
}

}  // namespace vorotool::core::digital
