#include "core/volumes/measure_volume.hpp"

#include <algorithm>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/base/flat_map.hpp"
#include "core/base/groups.hpp"
#include "core/base/parallel.hpp"
#include "core/tessellation/watch.hpp"
#include "core/volumes/slab_scan.hpp"

namespace vorotool::core::volumes {

using base::Monitor;
using label_images::border_key;
using label_images::ComponentSets;
using label_images::Run;

namespace {

// Voxels of a piece of parallel work: some milliseconds.
constexpr std::size_t piece_voxels = std::size_t{1} << 19;

// Called for the interfaces done, of which noise has millions.
class Poll {
 public:
  explicit Poll(const Monitor& monitor) : monitor_(monitor) {}
  void operator()() {
    if (++steps_ % (std::size_t{1} << 16) == 0) base::report(monitor_, 1);
  }

 private:
  const Monitor& monitor_;
  std::size_t steps_ = 0;
};

void absorb(VolumeRegion& into, const VolumeRegion& part) {
  into.voxels += part.voxels;
  into.components += part.components;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    into.faces[axis] += part.faces[axis];
    into.sum[axis] += part.sum[axis];
    into.low[axis] = std::min(into.low[axis], part.low[axis]);
    into.high[axis] = std::max(into.high[axis], part.high[axis]);
  }
}

}  // namespace

// Joins slabs from the first. Only sums, minima and maxima of integers: how the slices were cut leaves no trace.
class SlabJoiner {
 public:
  void add(SlabScan& slab) {
    const std::vector<std::uint32_t> number = absorb_regions(slab);
    for (const Interface& part : slab.interfaces) {
      PerAxis& faces = faces_between(number[part.a], number[part.b]);
      for (std::size_t axis = 0; axis < 3; ++axis) faces[axis] += part.faces[axis];
    }
    const std::uint32_t offset = components_.size();
    components_.append(slab.components);
    renumber(slab.first_slice, number, offset);
    renumber(slab.last_slice, number, offset);
    if (!last_slice_.empty()) sew(last_slice_, slab.first_slice);
    last_slice_ = std::move(slab.last_slice);
    forget_components();
  }

  VolumeRegions finish(const Monitor& monitor) {
    close_last_slice();
    VolumeRegions all;
    const std::vector<std::uint32_t> rank = sort_regions(all);
    Poll poll(monitor);
    for (const Interface& each : interfaces_) {
      poll();
      for (const std::uint32_t side : {each.a, each.b}) {
        if (side == 0) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) all.regions[rank[side]].faces[axis] += each.faces[axis];
      }
    }
    all.interfaces = sort_interfaces(rank, poll);
    return all;
  }

 private:
  // Numbers of the slab's regions among all.
  std::vector<std::uint32_t> absorb_regions(const SlabScan& slab) {
    std::vector<std::uint32_t> number(slab.labels.size(), 0);
    for (std::size_t r = 1; r < number.size(); ++r) {
      std::uint64_t& own = numbers_[slab.labels[r]];
      if (own == 0) {
        own = labels_.size();
        labels_.push_back(slab.labels[r]);
        regions_.emplace_back();
      }
      number[r] = static_cast<std::uint32_t>(own);
      absorb(regions_[own], slab.regions[r]);
    }
    return number;
  }

  static void renumber(SliceRuns& slice, const std::vector<std::uint32_t>& number, std::uint32_t offset) {
    for (Run& run : slice.runs) {
      if (run.label == 0) continue;
      run.region = number[run.region];
      run.component += offset;
    }
  }

  // Valid until the next call.
  PerAxis& faces_between(std::uint32_t one, std::uint32_t other) {
    std::uint64_t& number = pairs_[border_key(one, other)];
    if (number == 0) {
      interfaces_.push_back({one, other, {}});
      number = interfaces_.size();
    }
    return interfaces_[number - 1].faces;
  }

  void sew(SliceRuns& before, SliceRuns& after) {
    for (std::size_t y = 0; y < before.rows.size(); ++y) {
      const std::span<const Run> one = before.row(y);
      const std::span<const Run> other = after.row(y);
      for_overlaps(one, other, [&](std::size_t i, std::size_t j, std::uint32_t length) {
        if (one[i].label != other[j].label) {
          faces_between(one[i].region, other[j].region)[2] += length;
        } else if (one[i].label != 0 && components_.unite(one[i].component, other[j].component)) {
          --regions_[one[i].region].components;
        }
      });
    }
  }

  // Only components of the last slice may still grow; these are numbered anew.
  void forget_components() {
    ComponentSets kept;
    std::vector<std::uint32_t> number(components_.size(), label_images::no_component);
    for (Run& run : last_slice_.runs) {
      if (run.label == 0) continue;
      std::uint32_t& own = number[components_.find(run.component)];
      if (own == label_images::no_component) own = kept.add();
      run.component = own;
    }
    components_ = std::move(kept);
  }

  // The faces behind the last slice are on the outside.
  void close_last_slice() {
    for (std::size_t k = 0; k < last_slice_.runs.size(); ++k) {
      const Run& run = last_slice_.runs[k];
      if (run.label != 0) regions_[run.region].faces[2] += last_slice_.runs[k + 1].start - run.start;
    }
  }

  // Puts labels and regions in order; gives the place of each.
  std::vector<std::uint32_t> sort_regions(VolumeRegions& all) const {
    std::vector<std::uint32_t> order(labels_.size() - 1);
    std::iota(order.begin(), order.end(), 1U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return labels_[a] < labels_[b]; });
    std::vector<std::uint32_t> rank(labels_.size(), 0);
    for (std::uint32_t k = 0; k < order.size(); ++k) {
      rank[order[k]] = k;
      all.labels.push_back(labels_[order[k]]);
      all.regions.push_back(regions_[order[k]]);
    }
    return rank;
  }

  // Those between two regions, by the places of both: in groups by the first, which are short as a rule.
  std::vector<Interface> sort_interfaces(const std::vector<std::uint32_t>& rank, Poll& poll) const {
    base::Groups<Interface> groups(labels_.size() - 1, [&](const auto& add) {
      for (const Interface& each : interfaces_) {
        poll();
        if (each.a == 0 || each.b == 0) continue;
        const auto [least, most] = std::minmax(rank[each.a], rank[each.b]);
        add(least, Interface{least, most, each.faces});
      }
    });
    for (std::size_t k = 0; k < groups.size(); ++k) {
      std::sort(groups[k].begin(), groups[k].end(), [&](const Interface& p, const Interface& q) {
        poll();
        return p.b < q.b;
      });
    }
    return groups.take();
  }

  // By number, in order of appearance; 0 is the background.
  std::vector<std::uint32_t> labels_{0};
  std::vector<VolumeRegion> regions_ = std::vector<VolumeRegion>(1);
  base::FlatMap numbers_;              // label -> number
  std::vector<Interface> interfaces_;  // in order of appearance, each pair once; of the background, too
  base::FlatMap pairs_;                // border_key -> position + 1
  ComponentSets components_;           // of the last slice
  SliceRuns last_slice_;
};

namespace {

// Gives slabs to the joiner in their order, whichever is scanned first.
class SlabQueue {
 public:
  SlabQueue(SlabJoiner& joiner, std::size_t slabs) : joiner_(joiner), waiting_(slabs) {}

  void put(std::size_t number, std::unique_ptr<SlabScan> slab) {
    const std::scoped_lock lock(mutex_);
    waiting_[number] = std::move(slab);
    for (; next_ < waiting_.size() && waiting_[next_]; ++next_) {
      joiner_.add(*waiting_[next_]);
      waiting_[next_].reset();
    }
  }

 private:
  SlabJoiner& joiner_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<SlabScan>> waiting_;
  std::size_t next_ = 0;
};

}  // namespace

VolumeMeasurer::VolumeMeasurer(std::size_t width, std::size_t height)
    : width_(width), height_(height), joiner_(std::make_unique<SlabJoiner>()) {
  if (std::max(width, height) >= UINT32_MAX) throw std::length_error("a side exceeds 2^32 - 2 voxels");
}

VolumeMeasurer::~VolumeMeasurer() = default;

template <class Label>
void VolumeMeasurer::add(std::span<const Label> slices, unsigned threads, const Monitor& monitor) {
  if (slices.empty()) return;
  const std::size_t slice = width_ * height_;
  const std::size_t depth = slices.size() / slice;
  if (depth_ + depth >= UINT32_MAX) throw std::length_error("a side exceeds 2^32 - 2 voxels");
  const std::size_t grain = std::max<std::size_t>(1, piece_voxels / slice);
  SlabQueue queue(*joiner_, base::piece_count(depth, grain));
  tessellation::Watch watch(monitor);
  const auto scan = [&](std::size_t piece, std::size_t begin, std::size_t end) {
    auto slab = std::make_unique<SlabScan>(width_, height_, depth_ + begin);
    for (std::size_t z = begin; z < end; ++z) slab->add_slice(slices.subspan(z * slice, slice), watch);
    queue.put(piece, std::move(slab));
  };
  base::for_pieces(depth, grain, threads, watch.monitor(), scan);
  depth_ += depth;
}

VolumeRegions VolumeMeasurer::finish(const Monitor& monitor) { return joiner_->finish(monitor); }

template void VolumeMeasurer::add(std::span<const std::uint8_t>, unsigned, const Monitor&);
template void VolumeMeasurer::add(std::span<const std::uint16_t>, unsigned, const Monitor&);
template void VolumeMeasurer::add(std::span<const std::uint32_t>, unsigned, const Monitor&);

}  // namespace vorotool::core::volumes
