"""What a skeleton can be written as (``--what``)."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from fractions import Fraction
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, Kind, Message, RepairWarning, UsageError, silent
from vorotool.jobs.inputs import JobInput, check_columns
from vorotool.jobs.job import Results
from vorotool.jobs.options import Options, Place
from vorotool.jobs.outlined_images import read_polygons
from vorotool.jobs.pixel_sizes import placed_backdrop, written_grid
from vorotool.jobs.run_log import Run, parameters_of
from vorotool.jobs.targets import Target
from vorotool.jobs.units import (
    CRITERIA,
    LENGTHS,
    Amount,
    Pruning,
    box_amounts,
    chosen_pruning,
    in_units,
    length_in_units,
    lengths_among,
    sides_of,
    unit_text,
)
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import resolved
from vorotool.products.registry import DERIVED, Made, is_of
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.skeleton import EXTERIOR, Skeleton

if TYPE_CHECKING:
    from vorotool.engines.skeleton.diagrams import FeatureSkeleton
    from vorotool.engines.skeleton.exact import ShapeDiagram
    from vorotool.render.drawing import Drawing, Plot, World
    from vorotool.types.polygons.polygon_set import PolygonSet
    from vorotool.types.skeleton.arc_measures import ThicknessImage
    from vorotool.types.skeleton.discs import Discs
    from vorotool.types.skeleton.lines import Centerlines, LedOn, SmoothLines
    from vorotool.types.skeleton.offsets import Offsets
    from vorotool.types.skeleton.points_along import SkeletonPoints

SKELETON_INSIDE = "engines.skeleton.diagrams:skeleton_inside"
LINES = ("skeleton", "centerline")
"""Results that are lines."""


class SkeletonProducts(Results, ABC):
    """Results of one skeleton, however it is made."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        with run.phase("read"):
            self._polygons, self.is_mask, options, self.frame, self.grid = read_polygons(run, options, given)
        super().__init__(run, options)
        if self.frame is None and "thickness" in options.what:
            raise UsageError("--what thickness applies to images, but the input is polygons or lines")
        if given.backdrop is not None:
            self.backdrop = placed_backdrop(run, options, given.backdrop)
        self._is_told = False  # what was repaired, once
        check_columns(options, self._polygons.properties)
        self._derived: dict[Made, Any] = {}
        self._lines: dict[str, Skeleton | LedOn | SmoothLines] = {}

    @cached_property
    def world(self) -> World:
        """Where what is drawn lies."""
        from vorotool.jobs.picture_world import world_of_polygons

        o = self.options
        is_cut = o.side != "interior" or "diagram" in o.what
        return world_of_polygons(self.run, o, self._polygons, size=o.pixel_size, is_cut=is_cut)

    @contextmanager
    def telling_once(self) -> Iterator[None]:
        """Let repairs be told where polygons are placed first."""
        with silent(RepairWarning) if self._is_told else nullcontext():
            yield
        self._is_told = True

    @cached_property
    def whole(self) -> Skeleton:
        """Of the side that is asked for, before it is pruned."""
        with self.run.phase("skeleton"):
            return self._make_skeleton()

    @cached_property
    def pruning(self) -> Pruning:
        """What is removed."""
        return chosen_pruning(self.options.prune, is_mask=self.is_mask)

    @cached_property
    def skeleton(self) -> Skeleton:
        """What is left of it."""
        if self.pruning.criterion is None:
            return self.whole
        return self.call(
            "engines.pruning.pruning:prune", self.whole, **{self.pruning.criterion: self.pruning.threshold}
        )

    @cached_property
    def joined(self) -> Skeleton:
        """What is left, with near junctions made one: of what is drawn and counted, but not of what is measured."""
        if not self.options.join_junctions:
            return self.skeleton
        return self.call("engines.pruning.joining:join_junctions", self.skeleton, phase="join")

    @cached_property
    def centerlines(self) -> Centerlines:
        """The longest path in each polygon, or the one between the places that are given."""
        return self._made_centerlines(self.options.start, self.options.end)

    @cached_property
    def _longest(self) -> Centerlines:
        """The longest path in each polygon, for tables, which show who has none."""
        if self.options.start is None and self.options.end is None and "centerline" in self.options.what:
            return self.centerlines
        with silent():
            return self._made_centerlines(None, None)

    def _made_centerlines(self, start: Place | None, end: Place | None) -> Centerlines:
        places: dict[str, Any] = {"start": start, "end": end, "ends": self.options.ends or "middle"}
        try:
            return self.call("engines.centerlines.centerline:centerline", self.skeleton, **places)
        except InputError as error:
            size = self.options.pixel_size
            if size is None or size.sides is None:
                raise
            raise InputError(f"{error.marked} (coordinates in steps of {size.factor}{unit_text(size)})") from None

    @cached_property
    def diagram(self) -> Skeleton:
        """All edges of the diagram, cut by the frame."""
        with self.run.phase("skeleton"):
            return self._make_diagram()

    @abstractmethod
    def _make_skeleton(self) -> Skeleton: ...

    @abstractmethod
    def _make_diagram(self) -> Skeleton: ...

    @property
    @abstractmethod
    def graph(self) -> PlanarGraph:
        """The shapes as they were placed."""

    def exact_shapes(self) -> ShapeDiagram | PolygonSet:
        """What offset curves are of: each feature by itself, or the diagram of all."""
        return self._shape_diagram() if self.options.features == "together" else self._polygons

    def _shape_diagram(self) -> ShapeDiagram:
        """The exact diagram of the shapes."""
        return self.call("engines.skeleton.exact:diagram_of_graph", self.graph, phase="diagram")

    def _points(self, what: str) -> NDArray[np.float64] | None:
        """What pictures of a result show as points, if not the ends of edges."""
        return None

    @property
    def exact(self) -> Skeleton | None:
        """What pictures show beside an approximate skeleton."""
        return None

    # ---- what follows from it
    def derived(self, what: str) -> Any:
        """Give one of `DERIVED`, which is made when it is first asked for."""
        made = DERIVED[what]
        if made not in self._derived:
            self._derived[made] = getattr(self, made.by)() if made.by else self._made_by_function(made)
        return self._derived[made]

    def _made_by_function(self, made: Made) -> Any:
        """Call the function that makes a result, with the options that its parameters name and the user gives."""
        source, names = getattr(self, made.of), parameters_of(resolved(made.make))[1:]
        given = {name: value for name, value in vars(self.options).items() if name in names and value is not None}
        return self.call(made.make, source, phase=made.counted_as, **given)

    def offset_curves(self) -> Offsets:
        """Make offset curves of shapes, at all distances."""
        distances = self.options.distance or ()
        made = self._offset(self.exact_shapes(), distances, phase="offset")
        empty = [f"{distance:g}" for distance in distances if distance not in made.distance]
        if empty:
            self.run.warn(Message(f"no shape remains at the distance {', '.join(empty)}", Kind.EMPTY_RESULT))
        return made

    def _offset(self, shapes: Any, distances: Any, phase: str | None = None) -> Offsets:
        function, features = "engines.offsets.offsets:offset", self.options.features
        return self.call(function, shapes, distances, phase=phase, features=features)

    def inscribed_discs(self) -> Discs:
        """Make discs of each feature, of its exact skeleton before it is pruned, whatever skeleton is asked for."""
        o, function = self.options, "engines.from_skeleton.largest_discs:discs_of_skeleton"
        return self.call(function, self._axis(), phase="discs", count=o.count, local=o.local)

    def _axis(self) -> Skeleton:
        o = self.options
        if not o.gap and o.side != "exterior":
            return self.whole
        shapes = self.exact_shapes()
        if is_of(shapes, "PolygonSet"):
            inside: FeatureSkeleton[Any] = self.call(
                "engines.skeleton.diagrams:skeleton_inside", shapes, phase="skeleton"
            )
            return inside.skeleton
        return self.call(
            "engines.skeleton.diagrams:skeleton_in", shapes, phase="skeleton", side="interior", features=o.features
        )

    def points_along(self) -> SkeletonPoints:
        """Make points at equal steps along skeletons or centerlines, and transects from foot to foot."""
        lines = self.centerlines if self.options.along == "centerline" else self.skeleton
        return self.call(
            "engines.from_skeleton.points_along:points_along", lines, phase="points", every=self.options.every
        )

    def thickness(self) -> ThicknessImage:
        """Make the largest disc over each pixel: discs of what pruning removes cover pixels, too."""
        from vorotool.types.skeleton.arc_measures import ThicknessImage

        assert self.frame is not None  # polygons are refused when they are read
        function = "engines.from_skeleton.thickness:thickness_of_pixels"
        values: Any = self.call(function, self.whole, self.frame.shape, phase="thickness", sides=self._sides)
        return ThicknessImage(values, written_grid(self.options.pixel_size, self.grid))

    @property
    def _sides(self) -> tuple[float, float]:
        sides = sides_of(self.options)
        return float(sides.y), float(sides.x)

    def _verify_derived(self, what: str, progress: Progress) -> None:
        """Check a result by another way than it was made, where there is one."""
        o, made, value = self.options, DERIVED[what], self.derived(what)
        more: tuple[Any, ...] = ()
        given: dict[str, Any] = {"progress": progress}
        if what == "thickness":
            value, more, given = value.values, (self.whole,), given | {"sides": self._sides}
        elif what == "offset":
            given["distances"] = o.distance or ()
        elif made.by == "points_along":  # sections of branches end where discs of the skeleton, which is checked, touch
            if o.along != "centerline":
                return
            more, given = (self.centerlines, o.every), {}
        if made.check:
            self.call(made.check, value, *more, phase=None, **given)

    def _derived_stats(self, what: str) -> dict[str, Any]:
        """Counts of a result that follows from the skeleton."""
        o, made, value = self.options, DERIVED[what], self.derived(what)
        if what == "offset":
            counts = {"shapes": len(value), "rings": len(value.ring_kind), "pieces": len(value.site)}
            return {"distances": list(map(Amount, o.distance or ())), **counts}
        if what == "discs":
            return {"discs": len(value), "largest_radius": Amount(float(value.radius.max())) if len(value) else None}
        if made.by == "points_along":
            return {"every": Amount(o.every), "along": o.along or "branches", "points": len(value)}
        if what == "parts":
            neck = resolved("engines.necks.parts:NARROWEST") if o.neck is None else float(o.neck)
            return {"neck": neck, "pieces": len(value), "cuts": len(value.necks)}
        if what == "thickness":
            values = value.values[value.values > 0]
            found = {"mean": values.mean(), "sd": values.std(), "largest": values.max()} if len(values) else {}
            sizes = {f"thickness_{name}": Amount(float(each)) for name, each in found.items()}
            return {"pixels": len(values), **sizes}
        return {made.counted_as: len(value)} if made.counted_as else {}

    def _all_derived(self) -> list[str]:
        """Names of the results that are asked for, of those that are made together one."""
        return list({DERIVED[what]: what for what in DERIVED if what in self.options.what}.values())

    # ---- lines
    def lines(self, what: str) -> Skeleton | LedOn | SmoothLines:
        """Give the skeleton or the centerlines as they are, extended to their ends, or smooth."""
        if what not in self._lines:
            made: Any = self.centerlines if what == "centerline" else self.joined
            if what == "skeleton" and self.options.ends == "middle":
                made = self.call("engines.centerlines.extended_ends:extend_ends", made, phase="ends")
            if self.options.smooth is not None:
                made = self.call("engines.smoothing.smooth:smooth", made, self.options.smooth)
            self._lines[what] = made
        return self._lines[what]

    def _all_lines(self) -> list[Any]:
        return [self.lines(what) for what in LINES if what in self.options.what]

    def value(self, what: str) -> Any:
        """Give a result in the coordinates of the input."""
        if what in DERIVED:
            return self.derived(what)
        return self.lines(what) if what in LINES else self.diagram if what == "diagram" else self.joined

    # ---- what is checked, written and counted
    def verify(self, progress: Progress) -> None:
        """Check the diagram and the skeleton, from their arrays alone, and what pruning left of it."""
        for what in self._all_derived():
            self._verify_derived(what, progress)
        if set(self.options.what) == {"offset"}:  # of the whole diagram
            return
        self._verify_whole(progress)
        for value in self._all_lines():  # ends that skeletons are extended to, and smooth lines
            is_smooth = is_of(value, "SmoothLines")
            if is_smooth:
                self.call("engines.smoothing.verify_smooth:verify_smooth", value, phase=None)
            lines = value.lines if is_smooth else value
            if is_of(lines, "ExtendedSkeleton"):
                self.call("engines.centerlines.verify_extended:verify_extended", lines, self.joined, phase=None)
        if self.pruning.criterion is not None:
            self.call("engines.pruning.verify_pruning:verify_pruning", self.skeleton, self.whole, phase=None)
        if self.options.join_junctions:
            self.call("engines.pruning.verify_pruning:verify_joining", self.joined, self.skeleton, phase=None)

    def _verify_whole(self, progress: Progress) -> None:
        """Check the skeleton, from its arrays alone."""
        self.call("engines.skeleton.verify_skeleton:verify_skeleton", self.whole, phase=None, progress=progress)

    def check(self, target: Target) -> None:
        """Compute a result, and refuse what cannot be written, before anything is written."""
        what = target.what
        if what in DERIVED:
            self.derived(what)
        elif what == "centerline":
            _ = self.centerlines
        elif what == "diagram":
            _ = self.diagram
        else:
            _ = self.joined
        super().check(target)
        if what in ("skeleton", "branches") and self.options.side == "exterior" and not len(self.joined):
            self.run.warn(Message("the exterior skeleton is empty", Kind.EMPTY_RESULT))

    def check_page(self) -> None:
        """Refuse a page of too many arcs."""
        resolved("render.pages.html:check_skeleton_size")(self.whole)

    def written(self, what: str, fmt: str) -> Any:
        """Give a result in the units of files: the table tells of centerlines, too."""
        value, o = super().written(what, fmt), self.options
        if what != "table":
            return value
        from vorotool.types.skeleton.lines import centerline_columns
        from vorotool.types.skeleton.tables import polygon_table

        columns = centerline_columns(in_units(o.pixel_size, self._longest))
        return polygon_table(value, columns=columns, threads=o.threads)

    def write_page(self, out: BinaryIO) -> None:
        """Write a page of all prunings, which begins with that which is asked for."""
        from vorotool.engines.pruning.pruning import arc_profiles, critical_values
        from vorotool.render.pages.html import write_skeleton_html

        whole, (_, criterion, threshold) = in_units(self.options.pixel_size, self.whole), self.pruning
        values = [critical_values(whole, name) for name in CRITERIA]
        shown = None
        if criterion is not None:
            is_length = criterion in LENGTHS
            shown = (criterion, length_in_units(self.options.pixel_size, threshold) if is_length else threshold)
        write_skeleton_html(out, whole, values, arc_profiles(whole), shown=shown)

    def drawing(self, what: str, fmt: str) -> Drawing | Plot:
        """Prepare a picture: of thickness it has the pixels of the image."""
        from vorotool.render.drawing import Plot, drawing_of
        from vorotool.render.label_images.amounts import write_thickness_png

        product, wanted, o = self.products[what], self.wanted, self.options
        if what == "thickness":
            unit = None if o.pixel_size is None else o.pixel_size.unit
            style, image = wanted.looks.style(wanted.world.scale_bar), self.written(what, fmt)
            return Plot(partial(write_thickness_png, image=image, style=style, unit=unit))
        shown = wanted.shown(product.usual_layers)
        more: dict[str, Any] = {}
        if what in ("skeleton", "diagram", "elements"):
            more["points"] = self._points(what) if "points" in shown else None
            more["exact"] = self.exact if "exact" in shown else None
        return drawing_of(self.value(what), product, wanted, fmt, **more)

    def frames(self, what: str) -> Callable[[Fraction], NDArray[np.uint8]]:
        """Draw offset curves whose distances grow from nothing, on the page of the last ones."""
        shapes: Any = self.exact_shapes()
        whole: Any = self.drawing(what, "png")

        def draw(part: Fraction) -> NDArray[np.uint8]:
            distances = [float(distance * part) for distance in map(Fraction, self.options.distance or ())]
            return whole.of(self._offset(shapes, distances)).pixels()

        return draw

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        o, shapes = self.options, lengths_among(self._shape_stats(), "lattice_step", "largest_move")
        found = shapes | self._diagram_stats()
        found |= {"side": o.side, "threads": o.threads}
        if self.is_mask:
            found |= {"outline": o.outline or "crack", "connectivity": int(o.connectivity or 8)}
        if set(o.what) != {"offset"}:
            found |= self._skeleton_stats(self.joined)
        if o.smooth is not None:
            made = self._all_lines()
            found |= {"smooth": Amount(o.smooth), "curves": sum(len(each.control) for each in made)}
            error = max((float(each.error.max(initial=0.0)) for each in made), default=0.0)
            found["largest_error"] = Amount(error)
        for what in self._all_derived():
            found |= self._derived_stats(what)
        return found

    def _shape_stats(self) -> dict[str, Any]:
        graph = self.graph
        assert graph.polygons is not None
        return {
            "polygons": len(graph.polygons),
            "vertices": len(graph.polygons.xy),
            "sites": len(graph.points) + len(graph),
            "segments": len(graph),
            "lattice_step": graph.scale,
            "largest_move": graph.largest_move,
            "repairs": graph.repairs,
        }

    def _skeleton_stats(self, skeleton: Skeleton) -> dict[str, Any]:
        found: dict[str, Any] = {
            "arcs": len(skeleton),
            "parabolas": int(np.count_nonzero(skeleton.is_parabola)),
            "exterior_arcs": int(np.count_nonzero(skeleton.side == EXTERIOR)),
            "branches": int(skeleton.branch[-1]) + 1 if len(skeleton) else 0,
            "nodes": len(skeleton.vertices),
            "prune": lengths_among(self.pruning.stats(), *LENGTHS),
        }
        if self.options.join_junctions:
            junctions = [int(np.count_nonzero(value.degree > 2)) for value in (self.skeleton, skeleton)]
            found["junctions_joined"] = junctions[0] - junctions[1]
        if skeleton.frame is not None:
            found["frame"] = box_amounts(skeleton.frame)
        return found | self._more_stats()

    @abstractmethod
    def _diagram_stats(self) -> dict[str, Any]: ...

    def _more_stats(self) -> dict[str, Any]:
        return {}
