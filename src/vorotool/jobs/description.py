"""How a file is read: its format, what it holds, how much, where, and which commands take it."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.batch.inputs import Input, expand_inputs, pages_of
from vorotool.convert.sites import Sites
from vorotool.engines.tessellation.raster_objects import default_objects, foreground_values, numbered_components
from vorotool.errors import BatchError, InputError, Message, UsageError, VorotoolError
from vorotool.formats.io.atomic_output import open_output
from vorotool.formats.io.descriptors import stream_kind
from vorotool.formats.opening import Opened, opened
from vorotool.formats.text.tables import json_text
from vorotool.formats.volumes.opening import open_volume
from vorotool.formats.volumes.source import NpyVolume, ZarrVolume
from vorotool.formats.volumes.tiff_stack import TiffStack
from vorotool.jobs.inputs import check_streams, is_several
from vorotool.jobs.options import ALL_PAGES, Options, changed
from vorotool.jobs.refusals import refuse
from vorotool.jobs.terminal import escaped, tell
from vorotool.numeric.crs import crs_name
from vorotool.numeric.length_units import unit_of
from vorotool.products.inputs import NAMES_WITH, TAKEN_BY, VOLUME_NAMES, VOLUMES_TAKEN_BY, Holds
from vorotool.types.box import bounds
from vorotool.types.fields import UNSTATED
from vorotool.types.images import Raster
from vorotool.types.pixels import PixelGrid
from vorotool.types.points.point_set import PointSet
from vorotool.types.polygons.polygon_set import HOLE, PolygonSet
from vorotool.types.skeleton.offsets import Offsets
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.voronoi.voronoi_map import VoronoiMap

MOST_CHANNELS = 4
"""Values of a pixel of an image: an array whose last axis has no more is one."""

MOST_PIXELS_READ = 2**28
"""Larger images that can be read band by band are told by their headers alone."""

Description = dict[str, Any]
"""What there is to tell, by names, in the order in which it is told; None where a file does not say."""

_TYPES = {bool: "truth", int: "integer", float: "number", str: "text"}


def describe_inputs(options: Options) -> None:
    """Print how each input is read; of several, one that cannot be read ends nothing."""
    named = _named_by(options)
    if not named:
        raise UsageError("no input given: name a file, a folder, or - for standard input")
    check_streams(("the input", each.source) for each in named)
    failed, is_of_pages = 0, options.page == ALL_PAGES
    for each in pages_of(named) if is_of_pages else named:
        chosen = changed(options, page=each.page) if is_of_pages else options
        try:
            told = described(each.path or each.source, chosen) | {"input": each.source}
        except VorotoolError as error:
            if len(named) == 1 or isinstance(error, UsageError):
                raise
            tell(f"error: {error.typed}")
            failed += 1
            continue
        with open_output("-") as out:
            out.write(as_json(told) if options.json else as_text(told))
    if failed:
        raise BatchError(f"{failed} of {len(named)} inputs cannot be read")


def _named_by(options: Options) -> list[Input]:
    """Return files: those given, and those that folders and patterns stand for."""
    named: list[Input] = []
    for name in options.inputs:
        if not is_several(name):
            named.append(Input(name, name))
            continue
        named += expand_inputs(
            [name], extensions=NAMES_WITH[None], follow=options.follow, note=lambda text: tell(f"note: {text}")
        )
    return named


def described(path: str, options: Options) -> Description:
    """Read an input, and tell how."""
    volume = _of_volume(path, options)
    if volume is not None:
        return volume
    notes: list[Message] = []
    with opened(path, geometry=None, input_format=options.input_format, page=options.page) as source:
        told = _of_header(source)
        if told is None:
            told = _of_content(source.fetched(), options, lambda text: notes.append(Message.of(text).typed))
    return {"input": path, **told, "notes": notes}


def _of_volume(path: str, options: Options) -> Description | None:
    """Tell of a stack of images or an array of three axes by its header; None of all else."""
    said = options.input_format
    if options.page is not None or options.columns is not None or stream_kind(path) is not None:
        return None
    if said is not None and said.lower() not in VOLUME_NAMES:
        return None
    try:
        source = open_volume(path, input_format=said)
    except InputError:  # it may be something else
        return None
    depth, height, width = source.shape
    if depth == 1 or (isinstance(source, NpyVolume) and width <= MOST_CHANNELS):
        return None
    grid = source.grid
    return {
        "input": path,
        "format": _FORMAT_OF[type(source)],
        "kind": "volume",
        "slices": depth,
        "width": width,
        "height": height,
        "type": source.dtype.name,
        "voxel_size": None if grid is None else [float(side) for side in reversed(grid.sides)],
        "unit": None if grid is None else grid.unit,
        "commands": list(VOLUMES_TAKEN_BY),
        "notes": [source.note] if source.note else [],
    }


_FORMAT_OF: dict[type, str] = {TiffStack: "tiff", NpyVolume: "npy", ZarrVolume: "zarr"}


def _of_header(source: Opened) -> Description | None:
    """Tell of an image that is too large to look at each pixel; None of all else."""
    rows = source.rows()
    if rows is None or rows.shape[0] * rows.shape[1] <= MOST_PIXELS_READ:
        return None
    height, width = rows.shape
    return {
        "format": "tiff" if source.array is None else "zarr",
        "kind": "image",
        **_of_pixels(width, height, rows.rows(0, 0).dtype, rows.grid),
        "commands": list(TAKEN_BY["image"]),
    }


def _of_content(source: Opened, options: Options, note: Callable[[str], None]) -> Description:
    formats: list[str] = []
    read: Callable[[Opened], Any] = partial(
        Opened.read,
        columns=options.columns,
        max_pixels=options.max_pixels,
        threads=options.threads,
        note=note,
        crs=options.input_crs,
        told=formats.append,
    )
    try:
        value = read(source)
    except InputError:
        value = _mixed(source, read)
        if value is None:
            raise
    told = {"format": formats[0], **_told_of(value, note)}
    if not isinstance(value, Raster):
        refuse(options, ["page"], f"applies to images, but the input holds {told['kind']}")
    if _may_be_a_ring(value, formats[0]):
        note("a plain list of pairs may also be a polygon: skeleton-approx, skeleton-exact and draw read it as one")
    return told


def _mixed(source: Opened, read: Callable[[Opened], Any]) -> Sites | None:
    """Read points among polygons and lines, which one command takes together; None of what cannot be read so either."""
    try:
        value = read(replace(source, geometry="sites"))
    except VorotoolError:
        return None
    return value if isinstance(value, Sites) else None


def _may_be_a_ring(value: object, fmt: str) -> bool:
    """Whether points are a plain list in JSON, which is a ring where polygons are asked for."""
    return (
        isinstance(value, PointSet) and fmt == "json" and value.labels is None and not (value.properties or value.crs)
    )


def _told_of(value: Any, note: Callable[[str], None]) -> Description:
    """Tell what a value holds, how much, where, and which commands take it."""
    if isinstance(value, Raster):
        return _of_image(value, note)
    holder, columns = getattr(value, "polygons", value), value
    xy: Any = getattr(holder, "xy", None)
    taker: Holds
    counts: Description
    if isinstance(value, PointSet):
        taker, kind, counts = "points", "points", {"points": len(value)}
    elif isinstance(value, PolygonSet):
        taker, kind, counts = "polygons", *_of_polygons(value)
    elif isinstance(value, Sites):
        taker, kind, counts = "sites", "points, lines and polygons", _of_sites(value)
    elif isinstance(value, Skeleton):
        taker, kind, columns, xy = "skeleton", "skeleton", value.polygons, value.vertices
        counts = {"arcs": len(value), "nodes": len(value.vertices), "polygons": len(value.polygons)}
    elif isinstance(value, Offsets):
        taker, kind, columns, xy = "offsets", "offset curves", value.polygons, np.concatenate([value.start, value.end])
        distances = sorted(set(np.asarray(value.distance).tolist()))
        counts = {"shapes": len(value), "pieces": len(value.site), "distances": distances}
    else:
        assert isinstance(value, VoronoiMap)  # nothing else is read
        taker, kind, xy = "voronoi", "Voronoi map", value.vertices
        counts = {"cells": len(value), "arcs": len(value.arcs)}
    told = {"kind": kind, **counts, **_of_places(xy, holder)}
    if isinstance(value, PointSet):
        told["has_labels"] = value.labels is not None
    types = {name: _type_of(values) for name, values in columns.properties.items()}
    return {**told, "columns": types, "commands": list(TAKEN_BY[taker])}


def _of_polygons(value: PolygonSet) -> tuple[str, Description]:
    lines = int(value.is_line.sum())
    polygons = len(value) - lines
    kind = " and ".join(name for name, count in (("polygons", polygons), ("lines", lines)) if count)
    features = len(set(value.feature.tolist()))
    counts = {"features": features, "polygons": polygons, "holes": _holes(value), "lines": lines}
    return kind or "polygons", {**counts, "vertices": len(value.xy)}


def _of_sites(value: Sites) -> Description:
    polygons = value.polygons
    sizes = np.diff(polygons.ring_starts)[polygons.polygon_starts[:-1]]
    points = int((polygons.is_line & (sizes == 1)).sum())
    lines = int(polygons.is_line.sum()) - points
    counts = {"features": value.count, "points": points, "polygons": len(polygons) - points - lines}
    return {**counts, "holes": _holes(polygons), "lines": lines}


def _holes(value: PolygonSet) -> int:
    return int((value.ring_kind == HOLE).sum())


def _of_image(value: Raster, note: Callable[[str], None]) -> Description:
    height, width = value.shape
    told = {"kind": "", **_of_pixels(width, height, value.values.dtype, value.grid)}
    commands = list(TAKEN_BY["image"])
    if value.is_color:
        told["channels"] = value.values.shape[2]
    try:
        objects = foreground_values(value, None, invert=False)
        told["kind"] = {"components": "mask", "labels": "label image"}[default_objects(objects, note=note)]
        told["foreground_pixels"] = int(np.count_nonzero(objects))
        is_mask = told["kind"] == "mask"
        told["objects"] = int(numbered_components(objects).max() if is_mask else np.count_nonzero(np.unique(objects)))
    except InputError as error:  # what it says is what there is to know of a picture
        note(error.typed)
        told["kind"] = "picture"
        commands.remove("draw")
    return {**told, "commands": commands}


def _of_pixels(width: int, height: int, kind: Any, grid: PixelGrid | None) -> Description:
    """Size and type of an image, and the size of its pixels where the file says it in a length; dpi are of paper."""
    told = {"width": width, "height": height, "type": np.dtype(kind).name}
    if grid is None or not grid.is_size:
        return {**told, "pixel_size": None, "unit": None}
    told |= {"pixel_size": [float(grid.width), float(grid.height)], "unit": grid.unit}
    if grid.transform is not None:
        a, b, x, c, d, y = grid.transform
        corners = [(a * i + b * j + x, c * i + d * j + y) for i in (0, width) for j in (0, height)]
        low, high = bounds(np.array(corners))
        told |= {"bounds": [*low.tolist(), *high.tolist()], "crs": None if grid.crs is None else crs_name(grid.crs)}
    return told


def _of_places(xy: NDArray[np.float64], value: PointSet | PolygonSet) -> Description:
    low, high = bounds(xy) if len(xy) else (None, None)
    unit = unit_of(value)
    return {
        "bounds": None if low is None or high is None else [*low.tolist(), *high.tolist()],
        "unit": None if unit is None else unit.text,
        "crs": None if value.crs is None else crs_name(value.crs),
        "y": value.y_axis,
    }


def _type_of(values: Collection[Any]) -> str:
    """What the values of a column are that are there."""
    if isinstance(values, np.ndarray):
        values = values.tolist()
    names = {_TYPES.get(type(value)) or _type_in_json(value) for value in values if value is not None}
    if names == {"integer", "number"}:
        return "number"
    return names.pop() if len(names) == 1 else "mixed" if names else "empty"


def _type_in_json(value: Any) -> str:
    """What a value is that is of none of the plain types: numbers in text, days, arrays."""
    return _TYPES.get(type(json.loads(json_text(value))), "other")


def as_json(told: Description) -> bytes:
    """Give it as an object of JSON on one line."""
    return json.dumps(told, separators=(",", ":")).encode() + b"\n"


def as_text(told: Description) -> bytes:
    """Give it as lines for people: what a file does not say is left out."""
    apart = {"input", "notes", *(["unit"] if {"pixel_size", "voxel_size"} & set(told) else [])}
    shown = {name: _words(name, value, told) for name, value in told.items() if name not in apart}
    lines = [f"  {_TITLES.get(name, name):10} {text}" for name, text in shown.items() if text]
    lines += [f"  {'note':10} {text}" for text in told.get("notes", ())]
    title = "standard input" if told["input"] == "-" else told["input"]
    return "\n".join([*map(escaped, (title, *lines)), ""]).encode("utf-8", "surrogateescape")


_TITLES = {
    "pixel_size": "pixel size",
    "voxel_size": "voxel size",
    "has_labels": "labels",
    "foreground_pixels": "foreground",
    "commands": "taken by",
}
_MAY_BE_NONE = ("holes", "lines", "polygons")
"""Counts that are left out where they are 0."""


def _words(name: str, value: Any, told: Description) -> str:
    """What stands behind a title; nothing where there is nothing to tell."""
    if value is None or value is False or value == {} or (value == 0 and name in _MAY_BE_NONE):
        return ""
    return _WORDS[name](value, told) if name in _WORDS else str(value)


def _size(value: list[float], told: Description) -> str:
    sides = " x ".join(dict.fromkeys(map(_number, value)) if len(value) == 2 else map(_number, value))
    return sides if told["unit"] is None else f"{sides} {told['unit']}"


def _number(value: float) -> str:
    return repr(value).removesuffix(".0")


_WORDS: dict[str, Callable[[Any, Description], str]] = {
    "y": lambda value, _: "not stated" if value == UNSTATED else str(value),
    "bounds": lambda value, _: "x {0} to {2}, y {1} to {3}".format(*map(_number, value)),
    "pixel_size": _size,
    "voxel_size": _size,
    "columns": lambda value, _: ", ".join(f"{column} ({kind})" for column, kind in value.items()),
    "has_labels": lambda value, _: "the input's own",
    "foreground_pixels": lambda value, _: f"{value} pixels",
    "distances": lambda value, _: ", ".join(map(_number, value)),
    "commands": lambda value, _: ", ".join(value),
}
"""Words of what is more than a number or a name."""
