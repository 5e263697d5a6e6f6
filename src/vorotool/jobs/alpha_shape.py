"""What the shapes of points can be written as (``--what``)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from decimal import Decimal, localcontext
from fractions import Fraction
from functools import cached_property, partial
from math import inf
from typing import TYPE_CHECKING, Any, BinaryIO

from vorotool.engines.alpha.alpha_shape import (
    alpha_complex,
    alpha_curves,
    alpha_edges,
    alpha_shape,
    chosen_radius,
)
from vorotool.engines.alpha.few_points import unjoined
from vorotool.engines.alpha.persistence import persistence
from vorotool.errors import warn
from vorotool.jobs.animations import check_size, layer_pixels, parts_of_whole, write_frames
from vorotool.jobs.checked_columns import check_columns
from vorotool.jobs.inputs import JobInput, frame_of, note_repeated_labels, read_sites, window_of
from vorotool.jobs.names import OF_ONE_SHAPE, PLOTS
from vorotool.jobs.options import Options
from vorotool.jobs.picture_style import styled_page
from vorotool.jobs.picture_world import world_of_sites
from vorotool.jobs.pictures import write_layers
from vorotool.jobs.pixel_sizes import placed_backdrop, placed_mesh, placed_sites
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.jobs.units import in_units, length_in_units, measured, table_in_units
from vorotool.numeric.numbers import nearest_double
from vorotool.numeric.progress import Progress
from vorotool.products.formats import ANIMATIONS, PICTURES, picture_format
from vorotool.products.registry import PRODUCTS
from vorotool.products.writing import write_product
from vorotool.types.alpha.complex import AlphaComplex, Radius
from vorotool.types.alpha.persistence import RegionPersistence
from vorotool.types.alpha.shape import AlphaShape
from vorotool.types.points.point_set import PointSet
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.table import Table

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.render.canvas.layers import Layer, Page
    from vorotool.types.alpha.hull import AlphaHull
    from vorotool.types.mesh.digital_triangulation import AnyTriangulation


def products(run: Run, o: Options, given: JobInput) -> ShapeProducts:
    """Read points, or find those of an image, and what their shapes of all radii are made of."""
    if not measured(o):  # what is wrong with it is said before a long file is read
        chosen_radius(o.r, o.alpha, o.auto)
    with run.phase("read"):
        o, points = read_sites(
            run, o, given, properties="points" in o.what or o.names_columns, is_digital=o.method != "exact"
        )
        o, points = placed_sites(run, o, given, points)
    return ShapeProducts(run, o, given, points, chosen_radius(o.r, o.alpha, o.auto))


class ShapeProducts:
    """Results of the alpha shapes of one list of points."""

    def __init__(
        self,
        run: Run,
        options: Options,
        given: JobInput,
        points: PointSet | SeedSet,
        radius: Radius | None,
    ) -> None:
        self.run, self.options, self.radius = run, options, radius
        self._has_told_regions = False
        self.backdrop = placed_backdrop(run, options, given.backdrop)
        is_allowed = isinstance(points, SeedSet) or not len(points)
        self._empty: dict[str, Any] = {"strict": options.strict, "allow_empty": is_allowed}
        with run.phase("triangulate") as progress:
            mesh = self._triangulation(points, progress)
            mesh = mesh if isinstance(mesh, SeedSet) else placed_mesh(options.pixel_size, mesh)
        with run.phase("alpha complex") as progress:
            self.family = alpha_complex(
                mesh, rule=options.rule, **self._empty, threads=options.threads, progress=progress
            )
        check_columns(options, self.family.mesh.properties)
        self._world = world_of_sites(run, options, self.family.mesh, points)
        self.has_shape = bool(set(options.what) & OF_ONE_SHAPE)
        if self.has_shape:
            with run.phase("shape") as progress:
                self.shape = self._shape(progress)
            if radius is None and not self.is_unjoined:
                regions = "one region" if options.regions in (None, 1) else f"at most {options.regions} regions"
                run.note(f"r = {radius_text(self.shape.r)}, the smallest whose shape is {regions} with every point")

    def _triangulation(self, points: PointSet | SeedSet, progress: Progress) -> AnyTriangulation | SeedSet:
        if isinstance(points, SeedSet) and points.is_empty_image:
            return points
        from vorotool.engines.delaunay.delaunay import delaunay
        from vorotool.engines.digital.triangulation import digital_triangulation, repair_digital
        from vorotool.engines.tessellation.seeding import seeds_in_frame

        o = self.options
        if o.method == "exact" or not len(points):
            exact = delaunay(points, strict=o.strict, threads=o.threads, progress=progress)
            note_repeated_labels(self.run, points, exact)
            return exact
        seeds = points if isinstance(points, SeedSet) else seeds_in_frame(points, partial(frame_of, o), strict=o.strict)
        frame: Any = {"window": window_of(o, seeds), "spacing": 1, "strict": o.strict, "threads": o.threads}
        mesh: AnyTriangulation
        if o.method == "digital":
            mesh = digital_triangulation(seeds, **frame, progress=progress)
        else:
            mesh, _ = repair_digital(seeds, **frame, max_pixels=o.max_pixels, progress=progress)
        return replace(mesh, y_axis=points.y_axis, crs=points.crs) if isinstance(points, PointSet) else mesh

    def _shape(self, progress: Progress) -> AlphaShape:
        o = self.options
        if o.method == "digital":
            assert self.radius is not None  # the command refuses the automatic one
            return self._edges_only(self.radius)
        return alpha_shape(
            self.family,
            r=self.radius,
            regions=o.regions or 1,
            hole_threshold=o.hole_threshold,
            region_threshold=o.region_threshold,
            **self._empty,
            threads=o.threads,
            progress=progress,
        )

    @cached_property
    def is_unjoined(self) -> bool:
        """Whether the radius was to be found, but none gives a region that holds every point."""
        return self.radius is None and unjoined(self.family) is not None

    def _edges_only(self, r: Radius) -> AlphaShape:
        """The shape of triangles that need not fit together: each is a region of its own, and nothing is traced."""
        import numpy as np

        index, kind = alpha_edges(self.family, r, threads=self.options.threads)
        reached = self.family.triangle_rank < self.family.reached(r)
        region = np.where(reached, np.cumsum(reached, dtype=np.int32) - np.int32(1), np.int32(-1))
        nothing = PolygonSet(np.empty((0, 2)), np.zeros(1, np.int64), np.empty(0, np.int8), np.empty(0, np.int32))
        return AlphaShape(self.family, r, index, kind, region, nothing, 0)

    @cached_property
    def curves(self) -> Table:
        """Area, perimeter, regions, cavities and edges of all radii."""
        return alpha_curves(self.family, progress=self.run.progress("curves"))

    @cached_property
    def hull(self) -> AlphaHull:
        """The hull of the shape's radius."""
        from vorotool.engines.alpha.alpha_hull import alpha_hull

        return alpha_hull(self.shape)

    @cached_property
    def persistence(self) -> RegionPersistence:
        """When regions come and go as the radius grows."""
        return persistence(self.family, progress=self.run.progress("persistence"))

    @property
    def written(self) -> AlphaShape:
        """The shape in the units of files."""
        return in_units(self.options.pixel_size, self.shape)

    @property
    def written_family(self) -> AlphaComplex:
        """The family in the units of files."""
        return in_units(self.options.pixel_size, self.family)

    @property
    def written_curves(self) -> Table:
        """The curves in the units of files."""
        return table_in_units(self.options.pixel_size, self.curves)

    @property
    def written_persistence(self) -> Table:
        """Births and deaths of regions in the units of files."""
        return table_in_units(self.options.pixel_size, self.persistence.table())

    def check(self, target: Target) -> None:
        """Refuse what cannot be written, and say what will be empty, before anything is written."""
        if target.what == "persistence" and not self._has_told_regions:
            self._has_told_regions = True
            self.run.note(self._standing_regions())
        if picture_format(target.fmt) == "png":
            from vorotool.render.canvas.png import check_picture_size

            check_picture_size(self.page, self.options.max_pixels)
        if target.fmt in ANIMATIONS:
            check_size(self.options, (self.page.height, self.page.width))
        if target.fmt == "html":
            from vorotool.render.pages.alpha_html import check_html_size

            check_html_size(self.family)
        empty = {
            "edges": lambda: not len(self.shape.edge_index),
            "polygons": lambda: not len(self.shape.polygons),
            "table": lambda: not len(self.shape.polygons),
            "hull": lambda: not len(self.hull),
        }.get(target.what)
        if empty is not None and len(self.family.spectrum) and not self.is_unjoined and empty():
            words = {"table": "regions", "hull": "arcs in the hull"}.get(target.what, target.what)
            warn(f"there are no {words} at r = {radius_text(self.shape.r)}: {self._beginning(target.what, words)}")

    def _beginning(self, what: str, words: str) -> str:
        """Words for the radius at which there is something: regions begin with a triangle, shapes with an edge."""
        family = self.family
        if what in ("polygons", "table") and len(family.triangle_rank):
            return f"{words} begin at r = {radius_text(family.radius_from(int(family.triangle_rank.min())))}"
        return f"shapes begin at r = {radius_text(float(family.spectrum[0]))}"

    def _standing_regions(self) -> str:
        found = self.persistence
        if found.suggested < 2:
            return "1 region stands out" if found.suggested else "there are no regions"
        until = radius_text(length_in_units(self.options.pixel_size, found.apart_until))
        return f"{found.suggested} regions stand out, apart below r = {until}"

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Write one result."""
        from vorotool.formats.io.atomic_output import open_output

        o = self.options
        with open_output(target.path, binary=target.is_binary, no_clobber=o.no_clobber, inputs=inputs) as out:
            if target.fmt == "html":
                self._write_html(out)
            elif target.fmt in PICTURES and target.what in PLOTS:
                self._write_plot(out, target.what)
            elif target.fmt in PICTURES:
                write_layers(out, self._layers(target, self.shape), self.page, fmt=target.fmt, threads=o.threads)
            elif target.fmt in ANIMATIONS:
                self._write_animation(out, target)
            else:
                value = self._value(target.what)
                product = PRODUCTS["alphashape"][target.what]
                write_product(
                    out, value, product, target.fmt, precision=o.precision, threads=o.threads, path=target.path
                )

    def _value(self, what: str) -> Any:
        """What a result is written from, in the units of files."""
        if what == "curves":
            return self.written_curves
        if what == "persistence":
            return self.written_persistence
        if what == "hull":
            return in_units(self.options.pixel_size, self.hull)
        return self.written if what in OF_ONE_SHAPE else self.written_family

    def _write_plot(self, out: BinaryIO, what: str) -> None:
        width = self.options.width or 1000
        if what == "persistence":
            from vorotool.render.pages.persistence_plot import write_persistence_svg

            write_persistence_svg(out, self.written_persistence, self.persistence.suggested, width=width)
            return
        from vorotool.render.pages.alpha_plot import write_curves_svg

        write_curves_svg(out, self.written_curves, width=width)

    def _write_html(self, out: BinaryIO) -> None:
        from vorotool.render.pages.alpha_html import write_alpha_html

        r = self.shape.r if self.has_shape else self.radius
        r = None if r is None else length_in_units(self.options.pixel_size, r)
        write_alpha_html(out, self.written_family, self.written_curves, r=r)

    @cached_property
    def page(self) -> Page:
        """Where pictures show what."""
        from vorotool.render.canvas.layers import ImagePage
        from vorotool.render.layers.mesh import mesh_page

        if self.backdrop is not None:
            return styled_page(ImagePage(self.backdrop), self.options.looks, self._world)
        page = mesh_page(self.family.mesh, width=self.options.width or 1000)
        return styled_page(page, self.options.looks, self._world)

    def _layers(self, target: Target, shape: AlphaShape) -> list[Layer]:
        """Layers of the picture of a result, of the shape or of one of another radius."""
        from vorotool.render.layers.alpha import alpha_layers

        chosen = self.options.drawn(PRODUCTS["alphashape"][target.what].usual_layers)
        hull = None
        if "hull" in chosen:
            from vorotool.engines.alpha.alpha_hull import alpha_hull

            hull = self.hull if shape is self.shape else alpha_hull(shape)
        return alpha_layers(shape, self.page, chosen, hull=hull)

    def _write_animation(self, out: BinaryIO, target: Target) -> None:
        """Shapes whose radius grows to that of the shape, or to the largest critical one if that is infinite."""
        finite = self.family.spectrum[self.family.spectrum < inf]
        largest = float(finite[-1]) if len(finite) else 1.0
        r = Fraction(self.shape.r) if self.shape.r < inf else Fraction(largest)

        def draw(part: Fraction) -> NDArray[np.uint8]:
            shape = alpha_shape(self.family, r=r * part, threads=self.options.threads, **self._empty)
            return layer_pixels(self._layers(target, shape), self.page)

        write_frames(out, self.run, self.options, target.fmt, parts_of_whole(self.options), draw)

    def verify(self, progress: Progress) -> None:
        """Check the shape exactly, from its triangulation."""
        from vorotool.engines.alpha.verify_alpha import verify_alpha_shape

        shape = self.shape if self.has_shape else alpha_shape(self.family, r=inf, threads=self.options.threads)
        verify_alpha_shape(shape, threads=self.options.threads, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        mesh = self.family.mesh
        counts: dict[str, Any] = {
            "points": len(mesh.points),
            "duplicates": mesh.duplicates,
            "triangles": len(mesh.triangles),
            "delaunay_edges": len(self.family),
            "radii": len(self.family.spectrum),
            "rule": self.family.rule,
            "method": self.options.method,
            "threads": self.options.threads,
        }
        if not self.has_shape:
            return counts
        shape = self.shape
        chosen: dict[str, Any] = {
            "r": None if self.is_unjoined else _json_number(shape.r),
            "alpha": None if self.is_unjoined else shape.alpha,
            "automatic": self.radius is None,
        }
        kinds = {"singular_edges": int((shape.kind == 1).sum()), "boundary_edges": int((shape.kind == 2).sum())}
        if self.options.method == "digital":
            return {**counts, **chosen, **kinds}
        return {
            **counts,
            **chosen,
            **kinds,
            "isolated_points": len(shape.isolated),
            "regions": shape.region_count,
            "holes": shape.hole_count,
            "cavities": shape.cavity_count,
            "area": shape.area,
            "perimeter": shape.perimeter,
        }


def radius_text(r: Radius) -> str:
    """Write a radius with which the same shape is found again: a double's shortest digits, a fraction's all."""
    if not isinstance(r, Fraction):
        return repr(float(r)).removesuffix(".0")
    with localcontext() as context:
        context.prec = 60
        return f"{(Decimal(r.numerator) / Decimal(r.denominator)).normalize()}"


def _json_number(r: Radius) -> float | str:
    """A number where it says all; JSON has no infinity."""
    number = nearest_double(r)
    return number if number == r and number != inf else radius_text(r)
