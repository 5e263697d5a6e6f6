#include "core/sampled_skeleton/sample_faces.hpp"

#include <algorithm>
#include <cstddef>

#include "core/base/indices.hpp"
#include "core/base/parallel.hpp"

namespace vorotool::core::sampled_skeleton {

using base::at;

namespace {

constexpr std::int32_t unknown = -1;

class FaceFinder {
 public:
  explicit FaceFinder(const SampleFaceInput& in) : in_(in), face_(in.mesh.size(), unknown) {}

  std::vector<std::int32_t> run(unsigned threads, const base::Monitor& monitor) {
    constexpr std::size_t grain = 1 << 15;
    base::for_items(face_.size(), grain, threads, monitor,
                    [&](std::size_t t) { face_[t] = face_by_sides(static_cast<Triangle>(t)); });
    take_from_crossings();
    spread();
    return std::move(face_);
  }

 private:
  bool is_on_shape(Triangle t) const { return !in_.is_on_shape.empty() && in_.is_on_shape[at(t)] != 0; }
  const base::IndexPair& faces_of(std::int32_t segment) const {
    return in_.labels.graph().faces[at(segment)];
  }

  // Beside its own piece, or beyond the hull.
  std::int32_t face_by_sides(Triangle t) const {
    if (is_on_shape(t)) return unknown;
    for (Side s = 3 * t; s < 3 * t + 3; ++s) {
      const int state = in_.state[at(s)];
      if ((state & (own_piece | crossed)) == own_piece) {
        const auto [segment, is_forward] =
            in_.labels.segment_of_piece(in_.mesh.origin(s), in_.mesh.target(s));
        return faces_of(segment)[is_forward ? 0 : 1];
      }
      if ((state & (own_piece | crossed)) == 0 && in_.mesh.across(s) < 0) return 0;
    }
    return unknown;
  }

  // From the origin of a side to its target the circumcenter on the left of it is on the left of the piece.
  void take_from_crossings() {
    std::vector<Crossing> all;
    for (Crossing c : in_.crossings) {
      const Side twin = in_.mesh.twin(c.side);
      if (twin >= 0 && twin < c.side) c = {twin, c.piece, !c.from_origin};
      all.push_back(c);
    }
    add_own_pieces(all);
    std::stable_sort(all.begin(), all.end(),
                     [](const Crossing& a, const Crossing& b) { return a.side < b.side; });
    for (auto begin = all.begin(), end = begin; begin != all.end(); begin = end) {
      end = std::find_if(begin, all.end(), [&](const Crossing& c) { return c.side != begin->side; });
      const auto earlier = [&](const Crossing& a, const Crossing& b) {
        return compare_crossings(in_.mesh, in_.labels, a, b) < 0;
      };
      const auto [last, first] = std::minmax_element(begin, end, earlier);
      set_face(SampleMesh::triangle_of(begin->side), first->piece, first->from_origin);
      if (in_.mesh.across(begin->side) >= 0)
        set_face(in_.mesh.across(begin->side), last->piece, !last->from_origin);
    }
  }

  // Those of edges that other pieces cross as well.
  void add_own_pieces(std::vector<Crossing>& all) const {
    const std::size_t walked = all.size();
    for (std::size_t i = 0; i < walked; ++i) {
      const Side side = all[i].side;
      if ((in_.state[at(side)] & own_piece) == 0) continue;
      const std::int32_t p = in_.mesh.origin(side), q = in_.mesh.target(side);
      all.push_back({side, in_.labels.piece_between(p, q), in_.labels.segment_of_piece(p, q).second});
    }
  }

  void set_face(Triangle t, std::int32_t piece, bool is_left) {
    if (!is_on_shape(t)) face_[at(t)] = faces_of(in_.labels.piece(piece).segment)[is_left ? 0 : 1];
  }

  void spread() {
    std::vector<Triangle> next;
    for (std::size_t t = 0; t < face_.size(); ++t) {
      if (face_[t] != unknown || is_on_shape(static_cast<Triangle>(t))) continue;
      next.push_back(static_cast<Triangle>(t));
      while (!next.empty()) {
        const Triangle u = next.back();
        next.pop_back();
        if (face_[at(u)] == unknown) settle(u, next);
      }
    }
  }

  // Takes the face of a neighbor that has one, and tells those that have none.
  void settle(Triangle t, std::vector<Triangle>& next) {
    const auto visit_open = [&](const auto& visit) {
      for (Side s = 3 * t; s < 3 * t + 3; ++s) {
        const Triangle u = in_.mesh.across(s);
        if (u >= 0 && (in_.state[at(s)] & (own_piece | crossed)) == 0 && !is_on_shape(u)) visit(u);
      }
    };
    visit_open([&](Triangle u) {
      if (face_[at(u)] != unknown) face_[at(t)] = face_[at(u)];
    });
    if (face_[at(t)] == unknown) return;
    visit_open([&](Triangle u) {
      if (face_[at(u)] == unknown) next.push_back(u);
    });
  }

  const SampleFaceInput& in_;
  std::vector<std::int32_t> face_;
};

}  // namespace

std::vector<std::int32_t> sample_faces(const SampleFaceInput& input, unsigned threads,
                                       const base::Monitor& monitor) {
  return FaceFinder(input).run(threads, monitor);
}

}  // namespace vorotool::core::sampled_skeleton
