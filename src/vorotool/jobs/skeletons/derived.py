"""What follows from a skeleton and its diagram: which results there are, and how they are drawn and checked."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any, BinaryIO

from vorotool.jobs.animations import check_size, layer_pixels, parts_of_whole, write_frames
from vorotool.jobs.pictures import Drawing, drawing_of, write_layers
from vorotool.jobs.skeletons.result import Origin, Result
from vorotool.jobs.targets import Target
from vorotool.numeric.progress import Progress
from vorotool.products.formats import ANIMATIONS, picture_format, resolved
from vorotool.products.registry import DERIVED

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.render.canvas.layers import Backdrop, Page


class Derived:
    """Results that are made when they are asked for."""

    def __init__(self, origin: Origin, backdrop: Backdrop | None, styled: Callable[..., Page]) -> None:
        self.origin, self.backdrop, self._styled = origin, backdrop, styled
        self.options = origin.options
        self._made: dict[str, Result] = {}

    def result(self, what: str) -> Result:
        """Of a name of `DERIVED`."""
        home = DERIVED[what]
        if home not in self._made:
            self._made[home] = resolved(home)(self.origin)
        return self._made[home]

    def value(self, what: str) -> Any:
        """Of a result by its name."""
        return self.result(what).value

    def check(self, target: Target) -> None:
        """Compute a result, and refuse what cannot be written."""
        from vorotool.render.canvas.png import check_picture_size

        self.value(target.what)
        if self.result(target.what).draws_itself:
            return
        if picture_format(target.fmt) == "png":
            page = self._drawing(target.what, "png").page
            check_picture_size(page, self.options.max_pixels)
            if target.fmt in ANIMATIONS:
                check_size(self.origin.exact_options, (page.height, page.width))

    def _drawing(self, what: str, fmt: str, value: Any = None, page: Page | None = None) -> Drawing:
        o = self.options
        return drawing_of(
            self.value(what) if value is None else value,
            what=what,
            layers=o.layers,
            width=o.width or 1000,
            backdrop=self.backdrop,
            styled=partial(self._styled, fmt=fmt) if page is None else lambda _: page,
        )

    def write_picture(self, out: BinaryIO, target: Target) -> None:
        """Draw one result."""
        if target.fmt in ANIMATIONS:
            self._write_animation(out, target.fmt)
            return
        if self.result(target.what).draws_itself:
            self.result(target.what).draw(out, target, self._styled)
            return
        drawing = self._drawing(target.what, target.fmt)
        write_layers(out, drawing.layers, drawing.page, fmt=target.fmt, threads=self.options.threads)

    def _write_animation(self, out: BinaryIO, fmt: str) -> None:
        """Offset curves whose distances grow from nothing, on the page of the last ones."""
        from vorotool.engines.offsets.offsets import offset

        shapes, o, page = self.origin.shapes(), self.origin.exact_options, self._drawing("offset", "png").page

        def draw(part: Fraction) -> NDArray[np.uint8]:
            distances = [float(distance * part) for distance in map(Fraction, o.distance or ())]
            made = offset(shapes, distances, features=o.features, strict=o.strict, threads=o.threads)
            return layer_pixels(self._drawing("offset", "png", made, page).layers, page)

        write_frames(out, self.origin.run, o, fmt, parts_of_whole(o), draw)

    def _wanted(self) -> list[Result]:
        """Results that are asked for, each once."""
        found = {DERIVED[what]: self.result(what) for what in DERIVED if what in self.options.what}
        return list(found.values())

    def verify(self, progress: Progress) -> None:
        """Check what is asked for."""
        for result in self._wanted():
            result.verify(progress)

    def stats(self) -> dict[str, Any]:
        """Counts of what is asked for."""
        return {name: value for result in self._wanted() for name, value in result.stats().items()}
