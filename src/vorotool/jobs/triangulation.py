"""The job of ``vorotool delaunay``: triangulations of points, and of label images."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

from vorotool.engines.delaunay.delaunay import delaunay, verify_triangulation
from vorotool.errors import Kind, Message
from vorotool.jobs.checked_columns import check_columns, tell_empty_cells
from vorotool.jobs.inputs import JobInput, note_repeated_labels, read_sites
from vorotool.jobs.options import Options
from vorotool.jobs.pixel_sizes import in_steps, placed_backdrop, placed_mesh, placed_sites
from vorotool.jobs.results import Results
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.jobs.units import in_units, table_in_units, unit_columns
from vorotool.numeric.parallel import Progress
from vorotool.types.mesh.triangulation import AnyTriangulation
from vorotool.types.points.point_set import PointSet
from vorotool.types.points.seed_set import SeedSet

if TYPE_CHECKING:
    from vorotool.render.drawing import Drawing
    from vorotool.render.looks import World
    from vorotool.types.box import Box, Extent
    from vorotool.types.mesh.cells import CellSet
    from vorotool.types.mesh.tables import CellStatistics


class ReadPoints(NamedTuple):
    """What is triangulated, and what its cells are clipped to."""

    points: PointSet | SeedSet
    clip: Sequence[Any] | None = None  # the polygons of `--clip`


def products(run: Run, o: Options, given: JobInput) -> MeshProducts:
    """Read points, or find those of an image, and triangulate them."""
    is_digital = o.triangulated_by != "exact"
    with run.phase("read"):
        properties = bool({"table", "cells", "measures"} & set(o.what)) or o.names_columns
        o, points = read_sites(run, o, given, properties=properties, is_digital=is_digital)
        o, points = placed_sites(run, o, given, points)
    read = ReadPoints(points) if o.clip is None else _clipped(run, o, given, points)
    if not is_digital:
        return MeshProducts(run, o, given, read)
    from vorotool.jobs.digital_triangulation import DigitalProducts, RepairedProducts

    return (RepairedProducts if o.triangulated_by == "digital-valid" else DigitalProducts)(run, o, given, read)


def _clipped(run: Run, o: Options, given: JobInput, points: PointSet | SeedSet) -> ReadPoints:
    """Read the polygons of ``--clip``."""
    from vorotool.jobs.second_files import First, read_cut, unit_of_image, unit_of_vectors
    from vorotool.types.points.seed_set import SeedSet
    from vorotool.types.polygons.shapely_geometry import to_shapely

    if isinstance(points, SeedSet):
        grid = points.grid
        first = First(given.name, points, unit_of_image(o, grid), is_image=True, crs=None if grid is None else grid.crs)
    else:
        first = First(given.name, points, unit_of_vectors(o, points))
    with run.phase("read polygons"):
        points, clip = read_cut(run, o, "--clip", o.clip, first)
    return ReadPoints(points, list(to_shapely(clip)))


class MeshProducts(Results):
    """Results of one triangulation."""

    def __init__(self, run: Run, options: Options, given: JobInput, read: ReadPoints) -> None:
        super().__init__(run, options)
        self.backdrop, self.clip = placed_backdrop(run, options, given.backdrop), read.clip
        points = read.points
        if self.wants_mesh:
            with run.phase("triangulate") as progress:
                self.mesh: Any = placed_mesh(options.pixel_size, self._triangulate(points, progress))
            check_columns(options, self.mesh.properties)
            self._points = points
        self.edged: Any = self._with_graph() if self.wants_mesh else None

    def _with_graph(self) -> Any:
        """What has the edges that are written and drawn: the triangulation, or a graph that is a part of it."""
        o = self.options
        if o.graph == "delaunay":
            return self.mesh
        from vorotool.engines.delaunay.proximity import proximity_graph

        with self.run.phase("graph") as progress:
            return proximity_graph(self.mesh, o.graph, threads=o.threads, progress=progress)

    @property
    def wants_mesh(self) -> bool:
        """Whether a result shows the triangulation itself."""
        return self.options.what != ("compare",)

    def _triangulate(self, points: PointSet | SeedSet, progress: Progress) -> AnyTriangulation:
        o = self.options
        mesh = delaunay(in_steps(o, points), strict=o.strict, threads=o.threads, progress=progress)
        note_repeated_labels(self.run, points, mesh)
        return mesh

    def check(self, target: Target) -> None:
        """Refuse what cannot be written, and say what will be empty, before anything is written."""
        super().check(target)
        if target.fmt == "html":
            from vorotool.render.pages.html import check_cells_size

            check_cells_size(len(self.mesh.points))
        if target.what in ("edges", "triangles") and not len(getattr(self.edged, target.what)):
            self.run.warn(Message(f"the result has no {target.what}: {self._shape()}", Kind.EMPTY_RESULT))

    def _shape(self) -> str:
        count = len(self.mesh.points) - self.mesh.duplicates
        if count < 3:
            return f"{count} distinct point{'s' * (count != 1)}"
        return f"all {count} distinct points lie on a line"

    def value(self, what: str) -> Any:
        """Give the triangulation, its graph, its cells, or measures of these, which are in the units of files."""
        if what in ("statistics", "measures"):
            found = self._statistics_in_units()
            return found.measures if what == "measures" else found.summary
        return self.cells if what == "cells" else self.edged if what == "edges" else self.mesh

    def written(self, what: str, fmt: str) -> Any:
        """Give a result in the units of files: the table tells of cells, too."""
        if what in ("statistics", "measures"):
            return self.value(what)
        if what != "table" or fmt == "node":
            return super().written(what, fmt)
        from vorotool.engines.delaunay.site_table import site_table

        table = site_table(self.mesh, self.cells, threads=self.options.threads)
        return table_in_units(self.options.pixel_size, table, properties=self.mesh.properties)

    def _statistics_in_units(self) -> CellStatistics:
        """Measures of cells, decided in the units of the input, in those of files."""
        from vorotool.engines.delaunay.site_table import statistics_of

        o, has_region = self.options, self.options.frame is not None or self.options.clip is not None
        with self.run.phase("statistics") as progress:
            found = statistics_of(self.mesh, self.cells, has_region=has_region, threads=o.threads, progress=progress)
        if o.pixel_size is None:
            return found
        side = float(o.pixel_size.factor)
        cells = table_in_units(o.pixel_size, found.cells)
        return replace(found, cells=cells, tree_lengths=found.tree_lengths * side, area=found.area * side * side)

    @cached_property
    def cells(self) -> CellSet:
        """The Voronoi cells of the points, clipped."""
        with self.run.phase("cells") as progress:
            made = self._cells_in(self.options.frame, progress, clip=self.clip)
        tell_empty_cells(self.run, made.label_array, made.is_empty)
        return made

    def _cells_in(
        self, frame: Box | Extent | None, progress: Progress, *, clip: Sequence[Any] | None = None
    ) -> CellSet:
        from vorotool.engines.delaunay.cells import voronoi_cells

        return voronoi_cells(
            self.mesh,
            frame=frame,
            clip=clip,
            threads=self.options.threads,
            progress=progress,
        )

    @cached_property
    def world(self) -> World:
        """Where what is drawn lies."""
        from vorotool.jobs.picture_world import world_of_sites

        return world_of_sites(self.run, self.options, self.mesh, self._points)

    def drawing(self, what: str, fmt: str) -> Drawing:
        """Prepare a picture: of the frame of cells, where it has any."""
        from vorotool.render.drawing import drawing_of
        from vorotool.render.layers.mesh import OF_CELLS, mesh_page

        product, wanted, cells, page = self.products[what], self.wanted, None, None
        if set(OF_CELLS) & set(wanted.shown(product.usual_layers)):
            cells, world = self.cells, self.world
            if self.backdrop is None:
                page = mesh_page(self.mesh, width=wanted.width, bounds=cells.frame.sides)
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
        shapes = shapes_of_cells(cells)
        write_cells_html(out, shapes, cell_colors(self.mesh), columns | cells.properties)

    def verify(self, progress: Progress) -> None:
        """Check the triangulation exactly, from its arrays alone; and cells before they are clipped to polygons."""
        from vorotool.engines.delaunay.cells import verify_cells
        from vorotool.engines.delaunay.proximity import verify_proximity_graph

        verify_triangulation(self.mesh, threads=self.options.threads, progress=progress)
        if self.edged is not self.mesh:
            verify_proximity_graph(self.edged)
        if {"cells", "table", "statistics", "measures"} & set(self.options.what):
            cells = self.cells if self.clip is None else self._cells_in(self.cells.frame, progress)
            verify_cells(cells, threads=self.options.threads, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        mesh = self.mesh
        cells: dict[str, Any] = {}
        if "cells" in vars(self):  # a result shows them
            cells = {"frame": self.cells.frame.extent, "empty_cells": int(self.cells.is_empty.sum())}
        return {
            **cells,
            "points": len(mesh.points),
            "duplicates": mesh.duplicates,
            "edges": len(mesh.edges),
            "triangles": len(mesh.triangles),
            "hull": len(mesh.hull),
            "collinear": len(mesh.triangles) == 0,
            **(
                {}
                if self.options.graph == "delaunay"
                else {"graph": self.options.graph, "graph_edges": len(self.edged)}
            ),
            "method": self.options.method,
            "threads": self.options.threads,
        }
