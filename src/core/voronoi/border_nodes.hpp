// Where borders between sites end: vertices of the diagram, and points in the middle of straight lines, which
// are none; and the order of borders around them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/monitor.hpp"
#include "core/segment_voronoi/build/diagram.hpp"

namespace vorotool::core::voronoi {

class BorderNodes {
 public:
  // `is_needed` tells of each point whether a border ends in it.
  BorderNodes(const segment_voronoi::build::DiagramView& diagram, std::span<const std::uint8_t> is_needed);

  // The node at a point that is needed.
  std::int32_t of_point(std::int32_t point) const { return of_point_[base::at(point)]; }

  // Points whose nodes come after the vertices of the diagram: by place, however points are numbered.
  const std::vector<std::int32_t>& added() const { return added_; }

  // Two numbers a border that rise counter-clockwise among those that leave its source, and its target; 0 where
  // no more than two meet, unless it is `crowded`: others end there as well. Ends are -1 at infinity; `elements` are left and right, a wall has its segment twice.
  //
  // Around a vertex of the diagram its sites follow each other counter-clockwise: a border between two of them
  // comes after the one on its right, and a wall lies in the middle of its own sector.
  //
  // Throws std::runtime_error if a border ends at a vertex that its element does not touch.
  void put_in_order(std::span<const std::int64_t> ends, std::span<const std::int64_t> elements,
                    std::span<const std::int32_t> crowded, std::span<std::int64_t> order, unsigned threads,
                    const base::Monitor& monitor) const;

 private:
  struct End;  // of a border

  void find_vertices_of_points();
  void number_points();
  std::vector<std::int32_t> first_segments() const;
  std::int64_t order_in_line(const End& end, const std::vector<std::int32_t>& first) const;

  const segment_voronoi::build::DiagramView& diagram_;
  std::span<const std::uint8_t> is_needed_;
  std::vector<std::int32_t> of_point_;
  std::vector<std::int32_t> added_;
};

}  // namespace vorotool::core::voronoi
