"""What a skeleton can be written as (``--what``)."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import cached_property
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.cli.run import Run
from vorotool.cli.targets import Target
from vorotool.cli.units import in_units, length_in_units
from vorotool.errors import VorotoolWarning
from vorotool.geometry.planar_graph import PlanarGraph
from vorotool.geometry.skeleton import EXTERIOR, Skeleton
from vorotool.pictures import write_layers

if TYPE_CHECKING:
    from vorotool.render.layers import Page

DEFAULT_LAYERS = {
    "skeleton": ("polygons", "skeleton"),
    "diagram": ("polygons", "elements", "points", "skeleton"),
    "elements": ("polygons", "elements", "points"),
}
"""Layers of the picture of each result."""


class SkeletonProducts(ABC):
    """Results of one skeleton, however it is made.

    Parameters
    ----------
    options : namespace
        Options of the command line.
    run : Run
        Takes notes and seconds.
    """

    def __init__(self, options: SimpleNamespace, run: Run) -> None:
        self.options, self.run = options, run

    @cached_property
    def skeleton(self) -> Skeleton:
        """Of the side that is asked for."""
        with self.run.phase("skeleton"):
            return self._make_skeleton()

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

    @property
    def _points(self) -> NDArray[np.float64] | None:
        """What pictures show as points, if not the ends of edges."""
        return None

    @abstractmethod
    def verify(self) -> None:
        """Check the diagram and the skeleton, from their arrays alone."""

    def _value(self, what: str) -> Skeleton:
        return self.diagram if what == "diagram" else self.skeleton

    def check(self, target: Target) -> None:
        """Compute a result, and refuse what cannot be written, before anything is written."""
        value = self._value(target.what)
        if target.fmt == "png":
            from vorotool.render.layers_png import check_picture_size

            check_picture_size(self._page(value), self.options.max_pixels)
        if not len(value) and target.what in ("skeleton", "branches") and self.options.side == "exterior":
            warnings.warn("the exterior skeleton is empty", VorotoolWarning, stacklevel=2)

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Write one result."""
        from vorotool.formats.outputs import open_output

        with open_output(
            target.path, binary=target.is_binary, no_clobber=self.options.no_clobber, inputs=inputs
        ) as out:
            if target.fmt in ("svg", "png"):
                self._write_picture(out, target)
            else:
                self._write_data(out, target)

    def _write_data(self, out: BinaryIO, target: Target) -> None:
        from vorotool.formats.skeleton_files import write_skeleton

        write_skeleton(
            out,
            in_units(self.options, self._value(target.what)),
            target.fmt,
            what="skeleton" if target.what == "diagram" else target.what,
            flatten=length_in_units(self.options, self.options.flatten),
            precision=self.options.precision,
            threads=self.options.threads,
        )

    def _page(self, value: Skeleton) -> Page:
        from vorotool.render.layers import ImagePage
        from vorotool.render.skeleton_layers import skeleton_page

        if self.options.backdrop is not None:
            return ImagePage(self.options.backdrop)
        return skeleton_page(value, width=self.options.width or 1000, y_up=self.options.y_up)

    def _write_picture(self, out: BinaryIO, target: Target) -> None:
        from vorotool.render.skeleton_layers import picture_layers

        value = self._value(target.what)
        page = self._page(value)
        layers = picture_layers(value, page, self._layers(target.what), what=target.what, points=self._points)
        write_layers(out, layers, page, fmt=target.fmt, threads=self.options.threads)

    def _layers(self, what: str) -> Sequence[str]:
        """Layers of a picture: over an image the shapes are to be seen already."""
        if self.options.layers is not None or self.options.backdrop is None:
            return self.options.layers or DEFAULT_LAYERS[what]
        return [layer for layer in DEFAULT_LAYERS[what] if layer != "polygons"]

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        graph, skeleton = self.graph, self.skeleton
        assert graph.polygons is not None
        found: dict[str, Any] = {
            "polygons": len(graph.polygons),
            "vertices": len(graph.polygons.xy),
            "sites": len(skeleton.site_table),
            "segments": len(graph),
            "lattice_step": graph.scale,
            "largest_move": graph.largest_move,
            "repairs": graph.repairs,
            **self._diagram_stats(),
            "arcs": len(skeleton),
            "parabolas": int(np.count_nonzero(skeleton.is_parabola)),
            "exterior_arcs": int(np.count_nonzero(skeleton.side == EXTERIOR)),
            "branches": int(skeleton.branch[-1]) + 1 if len(skeleton) else 0,
            "nodes": len(skeleton.vertices),
            "side": self.options.side,
            "threads": self.options.threads,
        }
        if skeleton.frame is not None:
            found["frame"] = list(skeleton.frame)
        if self.options.is_mask:
            found |= {"outline": self.options.outline or "crack", "connectivity": int(self.options.connectivity or 8)}
        return found | self._more_stats()

    @abstractmethod
    def _diagram_stats(self) -> dict[str, Any]: ...

    def _more_stats(self) -> dict[str, Any]:
        return {}
