"""The job of ``vorotool alphashape --space``: alpha shapes of points in space."""

from __future__ import annotations

from functools import cached_property
from math import inf
from typing import TYPE_CHECKING, Any

from vorotool.engines.alpha.alpha_shape import chosen_radius
from vorotool.engines.alpha.space_shape import space_curves, unjoined
from vorotool.jobs.alpha_shape import ShapeProducts, radius_stats, radius_text
from vorotool.jobs.inputs import (
    JobInput,
    check_columns,
    note_repeated_labels,
    read_voxel_points,
    report_no_geometry,
)
from vorotool.jobs.job import Results
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.triangulation import TRIANGULATE
from vorotool.jobs.units import Amount
from vorotool.numeric.parallel import Progress
from vorotool.products.registry import OF_ONE_SHAPE
from vorotool.types.table import Table

if TYPE_CHECKING:
    from vorotool.types.alpha.space import SpaceAlphaComplex, SpaceAlphaShape


class SpaceShapeProducts(Results):
    """Results of the alpha shapes of one list of points in space."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        super().__init__(run, options)
        if not options.measured:  # what is wrong with it is said before a long file is read
            chosen_radius(options.r, options.alpha, options.auto)
        with run.phase("read"):
            points = read_voxel_points(run, options, given, properties=options.names_columns)
            check_columns(options, points.properties)
            if not len(points):
                report_no_geometry(run, options)
        self.radius = chosen_radius(options.r, options.alpha, options.auto)
        mesh: Any = self.call(TRIANGULATE, points, phase="triangulate")
        note_repeated_labels(run, points, mesh)
        self._allow_empty = not len(points)
        how: Any = {"phase": "alpha complex", "allow_empty": self._allow_empty}
        self.family: SpaceAlphaComplex = self.call("engines.alpha.alpha_complex:alpha_complex", mesh, **how)
        self.has_shape = bool(set(options.what) & OF_ONE_SHAPE)
        if self.has_shape and self.radius is None and unjoined(self.family) is None:
            regions = "one region" if options.regions in (None, 1) else f"at most {options.regions} regions"
            r = radius_text(self.shape.r)
            run.note(f"r = {r}, the smallest radius whose shape is {regions} covering every point")

    @cached_property
    def shape(self) -> SpaceAlphaShape:
        """The shape of the radius."""
        how: Any = {"r": self.radius, "regions": self.options.regions or 1, "allow_empty": self._allow_empty}
        made: SpaceAlphaShape = self.call("engines.alpha.alpha_shape:alpha_shape", self.family, phase="shape", **how)
        return made

    @cached_property
    def curves(self) -> Table:
        """Measures of the shapes of all radii."""
        return space_curves(self.family, progress=self.run.progress("curves"))

    def value(self, what: str) -> Any:
        """Give the shape of the radius, or what is of all radii."""
        if what == "curves":
            return self.curves
        return self.shape if what in OF_ONE_SHAPE else self.family

    check_page, write_page = ShapeProducts.check_page, ShapeProducts.write_page

    def emptiness(self, what: str) -> str:
        """Say from which radius on there are parts of a kind."""
        family, name = self.family, "tetrahedra" if what in ("surface", "table") else what
        if what not in OF_ONE_SHAPE or len(getattr(self.shape, name)):
            return ""
        ranks = family.ranks(name)[:, 0]
        if not len(ranks):
            return f"the points span no {name}"
        return f"{name} begin at r = {radius_text(family.radius_from(int(ranks.min())))}"

    def verify(self, progress: Progress) -> None:
        """Check the shape exactly, from its triangulation."""
        from vorotool.engines.alpha.verify_space import verify_space_shape

        shape: SpaceAlphaShape
        if self.has_shape:
            shape = self.shape
        else:
            shape = self.call("engines.alpha.alpha_shape:alpha_shape", self.family, phase=None, r=inf)
        verify_space_shape(shape, threads=self.options.threads, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        mesh, family = self.family.mesh, self.family
        counts: dict[str, Any] = {
            "points": len(mesh.points),
            "duplicates": mesh.duplicates,
            "dimension": mesh.dimension,
            "delaunay_tetrahedra": len(family),
            "delaunay_triangles": len(family.triangle_min),
            "delaunay_edges": len(family.edges),
            "radii": len(family.spectrum),
            "threads": self.options.threads,
        }
        if not self.has_shape:
            return counts
        shape = self.shape
        return {
            **counts,
            **radius_stats(shape),
            "automatic": self.radius is None,
            "tetrahedra": len(shape.tetrahedra),
            "surface": len(shape.surface),
            "singular_triangles": len(shape.singular),
            "singular_edges": len(shape.singular_edges),
            "isolated_points": len(shape.isolated),
            "volume": Amount(shape.volume, 3),
            "area": Amount(shape.area, 2),
            "regions": shape.region_count,
            "parts": shape.part_count,
            "cavities": shape.cavity_count,
            "tunnels": shape.tunnel_count,
        }
