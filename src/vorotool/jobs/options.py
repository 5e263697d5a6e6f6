"""Values of a command's options by name: one frozen object a job.

An option that a command lacks has its default, so that what commands share asks for no command; ``--help`` says what
each option means.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

from vorotool.formats.io.sources import suffix_of
from vorotool.products.commands import COMMANDS
from vorotool.products.inputs import DRAWINGS
from vorotool.products.options import DEFAULTS, options_of
from vorotool.products.registry import OF_ONE_SHAPE, OF_SPACE, PRODUCTS, Product

if TYPE_CHECKING:
    from vorotool.jobs.units import PixelSize
    from vorotool.render.looks import Looks

Place = tuple[float, float]
ALL_PAGES = -1
"""Of ``--page all``: each page is an input of a batch."""
AUTO_LEVELS = -1
"""Of ``--levels auto``: until a copy is small."""

OF_SITES = ("tessellate", "delaunay", "alphashape")
"""Commands whose sites are points, or the seeds of an image."""
OF_SHAPES = ("voronoi", "skeleton-approx", "skeleton-exact")
"""Commands that take shapes, or the outlines of an image."""
OF_IMAGES = ("page", "seeds", "connectivity", "threshold", "invert", "min-area", "fill-holes", "outline", "border")
"""Options that mean nothing for points, or for polygons and lines, for which ``--spacing`` means nothing either."""
OF_FRAMES = ("cell-size", "like", "size", "window")
"""Options of the frame that lists of points are tessellated in."""


class Options:
    """Options of one command, which nobody changes."""

    command: str
    inputs: tuple[str, ...]
    what: tuple[str, ...]
    pixel_size: PixelSize | None
    max_pixels: int
    threads: int
    other: str = ""  # the second of two inputs
    json: bool = False
    sources: Mapping[str, str] = {}  # `typed` or `environment`, by the names of options that are given

    def __init__(self, command: str, **given: Any) -> None:
        own = {name: row.unset for name, row in options_of(command).items()}
        self.__dict__.update(DEFAULTS, **own, command=command, inputs=())
        self.__dict__.update(given)

    def __getattr__(self, name: str) -> Any:  # what is there is found without this
        raise AttributeError(f"there is no option {name}")

    def __setattr__(self, name: str, value: Any) -> NoReturn:
        raise AttributeError(f"options are not changed: {name}")

    __delattr__ = __setattr__  # type: ignore[assignment]

    @property
    def products(self) -> Mapping[str, Product]:
        """All results of the command, by name."""
        return OF_SPACE[self.command] if self.command in OF_SPACE and self.is_of_space else PRODUCTS[self.command]

    @property
    def job(self) -> str:
        """``module:function`` that reads an input, and gives its results."""
        command = COMMANDS[self.command]
        return command.job_in_space if command.job_in_space and self.is_of_space else command.job

    # ---- the input
    @property
    def is_of_space(self) -> bool:
        """Whether the input has three axes: it says so itself, or its frame or its columns do."""
        has_z = self.columns is not None and any(part.strip()[:2].lower() == "z=" for part in self.columns.split(","))
        return (
            self.volume
            or self.space
            or has_z
            or len(self.size or ()) == 3
            or 6 in map(len, (self.window or (), self.frame or ()))
        )

    @property
    def is_laid_out(self) -> bool:
        """Whether pixels are laid over points, lines and polygons: cells, or the pixels of a raster."""
        return self.cell_size is not None or self.like is not None

    @property
    def names_columns(self) -> bool:
        """Whether options name columns of the input."""
        return self.label_by is not None or self.with_columns is not None

    @property
    def cleans_masks(self) -> str:
        """The option that changes a mask; empty where there is none."""
        return "--fill-holes" if self.fill_holes else "--min-area" if self.min_area is not None else ""

    @property
    def has_open_border(self) -> bool:
        """Whether objects go on beyond the image that cuts them."""
        return bool(self.border == "open")

    def among(self, *names: str) -> dict[str, Any]:
        """Give some options by their names, as users type them."""
        return {name: getattr(self, name.replace("-", "_")) for name in names}

    def files_of_inputs(self) -> dict[str, str]:
        """Give the files that are read beside each input, by the names of the options."""
        return {name: path for name in ("like", "clip", "enclosures", "overlay") if (path := getattr(self, name))}

    def files_read(self) -> dict[str, str]:
        """Give the files that are read beside the inputs, and so are never replaced, as the user names them."""
        if self.other:
            return {"B": self.other}
        files = {f"--{name}": path for name, path in self.files_of_inputs().items()}
        return {"--files-from": self.files_from, **files} if self.files_from else files

    # ---- the method
    @property
    def triangulated_by(self) -> str:
        """What the method comes to: it is the digital rule that is compared with the exact triangulation."""
        return "digital" if "compare" in self.what else str(self.method)

    @property
    def is_digital(self) -> bool:
        """Whether points are triangulated by the paper's digital rule."""
        return self.triangulated_by == "digital"

    @property
    def is_automatic(self) -> bool:
        """Whether the radius of one shape is to be found."""
        return self.r is None and self.alpha is None and bool(OF_ONE_SHAPE & set(self.what))

    @property
    def has_several_results(self) -> bool:
        """Whether more than one result is asked for."""
        return len(self.what) > 1

    @property
    def has_bands_on_cluster(self) -> bool:
        """Whether a cluster computes the bands of one image."""
        return self.cluster is not None and self.out_dir is None

    @property
    def has_pixel_size(self) -> bool:
        """Whether ``--pixel-size`` is given."""
        return self.pixel_size is not None and not self.pixel_size.is_spacing

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
    def wants_skeleton(self) -> bool:
        """Whether a result shows anything of the skeleton: offset curves are of the whole diagram."""
        return set(self.what) != {"offset"}

    @property
    def unit(self) -> PixelSize | None:
        """The side of a pixel, or its sides, of what has lengths; pictures that are drawn again have none."""
        return None if self.command == "draw" else self.pixel_size

    # ---- pictures
    @property
    def scale_in_millimeters(self) -> bool:
        """Whether a scale is given that is no ratio."""
        return self.scale is not None and not self.scale.is_ratio

    @property
    def looks(self) -> Looks:
        """The looks of pictures."""
        from vorotool.render.looks import Looks

        return Looks(
            self.scale,
            self.drawing_unit,
            self.background,
            self.colors,
            self.line_widths,
            self.label_by,
            self.legend,
            self.scale_bar,
            self.aspect,
            self.extent,
        )

    def drawn(self, usual: Sequence[str]) -> tuple[str, ...]:
        """Give the layers of a picture that has usual ones: a column of names is shown in any case."""
        chosen = tuple(self.layers or usual)
        return chosen if self.label_by is None or "labels" in chosen else (*chosen, "labels")

    @property
    def draws_diagram(self) -> bool:
        """Whether the diagram as PNG is a picture, not a mask."""
        return bool(self.layers or self.overlay or self.looks.given())

    # ---- many inputs
    @property
    def is_shared(self) -> bool:
        """Whether there are options of many inputs that mean something for one, too."""
        return any((self.null, self.dry_run, self.resume, self.shard, self.table, self.table_inputs, self.fields))


def changed(o: Options, **values: Any) -> Options:
    """Return options with some of them changed."""
    return Options(**{**vars(o), **values})
