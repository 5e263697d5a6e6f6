"""Files beside the input, in its coordinates: what states another unit is converted, what states none is as it is."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from vorotool.errors import InputError, Kind, Message
from vorotool.formats.io.sources import reading
from vorotool.jobs.pixel_sizes import side_of_pixel, unit_of_grid
from vorotool.types.values import counted

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.jobs.options import Options
    from vorotool.jobs.run_log import Run
    from vorotool.numeric.length_units import InputUnit
    from vorotool.types.pixels import PixelGrid
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.polygons.polygon_set import PolygonSet

Data = TypeVar("Data", "PointSet", "PolygonSet")


def side_of_backdrop(run: Run, o: Options, grid: PixelGrid | None) -> float:
    """Return the side of a pixel of ``--overlay`` in the coordinates of points, lines and polygons drawn over it."""
    from vorotool.numeric.length_units import ratio

    unit = run.coordinates
    if unit is None:
        return 1.0
    pixel = side_of_pixel(grid)
    found = None if pixel is None or (grid is not None and grid.transform is not None) else ratio(pixel.unit, unit.unit)
    if pixel is None or found is None:
        run.note(f"{o.overlay} states no pixel size: its pixels are assumed to be the coordinates")
        return 1.0
    return float(pixel.side * found / unit.side)


def unit_of_image(o: Options, grid: PixelGrid | None) -> InputUnit | None:
    """Return what 1 is in the coordinates that files beside an image are in: those of its map, else pixels."""
    from vorotool.numeric.length_units import InputUnit

    size = o.pixel_size
    is_of_map = size is not None and (size.origin is not None or size.sides is not None)
    if size is not None and size.unit is not None:
        return InputUnit(size.unit, Fraction(1) if is_of_map else size.factor)
    if is_of_map:
        return None if grid is None else unit_of_grid(grid)
    return side_of_pixel(grid)


def in_first_unit(
    run: Run,
    o: Options,
    second: tuple[str, PolygonSet],
    first: tuple[str, InputUnit | None],
    *,
    pixels: bool = False,
    crs: Any = None,
) -> PolygonSet:
    """Return polygons in the coordinates of the input, which may have a system, by the units that both state."""
    (path, value), (source, unit) = second, first
    if value.crs is not None:
        return value
    from vorotool.numeric.length_units import ratio, unit_of

    own = unit_of(value)
    if own is None:
        if pixels or (unit is not None and crs is None):  # of systems `in_one_crs` speaks
            what = "pixels" if pixels else "those"
            run.note(f"{path} states no unit: its coordinates are assumed to be {what} of {source}")
        return value
    found = None if unit is None else ratio(own.unit, unit.unit)
    if unit is None or found is None:
        text = f"{path} is in {own.text}, but the unit of {source} is unknown: the numbers are used as they are"
        if o.strict:
            raise InputError(f"{text}; state it with --pixel-size, or leave out --strict")
        run.warn(text)
        return value
    factor = found * own.side / unit.side
    return value if factor == 1 else replace(value, xy=times(value.xy, factor), unit=None)


def times(xy: NDArray[np.float64], factor: Fraction) -> NDArray[np.float64]:
    """Multiply by a ratio, with one rounding where it is a whole number or one over such."""
    if factor.denominator == 1 or factor.numerator == 1:
        return xy * float(factor.numerator) / float(factor.denominator)
    return xy * float(factor)


# ---- what results are cut by
class First(NamedTuple):
    """The input that a second file goes with."""

    name: str
    data: Any  # points, or polygons and lines
    unit: InputUnit | None  # of its coordinates
    is_image: bool = False
    crs: Any = None  # of an image


def read_cut(run: Run, o: Options, option: str, path: str, first: First) -> tuple[Any, PolygonSet]:
    """Read polygons and lines that results are cut by; return the input in one system with them, and them in pixels.

    Lines are left out of ``--clip``, with a note.
    """
    from vorotool.types.polygons.shapely_geometry import RingArrays

    with reading(path):  # messages name the file
        value, size, data = _read(run, o, option, path), o.pixel_size, first.data
        is_of_map = size is not None and (size.origin is not None or size.sides is not None)
        if first.is_image:
            if first.crs is not None and value.crs is not None:
                warp = "reproject the polygons to the system of the image: ogr2ogr -t_srs {} clip.gpkg {}"
                _require_same(path, value.crs, first.name, first.crs, warp)
            value = in_first_unit(run, o, (path, value), (first.name, first.unit), pixels=not is_of_map)
        else:
            value = in_first_unit(run, o, (path, value), (first.name, first.unit), crs=data.crs)
            data = in_one_crs(run, (path, value), (first.name, data))
        if option == "--clip":
            chosen = _polygons_among(run, path, value)
            value = RingArrays.of(value).taken(chosen)[0].polygons(value, chosen)
    if size is not None and is_of_map:
        value = replace(value, xy=(value.xy - (size.origin or (0.0, 0.0))) / float(size.factor))
    return data, value


def _read(run: Run, o: Options, option: str, path: str) -> PolygonSet:
    """Read polygons and lines, brought into the system of ``--crs`` if they are in another."""
    from vorotool.formats import read
    from vorotool.formats.parsing.reader_options import ReadOptions, with_crs
    from vorotool.numeric.crs import crs_member
    from vorotool.types.polygons.polygon_set import PolygonSet

    def note(message: str) -> None:  # but what is said of the data, or of both together
        if Message.of(message).kind not in (Kind.DEGREES, Kind.UNNAMED_CRS):
            run.note(message)

    value = read(path, geometry="polygons", threads=o.threads, note=note)
    if not isinstance(value, PolygonSet):
        raise InputError(f"{path} is an image, but {option} needs a file of polygons")
    if o.crs is not None and value.crs is not None:
        value = with_crs(value, path, ReadOptions(to_crs=crs_member(o.crs)))
    return value


def _polygons_among(run: Run, path: str, value: PolygonSet) -> NDArray[np.int64]:
    """Return which are polygons."""
    import numpy as np

    lines = int(value.is_line.sum())
    if lines:
        run.note(f"{path}: {counted(lines, 'open line')} of --clip skipped")
    if lines == len(value):
        raise InputError(f"{path} holds no polygons, which --clip needs: name another file")
    return np.flatnonzero(~value.is_line)


def in_one_crs(run: Run, cut: tuple[str, PointSet | PolygonSet], data: tuple[str, Data]) -> Data:
    """Check that a second file and data are in one coordinate reference system, as far as they name any."""
    from vorotool.formats.parsing.reader_options import declared_in
    from vorotool.numeric.crs import crs_name, note_degrees

    (path, polygons), (source, value) = cut, data
    if value.crs is None and polygons.crs is None:
        return value
    if value.crs is None or polygons.crs is None:
        unnamed, named, crs = (source, path, polygons.crs) if value.crs is None else (path, source, value.crs)
        _check_they_meet(value, polygons, f"{unnamed} states no coordinate reference system", f"{named} is in", crs)
        run.note(f"{unnamed} states no coordinate reference system: {crs_name(crs)} is assumed, as in {named}")
        if value.crs is None:
            value = declared_in(value, source, crs)
            note_degrees(value, source, run.note)
        return value
    advice = "reproject them to one system with --crs {0}, or ogr2ogr -t_srs {0}"
    _require_same(path, polygons.crs, source, value.crs, advice)
    return value


def _require_same(path: str, crs: Any, source: str, wanted: Any, advice: str) -> None:
    """Refuse polygons in another coordinate reference system than the sites."""
    from vorotool.numeric.crs import crs_name, same_crs

    if not same_crs(wanted, crs):
        name = crs_name(wanted)
        raise InputError(f"{path} is in {crs_name(crs)}, but {source} in {name}: {advice.format(name, path)}")


def _check_they_meet(
    data: PointSet | PolygonSet, polygons: PointSet | PolygonSet, unnamed: str, named: str, crs: Any
) -> None:
    """Refuse to take what lies elsewhere to be in the same system."""
    from vorotool.numeric.crs import crs_name
    from vorotool.types.box import bounds

    if not len(data.xy) or not len(polygons.xy):
        return
    (low_a, high_a), (low_b, high_b) = bounds(data.xy), bounds(polygons.xy)
    if (low_a > high_b).any() or (low_b > high_a).any():
        raise InputError(
            f"{unnamed}, {named} {crs_name(crs)}, and they do not meet: reproject them to one system that both state, "
            "for example with ogr2ogr -t_srs, or name that of the input with --input-crs"
        )
