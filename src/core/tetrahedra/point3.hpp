// A point of space.
#pragma once

namespace vorotool::core::tetrahedra {

struct Point3 {
  double x, y, z;

  friend bool operator==(const Point3&, const Point3&) = default;
};

// By x, then y, then z: the order that breaks ties.
inline bool comes_before(const Point3& p, const Point3& q) {
  if (p.x != q.x) return p.x < q.x;
  return p.y != q.y ? p.y < q.y : p.z < q.z;
}

}  // namespace vorotool::core::tetrahedra
