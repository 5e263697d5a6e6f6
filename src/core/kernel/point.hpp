// A point of the plane.
#pragma once

namespace vorotool::core {

struct Point {
  double x, y;
};

}  // namespace vorotool::core
