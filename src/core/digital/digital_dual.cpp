#include "core/digital/digital_dual.hpp"

#include <algorithm>

#include "core/base/groups.hpp"
#include "core/kernel/predicates.hpp"
#include "core/label_images/corner_scan.hpp"

namespace vorotool::core::digital {

using delaunay::RingVertex;
using delaunay::Vertex;

namespace {

using Triangle = std::array<Vertex, 3>;

class DualReader {
 public:
  DualReader(std::span<const Vertex> vertex, std::span<const RingVertex> vertices)
      : vertex_(vertex), vertices_(vertices) {}

  void add(const label_images::Corner& corner) {
    const int labels = corner.labels();
    if (labels < 3) return;
    // Upper left, upper right, lower right, lower left: counter-clockwise, as y is stored.
    std::array<Vertex, 4> around = {of(corner.upper_left), of(corner.upper_right), of(corner.lower_right),
                                    of(corner.lower_left)};
    if (labels == 4) {
      ++dual.four_label_corners;
      divide(around);
      return;
    }
    // A connected region on both sides of the corner encloses one of the others: these are no neighbors.
    if (corner.upper_left == corner.lower_right || corner.upper_right == corner.lower_left) return;
    static_cast<void>(std::unique(around.begin(), around.end()));  // leaves the three in front
    ++dual.three_label_corners;
    dual.triangles.push_back({around[0], around[1], around[2]});
  }

  Vertex of(std::uint32_t label) const { return vertex_[label - 1]; }

  DigitalDual dual;

 private:
  const kernel::Point& at(Vertex v) const { return vertices_[static_cast<std::size_t>(v)].point; }
  int sign(const Triangle& t) const { return kernel::orient2d(at(t[0]), at(t[1]), at(t[2])); }

  // The diagonal that leaves two counter-clockwise triangles; of two such, the Delaunay one.
  void divide(const std::array<Vertex, 4>& q) {
    const Triangle one[] = {{q[0], q[1], q[2]}, {q[0], q[2], q[3]}};
    const Triangle other[] = {{q[1], q[2], q[3]}, {q[1], q[3], q[0]}};
    const int worst_one = std::min(sign(one[0]), sign(one[1]));
    const int worst_other = std::min(sign(other[0]), sign(other[1]));
    const bool swap = worst_one == 1 && worst_other == 1
                          ? kernel::incircle(at(q[0]), at(q[1]), at(q[2]), at(q[3])) > 0
                          : worst_other > worst_one;
    const auto& chosen = swap ? other : one;
    dual.triangles.insert(dual.triangles.end(), std::begin(chosen), std::end(chosen));
  }

  std::span<const Vertex> vertex_;
  std::span<const RingVertex> vertices_;
};

// The labels along the frame: right along the first row, down, left along the last row, up.
std::vector<Vertex> walk_frame(std::span<const std::uint32_t> image, std::size_t width,
                               const DualReader& reader) {
  const std::size_t height = image.size() / width;
  std::vector<Vertex> ring;
  const auto visit = [&](std::size_t column, std::size_t row) {
    const Vertex v = reader.of(image[row * width + column]);
    if (ring.empty() || ring.back() != v) ring.push_back(v);
  };
  for (std::size_t x = 0; x < width; ++x) visit(x, 0);
  for (std::size_t y = 0; y < height; ++y) visit(width - 1, y);
  for (std::size_t x = width; x-- > 0;) visit(x, height - 1);
  for (std::size_t y = height; y-- > 0;) visit(0, y);
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  return ring;
}

class TwinRemover {
 public:
  TwinRemover(DigitalDual& dual, std::size_t vertices)
      : dual_(dual), alive_(dual.triangles.size(), true), incident_(vertices, [&](const auto& add) {
          for (std::size_t t = 0; t < dual.triangles.size(); ++t) {
            for (const Vertex v : dual.triangles[t]) add(v, static_cast<std::uint32_t>(t));
          }
        }) {
    for (std::size_t v = 0; v < vertices; ++v)
      degree_.push_back(static_cast<std::uint32_t>(incident_[v].size()));
    read_ring(vertices);
  }

  std::uint64_t run() {
    std::vector<Vertex> candidates;
    for (std::size_t v = 0; v < degree_.size(); ++v) {
      if (degree_[v] == 2) candidates.push_back(static_cast<Vertex>(v));
    }
    std::uint64_t removed = 0;
    while (!candidates.empty()) {
      const Vertex v = candidates.back();
      candidates.pop_back();
      if (!remove(v)) continue;
      ++removed;
      for (const Vertex w : last_) {
        if (w != v && degree_[index(w)] == 2) candidates.push_back(w);
      }
    }
    if (removed > 0) write();
    return removed;
  }

 private:
  static std::size_t index(Vertex v) { return static_cast<std::size_t>(v); }

  void read_ring(std::size_t vertices) {
    const auto count = static_cast<std::int32_t>(dual_.ring.size());
    place_.assign(vertices, -1);
    times_.assign(vertices, 0);
    for (std::int32_t i = 0; i < count; ++i) {
      after_.push_back((i + 1) % count);
      before_.push_back((i + count - 1) % count);
      place_[index(at_ring(i))] = i;
      ++times_[index(at_ring(i))];
    }
    ring_size_ = count;
  }

  Vertex at_ring(std::int32_t i) const { return dual_.ring[static_cast<std::size_t>(i)]; }
  std::int32_t& after(std::int32_t i) { return after_[static_cast<std::size_t>(i)]; }
  std::int32_t& before(std::int32_t i) { return before_[static_cast<std::size_t>(i)]; }

  bool remove(Vertex v) {
    if (degree_[index(v)] != 2) return false;
    std::array<std::uint32_t, 2> pair{};
    std::size_t found = 0;
    for (const std::uint32_t t : incident_[v]) {
      if (alive_[t]) pair[found++] = t;
    }
    const Triangle one = dual_.triangles[pair[0]], other = dual_.triangles[pair[1]];
    if (!are_twins(one, other) || !leave_ring(v)) return false;
    for (const std::uint32_t t : pair) alive_[t] = false;
    for (const Vertex w : one) degree_[index(w)] -= 2;
    last_ = one;
    return true;
  }

  static bool are_twins(const Triangle& one, Triangle other) {
    std::reverse(other.begin(), other.end());
    for (int k = 0; k < 3; ++k) {
      if (one == other) return true;
      std::rotate(other.begin(), other.begin() + 1, other.end());
    }
    return false;
  }

  // On the frame such a site lies between two stretches of one neighbor, which become one.
  bool leave_ring(Vertex v) {
    if (times_[index(v)] == 0) return true;
    const std::int32_t i = place_[index(v)], p = before(i), n = after(i);
    if (times_[index(v)] > 1 || at_ring(i) != v || at_ring(p) != at_ring(n) || ring_size_ < 4) return false;
    after(p) = after(n);
    before(after(n)) = p;
    place_[index(at_ring(p))] = p;
    --times_[index(at_ring(p))];
    times_[index(v)] = 0;
    gone_ = true;
    entry_ = p;
    ring_size_ -= 2;
    return true;
  }

  void write() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < alive_.size(); ++t) {
      if (alive_[t]) dual_.triangles[kept++] = dual_.triangles[t];
    }
    dual_.triangles.resize(kept);
    if (!gone_) return;
    std::vector<Vertex> ring;
    std::int32_t i = entry_;
    do {
      ring.push_back(at_ring(i));
      i = after(i);
    } while (i != entry_);
    dual_.ring = std::move(ring);
  }

  DigitalDual& dual_;
  std::vector<bool> alive_;                   // [triangles]
  base::Groups<std::uint32_t> incident_;      // triangles at each vertex
  std::vector<std::uint32_t> degree_;         // [vertices] triangles alive at each
  std::vector<std::int32_t> after_, before_;  // [ring]
  std::vector<std::int32_t> place_;           // [vertices] one place on the ring, or -1
  std::vector<std::uint32_t> times_;          // [vertices] on the ring
  std::int32_t ring_size_ = 0, entry_ = 0;
  bool gone_ = false;  // whether the ring has lost vertices
  Triangle last_{};    // the triangle removed last
};

}  // namespace

DigitalDual find_dual(std::span<const std::uint32_t> image, std::size_t width, std::span<const Vertex> vertex,
                      std::span<const RingVertex> vertices, const base::Monitor& monitor) {
  DualReader reader(vertex, vertices);
  label_images::RowPair pair(width);
  const std::size_t height = image.size() / width;
  const std::size_t rows = label_images::rows_per_piece(width);
  for (std::size_t y = 1; y < height; ++y) {
    if (y % rows == 0) base::report(monitor, static_cast<double>(y) / static_cast<double>(height));
    pair.walk(
        image.subspan((y - 1) * width, width), image.subspan(y * width, width), [](auto, auto) {},
        [&](std::uint32_t, const label_images::Corner& corner) { reader.add(corner); });
  }
  reader.dual.ring = walk_frame(image, width, reader);
  return std::move(reader.dual);
}

std::uint64_t remove_twins(DigitalDual& dual, std::size_t vertices) {
  return TwinRemover(dual, vertices).run();
}

}  // namespace vorotool::core::digital
