"""Options of pictures."""

from __future__ import annotations

from vorotool.products.options.row import ALL, BATCHES, SHAPES, Option

_OF_LINES = f"delaunay alphashape {SHAPES} distance draw"
_LOOKS = ".picture .amounts"
_MOVING = "tessellate alphashape skeleton-exact"


# Rows stay rows: one argument a line would hide the table.
# fmt: off
PICTURES = (
    Option("--layers A[,B...]", ALL, "Layers of pictures: {layers}.", "layers", repeats="joined", acts_on=".picture"),
    Option("--slice Z", "tessellate", "Draw this slice of a volume; default: the three through its middle.", "int::",
        acts_on=".picture"),
    Option("--overlay IMAGE", f"{BATCHES} draw", "Draw pictures over this image, at its size: coordinates are its "
        "pixels.", "names.image", complete="inputs:image", acts_on=".picture"),
    Option("--width PIXELS", ALL, "Pixels across a picture that is not the size of an image; default 1000.",
        "int:16:2147483647", acts_on=".sized"),
    Option("--scale S|1:N", _OF_LINES, "Draw SVG to scale: S millimeters per unit of the input, or 1:N in its unit.",
        "names.scale", acts_on=".svg"),
    Option("--unit", _OF_LINES, "Unit of the input, for SVG to scale; default: what it names. Without --scale, 1:1.",
        "choice:nm um mm cm dm m km in ft yd", name="drawing_unit", acts_on=".svg"),
    Option("--aspect RATIO", _OF_LINES, "Height of a unit of y beside the width of one of x; default 1; for "
        "longitude/latitude 1/cos(latitude) at the middle of the data.", "numbers.aspect", acts_on=".picture"),
    Option("--extent", _OF_LINES, "What pictures show of an image or a drawing: all of it (default), or the data and a "
        "margin.", "choice:image data", acts_on=".picture"),
    Option("--background none|COLOR", ALL, "Background of pictures; default white.", "names.color_or_none",
        complete="words:none white black", acts_on=_LOOKS),
    Option("--color --colour LAYER=COLOR", ALL, "Color of a layer of pictures, such as skeleton=#0000ff or seeds=red, "
        "or scale-bar=white; for cells it colors the borders. May be repeated.", "names.color_of_layer", (),
        name="colors", repeats="each", acts_on=".picture"),
    Option("--line-width LAYER=W", ALL, "Width of the lines of a layer, in px or with mm, such as skeleton=0.1mm, or "
        "cells=0 for no borders. May be repeated.", "names.width_of_layer", (), name="line_widths", repeats="each",
        acts_on=".picture"),
    Option("--label-by COLUMN", ALL, "Column or property that names objects or sites in pictures, instead of their "
        "ids.", acts_on=".picture"),
    Option("--legend", ALL, "Draw the names of the layers with their colors in a corner.", acts_on=_LOOKS),
    Option("--scale-bar", ALL, "Draw a length of 1, 2 or 5 times a power of ten, in the unit of --pixel-size or of the "
        "input.", acts_on=_LOOKS),
    *(
        Option("--animate", command, f"Write an animation of {grows}: GIF, APNG or WebP, as -f or the extension says; "
            "default GIF.", acts_on=".animation")
        for command, grows in (
            ("tessellate", "cells that grow from their seeds, up to --max-distance"),
            ("alphashape", "shapes whose r grows to that of the shape"),
            ("skeleton-exact", "offset curves whose distances grow to those of -d"),
        )
    ),
    Option("--frames N", _MOVING, "Frames of an animation; default 40.", "int:2:10000", acts_on=".animation"),
    Option("--fps N", _MOVING, "Frames per second; default 10.", "float:0.1:100", acts_on=".animation"),
)
# fmt: on
