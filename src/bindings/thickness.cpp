// The largest disc inside an outline that covers each pixel.
#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/skeleton_input.hpp"
#include "core/base/large_array.hpp"
#include "core/thickness/local_thickness.hpp"

namespace vorotool::bindings {
namespace {

Array<double> local_thickness(const SkeletonInput& input, std::pair<double, double> first,
                              std::pair<double, double> step, std::size_t height, std::size_t width,
                              double slack, unsigned threads, const Progress& progress) {
  if (!(step.first > 0 && step.second > 0)) throw std::invalid_argument("steps must be positive");
  const core::skeleton::SkeletonView& skeleton = input.view();
  const core::thickness::PixelCenters pixels{
      {first.first, first.second}, {step.first, step.second}, width, height};
  core::base::LargeArray<double> made(width * height);
  run_interruptible(progress, [&](const core::base::Monitor& monitor) {
    core::thickness::local_thickness(skeleton, pixels, slack, {made.data(), made.size()}, threads, monitor);
    return 0;
  });
  return to_numpy(std::move(made), {height, width});
}

}  // namespace

void bind_thickness(nb::module_& room) {
  room.def("local_thickness", &local_thickness, "skeleton"_a, "first"_a, "step"_a, "height"_a, "width"_a,
           "slack"_a, "threads"_a, "progress"_a.none(),
           "Diameters, row by row; the center of the first pixel, and the steps to the next, are x and y.");
}

}  // namespace vorotool::bindings
