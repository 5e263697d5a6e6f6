"""The input of a command: read, named in messages, and options that do not fit it refused."""

from __future__ import annotations

import os
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from vorotool.errors import InputError, Kind, Message, UsageError
from vorotool.formats.io.descriptors import STANDARD, input_identity
from vorotool.formats.io.sources import file_of
from vorotool.formats.opening import opened
from vorotool.formats.zarr.store import is_folder, is_store
from vorotool.jobs.options import OF_FRAMES, OF_IMAGES, OF_SITES, Measured, Options, changed
from vorotool.jobs.pixel_sizes import (
    lengths_of_image,
    lengths_of_vectors,
    side_of_pixel,
    unit_of_vectors,
    with_pixel_size,
)
from vorotool.jobs.refusals import check_image_size, check_unit, refuse
from vorotool.jobs.run_log import Run
from vorotool.jobs.units import known_length, lengths_in_steps, unit_stats
from vorotool.numeric.length_units import unit_of
from vorotool.products.registry import is_of
from vorotool.types.identity import check_plain, chosen_column

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.engines.tessellation.seeding import SeedMode
    from vorotool.formats.opening import Opened
    from vorotool.jobs.targets import Target
    from vorotool.render.canvas.layers import Backdrop
    from vorotool.types.images import Raster
    from vorotool.types.points.point_set import PointSet, VolumePoints
    from vorotool.types.points.seed_set import SeedSet
    from vorotool.types.polygons.polygon_set import PolygonSet
    from vorotool.types.volumes.volume import VolumeSeeds


class JobInput(NamedTuple):
    """What one job is about."""

    path: str  # the input; `-` is standard input
    backdrop: Backdrop | None = None  # the image that pictures of it are drawn over
    targets: Sequence[Target] = ()  # what is made of it

    @property
    def name(self) -> str:
        """What messages call it."""
        return "standard input" if self.path == "-" else self.path

    @property
    def has_page(self) -> bool:
        """Whether an output is a page of HTML, which shows columns of the input."""
        return any(each.fmt == "html" for each in self.targets)


def read_opened(
    run: Run,
    o: Options,
    given: JobInput,
    source: Opened,
    *,
    columns: str | None = None,
    properties: bool = True,
    wants_unit: bool = False,
    curves_advice: str = "",
) -> tuple[Options, Any]:
    """Read what is open, whole, as the options say: points, polygons or sites, as it was opened, or an image.

    The options that come back have lengths in its coordinates.
    """
    is_auto = o.pixel_size is not None and o.pixel_size.is_auto
    wants_unit = wants_unit or is_auto or bool(o.measured)  # a column may state it
    wants_properties = properties and not o.no_properties
    how: dict[str, Any] = {
        "columns": columns,
        "max_pixels": o.max_pixels,
        "max_sites": o.max_sites,
        "properties": wants_properties or wants_unit,
        "threads": o.threads,
        "crs": o.input_crs,
    }
    if o.flatten is not None or o.join_tolerance is not None:
        source, tolerances = _tolerances(o, source, how)
        how |= tolerances
    value: Any = source.read(note=run.note, to_crs=o.crs, y_up=o.y_up, curves_advice=curves_advice, **how)
    if not is_of(value, "PointSet", "PolygonSet", "Sites", "Raster"):  # which is read where no geometry is asked for
        raise InputError(
            f"{given.name} is a {type(value).__name__}, a result of vorotool, but points or polygons are expected"
        )
    if is_of(value, "Raster"):
        run.reads_image = True
        note_other_size(run, o, given, value.values.shape)
        run.pixel, run.grid = side_of_pixel(value.grid), value.grid
        check_image_size(run, o, given.name, value.grid)
        return lengths_of_image(o, value.grid), value
    if o.command in OF_SITES and not o.sources.keys().isdisjoint(OF_IMAGES):
        refuse(o, OF_IMAGES, "applies to images, but the input is a list of points")
    if o.measured or o.pixel_size is not None:
        o = lengths_of_vectors(o, value)
    shapes = value.polygons if is_of(value, "Sites") else value
    run.crs = shapes.crs
    if o.pixel_size is None:
        run.coordinates = unit_of(value) if shapes.crs is None else None
        run.stats |= {} if run.coordinates is None else {"unit": run.coordinates.unit}
    else:
        check_unit(run, o, given.name, value)
        run.coordinates = unit_of_vectors(o, value, with_system=False)
        run.stats |= unit_stats(o.pixel_size)
    return o, value if wants_properties or not wants_unit else replace(value, properties={})


def _tolerances(o: Options, source: Opened, how: Mapping[str, Any]) -> tuple[Opened, dict[str, Any]]:
    """Give the tolerances of reading as numbers; where these have a unit, a first reading tells that of the input."""
    names = ("flatten", "join_tolerance")
    if any(isinstance(getattr(o, name), Measured) for name in names):
        from vorotool.types.images import Raster

        source = source.fetched()
        first: Any = source.read(**how)
        if not isinstance(first, Raster):
            others: dict[str, Any] = {name: None for name in o.measured if name not in names}
            o = lengths_of_vectors(changed(o, **others), first)
    return source, {name: known_length(getattr(o, name)) for name in names}


def report_no_geometry(run: Run, o: Options, name: str | None = None) -> None:
    """Warn of an input without geometry, or refuse it where `--strict` is given."""
    if o.strict:  # messages of errors begin with the name of the input
        raise InputError("the input holds no geometry: leave out --strict for an empty result")
    name = name or run.source or "the input"
    run.warn(Message(f"{name} holds no geometry: the result is empty", Kind.EMPTY_INPUT, source=name))


def check_streams(named: Iterable[tuple[str, str]]) -> None:
    """Refuse two names of one stream: whoever reads it first leaves nothing for the other."""
    readers: dict[Hashable, str] = {}
    for reader, name in named:
        identity = input_identity(file_of(name))
        if identity is None:
            continue
        if identity in readers:
            raise UsageError(
                f"{reader} {name} and {readers[identity]} are the same stream, which can be read only once: name a "
                "file for one of them"
            )
        readers[identity] = f"{reader} {name}"


def is_several(name: str) -> bool:
    """Return whether a name stands for several inputs: a folder, or a pattern that no file has for a name."""
    is_file = os.path.isfile(name)  # noqa: PTH113 - a small job does without pathlib
    return not is_file and name not in ("", STANDARD) and (is_pattern(name) or is_searched(name))


def is_pattern(name: str) -> bool:
    """Return whether a name is a pattern, and no file has it."""
    return not {*"*?["}.isdisjoint(name) and not os.path.lexists(file_of(name))


def is_searched(path: str | os.PathLike[str]) -> bool:
    """Return whether a path is a folder of inputs: a Zarr store is one input."""
    return is_folder(path) and not is_store(path)


def refuse_several(named: Mapping[str, str]) -> None:
    """Refuse folders and patterns where two files are compared."""
    for name, path in named.items():
        if is_several(path):
            raise UsageError(
                f"{name} {path} stands for several files, but two files are compared: name one file for each"
            )


def read_sites(
    run: Run, o: Options, given: JobInput, *, properties: bool, is_digital: bool
) -> tuple[Options, PointSet | SeedSet]:
    """Read points to triangulate, or find those of an image as they lie on its map, as the options say."""
    with opened(given.path, geometry="points", **o.opening) as source:
        o, value = read_opened(run, o, given, source, columns=o.columns, properties=properties)
    if is_of(value, "PointSet"):
        if not len(value):
            report_no_geometry(run, o)
        return o if o.pixel_size is None else lengths_in_steps(o), value
    refuse(o, ["columns"], "applies to lists of points, but the input is an image")
    refuse(o, OF_FRAMES, "applies to lists of points, but the input is an image, which brings its own frame")
    # The sites of objects are their centroids, but their regions are not those of the centroids.
    seeds = seeds_of_image(run, o, value, None if o.seeds == "centroids" and not is_digital else o.seeds)
    o = with_pixel_size(run, o, given, seeds.grid)
    if o.pixel_size is None:
        return o, seeds
    from vorotool.types.scaling import stretched

    return lengths_in_steps(o), stretched(seeds, 1, -1) if o.pixel_size.y_up else seeds


def read_voxel_points(run: Run, o: Options, given: JobInput, *, properties: bool) -> VolumePoints:
    """Read points in space, as the options say."""
    how: dict[str, Any] = {"input_format": o.input_format, "columns": o.columns}
    is_wanted = properties and not o.no_properties
    return run.call(o, "formats.volumes.opening:read_xyz", given.path, phase=None, properties=is_wanted, **how)


def read_space(run: Run, o: Options, given: JobInput, *, properties: bool) -> VolumePoints:
    """Read points in space to triangulate."""
    with run.phase("read"):
        points = read_voxel_points(run, o, given, properties=properties or o.names_columns)
        check_columns(o, points.properties)
        if not len(points):
            report_no_geometry(run, o)
    return points


def seeds_of_image(run: Run, o: Options, image: Raster, mode: SeedMode | None) -> SeedSet:
    """Find the seeds of an image, as the options say."""
    from vorotool.engines.tessellation.seeding import seeds_from_raster
    from vorotool.jobs.outlined_images import settled_foreground

    image, threshold, invert, _ = settled_foreground(run, o, image)
    return seeds_from_raster(
        image,
        mode=mode,
        connectivity=int(o.connectivity or 8),
        threshold=threshold,
        invert=invert,
        strict=o.strict,
        max_sites=o.max_sites,
        note=run.note,
    )


def frame_of(o: Options, seeds: SeedSet | VolumeSeeds) -> Any:
    """Give the frame that is asked for, else the one that the seeds bring or need; None where there are no seeds."""
    from vorotool.engines.tessellation.frames import default_frame

    asked = asked_frame(o)
    if asked is not None:
        return asked
    if not len(seeds) and seeds.frame is None:
        return None
    instead = "delaunay --what cells"
    if o.command == "tessellate":
        instead = f"--cell-size C, or {instead}"
    form = "WxHxD or --window X,Y,Z,W,H,D" if o.is_of_space else "WxH or --window X,Y,W,H"
    return default_frame(seeds, how=f"give one with --size {form}", instead=instead)


def asked_frame(o: Options) -> Any:
    """Give the frame of --window or --size, if there is one: of pixels, or of voxels."""
    from vorotool.types.pixels import Frame
    from vorotool.types.volumes.volume import VoxelFrame

    numbers = o.window if o.size is None else (*(0 for _ in o.size), *o.size)
    if numbers is None:
        return None
    return Frame(*numbers) if len(numbers) == 4 else VoxelFrame(*numbers)


def report_no_seeds(run: Run, o: Options, frame: object) -> None:
    """Report an input without seeds: the frame is all 0, and has to be given."""
    if frame is None:
        raise InputError("no seeds and no frame: give at least one point, or --size or --window")
    if {"distance", "distance2"} & set(o.what):
        raise InputError("no seeds to measure distances to: give at least one point")
    report_no_geometry(run, o)


def no_seeds(run: Run, o: Options, value: PointSet | PolygonSet) -> SeedSet:
    """Return the seeds of an input without any, with its columns, and the frame that is asked for."""
    import numpy as np

    from vorotool.types.points.seed_set import SeedSet

    frame = asked_frame(o)
    report_no_seeds(run, o, frame)
    nothing = np.empty(0, np.int64)
    area = None if is_of(value, "PointSet") else nothing
    columns = {name: list(column) for name, column in value.properties.items()}
    return SeedSet(nothing, nothing, nothing.astype(np.uint32), frame=frame, properties=columns, object_area=area)


def window_of(o: Options, seeds: SeedSet) -> tuple[int, int, int, int] | None:
    """Give the same as the engines take it."""
    frame = frame_of(o, seeds)
    return None if frame is None else (frame.x, frame.y, frame.width, frame.height)


def read_backdrop(o: Options) -> Backdrop:
    """Read the image of ``--overlay``."""
    import io

    from vorotool.formats.images.png_writer import write_png
    from vorotool.formats.images.reader import picture_and_grid
    from vorotool.formats.io.sources import read_source, reading
    from vorotool.formats.opening import image_source
    from vorotool.formats.parsing.reader_options import ReadOptions
    from vorotool.render.canvas.layers import Backdrop

    with reading(o.overlay):
        options = ReadOptions(page=o.page, max_pixels=o.max_pixels)
        pixels, grid = picture_and_grid(image_source(read_source(o.overlay)), options)
    height, width = pixels.shape[:2]

    def encode() -> bytes:
        out = io.BytesIO()
        write_png(out, [pixels.reshape(height, 3 * width)], (height, width), rgb=True)
        return out.getvalue()

    return Backdrop(pixels, encode, grid=grid)


def note_other_size(run: Run, o: Options, given: JobInput, shape: Sequence[int]) -> None:
    """Say that the image of ``--overlay`` is not of the size of the input, whose pixels are those of the picture."""
    if given.backdrop is None or given.backdrop.pixels.shape[:2] == tuple(shape[:2]):
        return
    height, width = given.backdrop.pixels.shape[:2]
    run.note(
        f"{o.overlay} has {width} x {height} pixels, the input {shape[1]} x {shape[0]}: their first corners coincide, "
        "and parts outside the overlay are not drawn"
    )


def triangulated(run: Run, o: Options, points: Any) -> Any:
    """Triangulate points, and say that labels name groups of points, where they repeat."""
    mesh: Any = run.call(o, "engines.delaunay.delaunay:delaunay", points, phase="triangulate")
    if getattr(points, "labels", None) is not None and mesh.labels is None and len(mesh.points):
        run.note("labels repeat: points are numbered from 1, and label is an ordinary column")
    return mesh


@contextmanager
def naming(given: JobInput) -> Iterator[None]:
    """Let messages about the content of the input begin with its name, unless they name an input already."""
    try:
        yield
    except InputError as error:
        if error.source is not None:
            raise
        named = InputError(f"{given.name}: {error.marked}")
        named.source = given.path
        raise named from error


# ---- columns, and sites that a result does not show ------------------------------------------------
def check_column(label_by: str | None, columns: Mapping[str, Any], option: str = "--label-by") -> None:
    """Refuse a column that the input does not have, or that holds objects."""
    if label_by is not None:
        check_plain(chosen_column(columns, label_by, option), option)


def check_columns(o: Options, columns: Mapping[str, Any]) -> None:
    """Refuse columns that options name and the input does not have."""
    if o.label_by is not None:
        check_column(o.label_by, columns)
    for name in o.with_columns or ():
        chosen_column(columns, name, "--with")


SHOWN = 10
"""Labels of sites that are named."""


def tell_empty_cells(run: Run, labels: NDArray[Any], is_empty: NDArray[np.bool_]) -> None:
    """Name the sites whose cells are empty."""
    if not is_empty.any():
        return
    run.stats["empty_sites"] = labels[is_empty][:SHOWN].tolist()
    if is_empty.all():
        many = f"all {len(labels)} cells are" if len(labels) > 1 else "the only cell is"
        run.warn(Message(f"{many} empty: no site has points in the frame or the clip", Kind.EMPTY_RESULT))
    else:
        run.note(_text(labels, is_empty, "cells", "empty: {} of"))


def tell_outside(run: Run, labels: NDArray[Any], is_outside: NDArray[np.bool_]) -> None:
    """Name the seeds outside the frame, whose regions may reach into it."""
    if is_outside.any():
        run.stats["outside"] = int(is_outside.sum())
        run.note(_text(labels, is_outside, "seeds", "outside the frame:"))


def _text(labels: NDArray[Any], chosen: NDArray[np.bool_], noun: str, what: str) -> str:
    named = labels[chosen]
    shown = ", ".join(map(str, named[:SHOWN].tolist())) + (", …" if len(named) > SHOWN else "")
    is_one = len(named) == 1
    said = what.format("that" if is_one else "those")
    return f"{len(named)} of {len(labels)} {noun} {'is' if is_one else 'are'} {said} site{'s' * (not is_one)} {shown}"
