"""Values of a command's options by name: one frozen object a job.

An option that a command lacks has its default, so that what commands share asks for no command; ``--help`` says what
each option means.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any, NoReturn

from vorotool.formats.io.sources import suffix_of
from vorotool.frozen import frozen
from vorotool.products.commands import COMMANDS
from vorotool.products.inputs import DRAWINGS
from vorotool.products.options import DEFAULTS, options_of
from vorotool.products.registry import OF_ONE_SHAPE, OF_SPACE, PRODUCTS, Product

if TYPE_CHECKING:
    from vorotool.jobs.units import PixelSize
    from vorotool.render.drawing import Looks

Place = tuple[float, float]
ALL_PAGES = -1
"""Of ``--page all``: each page is an input of a batch."""
AUTO_LEVELS = -1
"""Of ``--levels auto``: until a copy is small."""

OF_SITES = ("tessellate", "delaunay", "alphashape")
"""Commands whose sites are points, or the seeds of an image."""
OF_SHAPES = ("voronoi", "skeleton-approx", "skeleton-exact")
"""Commands that take shapes, or the outlines of an image."""
OF_IMAGES = ("page", "seeds", "connectivity", "threshold", "invert", "min_area", "fill_holes", "outline", "border")
"""Options that mean nothing for points, or for polygons and lines, for which ``--spacing`` means nothing either."""
OF_FRAMES = ("cell_size", "like", "size", "window")
"""Options of the frame that lists of points are tessellated in."""


@frozen
class Measured:
    """A length, an area or a volume with a unit, as an option has it until the size of a pixel is known."""

    text: str  # as it was written
    number: Fraction
    unit: str
    is_exact: bool  # the option keeps numbers exactly: in pixels it is a fraction, and no float
    power: int = 1  # of the unit: 2 for squares, 3 for cubes

    def __bool__(self) -> bool:
        """Tell whether it is other than 0, as of a number: in every unit the answer is the same."""
        return self.number != 0


class Options:
    """Options of one command, which nobody changes; what follows from several of them is no option itself."""

    command: str
    inputs: tuple[str, ...]
    what: tuple[str, ...]
    pixel_size: PixelSize | None
    max_pixels: int
    threads: int
    other: str = ""  # the second of two inputs
    json: bool = False
    sources: Mapping[str, str] = {}  # `typed` or `environment`, by the names of options that are given

    __slots__ = (
        *("__dict__", "files_of_inputs", "files_read", "has_bands_on_cluster", "has_pixel_size", "has_several_results"),
        *("is_automatic", "is_digital", "is_laid_out", "is_of_space", "is_shared", "job", "measured", "names_columns"),
        *("opening", "products", "scale_in_millimeters", "triangulated_by", "unit"),
    )
    # ---- the input
    is_of_space: bool  # it has three axes: it says so itself, or its frame or its columns do
    files_of_inputs: dict[str, str]  # what is read beside each input, by the names of the options
    opening: dict[str, Any]  # how an input is opened
    files_read: dict[str, str]  # what is read beside the inputs, and so is never replaced, as the user names it
    is_laid_out: bool  # pixels are laid over points, lines and polygons: cells, or the pixels of a raster
    names_columns: bool  # options name columns of the input
    unit: PixelSize | None  # the side of a pixel of what has lengths; pictures that are drawn again have none
    measured: tuple[str, ...]  # options that have a unit, some of those that are given
    has_pixel_size: bool  # ``--pixel-size`` is given, not ``--spacing``
    is_shared: bool  # there are options of many inputs that mean something for one, too
    has_bands_on_cluster: bool  # a cluster computes the bands of one image
    # ---- the method
    job: str  # `module:function` that reads an input, and gives its results
    triangulated_by: str  # the method; it is the digital rule that is compared with the exact triangulation
    is_digital: bool  # it is the digital rule of the paper
    is_automatic: bool  # the radius of one shape is to be found
    # ---- the results
    products: Mapping[str, Product]  # all of the command, by name
    has_several_results: bool  # more than one is asked for
    scale_in_millimeters: bool  # pictures have a scale that is no ratio

    def __init__(self, command: str, **given: Any) -> None:
        own = {name: row.unset for name, row in options_of(command).items()}
        self.__dict__.update(DEFAULTS, **own, command=command, inputs=())
        self.__dict__.update(given)
        for name, value in _following(self).items():
            object.__setattr__(self, name, value)

    def __reduce__(self) -> Any:
        return partial(Options, **vars(self)), ()

    def __getattr__(self, name: str) -> Any:  # what is there is found without this
        raise AttributeError(f"there is no option {name}")

    def __setattr__(self, name: str, value: Any) -> NoReturn:
        raise AttributeError(f"options are not changed: {name}")

    __delattr__ = __setattr__  # type: ignore[assignment]

    @property
    def cleans_masks(self) -> str:
        """The option that changes a mask; empty where there is none."""
        return "--fill-holes" if self.fill_holes else "--min-area" if self.min_area is not None else ""

    @property
    def takes_spacing(self) -> bool:
        """Whether the command has ``--spacing``."""
        return "spacing" in options_of(self.command)

    @property
    def may_be_drawn(self) -> bool:
        """Whether an input may be a drawing with curves, as far as its name tells."""
        said = self.input_format and self.input_format.lower()
        endings = {suffix_of(path).removeprefix(".") for path in self.inputs}
        return said in DRAWINGS if said else self.files_from is not None or bool(endings & {*DRAWINGS, ""})

    @property
    def looks(self) -> Looks:
        """The looks of pictures."""
        from vorotool.render.drawing import Looks

        return Looks._make(getattr(self, name) for name in Looks._fields)

    @property
    def draws_diagram(self) -> bool:
        """Whether the diagram as PNG is a picture, not a mask."""
        return bool(self.layers or self.overlay or any(each not in (None, (), False) for each in self.looks))


def _following(o: Any) -> dict[str, Any]:
    """Give what follows from several options."""
    what, command = o.what or (), COMMANDS.get(o.command)
    has_z = o.columns is not None and any(part.strip()[:2].lower() == "z=" for part in o.columns.split(","))
    frames = len(o.size or ()), len(o.window or ()), len(o.frame or ())
    is_of_space = bool(o.volume or o.space or has_z or frames[0] == 3 or 6 in frames[1:])
    in_space = OF_SPACE.get(o.command) if is_of_space else None
    beside = {name: path for name in ("like", "clip", "enclosures", "overlay") if (path := getattr(o, name))}
    read = {"--files-from": o.files_from} if o.files_from else {}
    read |= {f"--{name}": path for name, path in beside.items()}
    values = ((name, getattr(o, name)) for name in o.sources)
    method = "digital" if "compare" in what else o.method
    return {
        "is_of_space": is_of_space,
        "files_of_inputs": beside,
        "files_read": {"B": o.other} if o.other else read,
        "opening": {"input_format": o.input_format, "page": o.page, "layer": o.input_layer},
        "is_laid_out": o.cell_size is not None or o.like is not None,
        "names_columns": o.label_by is not None or o.with_columns is not None,
        "unit": None if o.command == "draw" else o.pixel_size,
        "measured": tuple(
            name
            for name, value in values
            if isinstance(value, Measured) or (isinstance(value, tuple) and any(isinstance(x, Measured) for x in value))
        ),
        "has_pixel_size": o.pixel_size is not None and not o.pixel_size.is_spacing,
        "is_shared": any((o.null, o.dry_run, o.resume, o.shard, o.table, o.table_inputs, o.fields)),
        "has_bands_on_cluster": o.cluster is not None and o.out_dir is None,
        "job": command and dict(command.jobs).get("space" if is_of_space else method, command.job),
        "triangulated_by": method,
        "is_digital": method == "digital",
        "is_automatic": o.r is None and o.alpha is None and not OF_ONE_SHAPE.isdisjoint(what),
        "products": in_space or PRODUCTS.get(o.command, {}),
        "has_several_results": len(what) > 1,
        "scale_in_millimeters": o.scale is not None and not o.scale.is_ratio,
    }


def changed(o: Options, **values: Any) -> Options:
    """Return options with some of them changed."""
    return Options(**{**vars(o), **values})
