"""Options of the commands: one frozen value a job, made once from what the command line gives.

A field is called as its option is, and ``--help`` says what it means; one that is None was not given.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal

from vorotool.jobs.given import Options
from vorotool.jobs.picture_style import Looks, Paper

if TYPE_CHECKING:
    from vorotool.engines.centerlines.centerline import Ends
    from vorotool.engines.tessellation.seeding import SeedMode
    from vorotool.jobs.picture_style import Scale
    from vorotool.jobs.pruning_choice import Pruning
    from vorotool.jobs.units import PixelSize
    from vorotool.types.box import Extent

Place = tuple[float, float]
ALL_PAGES = -1
"""Of ``--page all``: each page is an input of a batch."""
AUTO_LEVELS = -1
"""Of ``--levels auto``: until a copy is small."""

Method = Literal["exact", "digital", "digital-valid"]


class JobOptions(Options):
    """What each command has: outputs, pictures, many inputs, and what is said."""

    inputs: tuple[str, ...]
    input_format: str | None
    input_layer: str | None
    page: int | None
    what: tuple[str, ...]
    output: str | None
    format: str | None
    out_dir: str | None
    no_clobber: bool
    overwrite: bool
    stats: str | None
    layers: tuple[str, ...] | None
    overlay: str | None
    width: int | None
    y_up: bool | None
    background: str | None
    colors: tuple[tuple[str, str], ...]
    line_widths: tuple[tuple[str, float], ...]
    label_by: str | None
    legend: bool
    scale_bar: bool
    max_pixels: int
    threads: int
    quiet: bool
    verbose: bool
    files_from: str | None
    null: bool
    jobs: int | None
    keep_going: bool
    dry_run: bool
    resume: bool
    shard: tuple[int, int] | None
    follow: bool
    cluster: str | None

    @property
    def unit(self) -> PixelSize | None:
        """The side of a pixel, of what has lengths."""
        return None

    @property
    def table_of_all(self) -> str | None:
        """The file of the tables of all inputs, of what has tables."""
        return None

    @property
    def table_of_inputs(self) -> str | None:
        """The file with a row an input, of what has tables."""
        return None

    @property
    def names_of_fields(self) -> str | None:
        """What the names of inputs tell, of what has tables."""
        return None

    @property
    def looks(self) -> Looks:
        """The looks of pictures."""
        paper = self.paper
        return Looks(
            paper.scale,
            paper.unit,
            self.background,
            self.colors,
            self.line_widths,
            self.label_by,
            self.legend,
            self.scale_bar,
            paper.aspect,
            paper.extent,
        )

    @property
    def paper(self) -> Paper:
        """The page of pictures, where these are of lines and areas."""
        return Paper()

    def drawn(self, usual: Sequence[str]) -> tuple[str, ...]:
        """Give the layers of a picture that has usual ones: a column of names is shown in any case."""
        chosen = tuple(self.layers or usual)
        return chosen if self.label_by is None or "labels" in chosen else (*chosen, "labels")

    @property
    def is_shared(self) -> bool:
        """Whether there are options of many inputs that mean something for one, too."""
        tables = self.table_of_all, self.table_of_inputs, self.names_of_fields
        return any((self.null, self.dry_run, self.resume, self.shard, *tables))

    def files_of_inputs(self) -> dict[str, str]:
        """Give the files that are read beside each input, by the names of the options."""
        return {"overlay": self.overlay} if self.overlay else {}

    def files_read(self) -> dict[str, str]:
        """Give the files that are read beside the inputs, and so are never replaced, as the user names them."""
        files = {f"--{name}": path for name, path in self.files_of_inputs().items()}
        return {"--files-from": self.files_from, **files} if self.files_from else files


class ReadingOptions(Options):
    """Of ``info``, which writes no file."""

    inputs: tuple[str, ...]
    json: bool = False
    input_format: str | None = None
    input_crs: str | None = None
    columns: str | None = None
    page: int | None = None
    follow: bool = False
    max_pixels: int = 2**31
    threads: int = 0


class DrawingOptions(JobOptions):
    """Of ``draw``, which has one result."""

    scale: Scale | None
    drawing_unit: str | None
    aspect: float | None
    extent: Literal["image", "data"] | None
    frame: Extent | None
    pixel_size: PixelSize | None
    what: tuple[str, ...] = ("picture",)

    @property
    def paper(self) -> Paper:
        """The page of pictures."""
        return Paper(self.scale, self.drawing_unit, self.aspect, self.extent)


class ComputingOptions(JobOptions):
    """What each command has that computes something of points, polygons or an image."""

    input_crs: str | None
    crs: str | None
    connectivity: Literal["8", "4", "26", "6"] | None
    threshold: float | Literal["otsu"] | None
    invert: bool
    min_area: Fraction | None
    fill_holes: bool | Fraction
    strict: bool
    verify: bool
    decimals: int | None
    precision: int | None
    pixel_size: PixelSize | None
    table: str | None
    table_inputs: str | None
    fields: str | None
    no_properties: bool
    with_columns: tuple[str, ...] | None
    safe_csv: bool
    max_sites: int

    @property
    def unit(self) -> PixelSize | None:
        """The side of a pixel, or its sides."""
        return self.pixel_size

    @property
    def table_of_all(self) -> str | None:
        """The file of the tables of all inputs."""
        return self.table

    @property
    def table_of_inputs(self) -> str | None:
        """The file with a row an input."""
        return self.table_inputs

    @property
    def names_of_fields(self) -> str | None:
        """What the names of inputs tell."""
        return self.fields

    @property
    def names_columns(self) -> bool:
        """Whether options name columns of the input."""
        return self.label_by is not None or self.with_columns is not None

    @property
    def cleans_masks(self) -> str:
        """The option that changes a mask; empty where there is none."""
        return "--fill-holes" if self.fill_holes else "--min-area" if self.min_area is not None else ""


class SiteOptions(ComputingOptions):
    """What each command has whose sites are points, or the seeds of an image."""

    columns: str | None
    seeds: SeedMode | None
    size: Any
    window: Any

    @property
    def cell_side(self) -> Fraction | None:
        """The side of the cells of a map, where the frame is in its units."""
        return None

    def for_images(self) -> dict[str, Any]:
        """Give the options that mean nothing for a list of points, by their names."""
        return {
            "page": self.page,
            "seeds": self.seeds,
            "connectivity": self.connectivity,
            "threshold": self.threshold,
            "invert": self.invert,
            "min-area": self.min_area,
            "fill-holes": self.fill_holes,
        }

    def of_frame(self) -> dict[str, Any]:
        """Give the options of the frame that lists of points are tessellated in, by their names."""
        return {"size": self.size, "window": self.window}


class TessellationOptions(SiteOptions):
    """Of ``tessellate``."""

    spacing: PixelSize | None
    method: Literal["exact", "propagation"]
    passes: Literal[1, 2] | None
    max_distance: Fraction | None
    dtype: Literal["uint8", "uint16", "uint32", "int32"] | None
    chunk: Any
    volume: bool
    slice: int | None
    levels: int | None
    cell_size: Fraction | None
    like: str | None
    tiled: bool
    animate: bool
    frames: int | None
    fps: float | None

    @property
    def cell_side(self) -> Fraction | None:
        """The side of the cells of a map, where the frame is in its units."""
        return self.cell_size

    @property
    def is_laid_out(self) -> bool:
        """Whether pixels are laid over points, lines and polygons: cells, or the pixels of a raster."""
        return self.cell_size is not None or self.like is not None

    def of_frame(self) -> dict[str, Any]:
        """Give the options of the frame, and of its pixels."""
        return {"cell-size": self.cell_size, "like": self.like} | SiteOptions.of_frame(self)

    def files_of_inputs(self) -> dict[str, str]:
        """Give the files that are read beside each input, by the names of the options."""
        return ({"like": self.like} if self.like else {}) | SiteOptions.files_of_inputs(self)

    @property
    def is_of_volumes(self) -> bool:
        """Whether the input has three axes: it says so itself, or its frame or its columns do."""
        has_z = self.columns is not None and any(part.strip()[:2].lower() == "z=" for part in self.columns.split(","))
        return self.volume or has_z or len(self.size or ()) == 3 or len(self.window or ()) == 6

    @property
    def draws_diagram(self) -> bool:
        """Whether the diagram as PNG is a picture, not a mask."""
        return bool(self.layers or self.overlay or self.looks.given())


class TriangulationOptions(SiteOptions):
    """Of ``delaunay``."""

    spacing: PixelSize | None
    scale: Scale | None
    drawing_unit: str | None
    aspect: float | None
    extent: Literal["image", "data"] | None
    method: Method
    graph: Literal["delaunay", "gabriel", "relative", "mst"]
    frame: Extent | None
    clip: str | None

    @property
    def paper(self) -> Paper:
        """The page of pictures."""
        return Paper(self.scale, self.drawing_unit, self.aspect, self.extent)

    @property
    def triangulated_by(self) -> Method:
        """What the method comes to: it is the digital rule that is compared with the exact triangulation."""
        return "digital" if "compare" in self.what else self.method

    def files_of_inputs(self) -> dict[str, str]:
        """Give the files that are read beside each input, by the names of the options."""
        return ({"clip": self.clip} if self.clip else {}) | JobOptions.files_of_inputs(self)


class AlphaShapeOptions(SiteOptions):
    """Of ``alphashape``."""

    scale: Scale | None
    drawing_unit: str | None
    aspect: float | None
    extent: Literal["image", "data"] | None
    frame: Extent | None
    method: Method
    r: Fraction | float | None
    alpha: Fraction | None
    auto: bool
    regions: int | None
    rule: Literal["corrected", "printed"]
    hole_threshold: Fraction | None
    region_threshold: Fraction | None
    animate: bool
    frames: int | None
    fps: float | None

    @property
    def paper(self) -> Paper:
        """The page of pictures."""
        return Paper(self.scale, self.drawing_unit, self.aspect, self.extent)


class ShapeOptions(ComputingOptions):
    """What each command has that takes shapes, or the outlines of an image."""

    spacing: PixelSize | None
    frame: Extent | None
    flatten: float | None
    join_tolerance: float | None
    simplify: float | None
    outline: Literal["crack", "contour"] | None
    seeds: Literal["components", "labels"] | None
    scale: Scale | None
    drawing_unit: str | None
    aspect: float | None
    extent: Literal["image", "data"] | None

    @property
    def paper(self) -> Paper:
        """The page of pictures."""
        return Paper(self.scale, self.drawing_unit, self.aspect, self.extent)

    def for_images(self) -> dict[str, Any]:
        """Give the options that mean nothing for polygons and lines, by their names."""
        return {
            "spacing": self.spacing,
            "page": self.page,
            "seeds": self.seeds,
            "connectivity": self.connectivity,
            "threshold": self.threshold,
            "invert": self.invert,
            "min-area": self.min_area,
            "fill-holes": self.fill_holes,
            "outline": self.outline,
        }


class VoronoiOptions(ShapeOptions):
    """Of ``voronoi``."""

    columns: str | None
    by: str | None
    clip: str | None
    max_distance: float | None
    enclosures: str | None
    count: int | None

    def files_of_inputs(self) -> dict[str, str]:
        """Give the files that are read beside each input, by the names of the options."""
        given = {"clip": self.clip, "enclosures": self.enclosures}
        return {name: path for name, path in given.items() if path} | JobOptions.files_of_inputs(self)


class DistanceOptions(ComputingOptions):
    """Of ``distance``, which compares the input with one other, and makes no batches."""

    other: str
    boundary: bool
    columns: str | None
    out_dir: str | None = None
    overlay: str | None = None
    files_from: str | None = None
    null: bool = False
    jobs: int | None = None
    keep_going: bool = False
    dry_run: bool = False
    resume: bool = False
    shard: tuple[int, int] | None = None
    follow: bool = False
    cluster: str | None = None
    connectivity: Literal["8", "4", "26", "6"] | None = None
    threshold: float | Literal["otsu"] | None = None
    invert: bool = False
    min_area: Fraction | None = None
    fill_holes: bool | Fraction = False
    pixel_size: PixelSize | None = None
    table: str | None = None
    table_inputs: str | None = None
    fields: str | None = None
    no_properties: bool = True
    with_columns: tuple[str, ...] | None = None
    safe_csv: bool = False
    scale: Scale | None
    drawing_unit: str | None
    aspect: float | None
    extent: Literal["image", "data"] | None
    frame: Extent | None

    @property
    def paper(self) -> Paper:
        """The page of pictures."""
        return Paper(self.scale, self.drawing_unit, self.aspect, self.extent)

    def files_read(self) -> dict[str, str]:
        """Give the file that is read beside the first input."""
        return {"B": self.other}


class SkeletonOptions(ShapeOptions):
    """What the commands have that make skeletons."""

    side: Literal["interior", "exterior", "both"]
    features: Literal["separate", "together"]
    complete: bool | None
    prune: Pruning | None
    join_junctions: bool
    start: Place | None
    end: Place | None
    ends: Ends | None
    every: float | None
    along: Literal["branches", "centerline"] | None
    smooth: float | None

    @property
    def wants_skeleton(self) -> bool:
        """Whether a result shows anything of the skeleton: offset curves are of the whole diagram."""
        return set(self.what) != {"offset"}


class ExactSkeletonOptions(SkeletonOptions):
    """Of ``skeleton-exact``."""

    gap: float
    distance: tuple[float, ...] | None
    count: int | None
    local: bool
    animate: bool
    frames: int | None
    fps: float | None
    neck: float | None
    border: Literal["closed", "open"] | None

    @property
    def has_open_border(self) -> bool:
        """Whether objects go on beyond the image that cuts them."""
        return self.border == "open"

    def for_images(self) -> dict[str, Any]:
        """Give the options that mean nothing for polygons and lines, by their names."""
        return ShapeOptions.for_images(self) | {"border": self.border}


class ApproximateSkeletonOptions(SkeletonOptions):
    """Of ``skeleton-approx``."""

    step: float | None
    tolerance: float | None
    sampling: Literal["paper", "symmetric"] | None
    compare: bool
