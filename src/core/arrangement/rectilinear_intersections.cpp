#include "core/arrangement/rectilinear_intersections.hpp"

#include <cstddef>
#include <memory>
#include <utility>

#include "core/arrangement/coordinate_compression.hpp"
#include "core/base/integer_set.hpp"

namespace vorotool::core::arrangement {
namespace {

// The table of rows then takes no more memory than sorting the points did: 64 bytes a point.
constexpr std::size_t most_rows_per_point = 16;

class RectilinearIntersections {
 public:
  RectilinearIntersections(const SortedSegments& segments, const CoordinateCompression& rows)
      : segments_(segments),
        rows_(rows),
        cut_(std::size_t{rows.last()} + 1),
        segment_in_(std::make_unique_for_overwrite<std::int32_t[]>(std::size_t{rows.last()} + 1)),
        below_(segments.points.size(), -1) {}

  // Points come column by column, upwards. Returns whether nothing is inside a segment.
  bool pass(std::size_t point) {
    const std::size_t row = row_of(point);
    if (cut_.contains(row)) {
      if (end_of(segment_in_[row]) != point) return false;
      cut_.erase(row);
    } else if (reached_ != point) {
      const std::size_t below = cut_.below(row);
      if (below != base::IntegerSet::none) below_[point] = segment_in_[below];
    }
    for (std::int32_t s = segments_.start[point]; s < segments_.start[point + 1]; ++s) {
      if (!begin(s, point, row)) return false;
    }
    return true;
  }

  std::vector<std::int32_t> take_below() { return std::move(below_); }

 private:
  std::size_t end_of(std::int32_t segment) const {
    return static_cast<std::size_t>(segments_.upper_end[static_cast<std::size_t>(segment)]);
  }
  std::size_t row_of(std::size_t point) const { return rows_.of(segments_.points[point].y); }

  // A segment to the right is cut from now on, until its end; one upwards must lead to the next point of the
  // column, and between them there must be no segment that is cut.
  bool begin(std::int32_t segment, std::size_t point, std::size_t row) {
    const std::size_t end = end_of(segment);
    const kernel::LatticePoint a = segments_.points[point], b = segments_.points[end];
    if (a.y == b.y) {
      if (cut_.contains(row)) return false;
      cut_.insert(row);
      segment_in_[row] = segment;
      return true;
    }
    if (a.x != b.x || end != point + 1) return false;
    reached_ = end;
    return cut_.above(row) >= row_of(end);
  }

  const SortedSegments& segments_;
  const CoordinateCompression& rows_;
  base::IntegerSet cut_;                        // rows of the segments that are cut here
  std::unique_ptr<std::int32_t[]> segment_in_;  // these, by row
  std::size_t reached_ = SIZE_MAX;              // the end of the last segment upwards
  std::vector<std::int32_t> below_;
};

}  // namespace

std::optional<std::vector<std::int32_t>> sweep_rectilinear(const SortedSegments& segments,
                                                           const base::Monitor& monitor) {
  const CoordinateCompression rows(segments.points, &kernel::LatticePoint::y);
  if (rows.last() >= most_rows_per_point * segments.points.size()) return {};
  RectilinearIntersections sweep(segments, rows);
  for (std::size_t point = 0; point < segments.points.size(); ++point) {
    if (!sweep.pass(point)) return {};
    base::report_item(monitor, point);
  }
  return sweep.take_below();
}

}  // namespace vorotool::core::arrangement
