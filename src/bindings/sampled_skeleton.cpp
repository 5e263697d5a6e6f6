// Approximate skeletons: seeds on edges, their Voronoi diagram, and what of it is kept.
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/diagram_arrays.hpp"
#include "bindings/support/mesh_arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "core/base/parallel.hpp"
#include "core/sampled_skeleton/boundary_samples.hpp"
#include "core/sampled_skeleton/sample_diagram.hpp"
#include "core/sampled_skeleton/sampled_skeleton.hpp"

namespace vorotool::bindings {
namespace {

namespace nb = nanobind;
using namespace nb::literals;
using core::base::Monitor;

// The arrays of a graph, kept while the core works on views of them.
struct GraphArrays {
  IndexRows points, segments, faces;

  core::kernel::PlanarGraphView graph() const {
    const core::kernel::PlanarGraphView g{rows<LatticePoint>(points), rows<Pair>(segments),
                                          rows<Pair>(faces)};
    if (g.faces.size() != g.segments.size()) throw std::invalid_argument("each segment must have two faces");
    for (const Pair& ends : g.segments) {
      for (const std::int32_t end : ends) {
        if (end < 0 || static_cast<std::size_t>(end) >= g.points.size()) {
          throw std::invalid_argument("an end of a segment is out of range");
        }
      }
    }
    return g;
  }
};

// Seeds, the segment that each is inside of, and where those of each segment begin.
auto to_tuple(core::sampled_skeleton::BoundarySamples&& samples) {
  const std::size_t count = samples.segment.size();
  return std::make_tuple(points_to_numpy(std::move(samples.seeds)),
                         to_numpy(std::move(samples.segment), {count}), to_numpy(std::move(samples.start)));
}

auto sample_by_step(const IndexRows& points, const IndexRows& segments, const IndexRows& faces, double step,
                    std::size_t most, unsigned threads, const Progress& progress) {
  const core::kernel::PlanarGraphView graph = GraphArrays{points, segments, faces}.graph();
  return to_tuple(run_interruptible(progress, [&](const Monitor& monitor) {
    return core::sampled_skeleton::sample_by_step(graph, step, most, core::base::resolve_threads(threads),
                                                  monitor);
  }));
}

using Steps = std::pair<Vector<const std::uint64_t>, Vector<const double>>;

core::sampled_skeleton::CornerSteps steps_of(const Steps& steps, const core::kernel::PlanarGraphView& graph) {
  const auto start = view(steps.first);
  const auto distance = view(steps.second);
  core::sampled_skeleton::CornerSteps made{{start.begin(), start.end()}, {distance.begin(), distance.end()}};
  if (made.start.size() != graph.points.size() + 1 || made.start.back() != made.distance.size()) {
    throw std::invalid_argument("the distances of seeds do not go with the points");
  }
  return made;
}

auto to_tuple(core::sampled_skeleton::CornerSteps&& steps) {
  return std::make_tuple(to_numpy(std::vector<std::uint64_t>(steps.start.begin(), steps.start.end())),
                         to_numpy(std::move(steps.distance)));
}

auto sample_from_corners(const IndexRows& points, const IndexRows& segments, const IndexRows& faces,
                         const Steps& steps, std::size_t most, unsigned threads, const Progress& progress) {
  const core::kernel::PlanarGraphView graph = GraphArrays{points, segments, faces}.graph();
  const core::sampled_skeleton::CornerSteps wanted = steps_of(steps, graph);
  return to_tuple(run_interruptible(progress, [&](const Monitor& monitor) {
    return core::sampled_skeleton::sample_from_corners(graph, wanted, most,
                                                       core::base::resolve_threads(threads), monitor);
  }));
}

auto corner_steps(const IndexRows& points, const IndexRows& segments, const IndexRows& faces, double step,
                  bool is_even, std::size_t most) {
  const core::kernel::PlanarGraphView graph = GraphArrays{points, segments, faces}.graph();
  return to_tuple(is_even ? core::sampled_skeleton::even_steps(graph, step, most)
                          : core::sampled_skeleton::doubled_steps(graph, step, most));
}

auto refined_steps(const IndexRows& points, const IndexRows& segments, const IndexRows& faces,
                   const Steps& steps, const Indices& start, const Indices& parts, std::size_t most) {
  const core::kernel::PlanarGraphView graph = GraphArrays{points, segments, faces}.graph();
  if (start.size() != graph.segments.size() + 1 ||
      parts.size() !=
          graph.segments.size() + static_cast<std::size_t>(view(start).back()) - graph.points.size()) {
    throw std::invalid_argument("the parts do not go with the pieces");
  }
  return to_tuple(
      core::sampled_skeleton::refined_steps(graph, steps_of(steps, graph), view(start), view(parts), most));
}

using Box = std::tuple<double, double, double, double>;  // least and most x, then y

// A diagram and what it looks at.
class SampledDiagram {
 public:
  SampledDiagram(const GraphArrays& arrays, const Matrix<const double>& seeds, const Indices& segment,
                 const Indices& start, const Indices& group, const std::optional<Box>& within,
                 unsigned threads, const Progress& progress)
      : arrays_(arrays), seeds_(seeds), segment_(segment), start_(start), group_(group) {
    const core::kernel::PlanarGraphView graph = arrays_.graph();
    check(graph);
    const core::sampled_skeleton::SampleGroups groups = groups_of(graph, within);
    made_ = run_interruptible(progress, [&](const Monitor& monitor) {
      return std::make_unique<core::sampled_skeleton::SampleDiagram>(
          graph, as_points(seeds_), view(segment_), view(start_), groups,
          core::base::resolve_threads(threads), monitor);
    });
  }

  const core::sampled_skeleton::SampleDiagram& operator*() const { return *made_; }

 private:
  void check(const core::kernel::PlanarGraphView& graph) const {
    const std::span<const std::int32_t> start = view(start_), segment = view(segment_);
    bool fits = start.size() == graph.segments.size() + 1 && segment.size() == as_points(seeds_).size() &&
                static_cast<std::size_t>(start.front()) == graph.points.size() &&
                static_cast<std::size_t>(start.back()) == segment.size();
    for (std::size_t j = 1; fits && j < start.size(); ++j) fits = start[j - 1] <= start[j];
    for (const std::int32_t j : segment) {
      fits &= j >= -1 && j < static_cast<std::int32_t>(graph.segments.size());
    }
    if (!fits) throw std::invalid_argument("the seeds do not go with the segments");
  }

  core::sampled_skeleton::SampleGroups groups_of(const core::kernel::PlanarGraphView& graph,
                                                 const std::optional<Box>& within) const {
    core::sampled_skeleton::SampleGroups groups{view(group_), 1, {}};
    if (within) {
      const auto [least_x, most_x, least_y, most_y] = *within;
      groups.within = core::spatial::Bounds({least_x, least_y});
      groups.within->add({most_x, most_y});
    }
    if (groups.of_point.empty()) return groups;
    bool fits = groups.of_point.size() == graph.points.size();
    for (const std::int32_t own : groups.of_point) {
      fits &= own >= 0 && static_cast<std::size_t>(own) < groups.of_point.size();
      groups.count = std::max(groups.count, own + 1);
    }
    for (std::size_t j = 0; fits && j < graph.segments.size(); ++j) {
      const auto [a, b] = graph.segments[j];
      fits = groups.of_point[static_cast<std::size_t>(a)] == groups.of_point[static_cast<std::size_t>(b)];
    }
    if (!fits) throw std::invalid_argument("the groups do not go with the points and segments");
    return groups;
  }

  GraphArrays arrays_;
  Matrix<const double> seeds_;
  Indices segment_, start_, group_;
  std::unique_ptr<core::sampled_skeleton::SampleDiagram> made_;
};

Columns counts_of(const SampledDiagram& diagram) {
  const auto& counts = (*diagram).counts();
  Columns result;
  result["triangles"] = (*diagram).mesh().size();
  result["shared_label"] = counts.shared;
  result["crossed"] = counts.crossed;
  result["walked_pieces"] = counts.walked;
  return result;
}

auto walked_pieces(const SampledDiagram& diagram) {
  const auto pieces = (*diagram).walked_pieces();
  return to_numpy(std::vector<std::int32_t>(pieces.begin(), pieces.end()));
}

Columns skeleton_of(const SampledDiagram& diagram, const Indices& face_group,
                    const std::optional<std::pair<std::int32_t, Box>>& clipped, bool whole, bool complete,
                    double tolerance, const std::pair<std::int32_t, std::int32_t>& joined, double origin_x,
                    double origin_y, double scale, unsigned threads, const Progress& progress) {
  core::sampled_skeleton::SampledSkeletonOptions options{
      view(face_group), {}, whole, complete, tolerance, {joined.first, joined.second}};
  if (clipped) {
    const auto [least_x, most_x, least_y, most_y] = clipped->second;
    options.clipped = core::skeleton::ClippedGroup{clipped->first, {least_x, most_x, least_y, most_y}};
  }
  for (const Pair& pair : (*diagram).labels().graph().faces) {
    for (const std::int32_t face : pair) {
      if (face < 0 || static_cast<std::size_t>(face) >= face_group.size()) {
        throw std::invalid_argument("a face has no group");
      }
    }
  }
  const std::int32_t unbounded = whole || face_group.size() == 0 ? 0 : view(face_group)[0];
  if (unbounded >= 0 && !(options.clipped && options.clipped->group == unbounded)) {
    throw std::invalid_argument("unbounded edges are in no frame");
  }
  core::sampled_skeleton::SampledSkeleton made = run_interruptible(progress, [&](const Monitor& monitor) {
    return core::sampled_skeleton::extract_sampled_skeleton(*diagram, options, {origin_x, origin_y, scale},
                                                            core::base::resolve_threads(threads), monitor);
  });
  Columns result;
  result["vertices"] = two_columns(std::move(made.arrays.vertices));
  result["radius"] = to_numpy(std::move(made.arrays.radius));
  result["frame_side"] = to_numpy(std::move(made.arrays.side));
  result["arcs"] = two_columns(std::move(made.arrays.arcs));
  result["control"] = two_columns(std::move(made.arrays.control));
  result["sites"] = two_columns(std::move(made.arrays.sites));
  result["group"] = to_numpy(std::move(made.arrays.group));
  result["branch"] = to_numpy(std::move(made.arrays.branch));
  result["length"] = to_numpy(std::move(made.arrays.length));
  result["error_bound"] = to_numpy(std::move(made.error));
  result["seeds"] = two_columns(std::move(made.seeds));
  result["parts"] = to_numpy(std::move(made.parts));
  result["open_corners"] = made.open_corners;
  return result;
}

}  // namespace

void bind_sampled_skeleton(nb::module_& room) {
  nb::exception<core::sampled_skeleton::TooManySeeds>(room, "TooManySeedsError");
  room.attr("LEAST_SAMPLE_GAP") = core::sampled_skeleton::least_gap;
  room.def("sample_by_step", &sample_by_step, "points"_a, "segments"_a, "faces"_a, "step"_a, "most"_a,
           "threads"_a, "progress"_a.none(),
           "Seeds, the segment that each is inside of (-1: a point), and where those of each segment begin.");
  room.def("sample_from_corners", &sample_from_corners, "points"_a, "segments"_a, "faces"_a, "steps"_a,
           "most"_a, "threads"_a, "progress"_a.none());
  room.def(
      "corner_steps", &corner_steps, "points"_a, "segments"_a, "faces"_a, "step"_a, "is_even"_a, "most"_a,
      "Where the distances of each point begin, and how far from it seeds are: at even steps, or doubling "
      "up to one.");
  room.def("refined_steps", &refined_steps, "points"_a, "segments"_a, "faces"_a, "steps"_a, "start"_a,
           "parts"_a, "most"_a, "Distances with each piece of an edge divided into so many parts.");
  nb::class_<SampledDiagram>(room, "SampledDiagram")
      .def(
          "__init__",
          [](SampledDiagram* self, const IndexRows& points, const IndexRows& segments, const IndexRows& faces,
             const Matrix<const double>& seeds, const Indices& segment, const Indices& start,
             const Indices& group, const std::optional<Box>& within, unsigned threads,
             const Progress& progress) {
            new (self) SampledDiagram({points, segments, faces}, seeds, segment, start, group, within,
                                      threads, progress);
          },
          "points"_a, "segments"_a, "faces"_a, "seeds"_a, "segment"_a, "start"_a, "group"_a,
          "within"_a.none(), "threads"_a, "progress"_a.none(),
          "Of each point a group that has a diagram of its own, or none of any; triangles are ordered within "
          "bounds. These are least and most x, then y, on the lattice.")
      .def_prop_ro("counts", &counts_of)
      .def_prop_ro("walked_pieces", &walked_pieces,
                   "Pieces of edges that may meet the cells of other seeds than their ends.")
      .def("skeleton", &skeleton_of, "face_group"_a, "clipped"_a.none(), "whole"_a, "complete"_a,
           "tolerance"_a, "joined"_a, "origin_x"_a, "origin_y"_a, "scale"_a, "threads"_a, "progress"_a.none(),
           "Arrays as of extract_skeleton, with error_bound, seeds and parts, and the number of "
           "open_corners.");
}

}  // namespace vorotool::bindings
