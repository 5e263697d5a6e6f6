"""The table of commands: what each does, reads, and which job it runs."""

from __future__ import annotations

from typing import NamedTuple

from vorotool.products.inputs import Holds


class Command(NamedTuple):
    """A command that reads inputs and writes results."""

    summary: str  # in the list of commands
    job: str  # `module:function` of `function(run, options, given)`, which reads an input and gives its results
    reads: Holds | None  # the geometry that it reads beside images; what is drawn again may be any
    text: str  # what `--help` says; the second paragraph is an example
    jobs: tuple[tuple[str, str], ...] = ()  # those for the value of `--method`, or in `space`
    check: str = ""  # `module:function` of `function(options, targets)`, which refuses what no table says
    instead: tuple[tuple[str, str], ...] = ()  # options that it lacks, and what to do instead


_IMAGES = "(PNG, TIFF, PGM, JPEG, NPY)"
COMMANDS: dict[str, Command] = {
    "tessellate": Command(
        "Digital Voronoi tessellation of points or of an image.",
        "jobs.tessellation:products",
        "points",
        """Label every pixel with its nearest seed, exactly; ties go to the smallest label.

\b
Example:
  vorotool sample dots.csv -o dots.csv
  vorotool tessellate dots.csv --size 512x512 -o labels.png

INPUT is a list of points (CSV, TSV, Triangle .node, NPY, GeoJSON, WKT, JSON) or an image (PNG, TIFF, PGM, JPEG, NPY,
Zarr); - is standard input. Label i is the i-th point; an image's own labels are kept. With --volume it is a volume: a
stack (TIFF, NPY, Zarr), or points with a z.""",
        jobs=(("space", "jobs.volumes:VolumeProducts"),),
        check="jobs.tessellation:check",
        instead=(("--unit", "give --pixel-size, such as 0.325um"),),
    ),
    "delaunay": Command(
        "Exact Delaunay triangulation of points or of an image.",
        "jobs.triangulation:MeshProducts",
        "points",
        f"""Triangulate points exactly: no circle through a triangle's vertices holds another point.

\b
Example:
  vorotool sample dots.csv -o dots.csv
  vorotool delaunay dots.csv -o edges.csv

INPUT is a list of points (CSV, TSV, Triangle .node, NPY, GeoJSON, WKT, JSON) or an image {_IMAGES}, whose components
or labels count as points at their centroids; - is standard input. Label i is the i-th point; labels of the input are
kept. OBJ and files for Triangle (.edge, .ele, .node) number the points instead.

--what statistics summarizes area, perimeter, roundness, neighbors and distances of whole cells.

--what compare lists where the digital rule differs from the exact triangulation, each with its cause.""",
        jobs=(
            ("space", "jobs.triangulation:TetrahedraProducts"),
            ("digital", "jobs.triangulation:DigitalProducts"),
            ("digital-valid", "jobs.triangulation:RepairedProducts"),
        ),
    ),
    "alphashape": Command(
        "Alpha shapes of points, of one radius or of all.",
        "jobs.alpha_shape:ShapeProducts",
        "points",
        f"""Find the alpha shape of points: edges that an empty disc of radius r touches at both ends, and the areas
that they bound.

\b
Example:
  vorotool sample dots.csv -o dots.csv
  vorotool alphashape dots.csv -r 60 -o shape.csv

INPUT is a list of points (CSV, TSV, Triangle .node, NPY, GeoJSON, WKT, JSON) or an image {_IMAGES}, whose components
or labels count as points at their centroids; - is standard input. Label i is the i-th point; labels of the input are
kept.

--what family, spectrum, curves and persistence are about the shapes of all radii. -f html makes a page with a slider
over r.

With --space points have a z: their shape consists of tetrahedra, and --what surface is its closed surface.""",
        jobs=(("space", "jobs.alpha_shape:SpaceShapeProducts"),),
        instead=(
            (
                "--spacing",
                "give it what vorotool tessellate --spacing SX,SY --what table writes, whose x and y are in that unit",
            ),
        ),
    ),
    "voronoi": Command(
        "Exact Voronoi diagram of points, lines and polygons.",
        "jobs.voronoi:VoronoiProducts",
        "sites",
        f"""Divide the plane among points, lines and polygons: each gets the places nearest to it.

\b
Example:
  vorotool sample two-shapes.json -o two-shapes.json
  vorotool voronoi two-shapes.json -o cells.geojson

INPUT holds points, lines and polygons in any mixture (GeoJSON, WKT, CSV, JSON, Triangle .poly, SVG, DXF and files of
maps), or is a mask or a label image {_IMAGES}, whose objects have outlines; - is standard input. Each feature is a
site, each input a diagram of its own. Polygons are filled. Where several sites are equally near to a whole region, the
first has it. Borders are straight lines and parabolas; as GeoJSON, WKT and in files of maps they are lines, the same
in both cells.

--what edges lists the borders, neighbors the pairs of cells that share one, table a row for each cell, discs the
largest empty disc between the sites, with its center in the frame or the clip.""",
    ),
    "skeleton-approx": Command(
        "Skeleton of polygons and lines from samples, with certified errors.",
        "jobs.skeletons.approximate:ApproximateProducts",
        "polygons",
        """Approximate the skeleton of polygons by samples of their edges, with a certified error of each arc.

\b
Example:
  vorotool sample two-shapes.json -o two-shapes.json
  vorotool skeleton-approx two-shapes.json --step 4 -o skeleton.svg

INPUT is as for skeleton-exact. The skeleton is the Voronoi diagram of the samples without the edges between samples of
one edge, and without those that the shapes cross. No point of an arc is farther from the exact skeleton than its
error_bound.""",
    ),
    "skeleton-exact": Command(
        "Exact skeleton (medial axis) of polygons and lines.",
        "jobs.skeletons.exact:ExactProducts",
        "polygons",
        f"""Compute the exact skeleton (medial axis) of polygons: straight lines and parabolas, each with its radius.

\b
Example:
  vorotool sample two-shapes.json -o two-shapes.json
  vorotool skeleton-exact two-shapes.json -o skeleton.svg

INPUT holds polygons or open lines (JSON, GeoJSON, WKT, Triangle .poly, SVG, DXF), or is a mask or a label image
{_IMAGES}, whose objects have outlines; - is standard input. Polygons are placed on a lattice of 31 bits over their
extent; one that crosses, touches or overlaps itself is cut there, with a warning. The skeleton is the Voronoi diagram
of vertices and open edges without the edges between an edge and its own end. What is inside polygons comes first,
polygon by polygon; arcs of a branch follow each other.""",
        instead=(("--offset", "give -d D with --what offset"),),
    ),
    "distance": Command(
        "Distance of two shapes: Hausdorff and smallest distance.",
        "jobs.distances:DistanceProducts",
        "sites",
        f"""Measure the distance of two shapes: the Hausdorff distance, both ways, and the smallest distance.

\b
Example:
  vorotool sample two-shapes.json -o two-shapes.json
  vorotool sample segments.wkt -o segments.wkt
  vorotool distance two-shapes.json segments.wkt

A and B hold points, lines and polygons in any mixture (GeoJSON, WKT, CSV, JSON, Triangle .poly, SVG, DXF and files of
maps), or are masks or label images {_IMAGES}, whose objects have outlines; - is standard input for one of them. Each
file is one shape; polygons are filled. The Hausdorff distance is the largest distance from a point of one shape to the
nearest point of the other, not from vertices only. Each row has both points; GeoJSON and WKT have lines between them,
and pictures show them.""",
    ),
    "draw": Command(
        "Draw label images, skeletons, Voronoi maps and shapes.",
        "jobs.drawing:DrawnInput",
        None,
        """Draw a label image, in which neighboring regions never share a color, a skeleton, a Voronoi map, or shapes.

\b
Example:
  vorotool sample cells.png -o cells.png
  vorotool draw cells.png -o cells.svg

INPUT is a label image (PNG, TIFF, PGM, NPY, Zarr), such as tessellate writes, a skeleton or a Voronoi map (JSON, NPZ),
the JSON of offset curves, or shapes: polygons and lines (GeoJSON, WKT, JSON, Triangle .poly, SVG, DXF), such as
centerlines and alpha shapes; - is standard input.""",
    ),
}
"""Commands by name."""
OTHERS = {
    "info": "Show how a file is read: its format, its content, and the commands that accept it.",
    "sample": "Write a small file to try commands on.",
    "completion": "Print the completion script for bash, zsh or fish.",
}
"""Commands that have a module of their own."""
