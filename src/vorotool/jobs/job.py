"""What a command does with one input: the steps that all commands have in common, and their results by name."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, BinaryIO

from vorotool.errors import Kind, LimitError, Message, UsageError
from vorotool.formats.io.atomic_output import open_output, spoken
from vorotool.formats.io.sources import suffix_of
from vorotool.jobs.inputs import JobInput, naming, read_backdrop, refuse_several
from vorotool.jobs.options import Options
from vorotool.jobs.run_log import Run
from vorotool.jobs.targets import Target, check_targets
from vorotool.jobs.units import in_stated_unit, in_units, length_in_units, table_in_units, unit_stats
from vorotool.numeric.parallel import Progress
from vorotool.products.formats import ANIMATIONS, FORMATS, PICTURES, format_named, resolved
from vorotool.products.registry import is_of, write_product
from vorotool.signals import end_by_exceptions

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vorotool.render.canvas.layers import Backdrop, Page
    from vorotool.render.drawing import Picture, Wanted, World


def options_of_line(command: str, given: Mapping[str, Any], sources: Mapping[str, str]) -> Options:
    """Return what a command line asks for, with what follows where options are left out."""
    values = dict(given)
    if command == "distance":
        a, b = values.pop("a"), values.pop("b")
        refuse_several({"A": a, "B": b})
        values |= {"inputs": (a,), "other": b}
        sources = {name: source for name, source in sources.items() if name in values}
    ending = suffix_of(values.get("output") or "")
    if values.get("animate") and values.get("format") is None:
        values["format"] = {"": "gif", ".png": "apng"}.get(ending)
    o = Options(command, sources=sources, **values)
    own = o.products
    if "what" not in sources:
        fmt = format_named(o.format or ending)
        usual = (what for what, each in own.items() if fmt in each.usual_for)
        return Options(command, sources=sources, **{**values, "what": (next(usual, next(iter(own))),)})
    for what in (what for what in o.what if what not in own):
        raise UsageError(f"--what {what} needs points in the plane: with --space use {', '.join(own)}")
    return o


def process_input(run: Run, options: Options, path: str, targets: Sequence[Target]) -> None:
    """Read one input, compute, check and write its results, which take their places together."""
    from vorotool.formats.io.atomic_output import make_folder
    from vorotool.formats.io.temporaries import committed_together
    from vorotool.jobs.refusals import check_system
    from vorotool.numeric.coordinates import writing

    check_targets(options, targets, path)
    with run.phase("read"):
        given = JobInput(path, None if options.overlay is None else read_backdrop(options), targets)
    with naming(given):
        products: Results = resolved(options.job)(run, options, given)
    if run.crs is not None:
        check_system(run, products.options, targets)
    for target in targets:
        products.check(target)
    if options.verify:
        with run.phase("verify") as progress:
            products.verify(progress)
    end_by_exceptions()
    size, deviation = options.unit, 0.0
    unit = None if size is None else run.stats.get("unit") if size.is_auto else size.unit
    stated = unit if size is not None or run.coordinates is None else run.coordinates.unit
    system = run.crs if size is None else getattr(products.options.unit, "crs", None)  # of tables
    how: dict[str, Any] = {
        "decimals": options.decimals,
        "precision": options.precision,
        "threads": options.threads,
        "is_verified": options.verify,
        "columns": options.with_columns,
        "unit": unit,
        "coordinate_unit": stated,
        "is_safe": options.safe_csv,
    }
    in_crs: dict[str, Any] = {}
    with committed_together():
        for target in targets:
            if options.out_dir is not None:
                from pathlib import Path

                make_folder(Path(target.path).parent)
            with run.phase(f"write {target.what}"), writing(**how) as written:
                products.write(target, inputs=(path,))
            deviation = max(deviation, written.deviation)
            if written.system_unread is not None:
                _note_system(run, target, written.system_unread)
            if written.has_y_down:
                _note_y_down(run, target)
            has_places = target.fmt == "wkt" or (target.fmt in ("csv", "tsv") and written.has_places)
            if has_places and (written.crs or system) is not None:
                in_crs[spoken(target.path)] = written.crs or system
    if in_crs:
        _note_no_system(run, in_crs)
    if options.stats is not None:
        with run.phase("count"):
            found = in_stated_unit(products.options.unit, products.stats())
            run.stats.update({**found, **unit_stats(options.unit)})
            if deviation:
                run.stats["deviation"] = deviation


def _note_system(run: Run, target: Target, crs: Any) -> None:
    """Say that readers take JSON lines to be longitude and latitude."""
    from vorotool.numeric.crs import crs_name, is_geographic

    if not is_geographic(crs):
        run.note(
            f"{spoken(target.path)} is in {crs_name(crs)}, but GDAL reads JSON lines as longitude and latitude: give "
            f"GDAL -a_srs {crs_name(crs)}, or write a GeoPackage"
        )


def _note_no_system(run: Run, crs: Mapping[str, Any]) -> None:
    """Say once which files do not state the coordinate reference system that their coordinates are in."""
    from vorotool.numeric.crs import crs_name

    verb, them = ("states", "it") if len(crs) == 1 else ("state", "them")
    name = crs_name(next(iter(crs.values())))
    run.note(f"{', '.join(crs)} {verb} no coordinate reference system: read {them} as {name} (--input-crs)")


def _note_y_down(run: Run, target: Target) -> None:
    """Say what becomes of y in a format whose readers take it to go upwards."""
    if FORMATS[target.fmt].is_map:
        run.note(f"y goes down in {spoken(target.path)}, as in the input: read it with --y-down")
    elif target.fmt == "dxf" and run.reads_image:
        run.note(f"y is negated in {spoken(target.path)}, since it goes up in DXF and down in images")


FRAMES, FPS = 40, 10.0
"""Of animations, where they are not chosen."""

MOST_PIXELS = 1 << 28
"""Of all frames together."""


class Results:
    """What a command makes of one input; each result is computed when it is first asked for."""

    backdrop: Backdrop | None = None
    """The image that pictures are drawn over."""
    read_beside: tuple[str, ...] = ()
    """Further files that are read, which no output replaces."""

    begins_empty = False
    """Animations begin with nothing."""

    def __init__(self, run: Run, options: Options) -> None:
        self.run, self.options = run, options
        self.call: Callable[..., Any] = partial(run.call, options)  # a function of the library, with the options
        self.products = options.products

    # ---- what commands give
    def value(self, what: str) -> Any:
        """Give a result in the coordinates of the input."""
        raise NotImplementedError

    def written(self, what: str, fmt: str) -> Any:
        """Give a result in the units of files."""
        size, value = self.options.pixel_size, self.value(what)
        if size is None:
            return value
        return table_in_units(size, value) if is_of(value, "Table") else in_units(size, value)

    @cached_property
    def world(self) -> World:
        """Where what is drawn lies: in space nowhere, since pictures are as seen from far away."""
        from vorotool.render.drawing import World

        return World()

    def drawing(self, what: str, fmt: str) -> Picture:
        """Prepare the picture of a result."""
        from vorotool.render.drawing import drawing_of

        return drawing_of(self.value(what), self.products[what], self.wanted, fmt)

    def write_page(self, out: BinaryIO) -> None:
        """Write a page of HTML."""
        raise NotImplementedError

    def check_page(self) -> None:
        """Refuse a page that is too large."""

    def emptiness(self, what: str) -> str:
        """Say why a result is empty; nothing of one that is not, or whose emptiness surprises nobody."""
        return ""

    def frames(self, what: str) -> Callable[[Fraction], NDArray[np.uint8]]:
        """Give what draws a result that has grown to a part of the whole."""
        raise NotImplementedError

    def verify(self, progress: Progress) -> None:
        """Check the results by another way."""

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        raise NotImplementedError

    # ---- what is the same for all
    @property
    def wanted(self) -> Wanted:
        """What is wanted of pictures."""
        from vorotool.render.drawing import Wanted

        o = self.options
        return Wanted(o.looks, self.world, o.layers, o.width or 1000, self.backdrop)

    def check(self, target: Target) -> None:
        """Refuse what cannot be written, before anything is."""
        if target.fmt == "png" or target.fmt in ANIMATIONS:
            drawing = self.drawing(target.what, "png")
            drawing.check(self.options.max_pixels)
            if target.fmt in ANIMATIONS:
                from vorotool.render.drawing import Drawing

                assert isinstance(drawing, Drawing)
                self.check_frames(drawing.shape)
        if target.fmt == "html":
            self.check_page()
        if reason := self.emptiness(target.what):
            self.run.warn(Message(f"the result has no {target.what}: {reason}", Kind.EMPTY_RESULT))

    def check_frames(self, shape: tuple[int, int]) -> None:
        """Refuse an animation of more pixels than can be shown."""
        count = self.options.frames or FRAMES
        if count * shape[0] * shape[1] > MOST_PIXELS:
            raise LimitError(
                f"{count} frames of {shape[1]} x {shape[0]} pixels are too many, at most {MOST_PIXELS} pixels: use "
                "fewer --frames, or a smaller --width"
            )

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Write one result."""
        page: Page | None = None
        rules: Any = {"no_clobber": self.options.no_clobber, "inputs": (*inputs, *self.read_beside)}
        if target.fmt == "zarr":
            self.write_store(target, rules)
            return
        with open_output(target.path, binary=not FORMATS[target.fmt].is_text, **rules) as out:
            if target.fmt in PICTURES and self.is_picture(target):
                drawing = self.drawing(target.what, target.fmt)
                drawing.write(out, target.fmt)
                page = drawing.page
            elif target.fmt == "html":
                self.write_page(out)
            elif target.fmt in ANIMATIONS:
                self._write_frames(out, target)
            else:
                self.write_data(out, target)
        if target.fmt == "png":
            from vorotool.jobs.picture_world import write_world_file

            write_world_file(self.run, self.options.unit, page, target.path, **rules)

    def is_picture(self, target: Target) -> bool:
        """Whether a PNG or an SVG is drawn."""
        return target.fmt in self.products[target.what].layers

    def _write_frames(self, out: BinaryIO, target: Target) -> None:
        """Draw a result that grows, each frame as a picture of its own."""
        from vorotool.formats.images.pictures import write_animation

        count, draw, progress = self.options.frames or FRAMES, self.frames(target.what), self.run.progress("animate")
        steps, first = (max(count - 1, 1), 0) if self.begins_empty else (count, 1)

        def frames() -> Iterator[NDArray[np.uint8]]:
            for number in range(count):
                yield draw(Fraction(number + first, steps))
                if progress is not None:
                    progress((number + 1) / count)

        write_animation(out, frames(), fmt=target.fmt, fps=self.options.fps or FPS)

    def write_store(self, target: Target, rules: Mapping[str, Any]) -> None:
        """Write a result to a Zarr store."""
        raise NotImplementedError

    def write_data(self, out: BinaryIO, target: Target) -> None:
        """Write a result in a format of its own."""
        o = self.options
        write_product(
            out,
            self.written(target.what, target.fmt),
            self.products[target.what],
            target.fmt,
            flatten=o.flatten and length_in_units(o.pixel_size, o.flatten),
            path=target.path,
        )
