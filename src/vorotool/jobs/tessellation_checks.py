"""Options of ``tessellate`` that fit images, or volumes."""

from __future__ import annotations

from collections.abc import Sequence

from vorotool.errors import UsageError
from vorotool.jobs.options import Options
from vorotool.jobs.targets import Target
from vorotool.jobs.units import known_length


def check(o: Options, _targets: Sequence[Target]) -> None:
    """Refuse sizes without a depth for a volume, those with one for an image, and cells of no size."""
    depth = 3 if o.is_of_volumes else 2
    for name, sides in (("--size", o.size), ("--chunk", o.chunk)):
        if sides is not None and len(sides) != depth:
            shown = "x".join(map(str, sides))
            form = "WxHxD for a volume, such as 256x256x64" if depth == 3 else "WxH for an image, such as 2048x512"
            raise UsageError(f"{name} {shown} has {len(sides)} numbers: give {name} {form}")
    if o.window is not None and len(o.window) != 2 * depth:
        raise UsageError("--window has four numbers: give six for a volume, X,Y,Z,W,H,D")
    side = known_length(o.cell_size)
    if side is not None and not 1e-100 < side < 1e100:
        raise UsageError("--cell-size must be more than 0, and at most 1e100")
