"""World files beside PNGs of what lies on a map."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vorotool.jobs.run_log import Run
    from vorotool.jobs.units import PixelSize
    from vorotool.render.canvas.layers import Page
    from vorotool.types.pixel_grid import PixelGrid, Transform


def write_world_file(
    run: Run, size: PixelSize | None, page: Page | None, path: str, *, no_clobber: bool, inputs: Sequence[str]
) -> None:
    """Write the world file of a PNG whose pixels have places on a map; others have none."""
    transform = _transform(run, size, page)
    if transform is None:
        return
    from vorotool.formats.images.world_file import world_text
    from vorotool.formats.io.atomic_output import open_output
    from vorotool.formats.io.descriptors import stream_kind

    if path == "-" or stream_kind(path) is not None:
        return
    with open_output(str(Path(path).with_suffix(".pgw")), no_clobber=no_clobber, inputs=inputs) as out:
        out.write(world_text(transform))


def _transform(run: Run, size: PixelSize | None, page: Page | None) -> Transform | None:
    grid = run.grid if run.grid is not None and run.grid.transform is not None else None
    if page is None:
        return None if grid is None else grid.transform
    if grid is None:
        return _of_page(page, lambda xy: xy) if run.has_crs else None
    return _of_page(page, _to_map(size, grid))


def _to_map(size: PixelSize | None, grid: PixelGrid) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """From coordinates of an image, as they are drawn, to the map."""
    if size is not None and size.origin is not None:
        origin, factor = np.asarray(size.origin), float(size.factor)
        return lambda xy: xy * factor + origin
    assert grid.transform is not None
    a, b, c, d, e, f = grid.transform
    return lambda xy: (xy + 0.5) @ np.array([[a, d], [b, e]]) + (c, f)


def _of_page(page: Page, to_map: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> Transform | None:
    """From columns and rows of corners of a page to the map."""
    left, low, right, high = page.bounds
    if not (right > left and high > low):
        return None
    corner, opposite = page.place(np.array([[left, low], [right, high]]))
    scale = (opposite - corner) / (right - left, high - low)
    begin, across, down = to_map((np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) - corner) / scale + (left, low))
    (a, d), (b, e) = across - begin, down - begin
    return (a, b, float(begin[0]), d, e, float(begin[1])) if a * e != b * d else None
