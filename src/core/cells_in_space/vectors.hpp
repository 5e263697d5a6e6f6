// Vectors of space in doubles.
#pragma once

#include "core/tetrahedra/point3.hpp"

namespace vorotool::core::cells_in_space {

using tetrahedra::Point3;

inline Point3 operator-(const Point3& p, const Point3& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
inline Point3 operator+(const Point3& p, const Point3& q) { return {p.x + q.x, p.y + q.y, p.z + q.z}; }
inline double scalar_product(const Point3& p, const Point3& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
inline Point3 vector_product(const Point3& p, const Point3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

}  // namespace vorotool::core::cells_in_space
