#include "core/sampled_skeleton/corner_bisectors.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"
#include "core/delaunay/vertex_triangles.hpp"
#include "core/numbers/fixed_integer.hpp"
#include "core/sampled_skeleton/sample_mesh.hpp"

namespace vorotool::core::sampled_skeleton {

using base::at;
using delaunay::following;
using delaunay::preceding;
using delaunay::VertexTriangles;
using kernel::LatticeVector;
using numbers::widen;

namespace {

struct Vector {
  double x, y;
};

Vector unit(const LatticeVector& v) {
  const double x = static_cast<double>(v.x), y = static_cast<double>(v.y), length = std::sqrt(x * x + y * y);
  return {x / length, y / length};
}

// Between two directions less than 180 degrees apart. Of an obtuse angle the normals are added: nothing
// cancels.
kernel::Point bisector_of(const LatticeVector& right, const LatticeVector& left) {
  const Vector a = unit(right), b = unit(left);
  const Vector sum =
      kernel::dot(right, left) > 0 ? Vector{a.x + b.x, a.y + b.y} : Vector{b.y - a.y, a.x - b.x};
  const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y);
  return {sum.x / length, sum.y / length};
}

// A neighbor of the corner in its sector, and a side between both. All but the last have the next triangle
// of the sector on the left of it.
struct CornerSpoke {
  std::int32_t seed;
  Side side;
};

class Sector {
 public:
  Sector(const SampleDiagram& diagram, const VertexTriangles& rings, CornerBisector& line)
      : diagram_(diagram), mesh_(diagram.mesh()), line_(line) {
    find_spokes(rings);
  }

  // Whether the bisector meets the border of the corner's cell in a vertex or a kept edge, and no piece
  // before: the pieces on both sides leave the cell across their own edges, and no other piece is in between.
  bool meet() {
    const auto is_crossed = [&](const CornerSpoke& spoke) { return diagram_.is_crossed(spoke.side); };
    if (spokes_.empty() || std::any_of(spokes_.begin(), spokes_.end(), is_crossed)) return false;
    if (!diagram_.has_own_piece(spokes_.front().side) || !diagram_.has_own_piece(spokes_.back().side))
      return false;
    const std::size_t first = first_met();
    const bool is_last = first + 1 == spokes_.size();
    if (first > 0 && !is_last && compare(first, first + 1) != 0) return meet_inside(first);
    line_.node = SampleMesh::triangle_of(is_last ? spokes_[first - 1].side : spokes_[first].side);
    return true;
  }

 private:
  // All seeds between the ones next to the corner on both edges; none if one of these is no neighbor.
  void find_spokes(const VertexTriangles& rings) {
    const SampleLabels& labels = diagram_.labels();
    const std::int32_t first = labels.seed_beside(line_.corner, line_.right);
    const std::int32_t last = labels.seed_beside(line_.corner, line_.left);
    struct Fan {
      CornerSpoke spoke, after;
    };
    std::vector<Fan> ring;
    rings.visit(line_.corner, [&](Triangle t, std::int32_t next, std::int32_t after) {
      const Side opposite = mesh_.opposite(t, line_.corner);
      ring.push_back({{next, preceding(opposite)}, {after, following(opposite)}});
    });
    const auto from =
        std::find_if(ring.begin(), ring.end(), [&](const Fan& fan) { return fan.spoke.seed == first; });
    if (from == ring.end()) return;
    std::rotate(ring.begin(), from, ring.end());
    for (const auto& [spoke, after] : ring) {
      spokes_.push_back(spoke);
      if (after.seed != last) continue;
      spokes_.push_back(after);
      return;
    }
    spokes_.clear();
  }

  // Along the unit vector w the place t w away is as far from the corner as from a seed at v for t = v v / (2
  // w v): exactly compared, the numerators being below 2^107 and the denominators below 2^108.
  struct Meeting {
    numbers::int128 square, dot;
  };
  Meeting meeting(std::size_t spoke) const {
    const SampleVector v = sample_difference(mesh_.seed(spokes_[spoke].seed), mesh_.seed(line_.corner));
    const SampleVector w{static_cast<std::int64_t>(std::nearbyint(line_.direction.x * 0x1p53)),
                         static_cast<std::int64_t>(std::nearbyint(line_.direction.y * 0x1p53))};
    return {dot(v, v), dot(w, v)};
  }
  int compare(std::size_t one, std::size_t other) const {
    const Meeting a = meeting(one), b = meeting(other);
    if (a.dot <= 0 || b.dot <= 0) return (a.dot <= 0) - (b.dot <= 0);
    return (widen(a.square) * widen(b.dot) - widen(b.square) * widen(a.dot)).sign();
  }

  std::size_t first_met() const {
    std::size_t first = 0;
    for (std::size_t i = 1; i < spokes_.size(); ++i) {
      if (compare(i, first) < 0) first = i;
    }
    return first;
  }

  bool meet_inside(std::size_t spoke) {
    const Side side = spokes_[spoke].side;
    if (!diagram_.is_kept(side)) return false;
    line_.side = side;
    const kernel::Point &seed = mesh_.seed(spokes_[spoke].seed), &corner = mesh_.seed(line_.corner);
    const double x = seed.x - corner.x, y = seed.y - corner.y;
    line_.along = (x * x + y * y) / (2 * (x * line_.direction.x + y * line_.direction.y));
    return true;
  }

  const SampleDiagram& diagram_;
  const SampleMesh& mesh_;
  CornerBisector& line_;
  std::vector<CornerSpoke> spokes_;
};

std::vector<CornerBisector> corners_of(const SampleDiagram& diagram,
                                       std::span<const std::int32_t> face_group) {
  const kernel::PlanarGraphView& graph = diagram.labels().graph();
  const auto points = static_cast<std::int32_t>(graph.points.size());
  std::vector<CornerBisector> corners;
  for (std::int32_t point = 0; point < points; ++point) {
    const auto sites = diagram.labels().incident().at(point);
    for (std::size_t i = 0; i < sites.size(); ++i) {
      const std::int32_t following = sites[(i + 1) % sites.size()];
      const LatticeVector a = graph.way_from(point, sites[i]), b = graph.way_from(point, following);
      if (kernel::cross(a, b) <= 0) continue;
      const std::int32_t right = sites[i] - points, left = following - points;
      const std::int32_t face = graph.faces[at(right)][graph.segments[at(right)][0] == point ? 0 : 1];
      if (face_group[at(face)] < 0) continue;
      corners.push_back({point, right, left, face});
      corners.back().direction = bisector_of(a, b);
    }
  }
  return corners;
}

}  // namespace

CornerBisectors corner_bisectors(const SampleDiagram& diagram, std::span<const std::int32_t> face_group,
                                 unsigned threads, const base::Monitor& monitor) {
  constexpr std::size_t grain = 1 << 10;
  CornerBisectors found{corners_of(diagram, face_group)};
  if (diagram.mesh().size() == 0) return {{}, found.lines.size()};
  const SampleMesh& mesh = diagram.mesh();
  const delaunay::TriangulationArrays arrays{mesh.seeds, mesh.triangles, mesh.neighbors, {}, {}, {}};
  const VertexTriangles rings(arrays);
  std::vector<std::uint8_t> is_met(found.lines.size());
  base::for_items(is_met.size(), grain, threads, monitor,
                  [&](std::size_t i) { is_met[i] = Sector(diagram, rings, found.lines[i]).meet() ? 1 : 0; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < is_met.size(); ++i) {
    if (is_met[i] != 0) found.lines[kept++] = found.lines[i];
  }
  found.open = found.lines.size() - kept;
  found.lines.resize(kept);
  return found;
}

}  // namespace vorotool::core::sampled_skeleton
