"""Types of the compiled core (private)."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

class SeedTooFarError(ValueError):
    args: tuple[int]

class Tessellation:
    def __init__(
        self,
        x: NDArray[Any],
        y: NDArray[Any],
        labels: NDArray[Any],
        frame_x: int,
        frame_y: int,
        width: int,
        height: int,
        steps: int,
        simd: str,
    ) -> None: ...
    @property
    def duplicates(self) -> int: ...
    @property
    def columns(self) -> int: ...
    @property
    def is_wide(self) -> bool: ...
    @property
    def products_exact(self) -> bool: ...
    def labels(
        self,
        out: NDArray[Any],
        first: int,
        most_squared: tuple[int, int] | None,
        threads: int,
        progress: Callable[[float], object] | None,
    ) -> None: ...
    def squared_distances(
        self, out: NDArray[Any], first: int, threads: int, progress: Callable[[float], object] | None
    ) -> None: ...
    def distances(
        self, out: NDArray[Any], first: int, threads: int, progress: Callable[[float], object] | None
    ) -> None: ...

def propagate(
    x: NDArray[Any],
    y: NDArray[Any],
    labels: NDArray[Any],
    passes: int,
    out: NDArray[Any],
    progress: Callable[[float], object] | None,
) -> None: ...
def stream_fill(out: NDArray[Any], threads: int) -> None: ...
def widest_simd() -> str: ...

_Progress = Callable[[float], object] | None

# regions: labels are C-contiguous uint8, uint16 or uint32
def measure_regions(labels: NDArray[Any], threads: int, progress: _Progress) -> dict[str, NDArray[Any]]: ...
def label_components(
    mask: NDArray[np.uint8], corners: bool, out: NDArray[np.uint32], progress: _Progress
) -> int: ...  # mask: zeros and ones

class StreamingComponents:
    def __init__(self, width: int, corners: bool) -> None: ...
    @property
    def size(self) -> int: ...
    def add(self, mask: NDArray[np.uint8], out: NDArray[np.uint32], progress: _Progress) -> None: ...
    def settle(self, out: NDArray[np.uint32]) -> int: ...

def number_band(
    mask: NDArray[np.uint8],
    corners: bool,
    above: NDArray[np.uint32],
    fresh: NDArray[np.uint32],
    out: NDArray[np.uint32],
    progress: _Progress,
) -> None: ...
def max_by_label(
    labels: NDArray[Any],
    values: NDArray[Any],
    wanted: NDArray[np.uint32],
    threads: int,
    progress: _Progress,
) -> NDArray[np.uint64]: ...
def mark_diagram(
    labels: NDArray[Any],
    above: NDArray[Any] | None,
    below: NDArray[Any] | None,
    out: NDArray[np.uint8],
    threads: int,
    progress: _Progress,
) -> None: ...
def verify_tessellation(
    labels: NDArray[Any],
    x: int,
    y: int,
    seed_x: NDArray[np.int64],
    seed_y: NDArray[np.int64],
    seed_labels: NDArray[np.uint32],
    scale: int,
    limit_high: int | None,
    limit_low: int,
    threads: int,
    progress: _Progress,
) -> tuple[int, int, int, int, int]: ...
def nearest_other_sites(
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    labels: NDArray[np.uint32],
    threads: int,
    progress: _Progress,
) -> tuple[NDArray[np.int64], NDArray[np.float64]]: ...
def colour_graph(
    vertices: int, a: NDArray[np.uint32], b: NDArray[np.uint32], progress: _Progress
) -> NDArray[np.uint32]: ...

# ---- text (bind_text.cpp): a delimiter is one of "," ";" "\t" " " ---------------------------------------------

class TextError(ValueError):
    """Args: kind (not_number, not_finite, field_count, open_quote), line, column, text, found, expected."""

    args: tuple[str, int, int, str, int, int]

def parse_numbers(
    text: bytes,
    delimiter: str,
    columns: list[int],
    header_records: int = 0,
    fields: int = 0,
    threads: int = 0,
) -> NDArray[np.float64]: ...
def parse_fields(
    text: bytes,
    delimiter: str,
    columns: list[int],
    header_records: int = 0,
    fields: int = 0,
    threads: int = 0,
) -> list[list[str]]: ...
def count_rows(text: bytes, delimiter: str, header_records: int = 0, threads: int = 0) -> int: ...
def line_of_row(text: bytes, delimiter: str, header_records: int, row: int) -> int: ...
def first_record(text: bytes, delimiter: str) -> tuple[int, str, list[str]] | None: ...
def find_too_deep(text: bytes, limit: int) -> int | None: ...
def unpack_lzw(data: bytes, limit: int) -> NDArray[np.uint8]: ...
def unpack_packbits(data: bytes, limit: int) -> NDArray[np.uint8]: ...
def format_rows(
    values: list[Any],
    missing: list[NDArray[np.bool_] | None],
    precision: int = 0,
    threads: int = 0,
    shape: tuple[tuple[str, ...], str, str] | None = None,
) -> list[bytes]: ...

class NumberTexts:
    def __init__(self, values: NDArray[np.float64], precision: int = 0, threads: int = 0) -> None: ...
    def __len__(self) -> int: ...

class PolygonTexts:
    """A column of polygons: each row from its first polygon to that of the next; style wkt, geojson or json."""

    def __init__(
        self,
        vertices: NDArray[np.float64],
        rings: NDArray[np.int64],
        polygons: NDArray[np.int64],
        rows: NDArray[np.int64],
        style: str,
    ) -> None: ...
    def __len__(self) -> int: ...

# ---- predicates (bind_predicates.cpp): a level is "auto", "filter", "seen" (the filter of the triangulation),
# ---- "integers", "expansions" or "wide"; the sign is 2 where a level other than "auto" and "wide" cannot tell. The
# ---- points must be finite. ---------------------------------------------------------------------------------------

def orient2d(points: NDArray[np.float64], level: str = "auto") -> NDArray[np.int8]: ...
def incircle(points: NDArray[np.float64], level: str = "auto") -> NDArray[np.int8]: ...

# ---- Delaunay triangulation (bind_delaunay.cpp): points are C-contiguous and finite, indices int32 -----------------

class DelaunayTriangulation:
    def __init__(self, points: NDArray[np.float64], threads: int, progress: _Progress) -> None: ...
    @property
    def first(self) -> NDArray[np.int32]: ...
    @property
    def hull(self) -> NDArray[np.int32]: ...
    def arrays(
        self, threads: int, progress: _Progress
    ) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
        """Triangles, their neighbours, and edges."""

def insert_points(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    neighbours: NDArray[np.int32],
    edges: NDArray[np.int32],
    hull: NDArray[np.int32],
    first: NDArray[np.int32],
    hints: NDArray[np.int32],
    threads: int,
    progress: _Progress,
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]] | None:
    """Triangles, neighbours, edges, hull, first; None where the order of the triangles that stay would change."""

def triangulation_fault(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    neighbours: NDArray[np.int32],
    edges: NDArray[np.int32],
    hull: NDArray[np.int32],
    first: NDArray[np.int32],
    threads: int,
    progress: _Progress,
) -> str | None: ...

# ---- alpha shapes (bind_alpha.cpp): a side is a triangle or -1; ranks are places in the spectrum ------------------

def edges_of_triangles(
    triangles: NDArray[np.int32], neighbours: NDArray[np.int32], threads: int, progress: _Progress
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Edges, and the triangles on their sides."""

def alpha_complex(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    edges: NDArray[np.int32],
    sides: NDArray[np.int32],
    printed: bool,
    threads: int,
    progress: _Progress,
) -> dict[str, NDArray[Any]]: ...
def shape_edges(
    rank_min: NDArray[np.int32],
    rank_mid: NDArray[np.int32],
    rank_max: NDArray[np.int32],
    reached: int,
    entered: int,
    threads: int,
    progress: _Progress,
) -> tuple[NDArray[np.int32], NDArray[np.uint8]]: ...
def connected_triangles(
    inside: NDArray[np.uint8], sides: NDArray[np.int32], progress: _Progress
) -> NDArray[np.int32]: ...
def trace_rings(
    points: NDArray[np.float64],
    a: NDArray[np.int32],
    b: NDArray[np.int32],
    region: NDArray[np.int32],
    progress: _Progress,
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32], NDArray[np.uint8]]:
    """Vertices of all rings, where each begins, its region, and whether it is a hole."""

def alpha_curves(
    spectrum: int,
    triangle_rank: NDArray[np.int32],
    rank_min: NDArray[np.int32],
    rank_mid: NDArray[np.int32],
    rank_max: NDArray[np.int32],
    sides: NDArray[np.int32],
    area: NDArray[np.float64],
    length: NDArray[np.float64],
    progress: _Progress,
) -> dict[str, NDArray[Any]]: ...

# rows of six: three points, the first two and the first again for an edge
def critical_radii(supports: NDArray[np.float64]) -> NDArray[np.float64]: ...
def compare_radii(p: NDArray[np.float64], q: NDArray[np.float64]) -> NDArray[np.int8]: ...

# ---- digital triangulation (bind_digital.cpp): rows are C-contiguous uint8, uint16 or uint32 labels ----------------

class DigitalTriangulationScan:
    def __init__(self) -> None: ...
    def add_rows(self, rows: NDArray[Any], threads: int, progress: _Progress) -> None: ...
    def finish(self) -> dict[str, Any]: ...

def digital_mesh(
    points: NDArray[np.float64],
    x: NDArray[np.int64],
    y: NDArray[np.int64],
    scale: int,
    image: NDArray[np.uint32],
    frame_x: int,
    frame_y: int,
    threads: int,
    progress: _Progress,
) -> tuple[DelaunayTriangulation, dict[str, Any]]: ...
def inserted_mesh(points: NDArray[np.float64], threads: int, progress: _Progress) -> DelaunayTriangulation: ...

# ---- Voronoi cells (bind_cells.cpp): a frame is left, bottom, right, top --------------------------------------------

def voronoi_cells(
    points: NDArray[np.float64],
    triangles: NDArray[np.int32],
    neighbours: NDArray[np.int32],
    hull: NDArray[np.int32],
    first: NDArray[np.int32],
    frame: tuple[float, float, float, float],
    threads: int,
    progress: _Progress,
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices of the cells' rings, and where the ring of each point begins."""

def cell_fault(
    sites: NDArray[np.float64],
    vertices: NDArray[np.float64],
    starts: NDArray[np.int64],
    frame: tuple[float, float, float, float],
    threads: int,
    progress: _Progress,
) -> str | None: ...
def measure_cells(
    sites: NDArray[np.float64],
    vertices: NDArray[np.float64],
    rings: NDArray[np.int64],
    cell_rings: NDArray[np.int64],
    frame: tuple[float, float, float, float],
    threads: int,
    progress: _Progress,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.uint8]]:
    """Area, perimeter, distance of the farthest vertex from the site, whether a vertex is on the frame."""

def nearest_neighbours(
    points: NDArray[np.float64], edges: NDArray[np.int32], labels: NDArray[np.int64], progress: _Progress
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Index of the nearest point of each, -1 without any, and its number of neighbours."""

# ---- outlines (bind_outlines.cpp): labels are C-contiguous uint8, uint16 or uint32 -----------------------------------

def count_crack_vertices(labels: NDArray[Any], threads: int, progress: _Progress) -> int: ...
def trace_cracks(labels: NDArray[Any], rule: str, threads: int, progress: _Progress) -> dict[str, NDArray[Any]]: ...

# ---- skeletons (bind_skeleton.cpp): the first six arguments are the arrays of a segment Voronoi diagram -------------

def skeleton_edges(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    vertices: NDArray[np.float64],
    radius: NDArray[np.float64],
    edges: NDArray[np.int32],
    edge_sites: NDArray[np.int32],
    segment_faces: NDArray[np.int32],
    threads: int,
    progress: _Progress,
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Edges that are not deleted, and the face that each lies in."""

def extract_skeleton(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    vertices: NDArray[np.float64],
    radius: NDArray[np.float64],
    edges: NDArray[np.int32],
    edge_sites: NDArray[np.int32],
    kept: NDArray[np.int32],
    groups: NDArray[np.int32],
    clipped: tuple[int, tuple[float, float, float, float]] | None,
    joined: tuple[int, int],
    origin_x: float,
    origin_y: float,
    scale: float,
    threads: int,
    progress: _Progress,
) -> dict[str, NDArray[Any]]:
    """Frames are (least x, most x, least y, most y) on the lattice; joined are groups from one to before another."""

def offset_curves(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    vertices: NDArray[np.float64],
    radius: NDArray[np.float64],
    edges: NDArray[np.int32],
    edge_sites: NDArray[np.int32],
    vertex_start: NDArray[np.int32],
    vertex_sites: NDArray[np.int32],
    edge_face: NDArray[np.int32],
    segment_faces: NDArray[np.int32],
    face_polygon: NDArray[np.int32],
    site_polygon: NDArray[np.int32],
    site_feature: NDArray[np.int32],
    distances: list[float],
    origin_x: float,
    origin_y: float,
    scale: float,
    progress: _Progress,
) -> list[dict[str, NDArray[Any]]]:
    """For each distance (> 0 outwards) the arrays of core/offsets/offset_curves.hpp by their names there."""

# ---- pruning (bind_pruning.cpp): a skeleton is its vertices, radii, arcs, control points, sites, lengths, the ends of
# ---- sites as (s, 4), which nodes are anchored (uint8), and whether sites are closed; criteria are numbered ----------

_SkeletonArrays = tuple[
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.int32],
    NDArray[np.float64],
    NDArray[np.int32],
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.uint8],
    bool,
]

def critical_values(
    skeleton: _SkeletonArrays, criterion: int, progress: _Progress
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int32], NDArray[np.float64]]:
    """Values at the ends of arcs and the largest of each; arcs on which a place is kept, and where.

    Of the angle: the tangent of half of it.
    """

def prune_skeleton(
    skeleton: _SkeletonArrays, criterion: int, threshold: float, group: NDArray[np.int32], progress: _Progress
) -> dict[str, NDArray[Any]]: ...
def arc_profiles(
    skeleton: _SkeletonArrays,
) -> tuple[NDArray[np.int8], NDArray[np.float64], NDArray[np.float64]]:
    """Kinds (between lines, between points, parabola), x at the ends, and h or the tangent of half the angle."""

def part_geometry(
    skeleton: _SkeletonArrays, arc: NDArray[np.int32], first: NDArray[np.float64], last: NDArray[np.float64]
) -> dict[str, NDArray[np.float64]]:
    """Places and radii of both ends, control points and lengths of parts of arcs."""

# ---- paths (bind_paths.cpp): arcs are pairs of nodes ----------------------------------------------------------------

def longest_paths(
    arcs: NDArray[np.int32],
    length: NDArray[np.float64],
    group: NDArray[np.int32],
    groups: int,
    nodes: int,
    tie: float,
    progress: _Progress,
) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int32]]:
    """Where the arcs of each group's path begin, the arcs, and the node that each leads to."""

def path_from(
    arcs: NDArray[np.int32], length: NDArray[np.float64], nodes: int, first: int, last: int, progress: _Progress
) -> tuple[NDArray[np.int32], NDArray[np.int32]] | None:
    """Arcs of the shortest path, and the node that each leads to; with last -1 to the farthest leaf."""

# ---- planar graphs (bind_planar_graph.cpp): arrays are C-contiguous; lattice points are int32 rows ------------------

class TooManyCrossingsError(ValueError): ...
class TooManyOverlapsError(ValueError): ...

def place_on_lattice(
    points: NDArray[np.float64], threads: int, progress: _Progress
) -> tuple[NDArray[np.int32], tuple[float, float], int, float]:
    """Lattice points, origin, exponent of the step and the largest move; the points must be finite."""

def first_at_place(points: NDArray[np.int32], progress: _Progress) -> NDArray[np.int32]:
    """For each lattice point the smallest index of one at the same place."""

def make_planar_graph(
    vertices: NDArray[np.int32],
    ring_start: NDArray[np.int64],
    ring_kind: NDArray[np.int8],
    ring_polygon: NDArray[np.int32],
    progress: _Progress,
) -> dict[str, Any]:
    """Arrays of a PlanarGraph; ``repairs``: of each kind the count, an edge, what meets it or -1; ``is_repaired``."""

def disjoint_sheets(boxes: NDArray[np.int64], progress: _Progress) -> NDArray[np.int32]:
    """Of boxes with the columns least x, least y, most x, most y."""

def boundary_rings(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    segment_faces: NDArray[np.int32],
    face_start: NDArray[np.int32],
    face_polygon: NDArray[np.int32],
    progress: _Progress,
) -> dict[str, NDArray[Any]]:
    """Arrays of core/arrangement/boundary_rings.hpp by their names there; the indices must be in range."""

def planar_graph_fault(
    points: NDArray[np.int32], segments: NDArray[np.int32], faces: NDArray[np.int32] | None, progress: _Progress
) -> str | None: ...

# ---- exact signs of segment Voronoi diagrams (bind_exact_signs.cpp), for tests: a site is a row x, y, x, y of int32,
# ---- a disc three sites in counter-clockwise order of contact; the sign is 2 where they have no disc ----------------

def segment_clearance_signs(sites: NDArray[np.int32]) -> NDArray[np.int8]:
    """(k, 4, 4): a disc, and the query."""

def segment_same_disc(sites: NDArray[np.int32]) -> NDArray[np.int8]:
    """(k, 6, 4): two discs."""

def segment_edge_clearance_signs(sites: NDArray[np.int32]) -> NDArray[np.int8]:
    """(k, 9, 4): the edge's two sites, two discs, and the query."""

def segment_discs(sites: NDArray[np.int32]) -> NDArray[np.float64]:
    """(k, 3) x, y and radius of (k, 3, 4) discs; NaN where there is none."""

# ---- decisions of the engine about a few sites (bind_insertion_predicates.cpp), for tests: sites as above --------

def segment_conflicts(sites: NDArray[np.int32]) -> NDArray[np.int8]:
    """(k, 2) of (k, 4, 4), a disc and a segment: in conflict; told by doubles, integers, double-double, exactly."""

def segment_coincidences(sites: NDArray[np.int32]) -> NDArray[np.int8]:
    """(k, 6, 4): two discs that share two sites."""

# ---- the check of segment Voronoi diagrams (bind_segment_verification.cpp): arrays as in SegmentVoronoiDiagram ----

def segment_voronoi_fault(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    vertices: NDArray[np.float64],
    radius: NDArray[np.float64],
    vertex_start: NDArray[np.int32],
    vertex_sites: NDArray[np.int32],
    edges: NDArray[np.int32],
    edge_sites: NDArray[np.int32],
    threads: int,
    progress: _Progress,
) -> str | None: ...

# ---- segment Voronoi diagrams (bind_segment_voronoi.cpp): arrays of int32, C-contiguous, two columns -----------------

def unwanted_sides(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    segment_faces: NDArray[np.int32],
    is_wanted: NDArray[np.uint8],
) -> NDArray[np.uint8]: ...

class SegmentVoronoi:
    def __init__(
        self,
        points: NDArray[np.int32],
        segments: NDArray[np.int32],
        threads: int,
        progress: _Progress,
        within: tuple[int, int, int, int] | None = None,
    ) -> None: ...
    @property
    def counts(self) -> dict[str, int]: ...
    def take_arrays(
        self, unwanted: NDArray[np.uint8] | None, threads: int, progress: _Progress
    ) -> tuple[
        NDArray[np.float64],
        NDArray[np.float64],
        NDArray[np.int32],
        NDArray[np.int32],
        NDArray[np.int32],
        NDArray[np.int32],
    ]:
        """Vertices, radii, where the sites of each begin, these, edges, and the sites beside them: once."""

# ---- distances from sites (bind_skeleton.cpp) --------------------------------------------------------------------

def clearances(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    places: NDArray[np.float64],
    reach: NDArray[np.float64],
    threads: int,
    progress: _Progress,
) -> NDArray[np.float64]:
    """Of the nearest site within reach; infinite where there is none."""

# ---- approximate skeletons (bind_sampled_skeleton.cpp): the first three arguments are the arrays of a planar graph ---

class TooManySeedsError(Exception): ...

LEAST_SAMPLE_GAP: float

_Samples = tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32]]
_Steps = tuple[NDArray[np.uint64], NDArray[np.float64]]

def sample_by_step(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    faces: NDArray[np.int32],
    step: float,
    most: int,
    threads: int,
    progress: _Progress,
) -> _Samples:
    """Seeds, the segment that each is inside of (-1: a point), and where those of each segment begin."""

def corner_steps(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    faces: NDArray[np.int32],
    step: float,
    is_even: bool,
    most: int,
) -> _Steps:
    """Where the distances of each point begin, and how far from it seeds are: at even steps, or doubling up to one."""

def sample_from_corners(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    faces: NDArray[np.int32],
    steps: _Steps,
    most: int,
    threads: int,
    progress: _Progress,
) -> _Samples: ...
def refined_steps(
    points: NDArray[np.int32],
    segments: NDArray[np.int32],
    faces: NDArray[np.int32],
    steps: _Steps,
    start: NDArray[np.int32],
    parts: NDArray[np.int32],
    most: int,
) -> _Steps:
    """Distances with each piece of an edge divided into so many parts."""

class SampledDiagram:
    def __init__(
        self,
        points: NDArray[np.int32],
        segments: NDArray[np.int32],
        faces: NDArray[np.int32],
        seeds: NDArray[np.float64],
        segment: NDArray[np.int32],
        start: NDArray[np.int32],
        group: NDArray[np.int32],
        within: tuple[float, float, float, float] | None,
        threads: int,
        progress: _Progress,
    ) -> None:
        """Of each point a group that has a diagram of its own, or none of any; triangles are ordered within bounds.

        These are least and most x, then y, on the lattice.
        """
    @property
    def counts(self) -> dict[str, int]: ...
    @property
    def walked_pieces(self) -> NDArray[np.int32]:
        """Pieces of edges that may meet the cells of other seeds than their ends."""
    def skeleton(
        self,
        face_group: NDArray[np.int32],
        clipped: tuple[int, tuple[float, float, float, float]] | None,
        whole: bool,
        complete: bool,
        tolerance: float,
        joined: tuple[int, int],
        origin_x: float,
        origin_y: float,
        scale: float,
        threads: int,
        progress: _Progress,
    ) -> dict[str, Any]:
        """Arrays as of extract_skeleton, with error_bound, seeds and parts, and the number of open_corners."""
