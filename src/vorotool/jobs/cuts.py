"""Files of polygons and lines that results are cut by, in the coordinate reference system of the input."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from vorotool.errors import InputError, Kind, Message
from vorotool.jobs.inputs import JobInput
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.second_files import in_first_unit, unit_of_image, unit_of_vectors

if TYPE_CHECKING:
    from vorotool.types.pixel_grid import PixelGrid
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.points.seed_set import SeedSet
    from vorotool.types.polygons.polygon_set import PolygonSet

Data = TypeVar("Data", "PointSet", "PolygonSet")


def read_clip(
    run: Run, o: Options, path: str, points: PointSet | SeedSet, given: JobInput
) -> tuple[PointSet | SeedSet, Sequence[Any]]:
    """Read the polygons of ``--clip``, as shapely geometry; lines are left out with a note."""
    from vorotool.types.points.point_set import PointSet
    from vorotool.types.polygons.conversion import to_shapely

    value = read_cut(run, o, "--clip", path)
    if isinstance(points, PointSet):
        value = in_first_unit(run, o, (path, value), (given.name, unit_of_vectors(o, points)), crs=points.crs)
        points = in_one_crs(run, (path, value), (given.name, points))
    else:
        check_image_crs((path, value), given.name, None if points.grid is None else points.grid.crs)
        value = in_unit_of_image(run, o, (path, value), given, points.grid)
    return points, list(to_shapely(value)[polygons_among(run, path, value)])


def in_unit_of_image(
    run: Run, o: Options, cut: tuple[str, PolygonSet], given: JobInput, grid: PixelGrid | None
) -> PolygonSet:
    """Give polygons in pixels, or on the map where results are."""
    size = o.pixel_size
    is_of_map = size is not None and (size.origin is not None or size.sides is not None)
    return in_first_unit(run, o, cut, (given.name, unit_of_image(o, grid)), pixels=not is_of_map)


def read_cut(run: Run, o: Options, option: str, path: str) -> PolygonSet:
    """Read the polygons and lines of an option, brought into the system of ``--crs`` if they are in another."""
    from vorotool.formats import read
    from vorotool.formats.parsing.reader_options import ReadOptions
    from vorotool.formats.parsing.reference_systems import with_crs
    from vorotool.numeric.crs import crs_member
    from vorotool.types.polygons.polygon_set import PolygonSet

    value = read(path, geometry="polygons", threads=o.threads, note=partial(_note_of_cut, run))
    if not isinstance(value, PolygonSet):
        raise InputError(f"{path} is an image: give {option} a file of polygons")
    if o.crs is not None and value.crs is not None:
        value = with_crs(value, path, ReadOptions(to_crs=crs_member(o.crs)))
    return value


def polygons_among(run: Run, path: str, value: PolygonSet) -> Any:
    """Tell which are polygons: lines are left out of ``--clip``, with a note."""
    lines = int(value.is_line.sum())
    if lines:
        run.note(f"{path}: {lines} open lines are left out of --clip")
    if lines == len(value):
        raise InputError(f"{path} holds no polygons: give --clip a file that does")
    return ~value.is_line


def _note_of_cut(run: Run, message: str) -> None:
    """Say what the reader noticed, but what is said of the data, or of both together."""
    if Message.of(message).kind not in (Kind.DEGREES, Kind.UNNAMED_CRS):
        run.note(message)


def check_image_crs(cut: tuple[str, PolygonSet], source: str, crs: Any) -> None:
    """Check that polygons are in the coordinate reference system of an image, as far as both name any."""
    path, polygons = cut
    if crs is not None and polygons.crs is not None:
        warp = "bring the polygons into that of the image: ogr2ogr -t_srs {} clip.gpkg {}"
        _require_same(path, polygons.crs, source, crs, warp)


def in_one_crs(run: Run, cut: tuple[str, PointSet | PolygonSet], data: tuple[str, Data]) -> Data:
    """Check that a second file and data are in one coordinate reference system, as far as they name any."""
    from vorotool.formats.parsing.reference_systems import declared_in
    from vorotool.numeric.crs import crs_name
    from vorotool.numeric.degrees import note_degrees

    (path, polygons), (source, value) = cut, data
    if value.crs is None and polygons.crs is None:
        return value
    if value.crs is None or polygons.crs is None:
        unnamed, named, crs = (source, path, polygons.crs) if value.crs is None else (path, source, value.crs)
        _check_they_meet(value, polygons, f"{unnamed} names no coordinate reference system", f"{named} is in", crs)
        run.note(f"{unnamed} names no coordinate reference system: it is taken to be in {crs_name(crs)}, as {named} is")
        if value.crs is None:
            value = declared_in(value, source, crs)
            note_degrees(value, source, run.note)
        return value
    advice = "bring them into one coordinate reference system: --crs {0}, or ogr2ogr -t_srs {0}, does"
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
            f"{unnamed}, {named} {crs_name(crs)}, and they do not meet: bring them into one system that both name, "
            "for example with ogr2ogr -t_srs, or with --input-crs for the input"
        )
