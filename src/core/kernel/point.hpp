// A point of the plane.
#pragma once

namespace vorotool::core::kernel {

struct Point {
  double x, y;
};

}  // namespace vorotool::core::kernel
