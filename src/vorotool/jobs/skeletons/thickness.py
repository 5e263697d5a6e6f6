"""Local thickness of masks and label images."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from vorotool.engines.from_skeleton.thickness import thickness_of_pixels
from vorotool.jobs.pixel_sizes import written_grid
from vorotool.jobs.skeletons.result import Result
from vorotool.jobs.targets import Target
from vorotool.jobs.units import in_units, length_in_units, sides_of
from vorotool.numeric.progress import Progress
from vorotool.types.skeleton.thickness import ThicknessImage

if TYPE_CHECKING:
    from vorotool.render.canvas.layers import Page


class Thickness(Result):
    """The largest disc over each pixel, of the whole skeleton: discs of what pruning removes cover pixels, too."""

    value: ThicknessImage
    draws_itself = True

    def _make(self) -> ThicknessImage:
        frame, o = self.origin.frame, self.options
        assert frame is not None  # polygons are refused when they are read
        skeleton = self.origin.whole()
        with self.run.phase("thickness") as progress:
            made = thickness_of_pixels(skeleton, frame.shape, sides=self._sides, threads=o.threads, progress=progress)
        return ThicknessImage(made, written_grid(o.pixel_size, self.origin.grid))

    @property
    def _sides(self) -> tuple[float, float]:
        sides = sides_of(self.options)
        return float(sides.y), float(sides.x)

    def verify(self, progress: Progress) -> None:
        """Check some pixels by all arcs, and by the distance from the outlines."""
        from vorotool.engines.from_skeleton.verify_thickness import verify_thickness

        verify_thickness(self.value.values, self.origin.whole(), sides=self._sides, progress=progress)

    def stats(self) -> dict[str, Any]:
        """Summarize the pixels of all objects, in the unit of the results."""
        values = self.value.values[self.value.values > 0]
        found = {"mean": values.mean(), "sd": values.std(), "largest": values.max()} if len(values) else {}
        return {
            "pixels": len(values),
            **{
                f"thickness_{name}": length_in_units(self.options.pixel_size, float(each))
                for name, each in found.items()
            },
        }

    def draw(self, out: BinaryIO, target: Target, page_of: Any) -> None:
        """Draw the pixels in colors from dark, which is thin, to light."""
        from vorotool.formats.images.png_writer import write_png
        from vorotool.render.canvas.layers import Backdrop, ImagePage
        from vorotool.render.label_images.amounts import amount_indices, amount_palette, with_color_bar

        o, size = self.options, self.options.pixel_size
        image: ThicknessImage = in_units(size, self.value)
        page: Page = page_of(ImagePage(Backdrop(np.empty((*image.values.shape, 0), np.uint8), bytes)))
        style, largest = page.style, image.largest
        indices, palette = amount_indices(image.values, largest), amount_palette(style.ground)
        if not style.has_insets:
            has_alpha = style.ground is None
            write_png(
                out, [indices], indices.shape, bit_depth=8, palette=palette, has_alpha=has_alpha, threads=o.threads
            )
            return
        unit = None if size is None else size.unit
        bare = replace(style, has_legend=False)
        pixels = with_color_bar(palette[indices], bare, largest if style.has_legend else 0.0, unit)
        write_png(out, [pixels.reshape(len(pixels), -1)], indices.shape, rgb=True, threads=o.threads)
