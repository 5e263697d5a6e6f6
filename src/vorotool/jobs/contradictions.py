"""Sizes of pixels that contradict those that the input states."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from vorotool.errors import InputError
from vorotool.jobs.input_lengths import unit_of_grid
from vorotool.products.registry import PRODUCTS

if TYPE_CHECKING:
    from vorotool.jobs.options import Options
    from vorotool.jobs.run_log import Run
    from vorotool.jobs.targets import Target
    from vorotool.jobs.units import PixelSize
    from vorotool.numeric.input_unit import InputUnit
    from vorotool.types.pixel_grid import PixelGrid
    from vorotool.types.volumes.voxel_frame import VoxelGrid

_WITH_SYSTEM = frozenset({"geojson", "jsonl", "json", "npz", "gpkg", "fgb", "shp", "parquet"})
"""Formats that hold a coordinate reference system."""

ALIKE = Fraction(1, 100)
"""Sides that differ by no more of their length are one: users round them."""


def check_image_size(run: Run, o: Options, name: str, grid: PixelGrid | None) -> None:
    """Warn of a size that contradicts that of an image, or has its sides in another order."""
    unit = None if grid is None or o.pixel_size is None else unit_of_grid(grid)
    if grid is not None and unit is not None:
        own = (unit.side * grid.height, unit.side * grid.width)
        _check(run, o, name, f"pixels of {grid.size_text()}", (unit.unit, own))


def check_system(run: Run, o: Options, targets: Sequence[Target]) -> None:
    """Warn of a size that scales coordinates, which are no longer in their reference system then."""
    size = o.unit
    if size is None or size.is_auto or size.is_spacing or size.factor == 1 or not run.has_crs:
        return
    if any(target.fmt in _WITH_SYSTEM and "geojson" in PRODUCTS[o.command][target.what].written for target in targets):
        text = f"--pixel-size {_text(size)} scales the coordinates: results state no coordinate reference system"
        instead = "leave out --pixel-size for a map"
        if o.strict:
            raise InputError(f"{text}; {instead}")
        run.warn(f"{text}; {instead}")


def check_voxel_size(run: Run, o: Options, name: str, grid: VoxelGrid | None) -> None:
    """Warn of sides that contradict those of a volume, or are in another order."""
    if grid is not None and grid.unit is not None:
        _check(run, o, name, f"voxels of {grid.size_text()}", (grid.unit, grid.sides))


def check_unit(run: Run, o: Options, name: str, unit: InputUnit | None) -> None:
    """Warn of a size that contradicts the unit of the coordinates of points, lines or polygons."""
    if unit is not None:
        _check(run, o, name, f"coordinates in {unit.text}", (unit.unit, (unit.side,) * 2))


def _check(run: Run, o: Options, name: str, has: str, stated: tuple[str, tuple[Fraction, ...]]) -> None:
    from vorotool.numeric.length_units import ratio

    size, (unit, own) = o.pixel_size, stated
    if size is None or size.is_auto or size.unit is None:
        return
    factor = ratio(size.unit, unit)
    if factor is None:
        return
    sides = (size.factor,) * len(own) if size.sides is None else size.sides.lengths
    given = tuple(side * factor for side in sides)
    if len(given) != len(own) or _are_alike(given, own):
        return
    text = f"{size.option} {_text(size)} contradicts {name}, which has {has}"
    if _are_alike(given[::-1], own):
        order = "SX,SY" if len(own) == 2 else "SX,SY,SZ"
        text = f"{text}, perhaps because its sides are not in the order {order}"
    if o.strict:
        raise InputError(f"{text}: leave out {size.option} or --strict")
    run.warn(text)


def _are_alike(sides: tuple[Fraction, ...], own: tuple[Fraction, ...]) -> bool:
    return all(abs(one - other) <= ALIKE * other for one, other in zip(sides, own, strict=True))


def _text(size: PixelSize) -> str:
    sides = [size.factor] if size.sides is None else size.sides.lengths[::-1]
    return ",".join(f"{float(side):.10g}" for side in sides) + (size.unit or "")
