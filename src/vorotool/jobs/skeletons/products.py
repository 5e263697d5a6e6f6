"""What a skeleton can be written as (``--what``)."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, Kind, Message, RepairWarning, VorotoolWarning
from vorotool.jobs.checked_columns import check_columns
from vorotool.jobs.inputs import JobInput
from vorotool.jobs.options import Options, Place
from vorotool.jobs.picture_style import styled_page
from vorotool.jobs.picture_world import world_of_polygons
from vorotool.jobs.pictures import write_layers
from vorotool.jobs.pixel_sizes import placed_backdrop
from vorotool.jobs.pruning_choice import CRITERIA, LENGTHS, Pruning, chosen_pruning
from vorotool.jobs.refusals import refuse
from vorotool.jobs.run_log import Run
from vorotool.jobs.skeleton_input import read_polygons
from vorotool.jobs.skeletons.derived import Derived
from vorotool.jobs.skeletons.lines import LINES, WrittenLines
from vorotool.jobs.skeletons.result import Origin
from vorotool.jobs.targets import Target
from vorotool.jobs.units import in_units, length_in_units, unit_text
from vorotool.numeric.progress import Progress
from vorotool.products.formats import PICTURES, picture_format
from vorotool.products.registry import DERIVED, PRODUCTS
from vorotool.products.writing import write_product
from vorotool.types.polygons.planar_graph import PlanarGraph
from vorotool.types.skeleton.skeleton import EXTERIOR, Skeleton

if TYPE_CHECKING:
    from vorotool.engines.skeleton.exact import ShapeDiagram
    from vorotool.render.canvas.layers import Page
    from vorotool.types.polygons.polygon_set import PolygonSet
    from vorotool.types.skeleton.centerline import Centerlines


class SkeletonProducts(ABC):
    """Results of one skeleton, however it is made."""

    def __init__(self, run: Run, options: Options, given: JobInput) -> None:
        self.run = run
        with run.phase("read"):
            self._polygons, self.is_mask, options, frame, grid = read_polygons(run, options, given)
        if frame is None:
            refuse({"what thickness": "thickness" in options.what}, "is for images, but the input is polygons or lines")
        self.options, self.backdrop = options, placed_backdrop(run, options, given.backdrop)
        self._is_told = False  # what was repaired, once
        check_columns(options, self._polygons.properties)
        is_cut = options.side != "interior" or "diagram" in options.what
        world = world_of_polygons(run, options, self._polygons, size=options.pixel_size, is_cut=is_cut)
        self._styled = partial(styled_page, looks=options.looks, world=world)
        made = (lambda: self.skeleton), (lambda: self.whole), (lambda: self.centerlines), self._shapes
        origin = Origin(run, options, *made, frame, grid)
        self.lines = WrittenLines(run, options, lambda: self.joined, lambda: self.centerlines)
        self.derived = Derived(origin, self.backdrop, self._styled)

    @contextmanager
    def telling_once(self) -> Iterator[None]:
        """Let repairs be told where polygons are placed first."""
        with warnings.catch_warnings():
            if self._is_told:
                warnings.simplefilter("ignore", RepairWarning)
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
        from vorotool.engines.pruning.pruning import prune

        whole = self.whole
        threshold: dict[str, Any] = {self.pruning.criterion: self.pruning.threshold}
        with self.run.phase("prune") as progress:
            return prune(whole, **threshold, threads=self.options.threads, progress=progress)

    @cached_property
    def joined(self) -> Skeleton:
        """What is left, with near junctions made one: of what is drawn and counted, but not of what is measured."""
        if not self.options.join_junctions:
            return self.skeleton
        from vorotool.engines.junctions.joining import join_junctions

        skeleton = self.skeleton
        with self.run.phase("join"):
            return join_junctions(skeleton)

    @cached_property
    def centerlines(self) -> Centerlines:
        """The longest path in each polygon, or the one between the places that are given."""
        return self._made_centerlines(self.options.start, self.options.end)

    @cached_property
    def _longest(self) -> Centerlines:
        """The longest path in each polygon, for tables, which show who has none."""
        if self.options.start is None and self.options.end is None and "centerline" in self.options.what:
            return self.centerlines
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", VorotoolWarning)
            return self._made_centerlines(None, None)

    def _made_centerlines(self, start: Place | None, end: Place | None) -> Centerlines:
        from vorotool.engines.centerlines.centerline import centerline

        skeleton = self.skeleton
        with self.run.phase("centerline") as progress:
            try:
                return centerline(skeleton, start=start, end=end, ends=self.options.ends or "middle", progress=progress)
            except InputError as error:
                size = self.options.pixel_size
                if size is None or size.sides is None:
                    raise
                raise InputError(f"{error.marked} (places in steps of {size.factor}{unit_text(size)})") from None

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

    def _shapes(self) -> ShapeDiagram | PolygonSet:
        """What offset curves are of: each feature by itself, or the diagram of all."""
        return self._shape_diagram() if self.options.features == "together" else self._polygons

    def _shape_diagram(self) -> ShapeDiagram:
        """The exact diagram of the shapes."""
        from vorotool.engines.skeleton.exact import diagram_of_graph

        with self.run.phase("diagram") as progress:
            return diagram_of_graph(self.graph, threads=self.options.threads, progress=progress)

    def _points(self, what: str) -> NDArray[np.float64] | None:
        """What pictures of a result show as points, if not the ends of edges."""
        return None

    @property
    def exact(self) -> Skeleton | None:
        """What pictures show beside an approximate skeleton."""
        return None

    def verify(self, progress: Progress) -> None:
        """Check the diagram and the skeleton, from their arrays alone, and what pruning left of it."""
        self.derived.verify(progress)
        if not self.options.wants_skeleton:
            return
        self._verify_whole(progress)
        self.lines.verify(progress)
        if self.pruning.criterion is not None:
            from vorotool.engines.pruning.verify_pruning import verify_pruning

            verify_pruning(self.skeleton, self.whole)
        if self.options.join_junctions:
            from vorotool.engines.junctions.verify_joining import verify_joining

            verify_joining(self.joined, self.skeleton)

    @abstractmethod
    def _verify_whole(self, progress: Progress) -> None: ...

    def _value(self, what: str) -> Skeleton:
        if what == "centerline":
            return self.centerlines.path
        return self.diagram if what == "diagram" else self.joined

    def check(self, target: Target) -> None:
        """Compute a result, and refuse what cannot be written, before anything is written."""
        if target.what in DERIVED:
            self.derived.check(target)
            return
        value = self._value(target.what)
        if target.fmt == "png":
            from vorotool.render.canvas.png import check_picture_size

            check_picture_size(self._page(value, target.fmt), self.options.max_pixels)
        if target.fmt == "html":
            from vorotool.render.pages.skeleton_html import check_html_size

            check_html_size(self.whole)
        if not len(value) and target.what in ("skeleton", "branches") and self.options.side == "exterior":
            self.run.warn(Message("the exterior skeleton is empty", Kind.EMPTY_RESULT))

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Write one result."""
        from vorotool.formats.io.atomic_output import open_output

        with open_output(
            target.path, binary=target.is_binary, no_clobber=self.options.no_clobber, inputs=inputs
        ) as out:
            if target.fmt == "html":
                self._write_html(out)
            elif picture_format(target.fmt) not in PICTURES:
                self._write_data(out, target)
            elif target.what in DERIVED:
                self.derived.write_picture(out, target)
            else:
                self._write_picture(out, target)

    def _write_data(self, out: BinaryIO, target: Target) -> None:
        o = self.options
        write_product(
            out,
            self._written(target.what),
            PRODUCTS["skeleton-exact"][target.what],
            target.fmt,
            flatten=length_in_units(o.pixel_size, o.flatten),
            precision=o.precision,
            threads=o.threads,
            path=target.path,
        )

    def _written(self, what: str) -> Any:
        """What a result is written from, in the units of files: the table tells of centerlines, too."""
        o = self.options
        if what in DERIVED:
            return in_units(o.pixel_size, self.derived.value(what))
        if what in LINES:
            return in_units(o.pixel_size, self.lines.value(what))
        value = in_units(o.pixel_size, self._value(what))
        if what != "table":
            return value
        from vorotool.types.skeleton.centerline import centerline_columns
        from vorotool.types.skeleton.tables import polygon_table

        return polygon_table(
            value, columns=centerline_columns(in_units(o.pixel_size, self._longest)), threads=o.threads
        )

    def _write_html(self, out: BinaryIO) -> None:
        """A page of all prunings, which begins with that which is asked for."""
        from vorotool.engines.pruning.pruning import arc_profiles, critical_values
        from vorotool.render.pages.skeleton_html import write_skeleton_html

        whole, (_, criterion, threshold) = in_units(self.options.pixel_size, self.whole), self.pruning
        values = [critical_values(whole, name) for name in CRITERIA]
        shown = None
        if criterion is not None:
            is_length = criterion in LENGTHS
            shown = (criterion, length_in_units(self.options.pixel_size, threshold) if is_length else threshold)
        write_skeleton_html(out, whole, values, arc_profiles(whole), shown=shown)

    def _page(self, value: Skeleton, fmt: str) -> Page:
        from vorotool.render.canvas.layers import ImagePage
        from vorotool.render.layers.skeleton import skeleton_page

        if self.backdrop is not None:
            return self._styled(ImagePage(self.backdrop))
        page = skeleton_page(value, width=self.options.width or 1000)
        return self._styled(page, fmt=fmt)

    def _write_picture(self, out: BinaryIO, target: Target) -> None:
        from vorotool.render.layers.lines_along import line_layers
        from vorotool.render.layers.skeleton import picture_layers

        value = self._value(target.what)
        page, wanted = self._page(value, target.fmt), self._layers(target.what)
        lines = self.lines.value(target.what) if target.what in LINES else value
        is_path = target.what == "centerline"
        exact = self.exact if "exact" in wanted and not is_path else None
        points = self._points(target.what) if "points" in wanted and not is_path else None
        if isinstance(lines, Skeleton):
            layers = picture_layers(lines, page, wanted, what=target.what, points=points, exact=exact)
        else:
            layers = line_layers(lines, page, wanted, points=points, exact=exact)
        write_layers(out, layers, page, fmt=target.fmt, threads=self.options.threads)

    def _layers(self, what: str) -> Sequence[str]:
        """Layers of a picture: over an image the shapes are to be seen already."""
        usual = PRODUCTS["skeleton-exact"][what].usual_layers
        if self.backdrop is not None:
            usual = tuple(layer for layer in usual if layer != "polygons")
        return self.options.drawn(usual)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        found: dict[str, Any] = {
            **self._shape_stats(),
            **self._diagram_stats(),
            "side": self.options.side,
            "threads": self.options.threads,
        }
        if self.is_mask:
            found |= {"outline": self.options.outline or "crack", "connectivity": int(self.options.connectivity or 8)}
        if self.options.wants_skeleton:
            found |= self._skeleton_stats(self.joined)
        return found | self.lines.stats() | self.derived.stats()

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
            "prune": self.pruning.stats(),
        }
        if self.options.join_junctions:
            junctions = [int(np.count_nonzero(value.degree > 2)) for value in (self.skeleton, skeleton)]
            found["junctions_joined"] = junctions[0] - junctions[1]
        if skeleton.frame is not None:
            found["frame"] = list(skeleton.frame)
        return found | self._more_stats()

    @abstractmethod
    def _diagram_stats(self) -> dict[str, Any]: ...

    def _more_stats(self) -> dict[str, Any]:
        return {}
