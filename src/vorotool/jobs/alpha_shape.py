"""What the shapes of points, in space, too, can be written as (``--what``)."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal, localcontext
from fractions import Fraction
from functools import cached_property, partial
from math import inf
from typing import TYPE_CHECKING, Any, BinaryIO

from vorotool.engines.alpha.alpha_complex import alpha_curves, alpha_edges
from vorotool.engines.alpha.alpha_shape import chosen_radius, persistence, unjoined
from vorotool.errors import warn
from vorotool.jobs.inputs import JobInput, check_columns, read_sites, read_space, triangulated
from vorotool.jobs.job import Results
from vorotool.jobs.options import Options
from vorotool.jobs.pixel_sizes import placed_backdrop, placed_mesh
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.jobs.units import Amount, length_in_units, unit_text
from vorotool.numeric.length_units import unit_name
from vorotool.numeric.numbers import nearest_double
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.products.registry import OF_ONE_SHAPE, PLOTS, is_of
from vorotool.types.alpha.complex import RegionPersistence
from vorotool.types.alpha.radii import Radius
from vorotool.types.alpha.shape import AlphaShape
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.table import Table

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.render.drawing import Drawing, Plot, World
    from vorotool.types.alpha.complex import AlphaComplex
    from vorotool.types.alpha.shape import AlphaHull
    from vorotool.types.alpha.space import SpaceAlphaComplex, SpaceAlphaShape


class ShapeProducts(Results):
    """Results of the alpha shapes of one list of points."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        if not options.measured:  # what is wrong with it is said before a long file is read
            chosen_radius(options.r, options.alpha, options.auto)
        with run.phase("read"):
            properties, is_digital = "points" in options.what or options.names_columns, options.method != "exact"
            o, points = read_sites(run, options, given, properties=properties, is_digital=is_digital)
        super().__init__(run, o)
        self.radius = chosen_radius(o.r, o.alpha, o.auto)
        self._has_told_regions = False
        if given.backdrop is not None:
            self.backdrop = placed_backdrop(run, o, given.backdrop)
        mesh = self._triangulation(points)
        mesh = mesh if is_of(mesh, "SeedSet") else placed_mesh(o.pixel_size, mesh)
        self._points, self._allow_empty = points, is_of(points, "SeedSet") or not len(points)
        how = {"phase": "alpha complex", "rule": o.rule, "allow_empty": self._allow_empty}
        self.family: AlphaComplex = self.call("engines.alpha.alpha_complex:alpha_complex", mesh, **how)
        check_columns(o, self.family.mesh.properties)
        self.has_shape = bool(set(o.what) & OF_ONE_SHAPE)
        if self.has_shape:
            self.shape = self._shape()
            if self.radius is None and not self.is_unjoined:
                _note_radius(run, o, self.shape.r)

    @cached_property
    def world(self) -> World:
        """Where what is drawn lies."""
        from vorotool.jobs.picture_world import world_of_sites

        return world_of_sites(self.run, self.options, self.family.mesh, self._points)

    def _triangulation(self, points: Any) -> Any:
        if is_of(points, "SeedSet") and points.is_empty_image:
            return points
        if self.options.method != "exact" and len(points):
            from vorotool.jobs.triangulation import digital_mesh, seeds_of

            seeds = seeds_of(self.run, self.options, points)
            return digital_mesh(self.run, self.options, points, seeds)[0]
        return triangulated(self.run, self.options, points)

    def _shape(self) -> AlphaShape:
        o = self.options
        if o.method == "digital":
            assert self.radius is not None  # the command refuses the automatic one
            with self.run.phase("shape"):
                return self._edges_only(self.radius)
        thresholds = {"hole_threshold": o.hole_threshold, "region_threshold": o.region_threshold}
        return self._shape_of(self.radius, phase="shape", regions=o.regions or 1, **thresholds)

    def _shape_of(self, r: Radius | None, *, phase: str | None = None, **more: Any) -> AlphaShape:
        how = {"phase": phase, "r": r, "allow_empty": self._allow_empty, **more}
        return self.call("engines.alpha.alpha_shape:alpha_shape", self.family, **how)

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
        return self.call("engines.alpha.alpha_hull:alpha_hull", self.shape, phase=None)

    @cached_property
    def persistence(self) -> RegionPersistence:
        """When regions come and go as the radius grows."""
        return persistence(self.family, progress=self.run.progress("persistence"))

    def check(self, target: Target) -> None:
        """Refuse what cannot be written, and say what will be empty, before anything is written."""
        if target.what == "persistence" and not self._has_told_regions:
            self._has_told_regions = True
            self.run.note(self._standing_regions())
        super().check(target)
        empty = {
            "edges": lambda: not len(self.shape.edge_index),
            "polygons": lambda: not len(self.shape.polygons),
            "table": lambda: not len(self.shape.polygons),
            "hull": lambda: not len(self.hull),
        }.get(target.what)
        if empty is not None and len(self.family.spectrum) and not self.is_unjoined and empty():
            words = {"table": "regions", "hull": "arcs in the hull"}.get(target.what, target.what)
            warn(f"the shape has no {words} at r = {radius_text(self.shape.r)}: {self._beginning(target.what, words)}")

    def check_page(self) -> None:
        """Refuse a page of too many edges."""
        resolved("render.pages.html:check_family_size")(self.family)

    def _beginning(self, what: str, words: str) -> str:
        """Words for the radius at which there is something: regions begin with a triangle, shapes with an edge."""
        family = self.family
        if what in ("polygons", "table") and len(family.triangle_rank):
            return f"{words} begin at r = {radius_text(family.radius_from(int(family.triangle_rank.min())))}"
        return f"shapes begin at r = {radius_text(float(family.spectrum[0]))}"

    def _standing_regions(self) -> str:
        found = self.persistence
        if found.suggested < 2:
            return "1 region stands out" if found.suggested else "the shapes have no regions"
        until = radius_text(length_in_units(self.options.pixel_size, found.apart_until))
        return f"{found.suggested} regions stand out, apart below r = {until}"

    def value(self, what: str) -> Any:
        """Give the shape of the radius, its hull, or what is of all radii."""
        if what == "persistence":
            return self.persistence.table()
        if what in ("curves", "hull"):
            return self.curves if what == "curves" else self.hull
        return self.shape if what in OF_ONE_SHAPE else self.family

    def drawing(self, what: str, fmt: str) -> Drawing | Plot:
        """Prepare a picture of the shape, or a plot over the radius."""
        from vorotool.render.drawing import Plot, drawing_of
        from vorotool.render.pages.plots import write_curves_svg, write_persistence_svg

        product, wanted = self.products[what], self.wanted
        if what in PLOTS:
            plotted: Any = {"width": wanted.width}
            if what == "curves":
                return Plot(partial(write_curves_svg, curves=self.written(what, fmt), **plotted))
            suggested = self.persistence.suggested
            return Plot(partial(write_persistence_svg, regions=self.written(what, fmt), suggested=suggested, **plotted))
        # polygons are the shape, which is drawn over an image, too
        wanted = wanted._replace(layers=wanted.layers or product.usual_layers)
        return drawing_of(self.value(what), product, wanted, fmt)

    def write_page(self, out: BinaryIO) -> None:
        """Write a page with the shapes of all radii."""
        from vorotool.render.pages.html import write_alpha_html

        r = self.shape.r if self.has_shape else self.radius
        r = None if r is None else length_in_units(self.options.pixel_size, r)
        family, curves = self.written("family", "html"), self.written("curves", "html")
        stated: Any = self.run.coordinates if self.options.pixel_size is None else self.options.pixel_size
        unit = None if stated is None or stated.unit is None else unit_name(stated.unit)
        write_alpha_html(out, family, curves, r=r, unit=unit)

    def frames(self, what: str) -> Callable[[Fraction], NDArray[np.uint8]]:
        """Draw shapes whose radius grows to that of the shape, or to the largest critical one if that is infinite."""
        finite = self.family.spectrum[self.family.spectrum < inf]
        largest = float(finite[-1]) if len(finite) else 1.0
        r = Fraction(self.shape.r) if self.shape.r < inf else Fraction(largest)
        whole: Any = self.drawing(what, "png")  # there are no plots of what moves

        def draw(part: Fraction) -> NDArray[np.uint8]:
            return whole.of(self._shape_of(r * part)).pixels()

        return draw

    def verify(self, progress: Progress) -> None:
        """Check the shape exactly, from its triangulation."""
        shape = self.shape if self.has_shape else self._shape_of(inf, strict=False, allow_empty=None)
        self.call("engines.alpha.verify_alpha:verify_alpha_shape", shape, phase=None, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        mesh, o = self.family.mesh, self.options
        counts: dict[str, Any] = {"points": len(mesh.points), "duplicates": mesh.duplicates}
        counts |= {"triangles": len(mesh.triangles), "delaunay_edges": len(self.family)}
        counts |= {"radii": len(self.family.spectrum), "rule": self.family.rule, "method": o.method}
        counts["threads"] = o.threads
        if not self.has_shape:
            return counts
        shape, is_known = self.shape, not self.is_unjoined
        counts |= radius_stats(shape) if is_known else {"r": None, "alpha": None}
        counts["automatic"] = self.radius is None
        counts |= {"singular_edges": int((shape.kind == 1).sum()), "boundary_edges": int((shape.kind == 2).sum())}
        if o.method == "digital":
            return counts
        names = {"regions": "region_count", "holes": "hole_count", "cavities": "cavity_count"}
        measures = {name: getattr(shape, field) for name, field in names.items()}
        return {
            **counts,
            "isolated_points": len(shape.isolated),
            **measures,
            "area": Amount(shape.area, 2),
            "perimeter": Amount(shape.perimeter),
        }


def _note_radius(run: Run, o: Options, r: Radius) -> None:
    """Say which radius was found."""
    regions = "one region" if o.regions in (None, 1) else f"at most {o.regions} regions"
    text = radius_text(r)
    if o.pixel_size is not None:
        text = f"{text} ({length_in_units(o.pixel_size, nearest_double(r)):g}{unit_text(o.pixel_size)})"
    run.note(f"r = {text}, the smallest radius whose shape is {regions} covering every point")


def radius_text(r: Radius) -> str:
    """Write a radius with which the same shape is found again: a double's shortest digits, a fraction's all."""
    if not isinstance(r, Fraction):
        return repr(float(r)).removesuffix(".0")
    with localcontext() as context:
        context.prec = 60
        return f"{(Decimal(r.numerator) / Decimal(r.denominator)).normalize()}"


def radius_stats(shape: Any) -> dict[str, Any]:
    """What statistics say of the radius of a shape."""
    return {"r": Amount(json_number(shape.r)), "alpha": Amount(shape.alpha, -1)}


def json_number(r: Radius) -> float | str:
    """A number where it says all; JSON has no infinity."""
    number = nearest_double(r)
    return number if number == r and number != inf else radius_text(r)


# ---- points in space -----------------------------------------------------------------------------
class SpaceShapeProducts(Results):
    """Results of the alpha shapes of one list of points in space."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        super().__init__(run, options)
        if not options.measured:  # what is wrong with it is said before a long file is read
            chosen_radius(options.r, options.alpha, options.auto)
        points = read_space(run, options, given, properties=False)
        self.radius = chosen_radius(options.r, options.alpha, options.auto)
        mesh = triangulated(run, options, points)
        self._allow_empty = not len(points)
        how: Any = {"phase": "alpha complex", "allow_empty": self._allow_empty}
        self.family: SpaceAlphaComplex = self.call("engines.alpha.alpha_complex:alpha_complex", mesh, **how)
        self.has_shape = bool(set(options.what) & OF_ONE_SHAPE)
        if self.has_shape and self.radius is None and unjoined(self.family) is None:
            _note_radius(run, options, self.shape.r)

    @cached_property
    def shape(self) -> SpaceAlphaShape:
        """The shape of the radius."""
        how: Any = {"r": self.radius, "regions": self.options.regions or 1, "allow_empty": self._allow_empty}
        return self.call("engines.alpha.alpha_shape:alpha_shape", self.family, phase="shape", **how)

    @cached_property
    def curves(self) -> Table:
        """Measures of the shapes of all radii."""
        space_curves = resolved("engines.alpha.space_shape:space_curves")
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
        if self.has_shape:
            shape: Any = self.shape
        else:
            shape = self.call("engines.alpha.alpha_shape:alpha_shape", self.family, phase=None, r=inf)
        self.call("engines.alpha.verify_alpha:verify_space_shape", shape, phase=None, progress=progress)

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
