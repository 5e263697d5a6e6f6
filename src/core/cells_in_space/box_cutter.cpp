#include "core/cells_in_space/box_cutter.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace vorotool::core::cells_in_space {

namespace {

// Corners are numbered by bits: 1 if x is high, 2 if y is, 4 if z is.
constexpr std::int32_t side_corners[box_sides][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

}  // namespace

void BoxCutter::begin(const CellPlanes& planes) {
  planes_ = &planes;
  vertices_.clear(), faces_.clear(), live_.clear();
  for (Index corner = 0; corner < 8; ++corner) {
    const Index x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    vertices_.push_back({planes.meeting({x, 2 + y, 4 + z}), {x, 2 + y, 4 + z}});
    live_.push_back(corner);
  }
  for (std::size_t side = 0; side < box_sides; ++side) {
    const auto& corners = side_corners[side];
    faces_.push_back({static_cast<Index>(side), {std::begin(corners), std::end(corners)}});
  }
}

bool BoxCutter::cut(Index plane) {
  sign_.resize(vertices_.size());
  bool any_inside = false, any_beyond = false;
  for (const Index v : live_) {
    const int side = planes_->side(vertex(v).at, plane);
    sign_[static_cast<std::size_t>(v)] = side;
    any_inside |= side > 0;
    any_beyond |= side < 0;
    if (side == 0) vertices_[static_cast<std::size_t>(v)].through.push_back(plane);
  }
  if (!any_inside) {
    faces_.clear(), live_.clear();
    return false;
  }
  if (!any_beyond) return true;
  crossings_.clear(), edges_.clear();
  std::erase_if(faces_, [&](Face& face) { return !cut_face(face, plane); });
  close(plane);
  std::erase_if(live_, [&](Index v) { return sign(v) < 0; });
  for (const Crossing& each : crossings_) live_.push_back(each.vertex);
  return true;
}

// Cuts a face; false if nothing with area is left of it inside.
bool BoxCutter::cut_face(Face& face, Index plane) {
  kept_.clear();
  const std::size_t size = face.corners.size();
  bool any_inside = false, any_beyond = false;
  for (std::size_t i = 0; i < size; ++i) {
    const Index v = face.corners[i], next = face.corners[i + 1 == size ? 0 : i + 1];
    const int here = sign(v), there = sign(next);
    any_inside |= here > 0;
    any_beyond |= here < 0;
    if (here >= 0) kept_.push_back(v);
    if (here * there < 0)
      kept_.push_back(here > 0 ? crossing(v, next, face.plane, plane) : crossing(next, v, face.plane, plane));
  }
  if (!any_inside) return false;
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const Index v = kept_[i], next = kept_[i + 1 == kept_.size() ? 0 : i + 1];
    if (sign(v) == 0 && sign(next) == 0) edges_.emplace_back(next, v);
  }
  if (any_beyond) face.corners.assign(kept_.begin(), kept_.end());
  return true;
}

// The vertex where an edge crosses the plane, one for both faces that have the edge.
BoxCutter::Index BoxCutter::crossing(Index inside, Index outside, Index of, Index plane) {
  for (const Crossing& each : crossings_) {
    if (each.inside != inside || each.outside != outside) continue;
    vertices_[static_cast<std::size_t>(each.vertex)].at = planes_->meeting({each.plane, of, plane});
    return each.vertex;
  }
  const auto made = static_cast<Index>(vertices_.size());
  std::vector<Index> through;
  const std::vector<Index>&a = vertex(inside).through, &b = vertex(outside).through;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(through));
  through.push_back(plane);
  vertices_.push_back({{}, std::move(through)});
  sign_.push_back(0);
  crossings_.push_back({inside, outside, of, made});
  return made;
}

// Adds the face in the plane, from the edges that other faces have there.
void BoxCutter::close(Index plane) {
  Face face{plane, {}};
  Index v = edges_.front().first;
  do {
    face.corners.push_back(v);
    const auto edge =
        std::find_if(edges_.begin(), edges_.end(), [v](const auto& each) { return each.first == v; });
    v = edge->second;
  } while (v != face.corners.front());
  faces_.push_back(std::move(face));
}

}  // namespace vorotool::core::cells_in_space
