// Approximate skeletons: seeds on edges, their Voronoi diagram, and what of it is kept.
#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "bindings/rooms.hpp"
#include "bindings/support/arrays.hpp"
#include "bindings/support/monitor.hpp"
#include "bindings/support/planar_graph.hpp"
#include "bindings/support/skeleton_arrays.hpp"
#include "bindings/support/triangulation.hpp"
#include "core/base/parallel.hpp"
#include "core/sampled_skeleton/boundary_samples.hpp"
#include "core/sampled_skeleton/sample_diagram.hpp"
#include "core/sampled_skeleton/sampled_skeleton.hpp"

namespace vorotool::bindings {
namespace {

using core::base::Monitor;
using core::kernel::Point;

// Seeds, the segment that each is inside of, and where those of each segment begin.
auto to_tuple(core::sampled_skeleton::BoundarySamples&& samples) {
  const std::size_t count = samples.segment.size();
  return std::make_tuple(points_to_numpy(std::move(samples.seeds)),
                         to_numpy(std::move(samples.segment), {count}), to_numpy(std::move(samples.start)));
}

auto sample_by_step(const PlanarGraph& graph, double step, std::size_t most, unsigned threads,
                    const Progress& progress) {
  return to_tuple(run_interruptible(progress, core::sampled_skeleton::sample_by_step, graph.view(), step,
                                    most, core::base::resolve_threads(threads)));
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

auto sample_from_corners(const PlanarGraph& graph, const Steps& steps, std::size_t most, unsigned threads,
                         const Progress& progress) {
  const core::sampled_skeleton::CornerSteps wanted = steps_of(steps, graph.view());
  return to_tuple(run_interruptible(progress, core::sampled_skeleton::sample_from_corners, graph.view(),
                                    wanted, most, core::base::resolve_threads(threads)));
}

auto corner_steps(const PlanarGraph& graph, double step, bool is_even, std::size_t most) {
  return to_tuple(is_even ? core::sampled_skeleton::even_steps(graph.view(), step, most)
                          : core::sampled_skeleton::doubled_steps(graph.view(), step, most));
}

auto refined_steps(const PlanarGraph& graph, const Steps& steps, const Indices& start, const Indices& parts,
                   std::size_t most) {
  const std::size_t segments = graph.view().segments.size();
  if (start.size() != segments + 1 ||
      parts.size() != segments + core::base::at(view(start).back()) - graph.view().points.size()) {
    throw std::invalid_argument("the parts do not go with the pieces");
  }
  return to_tuple(core::sampled_skeleton::refined_steps(graph.view(), steps_of(steps, graph.view()),
                                                        view(start), view(parts), most));
}

// A diagram and what it looks at.
class SampledDiagram {
 public:
  SampledDiagram(const PlanarGraph& input, const Places& seeds, const Indices& segment, const Indices& start,
                 const Indices& group, const std::optional<Box>& within, unsigned threads,
                 const Progress& progress)
      : kept_(keep(input, seeds, segment, start, group)) {
    const core::kernel::PlanarGraphView& graph = input.view();
    check(graph, seeds, segment, start);
    const core::sampled_skeleton::SampleGroups groups = groups_of(graph, group, within);
    made_ = run_interruptible(progress, [&](const Monitor& monitor) {
      return std::make_unique<core::sampled_skeleton::SampleDiagram>(
          graph, rows<Point>(seeds), view(segment), view(start), groups, core::base::resolve_threads(threads),
          monitor);
    });
  }

  const core::sampled_skeleton::SampleDiagram& operator*() const { return *made_; }

 private:
  static void check(const core::kernel::PlanarGraphView& graph, const Places& seeds, const Indices& segment,
                    const Indices& start) {
    static constexpr const char* wrong = "the seeds do not go with the segments";
    const std::span<const std::int32_t> first = view(start);
    if (first.size() != graph.segments.size() + 1 || segment.size() != seeds.shape(0) ||
        core::base::at(first.front()) != graph.points.size() ||
        core::base::at(first.back()) != segment.size() || !std::ranges::is_sorted(first)) {
      throw std::invalid_argument(wrong);
    }
    core::base::check_range(view(segment), -1, graph.segments.size(), wrong);
  }

  static core::sampled_skeleton::SampleGroups groups_of(const core::kernel::PlanarGraphView& graph,
                                                        const Indices& group,
                                                        const std::optional<Box>& within) {
    core::sampled_skeleton::SampleGroups groups{view(group), 1, {}};
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

  std::shared_ptr<const void> kept_;
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

Columns skeleton_of(const SampledDiagram& diagram, const Indices& face_group, const Clipped& clipped,
                    bool whole, bool complete, double tolerance,
                    const std::pair<std::int32_t, std::int32_t>& joined, double origin_x, double origin_y,
                    double scale, unsigned threads, const Progress& progress) {
  const core::sampled_skeleton::SampledSkeletonOptions options{
      view(face_group), clipped_group(clipped), whole, complete, tolerance, {joined.first, joined.second}};
  core::base::check_range((*diagram).labels().graph().faces, 0, face_group.size(), "a face has no group");
  const std::int32_t unbounded = whole || face_group.size() == 0 ? 0 : view(face_group)[0];
  if (unbounded >= 0 && !(options.clipped && options.clipped->group == unbounded)) {
    throw std::invalid_argument("unbounded edges are in no frame");
  }
  core::sampled_skeleton::SampledSkeleton made = run_interruptible(progress, [&](const Monitor& monitor) {
    return core::sampled_skeleton::extract_sampled_skeleton(*diagram, options, {origin_x, origin_y, scale},
                                                            core::base::resolve_threads(threads), monitor);
  });
  Columns result = as_dict(std::move(made.arrays));
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
  room.def("sample_by_step", &sample_by_step, "graph"_a, "step"_a, "most"_a, "threads"_a, "progress"_a.none(),
           "Seeds, the segment that each is inside of (-1: a point), and where those of each segment begin.");
  room.def("sample_from_corners", &sample_from_corners, "graph"_a, "steps"_a, "most"_a, "threads"_a,
           "progress"_a.none());
  room.def(
      "corner_steps", &corner_steps, "graph"_a, "step"_a, "is_even"_a, "most"_a,
      "Where the distances of each point begin, and how far from it seeds are: at even steps, or doubling "
      "up to one.");
  room.def("refined_steps", &refined_steps, "graph"_a, "steps"_a, "start"_a, "parts"_a, "most"_a,
           "Distances with each piece of an edge divided into so many parts.");
  nb::class_<SampledDiagram>(room, "SampledDiagram")
      .def(
          nb::init<const PlanarGraph&, const Places&, const Indices&, const Indices&, const Indices&,
                   const std::optional<Box>&, unsigned, const Progress&>(),
          "graph"_a, "seeds"_a, "segment"_a, "start"_a, "group"_a, "within"_a.none(), "threads"_a,
          "progress"_a.none(),
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
