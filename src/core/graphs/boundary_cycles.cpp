#include "core/graphs/boundary_cycles.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/base/indices.hpp"

namespace vorotool::core::graphs {

using base::at;
using base::no_index;

namespace {

class Tracer {
 public:
  Tracer(std::span<const std::int32_t> next, std::span<const std::int32_t> tail, std::size_t vertices)
      : next_(next), tail_(tail), is_done_(next.size()), place_(vertices, no_index) {
    cycles_.start.push_back(0);
    cycles_.half_edge.reserve(next.size());
  }

  BoundaryCycles trace() {
    for (std::size_t h = 0; h < next_.size(); ++h) {
      if (is_done_[h] == 0) walk(static_cast<std::int32_t>(h));
    }
    return sorted();
  }

 private:
  // Where a vertex is met again, what was walked since then is a cycle.
  void walk(std::int32_t first) {
    std::int32_t h = first;
    do {
      if (is_done_[at(h)] != 0) throw std::invalid_argument("the half-edges after others are no permutation");
      is_done_[at(h)] = 1;
      std::int32_t& place = place_[at(tail_[at(h)])];
      if (place != no_index) cut_off(at(place));
      place = static_cast<std::int32_t>(path_.size());
      path_.push_back(h);
      h = next_[at(h)];
    } while (h != first);
    cut_off(0);
  }

  void cut_off(std::size_t from) {
    const auto begin = path_.begin() + static_cast<std::ptrdiff_t>(from);
    for (auto each = begin; each != path_.end(); ++each) place_[at(tail_[at(*each)])] = no_index;
    std::rotate(begin, std::min_element(begin, path_.end()), path_.end());
    cycles_.half_edge.insert(cycles_.half_edge.end(), begin, path_.end());
    cycles_.start.push_back(static_cast<std::int32_t>(cycles_.half_edge.size()));
    path_.erase(begin, path_.end());
  }

  BoundaryCycles sorted() const {
    std::vector<std::size_t> order(cycles_.start.size() - 1);
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return cycles_.half_edge[at(cycles_.start[a])] < cycles_.half_edge[at(cycles_.start[b])];
    });
    BoundaryCycles made;
    made.start.reserve(cycles_.start.size());
    made.half_edge.reserve(cycles_.half_edge.size());
    made.start.push_back(0);
    for (const std::size_t k : order) {
      const auto begin = cycles_.half_edge.begin();
      made.half_edge.insert(made.half_edge.end(), begin + cycles_.start[k], begin + cycles_.start[k + 1]);
      made.start.push_back(static_cast<std::int32_t>(made.half_edge.size()));
    }
    return made;
  }

  std::span<const std::int32_t> next_, tail_;
  std::vector<std::uint8_t> is_done_;
  std::vector<std::int32_t> place_;  // of each vertex on the path; no_index of others
  std::vector<std::int32_t> path_;
  BoundaryCycles cycles_;
};

}  // namespace

BoundaryCycles boundary_cycles(std::span<const std::int32_t> next, std::span<const std::int32_t> tail,
                               std::size_t vertices) {
  return Tracer(next, tail, vertices).trace();
}

}  // namespace vorotool::core::graphs
