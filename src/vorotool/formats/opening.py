"""Inputs that are open: read whole, or band by band."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from vorotool.errors import InputError, UsageError
from vorotool.formats.images.band_reader import TiffRows, ZarrRows, open_tiff, open_zarr, read_rows
from vorotool.formats.io.sources import read_source, reading
from vorotool.formats.parsing.reader_options import ReadOptions, no_note
from vorotool.formats.recognition import read_recognised, recognised, refuse_crs
from vorotool.geometry.checks import checked_threads
from vorotool.products.inputs import NAMES_WITH, known_input_format

if TYPE_CHECKING:
    from vorotool.geometry.points.point_set import PointSet
    from vorotool.geometry.points.raster import Raster
    from vorotool.geometry.polygons.polygon_set import PolygonSet
    from vorotool.geometry.skeleton.offsets import Offsets
    from vorotool.geometry.skeleton.skeleton import Skeleton


@contextmanager
def opened(
    path: str | PathLike[str], *, geometry: str | None, input_format: str | None, page: int | None
) -> Iterator[Opened]:
    """Open an input: errors that arise while it is open carry its name.

    Parameters
    ----------
    path, geometry, input_format, page
        As of `vorotool.read`.

    Examples
    --------
    >>> with opened("data/dots.csv", geometry="points", input_format=None, page=None) as source:
    ...     print(len(source.read()), source.rows())
    53 None
    """
    if geometry not in NAMES_WITH:
        raise UsageError(f"invalid geometry {geometry!r}: expected points or polygons, or none")
    said = known_input_format(input_format, NAMES_WITH[geometry])
    if not isinstance(path, str | PathLike):
        raise InputError(f"{path!r} is no path: give the name of a file; arrays need not be read")
    name = fspath(path)
    with reading(name):
        yield Opened(name, geometry, said, page, open_zarr(name, said, page))


@dataclass(frozen=True)
class Opened:
    """An input that is read once, whole or by its rows.

    Parameters
    ----------
    name : str
        The path as the user wrote it; ``-`` is standard input.
    geometry, said, page
        What must be in it, its format and its page, as far as the caller says; as of `read`.
    array : ZarrRows, optional
        The rows of a Zarr array, which is no file.
    """

    name: str
    geometry: str | None
    said: str | None
    page: int | None
    array: ZarrRows | None

    def rows(self) -> ZarrRows | TiffRows | None:
        """Give an image that can be read band by band; None if it is none, or comes through a stream."""
        return self.array or open_tiff(self.name, self.said, self.page)

    def read(
        self, *, threads: int = 0, note: Callable[[str], None] | None = None, crs: str | None = None, **options: Any
    ) -> PointSet | PolygonSet | Raster | Skeleton | Offsets:
        """Read all, with the options of `vorotool.read` that are not about opening it."""
        declared = None if crs is None else _declared(crs)
        given = ReadOptions(
            page=self.page, threads=checked_threads(threads), note=note or no_note, crs=declared, **options
        )
        if self.array is not None:
            refuse_crs(declared)
            return read_rows(self.array, max_pixels=given.max_pixels, note=given.note)
        holds, source = recognised(read_source(self.name), self.geometry, self.said, given.columns)
        value: PointSet | PolygonSet | Raster | Skeleton | Offsets = read_recognised(holds, source, given)
        return value


def _declared(crs: str) -> dict[str, Any]:
    """Give the ``crs`` member of GeoJSON for a name."""
    from vorotool.geometry.crs import crs_member

    member = crs_member(crs)
    if member is None:
        raise UsageError(f"{crs!r} names no coordinate reference system: write authority and code, such as EPSG:3857")
    return member
