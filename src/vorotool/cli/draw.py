"""``vorotool draw``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, BinaryIO

import click

from vorotool.cli.commands import run_command
from vorotool.cli.inputs import refuse
from vorotool.cli.options import batch_options, inputs_argument, layers_option, output_options, shared
from vorotool.cli.recipes import Recipe
from vorotool.cli.results import SKELETON_LAYERS
from vorotool.cli.run import Run
from vorotool.cli.targets import Target, check_picture_options
from vorotool.formats.input_formats import DRAWN_NAMES

if TYPE_CHECKING:
    from vorotool.formats.sources import Source

FORMATS = {"picture": ("png", "svg")}
LAYERS = {"png": ("cells", "diagram"), "svg": ("cells", "labels")}
"""A label image from a file has no seeds."""

Drawing = tuple[Callable[[BinaryIO], None], dict[str, Any]]
"""What draws, and what it draws in numbers."""

_SKELETON_PICTURES = {"svg": SKELETON_LAYERS, "png": SKELETON_LAYERS[:-1]}


@click.command("draw")
@inputs_argument(DRAWN_NAMES)
@output_options(FORMATS)
@shared("input-format", "page")
@layers_option(("cells", "diagram", *SKELETON_LAYERS))
@shared("overlay", "width", "y-up", "out-dir", "threads", "stats", "max-pixels")
@batch_options(table=False)
@shared("no-clobber", "quiet", "verbose")
def command(**options: Any) -> None:
    """Draw a label image, in which neighbouring regions never share a colour, or a skeleton.

    \b
    Example:
      vorotool draw data/cells.png -o cells.svg

    INPUT is a label image (PNG, TIFF, PGM, NPY), such as tessellate writes, or the JSON of a skeleton; - is standard
    input.
    """
    run_command(RECIPE, SimpleNamespace(**options, what=("picture",)))


class _Picture:
    """The picture of one input: what is in it is told when the format is known."""

    def __init__(self, run: Run, o: SimpleNamespace, source: str) -> None:
        from vorotool.formats.sources import read_source

        self._run, self._options = run, o
        with run.phase("read"):
            self._content = read_source(source)

    def check(self, target: Target) -> None:
        """Read the rest, and prepare what draws it."""
        from vorotool.formats.skeleton_json import says_skeleton

        prepare = _skeleton_picture if says_skeleton(self._content.data) else _label_picture
        self._draw, self._counts = prepare(self._run, self._options, self._content, target.fmt)

    def verify(self) -> None:
        """There is nothing to check in a picture."""

    def write(self, target: Target, *, inputs: Sequence[str]) -> None:
        """Draw."""
        from vorotool.formats.outputs import open_output

        no_clobber = self._options.no_clobber
        with open_output(target.path, binary=target.is_binary, no_clobber=no_clobber, inputs=inputs) as out:
            self._draw(out)

    def stats(self) -> dict[str, Any]:
        """Counts and sizes."""
        return self._counts


def _label_picture(run: Run, o: SimpleNamespace, source: Source, fmt: str) -> Drawing:
    """Read a label image, and give what draws it."""
    from vorotool.engines.regions import region_colours
    from vorotool.formats.label_images import read_label_image
    from vorotool.pictures import write_label_picture

    check_picture_options(o, [fmt], LAYERS)
    with run.phase("read"):
        image = read_label_image(source, input_format=o.input_format, page=o.page, max_pixels=o.max_pixels)
    with run.phase("colour"):
        colours = region_colours(image, threads=o.threads)
    draw = partial(
        write_label_picture,
        image=image,
        colours=colours,
        fmt=fmt,
        layers=o.layers or (("cells", "labels") if fmt == "svg" else ("cells",)),
        width=o.width or 1000,
        y_up=bool(o.y_up),
        backdrop=o.backdrop,
        threads=o.threads,
    )
    return draw, {"shape": image.shape, "colours": int(colours[1].max(initial=0))}


def _skeleton_picture(run: Run, o: SimpleNamespace, source: Source, fmt: str) -> Drawing:
    """Read a skeleton, and give what draws it."""
    from vorotool.formats.skeleton_json import read_skeleton
    from vorotool.pictures import write_layers
    from vorotool.render.layers import ImagePage
    from vorotool.render.layers_png import check_picture_size
    from vorotool.render.skeleton_layers import skeleton_layers, skeleton_page

    check_picture_options(o, [fmt], _SKELETON_PICTURES, png_has_width=True)
    refuse(o, ("page",), "is for images, but the input is a skeleton")
    with run.phase("read"):
        skeleton = read_skeleton(source, properties=False)
    page = ImagePage(o.backdrop) if o.backdrop else skeleton_page(skeleton, width=o.width or 1000, y_up=o.y_up)
    if fmt == "png":
        check_picture_size(page, o.max_pixels)
    layers = skeleton_layers(skeleton, page, o.layers or (("skeleton",) if o.backdrop else ("polygons", "skeleton")))
    draw = partial(write_layers, layers=layers, page=page, fmt=fmt, threads=o.threads)
    return draw, {"arcs": len(skeleton), "nodes": len(skeleton.vertices)}


def _check_options(o: SimpleNamespace, targets: list[Target]) -> None:
    """What there can be in a picture depends on the input."""


RECIPE = Recipe("draw", FORMATS, _check_options, _Picture)
