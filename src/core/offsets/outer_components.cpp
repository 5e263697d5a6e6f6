#include "core/offsets/outer_components.hpp"

namespace vorotool::core::offsets {

OuterComponents::OuterComponents(const HalfEdges& borders, const PolygonFaces& domain, const LevelSet& level,
                                 const base::Monitor& monitor)
    : infinity_(static_cast<std::int32_t>(borders.diagram().radius.size())),
      sets_(borders.diagram().radius.size() + 1) {
  for (HalfEdge h = 0; h < borders.size(); h += 2) {
    base::report_item(monitor, static_cast<std::size_t>(h));
    if (domain.is_own_end(h) || !domain.holds(borders, h) || !level.is_edge_above(h)) continue;
    const std::int32_t tail = borders.tail(h), head = borders.head(h);
    sets_.join(tail < 0 ? infinity_ : tail, head < 0 ? infinity_ : head);
  }
}

}  // namespace vorotool::core::offsets
