"""The input of a command: read, named in messages, and options that do not fit it refused."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from vorotool.errors import InputError, Kind, Message, UsageError
from vorotool.jobs.masks import settled_foreground
from vorotool.jobs.options import (
    ComputingOptions,
    JobOptions,
    SiteOptions,
    ShapeOptions,
    TessellationOptions,
    TriangulationOptions,
)
from vorotool.jobs.run_log import Run

if TYPE_CHECKING:
    from vorotool.engines.tessellation.seeding import SeedMode
    from vorotool.formats.opening import Opened
    from vorotool.geometry.pixel_frame import Frame
    from vorotool.geometry.points.point_set import PointSet
    from vorotool.geometry.points.raster import Raster
    from vorotool.geometry.points.seed_set import SeedSet
    from vorotool.geometry.polygons.polygon_set import PolygonSet
    from vorotool.render.canvas.layers import Backdrop


class JobInput(NamedTuple):
    """What one job is about.

    Parameters
    ----------
    path : str
        The input; ``-`` is standard input.
    backdrop : Backdrop, optional
        The image that pictures of it are drawn over.
    has_units : bool
        An output has lengths.
    has_page : bool
        An output is a page of HTML, which shows columns of the input.
    """

    path: str
    backdrop: Backdrop | None = None
    has_units: bool = False
    has_page: bool = False

    @property
    def name(self) -> str:
        """What messages call it."""
        return "standard input" if self.path == "-" else self.path


def opened_input(o: ComputingOptions, given: JobInput, geometry: str | None) -> AbstractContextManager[Opened]:
    """Open points or polygons, or an image, as the options say; without a geometry any of these."""
    from vorotool.formats.opening import opened

    return opened(given.path, geometry=geometry, input_format=o.input_format, page=o.page, layer=o.input_layer)


def read_opened(
    run: Run,
    o: ComputingOptions,
    given: JobInput,
    source: Opened,
    *,
    columns: str | None = None,
    properties: bool = True,
) -> PointSet | PolygonSet | Raster:
    """Read what is open, whole, as the options say."""
    from vorotool.geometry.points.point_set import PointSet
    from vorotool.geometry.points.raster import Raster
    from vorotool.geometry.polygons.polygon_set import PolygonSet

    value = source.read(
        columns=columns,
        max_pixels=o.max_pixels,
        max_sites=o.max_sites,
        properties=properties and not o.no_properties,
        threads=o.threads,
        note=run.note,
        crs=o.input_crs,
        to_crs=o.crs,
        flatten=o.flatten if isinstance(o, ShapeOptions) else None,
        join_tolerance=o.join_tolerance if isinstance(o, ShapeOptions) else None,
    )
    if not isinstance(value, PointSet | PolygonSet | Raster):  # which is read where no geometry is asked for
        raise InputError(
            f"{given.name} is a result of vorotool, of {type(value).__name__}: points or polygons were due"
        )
    if isinstance(value, Raster):
        note_other_size(run, o, given, value.values.shape)
        return value
    if o.pixel_size is not None and o.pixel_size.is_auto:
        raise UsageError(
            "--pixel-size auto is for images, whose files may say it: give a number and its unit, such as 0.325um"
        )
    if isinstance(o, SiteOptions):
        refuse(o.for_images(), "is for images, but the input is a list of points")
    return value


def check_components(o: SiteOptions) -> None:
    """Refuse ``--connectivity`` where no components are made."""
    if o.connectivity is not None and o.seeds in ("pixels", "labels"):
        raise UsageError(f"--connectivity is for components: leave it out with --seeds {o.seeds}")


def check_frame_options(o: SiteOptions, *, is_digital: bool) -> None:
    """Refuse two frames, and any where nothing is tessellated."""
    if o.size is not None and o.window is not None:
        raise UsageError("give --size or --window, not both")
    if o.window is not None and o.cell_side is None and not all(isinstance(number, int) for number in o.window):
        shown = ",".join(f"{float(number):g}" for number in o.window)
        raise UsageError(f"invalid --window '{shown}': expected four integers X,Y,W,H, such as -10,-10,640,480")
    if not is_digital:
        refuse(o.of_frame(), "is the frame of a tessellation: use --method digital or digital-valid")


def read_sites(run: Run, o: SiteOptions, given: JobInput, *, properties: bool, is_digital: bool) -> PointSet | SeedSet:
    """Read points to triangulate, or find those of an image, as the options say."""
    from vorotool.geometry.points.point_set import PointSet
    from vorotool.geometry.points.raster import Raster

    with opened_input(o, given, "points") as source:
        value = read_opened(run, o, given, source, columns=o.columns, properties=properties)
    if isinstance(value, PointSet):
        return value
    assert isinstance(value, Raster)  # what is asked for is points, or an image
    refuse({"columns": o.columns}, "is for lists of points, but the input is an image")
    refuse(o.of_frame(), "is for lists of points, but the input is an image, which brings its own frame")
    # The sites of objects are their centroids, but their regions are not those of the centroids.
    return seeds_of_image(run, o, value, None if o.seeds == "centroids" and not is_digital else o.seeds)


def seeds_of_image(run: Run, o: SiteOptions, image: Raster, mode: SeedMode | None) -> SeedSet:
    """Find the seeds of an image, as the options say."""
    from vorotool.engines.tessellation.seeding import seeds_from_raster

    image, threshold, invert = settled_foreground(run, o, image)
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


def frame_of(o: SiteOptions, seeds: SeedSet) -> Frame | None:
    """Give the frame that is asked for, else the one that the seeds bring or need; None where there are no seeds."""
    from vorotool.engines.tessellation.frames import default_frame
    from vorotool.geometry.pixel_frame import Frame

    if o.window is not None:
        return Frame(*o.window)
    if o.size is not None:
        return Frame(0, 0, *o.size)
    if not len(seeds) and not seeds.is_empty_image:
        return None
    instead = "delaunay --what cells"
    if isinstance(o, TessellationOptions):
        instead = f"--cell-size C, or {instead}"
    return default_frame(seeds, how="give one with --size WxH or --window X,Y,W,H", instead=instead)


def window_of(o: SiteOptions, seeds: SeedSet) -> tuple[int, int, int, int] | None:
    """Give the same as the engines take it."""
    frame = frame_of(o, seeds)
    return None if frame is None else (frame.x, frame.y, frame.width, frame.height)


def read_clip(
    run: Run, o: TriangulationOptions, path: str, points: PointSet | SeedSet, given: JobInput
) -> tuple[PointSet | SeedSet, Sequence[Any]]:
    """Read the polygons of ``--clip``, as shapely geometry; lines are left out with a note.

    Of polygons and points that name no coordinate reference system, the ones are taken to be in that of the others.

    Returns
    -------
    points : PointSet or SeedSet
        The points, in a system if the polygons are in one.
    polygons : sequence of shapely geometry
        To clip to.

    Raises
    ------
    InputError
        If there are no polygons, or they are in another system than the points.
    """
    from vorotool.formats import read
    from vorotool.formats.parsing.reader_options import ReadOptions
    from vorotool.formats.parsing.reference_systems import with_crs
    from vorotool.geometry.crs import crs_member
    from vorotool.geometry.polygons.conversion import to_shapely
    from vorotool.geometry.polygons.polygon_set import PolygonSet

    value = read(path, geometry="polygons", properties=False, threads=o.threads, note=partial(_note_of_clip, run))
    if not isinstance(value, PolygonSet):
        raise InputError(f"{path} is an image: give --clip a file of polygons")
    if o.crs is not None and value.crs is not None:
        value = with_crs(value, path, ReadOptions(to_crs=crs_member(o.crs)))
    points = _in_one_crs(run, (path, value), (given.name, points))
    lines = int(value.is_line.sum())
    if lines:
        run.note(f"{path}: {lines} open lines are left out of --clip")
    if lines == len(value):
        raise InputError(f"{path} holds no polygons: give --clip a file that does")
    return points, list(to_shapely(value)[~value.is_line])


def _note_of_clip(run: Run, message: str) -> None:
    """Say what the reader noticed, but what is said of the points, or of both together."""
    if Message.of(message).kind not in (Kind.DEGREES, Kind.UNNAMED_CRS):
        run.note(message)


def _in_one_crs(run: Run, clip: tuple[str, PolygonSet], data: tuple[str, PointSet | SeedSet]) -> PointSet | SeedSet:
    """Check that polygons and points are in one coordinate reference system, as far as they name any."""
    from vorotool.formats.parsing.reference_systems import declared_in, note_degrees
    from vorotool.geometry.crs import crs_name
    from vorotool.geometry.points.point_set import PointSet

    (path, polygons), (source, points) = clip, data
    if not isinstance(points, PointSet):
        if points.grid is not None and points.grid.crs is not None and polygons.crs is not None:
            warp = "bring the polygons into that of the image: ogr2ogr -t_srs {} clip.gpkg {}"
            _require_same(path, polygons.crs, source, points.grid.crs, warp)
        return points
    if points.crs is None and polygons.crs is None:
        return points
    if points.crs is None or polygons.crs is None:
        unnamed, named, crs = (source, path, polygons.crs) if points.crs is None else (path, source, points.crs)
        _check_they_meet(points, polygons, f"{unnamed} names no coordinate reference system", f"{named} is in", crs)
        run.note(f"{unnamed} names no coordinate reference system: it is taken to be in {crs_name(crs)}, as {named} is")
        if points.crs is None:
            points = declared_in(points, source, crs)
            note_degrees(points, source, run.note)
        return points
    advice = "bring them into one coordinate reference system: --crs {} does"
    _require_same(path, polygons.crs, source, points.crs, advice)
    return points


def _require_same(path: str, crs: Any, source: str, wanted: Any, advice: str) -> None:
    """Refuse polygons in another coordinate reference system than the sites."""
    from vorotool.geometry.crs import crs_name, same_crs

    if not same_crs(wanted, crs):
        name = crs_name(wanted)
        raise InputError(f"{path} is in {crs_name(crs)}, but {source} in {name}: {advice.format(name, path)}")


def _check_they_meet(points: PointSet, polygons: PolygonSet, unnamed: str, named: str, crs: Any) -> None:
    """Refuse to take what lies elsewhere to be in the same system."""
    from vorotool.geometry.box import bounds
    from vorotool.geometry.crs import crs_name

    if not len(points.xy) or not len(polygons.xy):
        return
    (low_a, high_a), (low_b, high_b) = bounds(points.xy), bounds(polygons.xy)
    if (low_a > high_b).any() or (low_b > high_a).any():
        raise InputError(
            f"{unnamed}, {named} {crs_name(crs)}, and the points lie outside the polygons: bring them into one system "
            "that both name, for example with ogr2ogr -t_srs, or with --input-crs for the points"
        )


def read_backdrop(o: JobOptions) -> Backdrop | None:
    """Read the image of ``--overlay``, if there is one."""
    if o.overlay is None:
        return None
    import io

    from vorotool.formats.images.png_writer import write_png
    from vorotool.formats.images.rgb_reader import read_picture
    from vorotool.formats.io.sources import read_source, reading
    from vorotool.formats.parsing.reader_options import ReadOptions
    from vorotool.formats.recognition import image_source
    from vorotool.render.canvas.layers import Backdrop

    with reading(o.overlay):
        pixels = read_picture(image_source(read_source(o.overlay)), ReadOptions(page=o.page, max_pixels=o.max_pixels))
    height, width = pixels.shape[:2]

    def encode() -> bytes:
        out = io.BytesIO()
        write_png(out, [pixels.reshape(height, 3 * width)], (height, width), rgb=True, threads=o.threads)
        return out.getvalue()

    return Backdrop(pixels, encode)


def note_other_size(run: Run, o: JobOptions, given: JobInput, shape: Sequence[int]) -> None:
    """Say that the image of ``--overlay`` is not of the size of the input, whose pixels are those of the picture."""
    if given.backdrop is None or given.backdrop.pixels.shape[:2] == tuple(shape[:2]):
        return
    height, width = given.backdrop.pixels.shape[:2]
    run.note(
        f"{o.overlay} has {width} x {height} pixels, the input {shape[1]} x {shape[0]}: both begin in one corner, and "
        "what lies beside the overlay is not drawn"
    )


def refuse(options: Mapping[str, Any], reason: str) -> None:
    """Refuse options that are given although they mean nothing here."""
    for name, value in options.items():
        if value is not None and value is not False:  # 0 is given, too
            raise UsageError(f"--{name} {reason}")


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
