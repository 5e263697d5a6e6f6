"""Results of one input, by name: checked, and written as data, pictures, pages or animations."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, BinaryIO

from vorotool.errors import Kind, LimitError, Message
from vorotool.formats.io.atomic_output import open_output
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Made, Run
from vorotool.jobs.targets import Target
from vorotool.jobs.units import in_units, length_in_units, table_in_units
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import ANIMATIONS, PICTURES, picture_format
from vorotool.products.registry import Product, is_of, write_product

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.render.canvas.layers import Backdrop, Page
    from vorotool.render.drawing import Picture, Wanted
    from vorotool.render.looks import World

FRAMES, FPS = 40, 10.0
"""Of animations, where they are not chosen."""

MOST_PIXELS = 1 << 28
"""Of all frames together."""


class Results:
    """What a command makes of one input; each result is computed when it is first asked for."""

    backdrop: Backdrop | None = None
    """The image that pictures are drawn over."""
    read_beside: tuple[str, ...] = ()
    """Further files that are read, which no output replaces."""

    begins_empty = False
    """Animations begin with nothing."""

    def __init__(self, run: Run, options: Options) -> None:
        self.run, self.options = run, options

    @cached_property
    def products(self) -> Mapping[str, Product]:
        """All results of the command."""
        return self.options.products

    # ---- what commands give
    def value(self, what: str) -> Any:
        """Give a result in the coordinates of the input."""
        raise NotImplementedError

    def written(self, what: str, fmt: str) -> Any:
        """Give a result in the units of files."""
        size, value = self.options.pixel_size, self.value(what)
        return table_in_units(size, value) if is_of(value, "Table") else in_units(size, value)

    @cached_property
    def world(self) -> World:
        """Where what is drawn lies: in space nowhere, since pictures are as seen from far away."""
        from vorotool.render.looks import World

        return World()

    def drawing(self, what: str, fmt: str) -> Picture:
        """Prepare the picture of a result."""
        from vorotool.render.drawing import drawing_of

        return drawing_of(self.value(what), self.products[what], self.wanted, fmt)

    def write_page(self, out: BinaryIO) -> None:
        """Write a page of HTML."""
        raise NotImplementedError

    def check_page(self) -> None:
        """Refuse a page that is too large."""

    @property
    def page_unit(self) -> str | None:
        """The unit of lengths on pages."""
        from vorotool.numeric.length_units import unit_name

        stated: Any = self.run.coordinates if self.options.pixel_size is None else self.options.pixel_size
        return None if stated is None or stated.unit is None else unit_name(stated.unit)

    def emptiness(self, what: str) -> str:
        """Say why a result is empty; nothing of one that is not, or whose emptiness surprises nobody."""
        return ""

    def frames(self, what: str) -> Callable[[Fraction], NDArray[np.uint8]]:
        """Give what draws a result that has grown to a part of the whole."""
        raise NotImplementedError

    def verify(self, progress: Progress) -> None:
        """Check the results by another way."""

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        raise NotImplementedError

    # ---- what is the same for all
    def call(self, function: str, *sources: Any, phase: str | None = "", **more: Any) -> Made:  # type: ignore[type-var]
        """Call a function of the library with the options: see `Run.call`."""
        return self.run.call(self.options, function, *sources, phase=phase, **more)

    @property
    def wanted(self) -> Wanted:
        """What is wanted of pictures."""
        from vorotool.render.drawing import Wanted

        o = self.options
        return Wanted(o.looks, self.world, o.layers, o.width or 1000, self.backdrop, o.threads)

    def check(self, target: Target) -> None:
        """Refuse what cannot be written, before anything is."""
        if picture_format(target.fmt) == "png":
            drawing = self.drawing(target.what, "png")
            drawing.check(self.options.max_pixels)
            if target.fmt in ANIMATIONS:
                from vorotool.render.drawing import Drawing

                assert isinstance(drawing, Drawing)
                self.check_frames(drawing.shape)
        if target.fmt == "html":
            self.check_page()
        if reason := self.emptiness(target.what):
            self.run.warn(Message(f"the result has no {target.what}: {reason}", Kind.EMPTY_RESULT))

    def check_frames(self, shape: tuple[int, int]) -> None:
        """Refuse an animation of more pixels than can be shown."""
        count = self.options.frames or FRAMES
        if count * shape[0] * shape[1] > MOST_PIXELS:
            raise LimitError(
                f"{count} frames of {shape[1]} x {shape[0]} pixels are too many, at most {MOST_PIXELS} pixels: use "
                "fewer --frames, or a smaller --width"
            )

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Write one result."""
        page: Page | None = None
        rules: Any = {"no_clobber": self.options.no_clobber, "inputs": (*inputs, *self.read_beside)}
        if target.fmt == "zarr":
            self.write_store(target, rules)
            return
        with open_output(target.path, binary=target.is_binary, **rules) as out:
            if target.fmt in PICTURES and self.is_picture(target):
                drawing = self.drawing(target.what, target.fmt)
                drawing.write(out, target.fmt)
                page = drawing.page
            elif target.fmt == "html":
                self.write_page(out)
            elif target.fmt in ANIMATIONS:
                self._write_frames(out, target)
            else:
                self.write_data(out, target)
        if target.fmt == "png":
            from vorotool.jobs.picture_world import write_world_file

            write_world_file(self.run, self.options.unit, page, target.path, **rules)

    def is_picture(self, target: Target) -> bool:
        """Whether a PNG or an SVG is drawn."""
        return target.fmt in self.products[target.what].layers

    def _write_frames(self, out: BinaryIO, target: Target) -> None:
        """Draw a result that grows, each frame as a picture of its own."""
        from vorotool.formats.images.pictures import write_animation

        count, draw, progress = self.options.frames or FRAMES, self.frames(target.what), self.run.progress("animate")
        steps, first = (max(count - 1, 1), 0) if self.begins_empty else (count, 1)

        def frames() -> Iterator[NDArray[np.uint8]]:
            for number in range(count):
                yield draw(Fraction(number + first, steps))
                if progress is not None:
                    progress((number + 1) / count)

        write_animation(out, frames(), fmt=target.fmt, fps=self.options.fps or FPS)

    def write_store(self, target: Target, rules: Mapping[str, Any]) -> None:
        """Write a result to a Zarr store."""
        raise NotImplementedError

    def write_data(self, out: BinaryIO, target: Target) -> None:
        """Write a result in a format of its own."""
        o = self.options
        write_product(
            out,
            self.written(target.what, target.fmt),
            self.products[target.what],
            target.fmt,
            flatten=length_in_units(o.pixel_size, o.flatten),
            precision=o.precision,
            threads=o.threads,
            path=target.path,
        )
