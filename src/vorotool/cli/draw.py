"""``vorotool draw``."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import click

from vorotool.cli.options import layers_option, shared, single_input
from vorotool.cli.run import Run
from vorotool.cli.targets import check_stats, plan_targets

FORMATS = {"picture": ("png", "svg")}


@click.command("draw")
@click.argument("inputs", metavar="INPUT", nargs=-1)
@shared("output", "format", "input-format", "page")
@layers_option(("cells", "diagram", "labels"))
@shared("width", "y-up", "out-dir", "threads", "stats", "max-pixels", "no-clobber", "quiet", "verbose")
def command(**options: Any) -> None:
    """Draw a label image: neighbouring regions never share a colour.

    \b
    Example:
      vorotool draw data/cells.png -o cells.svg

    INPUT is a label image (PNG, TIFF, PGM, NPY), such as tessellate writes; - is standard input.
    """
    o = SimpleNamespace(**options)
    source = single_input(o.inputs)
    (target,) = plan_targets(FORMATS, ["picture"], output=o.output, fmt=o.format, out_dir=o.out_dir, source=source)
    check_stats(o.stats, [target], source)
    with Run("draw", quiet=o.quiet, verbose=o.verbose, stats=o.stats, no_clobber=o.no_clobber) as run:
        from vorotool.cli.pictures import write_label_picture
        from vorotool.engines.regions import colour_regions
        from vorotool.formats.label_images import read_label_image
        from vorotool.formats.outputs import open_output
        from vorotool.formats.sources import read_source

        with run.phase("read"):
            image = read_label_image(
                read_source(source), input_format=o.input_format, page=o.page, max_pixels=o.max_pixels
            )
        with run.phase("colour"):
            colours = colour_regions(image, threads=o.threads)
        with (
            run.phase("write"),
            open_output(target.path, binary=target.is_binary, no_clobber=o.no_clobber, inputs=(source,)) as out,
        ):
            layers = o.layers or (("cells", "labels") if target.fmt == "svg" else ("cells",))
            write_label_picture(
                out,
                image,
                colours,
                fmt=target.fmt,
                layers=layers,
                width=o.width,
                y_up=bool(o.y_up),
                threads=o.threads,
            )
        run.stats.update({"shape": image.shape, "colours": int(colours.max(initial=0))})
