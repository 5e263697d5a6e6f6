"""What follows from a skeleton and its diagram: offset curves, the shape again, places along it."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, BinaryIO

from vorotool.errors import Kind, Message
from vorotool.geometry.polygons.polygon_set import PolygonSet
from vorotool.geometry.progress import Progress
from vorotool.geometry.skeleton.offsets import Offsets
from vorotool.geometry.skeleton.points_along import SkeletonPoints
from vorotool.geometry.skeleton.skeleton import Skeleton
from vorotool.jobs.animations import check_size, layer_pixels, parts_of_whole, write_frames
from vorotool.jobs.options import SkeletonOptions
from vorotool.jobs.pictures import Drawing, drawing_of, write_layers
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target
from vorotool.products.formats import ANIMATIONS, picture_format

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.engines.skeleton.exact import ShapeDiagram
    from vorotool.render.canvas.layers import Backdrop, Page


class Derived:
    """Results that are made when they are asked for.

    Parameters
    ----------
    run : Run
        Takes seconds.
    options : SkeletonOptions
        Of the command line.
    backdrop : Backdrop, optional
        The image that pictures are drawn over.
    skeleton, shapes : callable
        Give the skeleton, and the shapes or their exact diagram.
    styled : callable
        Gives the page that is drawn on as the options say.
    """

    def __init__(
        self,
        run: Run,
        options: SkeletonOptions,
        backdrop: Backdrop | None,
        skeleton: Callable[[], Skeleton],
        shapes: Callable[[], ShapeDiagram | PolygonSet],
        styled: Callable[[Page], Page],
    ) -> None:
        self.run, self.options, self.backdrop = run, options, backdrop
        self._skeleton, self._shapes, self._styled = skeleton, shapes, styled

    @property
    def distances(self) -> tuple[float, ...]:
        """Of the offset curves."""
        return self.options.distance or ()

    @cached_property
    def offset(self) -> Offsets:
        """Curves at all distances."""
        from vorotool.engines.offsets.offsets import offset

        shapes, o = self._shapes(), self.options
        with self.run.phase("offset") as progress:
            made = offset(
                shapes, self.distances, features=o.features, strict=o.strict, threads=o.threads, progress=progress
            )
        empty = [f"{distance:g}" for distance in self.distances if distance not in made.distance]
        if empty:
            self.run.warn(Message(f"nothing is left at the distance {', '.join(empty)}", Kind.EMPTY_RESULT))
        return made

    @cached_property
    def shape(self) -> PolygonSet:
        """Rebuilt from the skeleton."""
        from vorotool.engines.from_skeleton.reconstruction import rebuild

        skeleton = self._skeleton()
        with self.run.phase("rebuild"):
            return rebuild(skeleton, flatten=self.options.flatten)

    @cached_property
    def points(self) -> SkeletonPoints:
        """At equal steps along the branches."""
        from vorotool.engines.from_skeleton.points_along import points_along

        skeleton, every = self._skeleton(), self.options.every
        assert every is not None  # the command refuses points without it
        with self.run.phase("points"):
            return points_along(skeleton, every=every)

    def value(self, what: str) -> Any:
        """Of a result by its name."""
        return getattr(self, {"transects": "points"}.get(what, what))

    def check(self, target: Target) -> None:
        """Compute a result, and refuse what cannot be written."""
        from vorotool.render.canvas.png import check_picture_size

        self.value(target.what)
        if picture_format(target.fmt) == "png":
            page = self._drawing(target.what).page
            check_picture_size(page, self.options.max_pixels)
            if target.fmt in ANIMATIONS:
                check_size(self.options, (page.height, page.width))

    def _drawing(self, what: str, value: Any = None, styled: Callable[[Page], Page] | None = None) -> Drawing:
        o = self.options
        return drawing_of(
            self.value(what) if value is None else value,
            what=what,
            layers=o.layers,
            width=o.width or 1000,
            y_up=o.y_up,
            backdrop=self.backdrop,
            styled=styled or self._styled,
        )

    def write_picture(self, out: BinaryIO, target: Target) -> None:
        """Draw one result."""
        if target.fmt in ANIMATIONS:
            self._write_animation(out, target.fmt)
            return
        drawing = self._drawing(target.what)
        write_layers(out, drawing.layers, drawing.page, fmt=target.fmt, threads=self.options.threads)

    def _write_animation(self, out: BinaryIO, fmt: str) -> None:
        """Offset curves whose distances grow from nothing, on the page of the last ones."""
        from vorotool.engines.offsets.offsets import offset

        shapes, o, page = self._shapes(), self.options, self._drawing("offset").page

        def draw(part: Fraction) -> NDArray[np.uint8]:
            distances = [float(distance * part) for distance in map(Fraction, self.distances)]
            made = offset(shapes, distances, features=o.features, strict=o.strict, threads=o.threads)
            return layer_pixels(self._drawing("offset", made, lambda _: page).layers, page)

        write_frames(out, self.run, o, fmt, parts_of_whole(o), draw)

    def verify(self, progress: Progress) -> None:
        """Check the offset curves, if there are any."""
        if "offset" in self.options.what:
            from vorotool.engines.offsets.verify_offsets import verify_offsets

            verify_offsets(self.offset, distances=self.distances, threads=self.options.threads, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Counts of what was made."""
        found: dict[str, Any] = {}
        if "offset" in self.options.what:
            offsets = self.offset
            found["distances"] = list(self.distances)
            found |= {"shapes": len(offsets), "rings": len(offsets.ring_kind), "pieces": len(offsets.site)}
        if {"points", "transects"} & set(self.options.what):
            found |= {"every": self.options.every, "points": len(self.points)}
        return found
