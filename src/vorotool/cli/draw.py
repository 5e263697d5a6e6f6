"""``vorotool draw``."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, BinaryIO

import click

from vorotool.cli.inputs import read_backdrop, refuse
from vorotool.cli.options import layers_option, shared, single_input
from vorotool.cli.run import Run
from vorotool.cli.targets import check_picture_options, check_stats, check_targets, plan_targets

if TYPE_CHECKING:
    from vorotool.formats.sources import Source

FORMATS = {"picture": ("png", "svg")}
LAYERS = {"png": ("cells", "diagram"), "svg": ("cells", "labels")}
"""A label image from a file has no seeds."""

SKELETON_LAYERS = ("polygons", "elements", "points", "skeleton", "nodes", "labels")
_SKELETON_PICTURES = {"svg": SKELETON_LAYERS, "png": SKELETON_LAYERS[:-1]}


@click.command("draw")
@click.argument("inputs", metavar="INPUT", nargs=-1)
@shared("output", "format", "input-format", "page")
@layers_option(("cells", "diagram", *SKELETON_LAYERS))
@shared("overlay", "width", "y-up", "out-dir", "threads", "stats", "max-pixels", "no-clobber", "quiet", "verbose")
def command(**options: Any) -> None:
    """Draw a label image, in which neighbouring regions never share a colour, or a skeleton.

    \b
    Example:
      vorotool draw data/cells.png -o cells.svg

    INPUT is a label image (PNG, TIFF, PGM, NPY), such as tessellate writes, or the JSON of a skeleton; - is standard
    input.
    """
    o = SimpleNamespace(**options)
    source = single_input(o.inputs)
    (target,) = plan_targets(FORMATS, ["picture"], output=o.output, fmt=o.format, out_dir=o.out_dir, source=source)
    check_stats(o.stats, [target], source)
    with Run("draw", quiet=o.quiet, verbose=o.verbose, stats=o.stats, no_clobber=o.no_clobber) as run:
        from vorotool.formats.outputs import make_folder, open_output
        from vorotool.formats.skeleton_json import says_skeleton
        from vorotool.formats.sources import read_source

        check_targets(o, [target], source)
        with run.phase("read"):
            content = read_source(source)
        prepare = _skeleton_picture if says_skeleton(content.data) else _label_picture
        with run.phase("read"):
            o.backdrop = read_backdrop(o)
        write = prepare(run, o, content, target.fmt)
        if o.out_dir is not None:
            make_folder(o.out_dir)
        with (
            run.phase("write"),
            open_output(target.path, binary=target.is_binary, no_clobber=o.no_clobber, inputs=(source,)) as out,
        ):
            write(out)


def _label_picture(run: Run, o: SimpleNamespace, source: Source, fmt: str) -> Callable[[BinaryIO], None]:
    """Read a label image, and give what draws it."""
    from vorotool.cli.pictures import write_label_picture
    from vorotool.engines.regions import region_colours
    from vorotool.formats.label_images import read_label_image

    check_picture_options(o, [fmt], LAYERS)
    with run.phase("read"):
        image = read_label_image(source, input_format=o.input_format, page=o.page, max_pixels=o.max_pixels)
    with run.phase("colour"):
        colours = region_colours(image, threads=o.threads)
    run.stats.update({"shape": image.shape, "colours": int(colours[1].max(initial=0))})
    return partial(
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


def _skeleton_picture(run: Run, o: SimpleNamespace, source: Source, fmt: str) -> Callable[[BinaryIO], None]:
    """Read a skeleton, and give what draws it."""
    from vorotool.cli.pictures import write_layers
    from vorotool.formats.skeleton_json import read_skeleton
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
    run.stats.update({"arcs": len(skeleton), "nodes": len(skeleton.vertices)})
    return partial(write_layers, layers=layers, page=page, fmt=fmt, threads=o.threads)
