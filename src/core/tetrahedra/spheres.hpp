// The spheres through the corners of tetrahedra, and their volumes.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/large_array.hpp"
#include "core/base/monitor.hpp"
#include "core/tetrahedra/exact_measures.hpp"
#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::tetrahedra {

constexpr double sphere_error = 0x1p-43;

// The way is within `enough` of its length, the volume within half of that: in floating point where that has a smaller
// bound, else by twice as many digits, else by integers. `enough` is at least 2^-50.
Sphere sphere_of(const std::array<Point3, 4>& corners, double enough = sphere_error);

struct Spheres {
  base::LargeArray<Point3> ways;  // from the first corner of each to the center
  base::LargeArray<double> volumes;
};

// The corners of tetrahedra are points.
Spheres measure_spheres(std::span<const Point3> points,
                        std::span<const std::array<std::int32_t, 4>> tetrahedra, unsigned threads,
                        const base::Monitor& monitor);

}  // namespace vorotool::core::tetrahedra
