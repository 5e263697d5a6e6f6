"""The job of ``vorotool delaunay``: triangulations of points, in space, too, and of images, exact or digital."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, BinaryIO

from vorotool.errors import Message
from vorotool.jobs.inputs import (
    JobInput,
    check_columns,
    frame_of,
    read_sites,
    read_space,
    tell_empty_cells,
    triangulated,
    window_of,
)
from vorotool.jobs.job import Results
from vorotool.jobs.options import Options
from vorotool.jobs.pixel_sizes import placed_backdrop, placed_mesh, unit_of_vectors
from vorotool.jobs.run_log import Run
from vorotool.jobs.units import Amount, box_amounts, in_units, refuse_lengths, sides_of, table_in_units, unit_columns
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.products.registry import is_of

if TYPE_CHECKING:
    from vorotool.render.drawing import Drawing, World
    from vorotool.types.mesh.cells import CellSet
    from vorotool.types.mesh.tables import CellStatistics
    from vorotool.types.mesh.tetrahedralization import SpaceCellSet
    from vorotool.types.mesh.triangulation import DigitalComparison
    from vorotool.types.points.seed_set import SeedSet

VERIFY = "engines.delaunay.delaunay:verify_triangulation"


def seeds_of(run: Run, o: Options, points: Any) -> SeedSet:
    """Give the seeds of an image, or points in their frame."""
    if is_of(points, "SeedSet"):
        return points
    place, frame = "engines.tessellation.seeding:seeds_in_frame", partial(frame_of, o)
    return run.call(o, place, points, frame, phase=None, sides=sides_of(o))


def digital_mesh(run: Run, o: Options, points: Any, seeds: SeedSet) -> tuple[Any, Any]:
    """Triangulate by the digital rule, or by its certified repair, which is told of as well."""
    where: dict[str, Any] = {"window": window_of(o, seeds), "spacing": sides_of(o).units}
    mesh: Any
    repair: Any = None
    if o.triangulated_by == "digital":
        mesh = run.call(o, "engines.digital.triangulation:digital_triangulation", seeds, phase="triangulate", **where)
    else:
        mesh, repair = run.call(o, "engines.digital.triangulation:repair_digital", seeds, phase="triangulate", **where)
    if is_of(points, "PointSet"):
        numbers = {} if repair is None else {"first_number": points.first_number}
        mesh = replace(mesh, y_axis=points.y_axis, crs=points.crs, **numbers)
    return mesh, repair


class MeshProducts(Results):
    """Results of one triangulation."""

    mesh: Any = None
    edged: Any = None

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        with run.phase("read"):
            properties = bool({"table", "cells", "measures"} & set(options.what)) or options.names_columns
            is_digital = options.triangulated_by != "exact"
            o, points = read_sites(run, options, given, properties=properties, is_digital=is_digital)
        super().__init__(run, o)
        self.clip: Sequence[Any] | None = None
        if o.clip is not None:
            points, self.clip = self._clipped(given, points)
        self._points = points
        self.wants_mesh = o.what != ("compare",)  # a result shows the triangulation itself
        if given.backdrop is not None:
            self.backdrop = placed_backdrop(run, o, given.backdrop)
        if not self.wants_mesh:
            return
        self.mesh = self._triangulate()
        if o.pixel_size is not None:
            self.mesh = placed_mesh(o.pixel_size, self.mesh)
        if o.names_columns:
            check_columns(o, self.mesh.properties)
        self.edged = self.mesh  # or a graph that is a part of it: what has the edges that are written and drawn
        if o.graph != "delaunay":
            self.edged = self.call("engines.delaunay.proximity:proximity_graph", self.mesh, o.graph, phase="graph")

    def _clipped(self, given: JobInput, points: Any) -> tuple[Any, Sequence[Any]]:
        """Read the polygons of ``--clip``."""
        from vorotool.jobs.second_files import First, read_cut, unit_of_image
        from vorotool.types.polygons.shapely_geometry import to_shapely

        o = self.options
        if is_of(points, "SeedSet"):
            crs = None if points.grid is None else points.grid.crs
            first = First(given.name, points, unit_of_image(o, points.grid), is_image=True, crs=crs)
        else:
            first = First(given.name, points, unit_of_vectors(o, points))
        with self.run.phase("read polygons"):
            points, clip = read_cut(self.run, o, "--clip", o.clip, first)
        return points, list(to_shapely(clip))

    def _triangulate(self) -> Any:
        size = self.options.pixel_size
        points: Any = self._points
        sides = None if size is None else size.sides
        if is_of(points, "PointSet") and (sides is None or set(sides.units) == {1} == {sides.step}):
            points = replace(points, xy=points.xy + 0.0)  # there is no -0
        else:  # sites of an image, or points whose distances are in steps of `--spacing`
            sides = sides_of(self.options)
            points = resolved("types.scaling:stretched")(resolved("convert.points:as_points")(points), sides.x, sides.y)
        return triangulated(self.run, self.options, points)

    def check_page(self) -> None:
        """Refuse a page of too many cells."""
        resolved("render.pages.html:check_cells_size")(len(self.mesh.points))

    def emptiness(self, what: str) -> str:
        """Say why there are no edges or triangles."""
        return "" if what not in ("edges", "triangles") or len(getattr(self.edged, what)) else self._shape()

    def _shape(self) -> str:
        count = len(self.mesh.points) - self.mesh.duplicates
        if count < 3:
            return f"{count} distinct point{'s' * (count != 1)}"
        return f"all {count} distinct points lie on a line"

    def value(self, what: str) -> Any:
        """Give the triangulation, its graph, its cells, or measures of these, which are in the units of files."""
        if what in ("statistics", "measures"):
            found = self._statistics_in_units
            return found.measures if what == "measures" else found.summary
        return self.cells if what == "cells" else self.edged if what == "edges" else self.mesh

    def written(self, what: str, fmt: str) -> Any:
        """Give a result in the units of files: the table tells of cells, too."""
        if what in ("statistics", "measures"):
            return self.value(what)
        if what != "table" or fmt == "node":
            return super().written(what, fmt)
        table: Any = self.call("engines.delaunay.proximity:site_table", self.mesh, self.cells, phase=None)
        return table_in_units(self.options.pixel_size, table, properties=self.mesh.properties)

    @cached_property
    def _statistics_in_units(self) -> CellStatistics:
        """Measures of cells, decided in the units of the input, in those of files."""
        o, function = self.options, "engines.delaunay.proximity:statistics_of"
        has_region = o.frame is not None or o.clip is not None
        cells = self.cells
        found: CellStatistics = self.call(function, self.mesh, cells, phase="statistics", has_region=has_region)
        if o.pixel_size is None:
            return found
        side = float(o.pixel_size.factor)
        measured = table_in_units(o.pixel_size, found.cells)
        return replace(found, cells=measured, tree_lengths=found.tree_lengths * side, area=found.area * side * side)

    @cached_property
    def cells(self) -> CellSet:
        """The Voronoi cells of the points, clipped."""
        made = self._cells_in(self.options.frame, phase="cells", clip=self.clip)
        tell_empty_cells(self.run, made.label_array, made.is_empty)
        return made

    def _cells_in(self, frame: Any, *, phase: str | None = None, **more: Any) -> CellSet:
        return self.call("engines.delaunay.cells:voronoi_cells", self.mesh, phase=phase, frame=frame, **more)

    @cached_property
    def world(self) -> World:
        """Where what is drawn lies."""
        from vorotool.jobs.picture_world import world_of_sites

        return world_of_sites(self.run, self.options, self.mesh, self._points)

    def drawing(self, what: str, fmt: str) -> Drawing:
        """Prepare a picture: of the frame of cells, where it has any."""
        from vorotool.render.canvas.layers import page_of
        from vorotool.render.drawing import drawing_of
        from vorotool.render.layers.mesh import OF_CELLS

        product, wanted, cells, page = self.products[what], self.wanted, None, None
        if set(OF_CELLS) & set(wanted.shown(product.usual_layers)):
            cells, world = self.cells, self.world
            if self.backdrop is None:
                page = page_of(self.mesh, width=wanted.width, bounds=cells.frame.sides)
            if cells.frame.sides != world.frame or self.options.frame is not None:
                wanted = wanted._replace(world=world._replace(frame=None))
        return drawing_of(self.edged, product, wanted, fmt, page=page, cells=cells)

    def write_page(self, out: BinaryIO) -> None:
        """Write a page that shows the cells."""
        from vorotool.engines.delaunay.cells import cell_colors
        from vorotool.render.pages.html import shapes_of_cells, write_cells_html

        cells = in_units(self.options.pixel_size, self.cells)
        x, y = cells.sites.T
        measures = {"area": cells.areas, "perimeter": cells.perimeters, "x": x, "y": y}
        columns: dict[str, Any] = {name: values.tolist() for name, values in measures.items()}
        columns |= unit_columns(self.options.pixel_size, len(cells))
        write_cells_html(out, shapes_of_cells(cells), cell_colors(self.mesh), columns | cells.properties)

    def verify(self, progress: Progress) -> None:
        """Check the triangulation exactly, from its arrays alone; and cells before they are clipped to polygons."""
        self.call(VERIFY, self.mesh, phase=None, progress=progress)
        if self.edged is not self.mesh:
            self.call("engines.delaunay.proximity:verify_proximity_graph", self.edged, phase=None)
        if {"cells", "table", "statistics", "measures"} & set(self.options.what):
            cells = self.cells if self.clip is None else self._cells_in(self.cells.frame, progress=progress)
            self.call("engines.delaunay.cells:verify_cells", cells, phase=None, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        mesh, o = self.mesh, self.options
        found: dict[str, Any] = {}
        if "cells" in vars(self):  # a result shows them
            found = {"frame": box_amounts(self.cells.frame.extent), "empty_cells": int(self.cells.is_empty.sum())}
        found |= {"points": len(mesh.points), "duplicates": mesh.duplicates}
        found |= {name: len(getattr(mesh, name)) for name in ("edges", "triangles", "hull")}
        found["collinear"] = len(mesh.triangles) == 0
        if o.graph != "delaunay":
            found |= {"graph": o.graph, "graph_edges": len(self.edged)}
        return {**found, "method": o.method, "threads": o.threads}


# ---- digital triangulations ----------------------------------------------------------------------
class DigitalProducts(MeshProducts):
    """Results of the paper's rule (``--method digital``), and of its comparison with the exact triangulation."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        super().__init__(run, options, given)
        if "compare" in options.what:
            with run.phase("compare"):
                run.note(self.comparison.summary())
            if self.comparison.suggestion:
                run.note(self.comparison.suggestion)

    @cached_property
    def seeds(self) -> SeedSet:
        """The seeds whose regions touch."""
        return seeds_of(self.run, self.options, self._points)

    def _triangulate(self) -> Any:
        mesh, self.repair = digital_mesh(self.run, self.options, self._points, self.seeds)
        return mesh

    @cached_property
    def comparison(self) -> DigitalComparison:
        """Differences from the exact triangulation."""
        window = window_of(self.options, self.seeds)  # the command refuses a spacing
        return self.call(
            "engines.digital.comparison:compare_digital", self.seeds, phase=None, window=window, strict=False
        )

    def value(self, what: str) -> Any:
        """Give what the digital rule finds, or how it differs."""
        return self.comparison.differences if what == "compare" else super().value(what)

    def _shape(self) -> str:
        return f"of {len(self.mesh.points)} regions too few touch"

    def verify(self, progress: Progress) -> None:
        """Check labels, edges and triangles by another way."""
        where: dict[str, Any] = {"window": window_of(self.options, self.seeds), "spacing": sides_of(self.options).units}
        function = "engines.digital.triangulation:digital_triangulation"
        found: Any = self.call(function, self.seeds, phase=None, progress=progress, **where)
        function = "engines.digital.triangulation:verify_digital_triangulation"
        self.call(function, found, self.seeds, phase=None, **where)

    def stats(self) -> dict[str, Any]:
        """Counts, and how good they are."""
        counts: dict[str, Any] = {"points": len(self.seeds.sites) if self.seeds.sites is not None else 0}
        if self.wants_mesh:
            mesh = self.mesh
            counts |= {"edges": len(mesh.edges), "triangles": len(mesh.triangles)}
            counts |= {name: getattr(mesh, name) for name in ("three_label_corners", "four_label_corners")}
        if "compare" in self.options.what:
            found = self.comparison
            names = ("edge_precision", "edge_recall", "triangle_precision", "triangle_recall")
            counts["compare"] = {name: getattr(found, name) for name in names} | {
                "differences": found.counts,
                "suggestion": Message.of(found.suggestion).typed,
            }
        return {**counts, "method": "digital", "threads": self.options.threads}


class RepairedProducts(DigitalProducts):
    """Results of the certified repair (``--method digital-valid``): those of the exact triangulation."""

    _shape, verify = MeshProducts._shape, MeshProducts.verify

    def stats(self) -> dict[str, Any]:
        """Counts, and what each step of the repair did."""
        return {**MeshProducts.stats(self), "repair": asdict(self.repair)}


# ---- points in space -----------------------------------------------------------------------------
_SHAPES = {-1: "there are no points", 0: "there is one place", 1: "all points lie on a line", 2: "all lie in a plane"}


class TetrahedraProducts(Results):
    """Results of one triangulation in space."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        super().__init__(run, options)
        refuse_lengths(options, "points in space have none: give numbers in their coordinates")
        points = read_space(run, options, given, properties=bool({"table", "cells"} & set(options.what)))
        self.mesh = triangulated(run, options, points)

    def value(self, what: str) -> Any:
        """Give the triangulation, or its cells."""
        return self.cells if what == "cells" else self.mesh

    @cached_property
    def cells(self) -> SpaceCellSet:
        """The Voronoi cells of the points, clipped to a box."""
        place, frame = "engines.delaunay.cells:voronoi_cells", self.options.frame
        made: SpaceCellSet = self.call(place, self.mesh, phase="cells", frame=frame)
        tell_empty_cells(self.run, made.label_array, made.is_empty)
        return made

    def check_page(self) -> None:
        """Refuse a page of too many edges."""
        resolved("render.pages.html:check_space_size")(self.mesh)

    def write_page(self, out: BinaryIO) -> None:
        """Write a page that shows the hull and the edges."""
        resolved("render.pages.html:write_space_html")(out, self.mesh)

    def emptiness(self, what: str) -> str:
        """Say why there are no parts of a kind."""
        return "" if what in ("table", "cells") or len(getattr(self.mesh, what)) else _SHAPES[self.mesh.dimension]

    def verify(self, progress: Progress) -> None:
        """Check the triangulation exactly, from its arrays alone, and cells."""
        self.call(VERIFY, self.mesh, phase=None, progress=progress)
        if "cells" in self.options.what:
            self.call("engines.delaunay.cells:verify_cells", self.cells, phase=None, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Counts, and the box of cells."""
        mesh = self.mesh
        counts = {"points": len(mesh.points), "duplicates": mesh.duplicates, "dimension": mesh.dimension}
        counts |= {"tetrahedra": len(mesh)} | {
            name: len(getattr(mesh, name)) for name in ("triangles", "edges", "hull")
        }
        if "cells" in vars(self):  # a result shows them
            low, high = self.cells.box.tolist()
            counts |= {
                "low": list(map(Amount, low)),
                "high": list(map(Amount, high)),
                "empty_cells": int(self.cells.is_empty.sum()),
            }
            counts |= {"faces": len(self.cells.face_cells), "vertices": len(self.cells.vertices)}
        return counts | {"threads": self.options.threads}
