"""OME-Zarr (NGFF 0.4 and 0.5): which array of a group is an image at its full size, and how large its pixels are."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path, PurePosixPath
from typing import Any

from vorotool.errors import InputError
from vorotool.formats.zarr.metadata import read_json, read_metadata
from vorotool.plain import plain

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


@plain
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
        dataset, axes = first["datasets"][0], tuple(_axis_name(axis) for axis in first["axes"])
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


def _axis_name(axis: Any) -> str:
    return str(axis["name"] if isinstance(axis, dict) else axis)


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
