#include "core/voronoi/site_borders.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/disjoint_sets.hpp"
#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/skeleton/edges.hpp"
#include "core/voronoi/border_nodes.hpp"
#include "core/voronoi/own_ends.hpp"

namespace vorotool::core::voronoi {

using base::at;
using base::IndexPair;
using base::no_index;
using segment_voronoi::build::DiagramView;

namespace {

constexpr std::size_t edges_a_piece = 1 << 15;

// What is left and right of a piece or a segment.
struct Sides {
  IndexPair sites, parts;

  bool is_border() const { return sites[0] != sites[1]; }
};

class Chooser {
 public:
  Chooser(const DiagramView& diagram, std::span<const std::int32_t> element_owner,
          std::span<const std::int32_t> face_owner, const std::optional<Reach>& reach, unsigned threads,
          const base::Monitor& monitor)
      : diagram_(diagram),
        element_owner_(element_owner),
        face_owner_(face_owner),
        reach_(reach),
        threads_(threads),
        monitor_(monitor),
        kept_(skeleton::skeleton_edges(diagram, threads, monitor)),
        own_(own_ends(diagram, kept_)),
        parts_(diagram.site_count() + diagram.segments.size() + face_owner.size()) {}

  SiteBorders borders() {
    choose();
    const BorderNodes nodes(diagram_, needed_points());
    SiteBorders made;
    const std::size_t size = 2 * (pieces_.size() + walls_.size());
    for (auto* numbers : {&made.ends, &made.elements, &made.parts, &made.order}) {
      *numbers = base::LargeArray<std::int64_t>(size);
    }
    made.sites = base::LargeArray<std::int32_t>(size);
    write(made, nodes);
    for (std::size_t k = 0; k < size; ++k)
      made.parts[k] = parts_.find(static_cast<std::int32_t>(made.parts[k]));
    nodes.put_in_order({made.ends.data(), size}, {made.elements.data(), size},
                       reach_ ? reach_->crowded : std::span<const std::int32_t>(), {made.order.data(), size},
                       threads_, monitor_);
    made.added = nodes.added();
    if (reach_) tell(made);
    return made;
  }

 private:
  std::size_t piece_count() const { return kept_.edge.size() + own_.pieces.size(); }

  Piece piece(std::size_t k) const {
    if (k >= kept_.edge.size()) return own_.pieces[k - kept_.edge.size()];
    return {kept_.edge[k], kept_.face[k], no_index, false};
  }

  bool is_covered(std::int32_t face) const { return face_owner_[at(face)] >= 0; }

  // A half that ends at a point always is.
  bool is_near(const Piece& piece) const {
    return !reach_ || piece.point != no_index || reach_->is_near[at(piece.edge)] != 0;
  }

  // In a face that no site covers.
  Sides sides(const Piece& piece) const {
    Sides made;
    for (std::size_t hand = 0; hand < 2; ++hand) {
      std::int32_t element = diagram_.edge_sites[at(piece.edge)][hand];
      if (diagram_.is_point(element)) element = own_.alias[at(element)];
      made.sites[hand] = element_owner_[at(element)];
      made.parts[hand] = part(element, piece.face);
    }
    return made;
  }

  // Points come first, then the left and the right sides of segments, then covered faces.
  std::int32_t part(std::int32_t element, std::int32_t face) const {
    if (diagram_.is_point(element)) return element;
    const std::size_t segment = diagram_.segment_of(element);
    return side_of(segment, diagram_.faces[segment][0] == face ? 0 : 1);
  }

  std::int32_t side_of(std::size_t segment, std::size_t hand) const {
    return static_cast<std::int32_t>(diagram_.points.size() + 2 * segment + hand);
  }

  Sides sides_of_segment(std::size_t segment) const {
    Sides made;
    for (std::size_t hand = 0; hand < 2; ++hand) {
      const std::int32_t face = diagram_.faces[segment][hand];
      const std::size_t first_face = diagram_.site_count() + diagram_.segments.size();
      const bool covered = is_covered(face);
      made.sites[hand] = covered ? face_owner_[at(face)] : element_owner_[diagram_.points.size() + segment];
      made.parts[hand] = covered ? static_cast<std::int32_t>(first_face) + face : side_of(segment, hand);
    }
    return made;
  }

  // Chooses the borders among pieces and segments, and joins the parts beside the others.
  void choose() {
    const std::size_t count = piece_count();
    std::vector<std::vector<std::int32_t>> chosen(base::piece_count(count, edges_a_piece));
    std::vector<std::vector<IndexPair>> joined(chosen.size());
    base::for_pieces(count, edges_a_piece, threads_, monitor_,
                     [&](std::size_t some, std::size_t begin, std::size_t end) {
                       for (std::size_t k = begin; k < end; ++k) {
                         const Piece each = piece(k);
                         if (is_covered(each.face) || !is_near(each)) continue;
                         const Sides beside = sides(each);
                         if (beside.is_border()) {
                           chosen[some].push_back(static_cast<std::int32_t>(k));
                         } else {
                           joined[some].push_back(beside.parts);
                         }
                       }
                     });
    for (std::size_t some = 0; some < chosen.size(); ++some) {
      pieces_.insert(pieces_.end(), chosen[some].begin(), chosen[some].end());
      for (const auto& [a, b] : joined[some]) parts_.join(a, b);
    }
    for (std::size_t j = 0; j < diagram_.segments.size(); ++j) {
      const Sides beside = sides_of_segment(j);
      if (beside.is_border()) {
        walls_.push_back(static_cast<std::int32_t>(j));
      } else {
        parts_.join(beside.parts[0], beside.parts[1]);
      }
    }
  }

  std::vector<std::uint8_t> needed_points() const {
    std::vector<std::uint8_t> is_needed(diagram_.points.size());
    for (const std::int32_t k : pieces_) {
      if (at(k) < kept_.edge.size()) continue;
      const std::int32_t point = piece(at(k)).point;
      if (point != no_index) is_needed[at(point)] = 1;
    }
    for (const std::int32_t j : walls_) {
      for (const std::int32_t point : diagram_.segments[at(j)]) is_needed[at(point)] = 1;
    }
    return is_needed;
  }

  void write(SiteBorders& made, const BorderNodes& nodes) const {
    base::for_items(made.size(), edges_a_piece, threads_, monitor_, [&](std::size_t b) {
      IndexPair ends, elements;
      Sides beside;
      if (b < pieces_.size()) {
        const Piece each = piece(at(pieces_[b]));
        ends = diagram_.edges[at(each.edge)];
        if (each.point != no_index) ends[each.is_first ? 1 : 0] = nodes.of_point(each.point);
        elements = diagram_.edge_sites[at(each.edge)];
        beside = sides(each);
      } else {
        const std::size_t segment = at(walls_[b - pieces_.size()]);
        for (std::size_t end = 0; end < 2; ++end) ends[end] = nodes.of_point(diagram_.segments[segment][end]);
        elements.fill(static_cast<std::int32_t>(diagram_.points.size() + segment));
        beside = sides_of_segment(segment);
      }
      for (std::size_t hand = 0; hand < 2; ++hand) {
        made.ends[2 * b + hand] = ends[hand];
        made.elements[2 * b + hand] = elements[hand];
        made.parts[2 * b + hand] = beside.parts[hand];
        made.sites[2 * b + hand] = beside.sites[hand];
      }
    });
  }

  void tell(SiteBorders& made) {
    for (const std::int32_t k : pieces_) {
      const Piece each = piece(at(k));
      made.edge.push_back(each.edge);
      made.point.push_back(each.point);
      made.is_first.push_back(each.is_first ? 1 : 0);
    }
    const std::size_t parts = diagram_.site_count() + diagram_.segments.size() + face_owner_.size();
    for (std::size_t k = 0; k < parts; ++k) made.root.push_back(parts_.find(static_cast<std::int32_t>(k)));
  }

  const DiagramView& diagram_;
  std::span<const std::int32_t> element_owner_, face_owner_;
  const std::optional<Reach>& reach_;
  unsigned threads_;
  const base::Monitor& monitor_;
  skeleton::SkeletonEdges kept_;
  OwnEnds own_;
  base::DisjointSets<std::int32_t> parts_;
  std::vector<std::int32_t> pieces_, walls_;
};

}  // namespace

EdgeFaces edge_faces(const DiagramView& diagram, unsigned threads, const base::Monitor& monitor) {
  const skeleton::SkeletonEdges kept = skeleton::skeleton_edges(diagram, threads, monitor);
  const std::size_t count = diagram.edges.size();
  EdgeFaces made{base::LargeArray<std::int32_t>(2 * count), base::LargeArray<std::uint8_t>(count), {}};
  std::fill_n(made.is_own.data(), count, std::uint8_t{1});
  for (std::size_t k = 0; k < kept.edge.size(); ++k) {
    const std::size_t edge = at(kept.edge[k]);
    made.is_own[edge] = 0;
    made.faces[2 * edge] = made.faces[2 * edge + 1] = kept.face[k];
  }
  OwnEnds own = own_ends(diagram, kept);
  for (const Piece& each : own.pieces) {
    const std::size_t edge = at(each.edge);
    if (each.point == no_index || each.is_first) made.faces[2 * edge] = each.face;
    if (each.point == no_index || !each.is_first) made.faces[2 * edge + 1] = each.face;
  }
  made.alias = std::move(own.alias);
  return made;
}

SiteBorders site_borders(const DiagramView& diagram, std::span<const std::int32_t> element_owner,
                         std::span<const std::int32_t> face_owner, const std::optional<Reach>& reach,
                         unsigned threads, const base::Monitor& monitor) {
  return Chooser(diagram, element_owner, face_owner, reach, threads, monitor).borders();
}

}  // namespace vorotool::core::voronoi
