"""Reading Zarr arrays chunk by chunk, and OME-Zarr (NGFF 0.4 and 0.5): which array of a group is the full image."""

from __future__ import annotations

import json
import math
import os
import stat
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.arrays import plain_values
from vorotool.formats.io.sources import StoredParts, decoding
from vorotool.formats.zarr.metadata import (
    ZarrMetadata,
    array_metadata,
    overlap,
    places_within,
    read_json,
    read_metadata,
)
from vorotool.formats.zarr.store import is_array, is_group
from vorotool.frozen import frozen
from vorotool.numeric.parallel import in_order

_WORTH_THREADS = 2**20
"""Bytes from which threads take less time than they cost."""

_MANY_CHUNKS = 2**16
"""Where there may be more, those that are stored are listed, and no others looked for."""

_MOST_DIGITS = 19


class StoredArray:
    """An array in a folder, of format 2 or 3; its values are read when they are asked for."""

    def __init__(self, name: str, path: str | os.PathLike[str]) -> None:
        made = read_metadata(path)
        if made is None or made.get("node_type") != "array":
            raise InputError(f"{name} holds no Zarr array")
        self.folder = Path(path)
        self.metadata: ZarrMetadata = array_metadata(name, made)
        self._stored: dict[int, list[tuple[int, ...]]] | None = None  # places by rows of chunks, when they are listed

    @property
    def shape(self) -> tuple[int, ...]:
        """Length of each axis."""
        return self.metadata.shape

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the values, in the order of bytes of this machine."""
        return self.metadata.pipeline.dtype.newbyteorder("=")

    def read(self, region: tuple[slice, ...], *, threads: int = 0) -> NDArray[Any]:
        """Read a region: each slice has a start and a stop within its axis."""
        chunk = self.metadata.pipeline.shape
        if self._stored is None and self._places > _MANY_CHUNKS:
            self._stored = self._listed()
        places = places_within(region, chunk) if self._stored is None else self._stored_within(region)
        result = np.empty([part.stop - part.start for part in region], self.dtype)
        if self._stored is not None:
            result[...] = self.metadata.pipeline.fill

        def put(place: tuple[int, ...]) -> None:
            target, source = overlap(region, place, chunk)
            data = self._chunk(place)
            if data is None:
                result[target] = self.metadata.pipeline.fill
            else:
                result[target] = self.metadata.pipeline.decoded(data, source)

        for _ in in_order(put, places, 1 if result.nbytes < _WORTH_THREADS else threads):
            pass
        return result

    @property
    def _places(self) -> int:
        """How many chunks there may be."""
        return math.prod(-(-side // part) for side, part in zip(self.shape, self.metadata.chunks, strict=True))

    def _chunk(self, place: tuple[int, ...]) -> bytes | None:
        """Read the bytes of a chunk; None if it is left out."""
        key, most = self.metadata.key(place), self.metadata.pipeline.most_bytes
        path = self.folder / key
        try:
            status = path.stat()
        except FileNotFoundError:
            if self._stored is None:
                self._stored = self._listed()
            return None
        if not stat.S_ISREG(status.st_mode) or status.st_size > most:
            raise ValueError(f"chunk {key} is not a file of at most {most} bytes")
        return path.read_bytes()

    def _stored_within(self, region: tuple[slice, ...]) -> Iterator[tuple[int, ...]]:
        """Go through the places of the chunks that are stored and have some of a region."""
        limits = [
            (part.start // side, -(-part.stop // side)) for part, side in zip(region, self.metadata.chunks, strict=True)
        ]
        stored = self._stored or {}
        first, end = limits[0]
        for row in range(first, end) if end - first < len(stored) else sorted(stored):
            for place in stored.get(row, ()):
                if all(low <= number < high for number, (low, high) in zip(place, limits, strict=True)):
                    yield place

    def _listed(self) -> dict[int, list[tuple[int, ...]]]:
        """List the places of the chunks that are stored, by their rows."""
        within, start = os.path.split(self.metadata.prefix)
        places: dict[int, list[tuple[int, ...]]] = {}
        for place in _numbers_below(self.folder / within, start, self.metadata.separator, len(self.shape)):
            places.setdefault(place[0], []).append(place)
        return places


# ---- images and volumes --------------------------------------------------------------------------
@frozen
class ZarrImage(StoredParts):
    """An image or a volume in a store: an array, or the largest one that a group of OME-Zarr describes."""

    @cached_property
    def described(self) -> Described | None:
        """What a group of OME-Zarr says of its image."""
        return None if is_array(self.path) or not is_group(self.path) else largest_image(self.name, self.path)

    @property
    def note(self) -> str:
        """Where else there are labels."""
        found = [] if self.described is None else label_images(self.path)
        return f"{self.name} has label images: {self.name.rstrip(os.sep)}/labels/{found[0]} names one" if found else ""

    def opened(self) -> StoredArray:
        """Open the array."""
        path = Path(self.path)
        if self.described is not None:
            path = path.joinpath(*self.described.path.split("/"))
        elif not is_array(path):
            self._refuse()
        with decoding(self.name, "Zarr"):
            return StoredArray(self.name, path)

    def _refuse(self) -> None:
        """Say what is there instead of an array."""
        if is_group(self.path):
            example = f"{self.name.rstrip(os.sep)}/0"
            raise InputError(f"{self.name} is a Zarr group: name an array in it, such as {example}")
        try:
            read_metadata(self.path)
        except InputError as error:
            raise InputError(f"{self.name} holds no Zarr array: {error.marked}") from None
        raise InputError(f"{self.name} holds no Zarr array: the folder of an array has a zarr.json or .zarray")

    def read(self, array: StoredArray, *last: slice) -> NDArray[Any]:
        """Read a part of the last axes, where the others have one step each; bool becomes uint8."""
        with decoding(self.name, "Zarr"):
            leading = [slice(0, 1)] * (len(array.shape) - len(last))
            read = array.read((*leading, *last))
            return plain_values(read.reshape(read.shape[-len(last) :]))


def _numbers_below(folder: Path, start: str, separator: str, axes: int) -> Iterator[tuple[int, ...]]:
    """Read the names in a folder of chunks, and in those within, as places of so many axes."""
    try:
        with os.scandir(folder) as entries:
            names = [(entry.name, entry.is_dir()) for entry in entries]
    except FileNotFoundError:
        return
    for name, is_folder in names:
        parts = name.removeprefix(start).split(separator)
        if not all(part.isascii() and part.isdigit() and len(part) <= _MOST_DIGITS for part in parts):
            continue
        numbers = tuple(map(int, parts))
        if len(numbers) == axes:
            yield numbers
        elif len(numbers) < axes and is_folder:
            yield from (numbers + more for more in _numbers_below(folder / name, "", separator, axes - len(numbers)))


VERSION = "0.5"
"""Of the metadata that are written."""

OME_ENDING = ".ome.zarr"
"""Names with it are written as OME-Zarr; other stores are plain arrays."""

DECIMATED = {"method": "vorotool: every second voxel along each axis"}
"""How coarser images are made, as their metadata have it."""

_PLANE = ["y", "x"]
_MOST_AXES, _MOST_CHANGES = 16, 16
"""Axes of an image, and transformations of one: OME-Zarr has at most five and four."""

_LONG_UNITS = {"pm": "picometer", "nm": "nanometer", "µm": "micrometer", "mm": "millimeter", "cm": "centimeter"}
_LONG_UNITS |= {"m": "meter", "km": "kilometer", "Å": "angstrom", "inch": "inch", "ft": "foot"}


@frozen
class Described:
    """What the metadata of a group say of the largest image in it."""

    path: str  # of its array, from the group
    axes: tuple[str, ...]  # names of the axes
    scale: tuple[Fraction, ...]  # the products of all scales, one for each axis
    units: tuple[Any, ...]  # of the axes: anything, None where there is none


def largest_image(name: str, folder: str) -> Described | None:
    """Read what an OME-Zarr group says of its image, whatever its axes; None if the group is none."""
    about = _ome_attributes(folder)
    scales = about.get("multiscales")
    if not scales:
        return None
    try:
        first = scales[0]
        dataset, axes = (
            first["datasets"][0],
            tuple(str(axis["name"] if isinstance(axis, dict) else axis) for axis in first["axes"]),
        )
        path = str(dataset["path"])
        changes = [*dataset.get("coordinateTransformations", ()), *first.get("coordinateTransformations", ())]
        units = tuple(axis.get("unit") if isinstance(axis, dict) else None for axis in first["axes"])
        found = Described(path, axes, _scale(len(axes), changes), units)
    except (AttributeError, KeyError, TypeError, ValueError, IndexError):
        raise InputError(
            f"{name}: its multiscales are not metadata of OME-Zarr 0.4 or 0.5; name an array in it"
        ) from None
    place = PurePosixPath(path)
    if place.is_absolute() or ".." in place.parts or not place.parts or "\\" in path or "\0" in path:
        raise InputError(f"{name}: its image is {path!r}, which is not in the store")
    return found


def label_images(folder: str) -> list[str]:
    """Names of the label images that belong to an image of OME-Zarr."""
    try:
        about = _ome_attributes(str(Path(folder) / "labels"))
    except InputError:
        return []
    found = about.get("labels")
    return [str(each) for each in found] if isinstance(found, list) else []


def _ome_attributes(folder: str) -> dict[str, Any]:
    """Attributes of a group, of format 2 or 3, as far as they are about OME-Zarr."""
    made = read_metadata(folder) or {}
    if made.get("node_type") != "group":
        return {}
    attributes = made.get("attributes")
    if made.get("zarr_format") == 2:
        file = Path(folder) / ".zattrs"
        attributes = read_json(file) if file.is_file() else {}
    if not isinstance(attributes, dict):
        return {}
    inner = attributes.get("ome")
    return inner if isinstance(inner, dict) else attributes


def _scale(axes: int, changes: list[dict[str, Any]]) -> tuple[Fraction, ...]:
    """Multiply all scales."""
    if axes > _MOST_AXES or len(changes) > _MOST_CHANGES:
        raise ValueError("the exact product would have very many digits")
    sides = [Fraction(1)] * axes
    for change in changes:
        if change.get("type") == "scale":
            factors = [Fraction(repr(float(factor))) for factor in change["scale"][-axes:]]
            if len(factors) < len(_PLANE):
                raise ValueError("a plane has two")
            for axis, factor in enumerate(factors, axes - len(factors)):
                sides[axis] *= factor
    return tuple(sides)


def has_long_name(unit: str | None) -> bool:
    """Return whether OME-Zarr knows a unit."""
    return unit in _LONG_UNITS


def write_image(folder: Path, name: str, scale: Mapping[str, float], unit: str | None, *, is_labels: bool) -> None:
    """Write the metadata of a group whose array ``0`` is an image."""
    told = {"unit": _LONG_UNITS[unit]} if unit in _LONG_UNITS else {}
    axes = [{"name": axis, "type": "space", **told} for axis in scale]
    datasets = [_dataset(0, list(scale.values()))]
    ome: dict[str, Any] = {"version": VERSION, "multiscales": [{"name": name, "axes": axes, "datasets": datasets}]}
    if is_labels:
        ome["image-label"] = {}
    _write_metadata(folder, {"zarr_format": 3, "node_type": "group", "attributes": {"ome": ome}})


def add_scales(folder: Path, factors: Sequence[Sequence[int]]) -> None:
    """Say of a group whose metadata `write_image` wrote that there are coarser images, too."""
    made = read_json(folder / "zarr.json")
    image = made["attributes"]["ome"]["multiscales"][0]
    sides = image["datasets"][0]["coordinateTransformations"][0]["scale"]
    for level, each in enumerate(factors, start=1):
        scale = [side * factor for side, factor in zip(sides, each, strict=True)]
        image["datasets"].append(_dataset(level, scale))
    image |= {"type": "decimation", "metadata": DECIMATED}
    _write_metadata(folder, made)


def _dataset(level: int, scale: list[float]) -> dict[str, Any]:
    return {"path": str(level), "coordinateTransformations": [{"type": "scale", "scale": scale}]}


def _write_metadata(folder: Path, made: dict[str, Any]) -> None:
    (folder / "zarr.json").write_text(json.dumps(made, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def is_single_image(folder: Path) -> bool:
    """Whether a folder is what is written here, and nothing else: what may be replaced."""
    try:
        names = {path.name for path in folder.iterdir()}
        scales = _ome_attributes(str(folder)).get("multiscales")
        if not scales or names == {"zarr.json", "0"}:
            return scales is not None and names == {"zarr.json", "0"}
        paths = {str(each["path"]) for each in scales[0]["datasets"]}
        return scales[0].get("metadata") == DECIMATED and names == {"zarr.json", *paths}
    except (OSError, InputError, AttributeError, KeyError, TypeError, IndexError):
        return False
