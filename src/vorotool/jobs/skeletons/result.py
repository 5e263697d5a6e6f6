"""One result that follows from a skeleton or its diagram: what makes it, checks it and counts it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, BinaryIO

from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.numeric.progress import Progress
from vorotool.plain import plain

if TYPE_CHECKING:
    from vorotool.engines.skeleton.exact import ShapeDiagram
    from vorotool.jobs.targets import Target
    from vorotool.render.canvas.layers import Page
    from vorotool.types.pixel_frame import Frame
    from vorotool.types.pixel_grid import PixelGrid
    from vorotool.types.polygons.polygon_set import PolygonSet
    from vorotool.types.skeleton.centerline import Centerlines
    from vorotool.types.skeleton.skeleton import Skeleton


@plain
class Origin:
    """What results follow from."""

    run: Run  # takes seconds and what is to be said
    options: Options  # of the command line
    skeleton: Callable[[], Skeleton]  # gives the skeleton, pruned as the options say
    whole: Callable[[], Skeleton]  # gives it before it is pruned
    # gives the longest path in each polygon, or that between the places that are given
    centerlines: Callable[[], Centerlines]
    shapes: Callable[[], ShapeDiagram | PolygonSet]  # gives the shapes, or their exact diagram
    frame: Frame | None = None  # pixels of the image that the shapes are outlines of
    grid: PixelGrid | None = None  # what that image says of them

    @property
    def exact_options(self) -> Options:
        """Those of a result that only `skeleton-exact` has."""
        assert isinstance(self.options, Options)
        return self.options


class Result(ABC):
    """A result, made when it is asked for."""

    draws_itself = False
    """Its picture is an image of its own, and no layers."""

    def __init__(self, origin: Origin) -> None:
        self.origin, self.run, self.options = origin, origin.run, origin.options

    @cached_property
    def value(self) -> Any:
        """What is written, of a public type."""
        return self._make()

    @abstractmethod
    def _make(self) -> Any: ...

    def verify(self, progress: Progress) -> None:  # noqa: B027 - some are not checked
        """Check the value by another way than it was made."""

    def stats(self) -> dict[str, Any]:
        """Counts of it."""
        return {}

    def draw(self, out: BinaryIO, target: Target, styled: Callable[..., Page]) -> None:
        """Draw what draws itself, on a page that is styled as the options say."""
        raise NotImplementedError
