"""Options of outputs, of pictures, and of checks and resources."""

from __future__ import annotations

from vorotool.products.options.row import ALL, BATCHES, COMPUTING, SHAPES, SKELETONS, Option

SEVERAL = (
    "several separated by commas: -o x.gpkg writes them as layers of one file, any other name a file for each, such as "
    "x.labels.tif and x.table.csv for -o x.tif"
)
"""How several results are written, as help says it."""

_FLATTEN = (
    "Largest distance of polylines from the curves that they replace, where a format ({flattened}){more} has no "
    "curves, and in inputs with curves. Default auto: 1/2000 of the radius for arcs, for other curves 1/2000 of their "
    "extent or 1/100 of their clearance."
)

# Rows stay rows: one argument a line would hide the table.
# fmt: off
OUTPUT = (
    Option("-o --output FILE", ALL, "Where to write; - is standard output.", complete="outputs"),
    Option("-f --format FORMAT", ALL, "Format of the output: {formats}; default: from the extension of -o. With "
        "several results a list, such as tiff,csv: each gets the one that is usual for it.", complete="formats"),
    Option("--what A[,B...]", COMPUTING.replace("alphashape ", ""), f"What to write: {{results}}; {SEVERAL}.",
        "results", repeats="joined"),
    Option("--what A[,B...]", "alphashape",
        f"What to write: {{results}}; default edges, for {{of_polygons}} polygons; {SEVERAL}.", "results",
        repeats="joined"),
    Option("--dtype", "tessellate", "Type of labels in TIFF, NPY, Zarr.", "choice:uint8 uint16 uint32 int32",
        acts_on="labels.tiff labels.npy labels.zarr"),
    Option("--chunk WxH[xD]", "tessellate", "Columns x rows (x slices) of the chunks of a Zarr store; default "
        "2048x512, fewer rows if wide.", "numbers.size_or_volume", acts_on=".zarr"),
    Option("--levels N|auto", "tessellate", "Coarser copies of a volume in OME-Zarr, each of every second voxel; auto: "
        "until 256 across.", "numbers.levels", acts_on=".ome-zarr"),
    Option("--tiled", "tessellate", "Tiles of 512 x 512 pixels in TIFFs, instead of strips of whole rows.",
        acts_on=".tiff"),
    Option("--flatten TOLERANCE|auto", "voronoi", _FLATTEN.replace("{more}", ""), "lengths.tolerance_or_auto",
        acts_on=".curves cells.csv cells.tsv ?may_be_drawn"),
    Option("--flatten TOLERANCE|auto", SKELETONS, _FLATTEN.replace("{more}", " or --what shape"),
        "lengths.tolerance_or_auto", acts_on=".curves shape ?may_be_drawn"),
    Option("--decimals N", COMPUTING, "Decimals of coordinates; polygons stay valid. Default: all that round-trip.",
        "int:0:17", acts_on=".coordinates"),
    Option("--precision N", COMPUTING, "Significant digits of other numbers. Default: the shortest that round-trips.",
        "int:1:17", acts_on=".digits"),
    Option("--with COLUMN[,...]", BATCHES, "Columns of the input for rows about parts of features (branches, points, "
        "...); for rows about several (edges, neighbors) as COLUMN_a, COLUMN_b.", "names.columns", name="with_columns",
        repeats="joined", acts_on=".parts"),
    Option("--no-properties", BATCHES, "Do not copy further columns or properties of the input."),
    Option("--safe-csv", BATCHES, "Put ' before texts in CSV and TSV that a spreadsheet would read as formulas; "
        "numbers stay."),
    Option("--no-clobber", ALL, "Refuse to replace an existing file."),
    Option("--overwrite", ALL, "Replace a GeoPackage that holds other layers, which are lost."),
)
# fmt: on

# Rows stay rows: one argument a line would hide the table.
# fmt: off
CHECKS = (
    Option("--verify", COMPUTING, "Run an independent checker on the result; exit 1 if it is wrong."),
    Option("--strict", COMPUTING, "Refuse input that would be repaired or snapped."),
    Option("--stats FILE|-", ALL, "Write counts, sizes, seconds and warnings as JSON.", complete="files:json"),
    Option("--threads N", f"{ALL} info", "Threads; 0 uses all.", "int:0:1024", 0, env="THREADS"),
    Option("--max-pixels N", f"{ALL} info", "Maximum number of pixels held in memory.", "int:1:", 2**31,
        env="MAX_PIXELS"),
    Option("--max-sites N", COMPUTING, "Maximum number of seeds, samples or vertices.", "int:1:", 2**31 - 1,
        env="MAX_SITES"),
    Option("-q --quiet", ALL, "Print no notes, warnings or progress.", env="QUIET"),
    Option("-v --verbose", ALL, "Report the time of each phase."),
)
# fmt: on

_TABLE_FILES = "files:csv tsv json"
# Rows stay rows: one argument a line would hide the table.
# fmt: off
MANY = (
    Option("--out-dir DIR", f"{BATCHES} draw", "Folder for outputs named after the inputs.", "names.folder",
        complete="folders"),
    Option("--files-from FILE|-", f"{BATCHES} draw", "Read the names of further inputs, one per line.", complete="any"),
    Option("-0 --null", f"{BATCHES} draw", "Names of --files-from end with NUL bytes."),
    Option("-j --jobs N", f"{BATCHES} draw", "Worker processes, with one thread each; 0: one per core; default: "
        "one, which uses all cores.", "int:0:1024", env="JOBS"),
    Option("--keep-going", f"{BATCHES} draw", "Continue with the other inputs when one fails."),
    Option("--dry-run", f"{BATCHES} draw", "Print the plan as JSON lines, and write nothing."),
    Option("--resume", f"{BATCHES} draw", "Skip inputs that are done."),
    Option("--shard I/N", f"{BATCHES} draw", "Process every N-th input in the order of names, from the I-th.",
        "numbers.shard"),
    Option("--follow", f"{BATCHES} draw info", "Follow links to folders that are found in folders."),
    Option("--table FILE", BATCHES, "Write the tables of all inputs as one (CSV, TSV, JSON): the rows of --what if "
        "that is a table, else of table.", complete=_TABLE_FILES),
    Option("--table-inputs FILE", BATCHES, "Write one row per input, also for inputs without objects: its status and "
        "its number of rows.", complete=_TABLE_FILES),
    Option("--fields REGEX", BATCHES, "Add columns to --table and --table-inputs: the named groups, (?P<name>...), "
        "found in each path."),
    Option("--cluster ADDRESS|local", f"{BATCHES} draw", "Run on a Dask cluster.", env="CLUSTER",
        complete="words:local"),
)
# fmt: on


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
