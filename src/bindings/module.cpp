// The extension module vorotool._core, a submodule a room of the core: conversions only; the algorithms are
// in src/core.
#include "bindings/rooms.hpp"

namespace {

struct Room {
  const char* name;
  void (*bind)(nanobind::module_&);
  const char* doc;
};

using namespace vorotool::bindings;
constexpr Room rooms[] = {
    {"alpha", bind_alpha,
     "Alpha complexes, shapes and curves: a side is a triangle or -1, ranks are places in the spectrum."},
    {"arrangement", bind_arrangement, "Placement on the lattice, planar graphs, and their check."},
    {"cells", bind_cells,
     "Voronoi cells, and what is computed of them: a frame is left, bottom, right, top."},
    {"cells_in_space", bind_cells_in_space,
     "Voronoi cells of points in space: a box is low x, y, z, high x, y, z."},
    {"compression", bind_compression, "Compressed bytes of TIFF files."},
    {"delaunay", bind_delaunay, "Delaunay triangulations, and their check: points are finite."},
    {"digital", bind_digital, "The digital triangulation, to the letter and repaired."},
    {"distances", bind_distances,
     "The largest and the smallest distances between points, segments and polygons."},
    {"graphs", bind_graphs, "Paths in graphs of arcs, which are pairs of nodes, and colors of graphs."},
    {"kernel", bind_kernel, "Planar graphs; the exact predicates, and each of their levels alone."},
    {"label_images", bind_label_images,
     "Measures, diagrams, outlines and connected components of label images and masks."},
    {"offsets", bind_offsets, "Offset curves, from segment Voronoi diagrams."},
    {"proximity", bind_proximity, "Gabriel graphs, relative neighborhood graphs and minimum spanning trees."},
    {"pruning", bind_pruning, "Critical values of skeletons, and what is left for a threshold."},
    {"sampled_skeleton", bind_sampled_skeleton,
     "Approximate skeletons, from the Voronoi diagram of seeds on the edges of a planar graph."},
    {"segment_voronoi", bind_segment_voronoi, "Segment Voronoi diagrams, and their check."},
    {"skeleton", bind_skeleton, "From segment Voronoi diagrams to skeletons."},
    {"spatial", bind_spatial, "What is nearest, and which boxes are disjoint."},
    {"tessellation", bind_tessellation, "The tessellation of frames, and its check."},
    {"tetrahedra", bind_tetrahedra, "Delaunay triangulations of space, and their exact predicates."},
    {"tetrahedral_alpha", bind_tetrahedral_alpha,
     "Alpha complexes of points in space: ranks are places in the spectrum."},
    {"text", bind_text,
     "Numbers, fields and polygons as text, read and written: a delimiter is one of , ; tab and blank."},
    {"thickness", bind_thickness, "The largest disc inside an outline that covers each pixel."},
    {"voronoi", bind_voronoi, "Borders between sites, which are points, lines and polygons."},
    {"volumes", bind_volumes, "The tessellation of volumes."},
};

}  // namespace

NB_MODULE(_core, module) {
  module.doc() = "Compiled core of vorotool (private: use the functions of the package).";
  for (const Room& room : rooms) {
    nanobind::module_ made = module.def_submodule(room.name, room.doc);
    room.bind(made);
  }
}
