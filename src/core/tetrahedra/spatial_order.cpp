#include "core/tetrahedra/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <memory>
#include <numeric>
#include <vector>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/base/radix_sort.hpp"

namespace vorotool::core::tetrahedra {

namespace {

constexpr int cell_bits = 21;  // of each coordinate
constexpr std::size_t points_a_piece = std::size_t{1} << 14;

// Where the curve goes in a cube: the corner at which it enters, and the axis along which it leaves. `step` tells for
// each of eight parts, numbered by bits of x, y and z, its place on the curve, and where the curve goes in it
// (C. Hamilton, "Compact Hilbert indices", 2006).
struct CurveStep {
  std::uint8_t place, next;
};

constexpr unsigned turn_left(unsigned bits, unsigned by) { return (bits << by | bits >> (3 - by)) & 7; }
constexpr unsigned gray(unsigned i) { return i ^ i >> 1; }

constexpr std::array<std::array<CurveStep, 8>, 24> curve_steps() {
  std::array<std::array<CurveStep, 8>, 24> steps{};
  for (unsigned state = 0; state < 24; ++state) {
    const unsigned entry = state / 3, axis = state % 3, turn = (axis + 1) % 3;
    for (unsigned place = 0; place < 8; ++place) {
      const unsigned part = turn_left(gray(place), turn) ^ entry;
      const unsigned inner_entry = place == 0 ? 0 : gray((place - 1) / 2 * 2);
      const unsigned ones = place == 0 ? 0 : static_cast<unsigned>(std::countr_one(place - 1 + place % 2));
      const unsigned next_axis = (axis + ones + 1) % 3;
      steps[state][part] = {
          static_cast<std::uint8_t>(place),
          static_cast<std::uint8_t>((entry ^ turn_left(inner_entry, turn)) * 3 + next_axis)};
    }
  }
  return steps;
}

constexpr auto steps_of_curve = curve_steps();

// Cells have one size along all axes. Every step rounds monotonically; halves keep the range of the largest doubles
// finite, and a range below 2^-960 is blown up in two exact steps, where one factor would be infinite.
class HilbertGrid {
 public:
  HilbertGrid(const Point3& least, const Point3& most) : least_{least.x / 2, least.y / 2, least.z / 2} {
    const double range = std::max({most.x / 2 - least_.x, most.y / 2 - least_.y, most.z / 2 - least_.z});
    blow_up_ = range < 0x1p-960 ? 0x1p120 : 1.0;
    factor_ = range > 0 ? last / (range * blow_up_) : 0.0;
  }

  std::uint64_t code(const Point3& p) const {
    const std::uint32_t x = cell(p.x, least_.x), y = cell(p.y, least_.y), z = cell(p.z, least_.z);
    std::uint64_t code = 0;
    unsigned state = 0;
    for (int bit = cell_bits - 1; bit >= 0; --bit) {
      const CurveStep step =
          steps_of_curve[state][(x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2];
      code = code << 3 | step.place;
      state = step.next;
    }
    return code;
  }

 private:
  static constexpr double last = (1 << cell_bits) - 1;

  std::uint32_t cell(double value, double least) const {
    return static_cast<std::uint32_t>(std::min((value / 2 - least) * blow_up_ * factor_, last));
  }

  Point3 least_;
  double blow_up_, factor_;
};

HilbertGrid grid_over(std::span<const Point3> points) {
  Point3 least = points[0], most = points[0];
  for (const Point3& p : points) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  return {least, most};
}

// Where pieces of sorted items begin and end: all items of a cell are in one.
std::vector<std::size_t> ends_of_pieces(std::span<const base::Keyed> items) {
  std::vector<std::size_t> ends{0};
  for (std::size_t next = points_a_piece; next < items.size(); next += points_a_piece) {
    const auto is_less = [](std::uint64_t key, const base::Keyed& item) { return key < item.key; };
    const auto from = items.begin() + static_cast<std::ptrdiff_t>(std::max(next, ends.back()));
    const auto end = std::upper_bound(from, items.end(), items[next - 1].key, is_less);
    ends.push_back(static_cast<std::size_t>(end - items.begin()));
  }
  ends.push_back(items.size());
  return ends;
}

}  // namespace

SpatialOrder spatial_order(std::span<const Point3> points, std::span<std::int32_t> first, unsigned threads,
                           const base::Monitor& monitor) {
  SpatialOrder order;
  if (points.empty()) return order;
  const HilbertGrid grid = grid_over(points);
  const auto keyed = std::make_unique_for_overwrite<base::Keyed[]>(points.size());
  const std::span<base::Keyed> items(keyed.get(), points.size());
  base::for_items(points.size(), points_a_piece, threads, monitor,
                  [&](std::size_t i) { items[i] = {grid.code(points[i]), static_cast<std::uint32_t>(i)}; });
  base::radix_sort(items, 3 * cell_bits, threads);
  const auto is_repeated = [&](std::size_t i) {  // once sorted
    return i > 0 && items[i].key == items[i - 1].key && points[items[i].value] == points[items[i - 1].value];
  };
  const std::vector<std::size_t> ends = ends_of_pieces(items);
  const std::size_t pieces = ends.size() - 1;
  std::vector<std::size_t> places(pieces + 1);  // where the points of each piece begin
  base::parallel_for(pieces, threads, [&](std::size_t piece) {
    const std::size_t last = ends[piece + 1];
    for (std::size_t begin = ends[piece], end = begin; begin < last; begin = end) {
      while (end < last && items[end].key == items[begin].key) ++end;
      if (end - begin > 1) {
        std::stable_sort(items.begin() + begin, items.begin() + end,
                         [&](const base::Keyed& a, const base::Keyed& b) {
                           return comes_before(points[a.value], points[b.value]);
                         });
      }
      for (std::size_t i = begin; i < end; ++i) places[piece + 1] += !is_repeated(i);
    }
  });
  std::partial_sum(places.begin(), places.end(), places.begin());
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  order.count = places.back();
  order.points = std::make_unique_for_overwrite<Point3[]>(order.count + 1);
  order.points[order.count] = {nan, nan, nan};
  order.index.resize(order.count);
  base::parallel_for(pieces, threads, [&](std::size_t piece) {
    std::size_t next = places[piece];
    for (std::size_t i = ends[piece]; i < ends[piece + 1]; ++i) {
      const std::uint32_t v = items[i].value;
      if (!is_repeated(i)) {
        order.points[next] = points[v];
        order.index[next++] = static_cast<std::int32_t>(v);
      }
      first[v] = order.index[next - 1];
    }
  });
  return order;
}

}  // namespace vorotool::core::tetrahedra
