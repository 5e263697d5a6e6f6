"""All results of all commands: in every format, with the layers that are drawn, the same for any number of threads."""

import numpy as np
import pytest

from support.documents import DATA
from vorotool.products.formats import ANIMATIONS, FORMATS
from vorotool.products.registry import PRODUCTS, formats_of, layers_of
from vorotool.render.label_images import svg as label_svg

INPUTS = {
    "tessellate": ["dots.csv"],
    "delaunay": [DATA / "dots.csv"],
    "alphashape": [DATA / "dots.csv", "-r", 60],
    "voronoi": [DATA / "two-shapes.json"],
    "skeleton-exact": [DATA / "two-shapes.json"],
}
NEEDED = {"offset": ["-d", "-20,5"], "points": ["--every", "20"], "transects": ["--every", "20"]}
"""Of skeletons."""
OF_IMAGES = {("skeleton-exact", "thickness")}
"""What is of no polygons."""
OF_SPACE = {("delaunay", "tetrahedra"), ("delaunay", "hull")}
OF_SPACE |= {("alphashape", "surface"), ("alphashape", "tetrahedra"), ("alphashape", "triangles")}
"""Results with `--space` alone; test_space.py have the others."""


@pytest.mark.parametrize(("command", "what"), [(command, what) for command in INPUTS for what in formats_of(command)])
def test_every_format_is_written(run, folder, command, what):
    more = NEEDED.get(what, []) if command == "skeleton-exact" else []
    if (command, what) in OF_SPACE:
        (folder / "space.csv").write_text("x,y,z\n0,0,0\n4,0,0\n0,3,0\n0,0,2\n1,1,1\n")
        more = ["--space", *(["-r", "inf"] if command == "alphashape" else [])]
    for fmt in formats_of(command)[what]:
        if (command, what, fmt) in OF_SEVERAL_KINDS or what not in (first_with(command, fmt), last_with(command, fmt)):
            continue  # the library writes all of them: products/test_writing.py
        named, chosen = folder / f"a{FORMATS[fmt].endings[0]}", folder / "b"
        is_scaled = fmt in (*ANIMATIONS, "png") and command != "tessellate" and (command, what) not in OF_IMAGES
        picture = ["--width", 90] if is_scaled else []
        frames = ["--frames", 2] if fmt in ANIMATIONS else []
        ways = [["-o", named.name], ["-f", fmt, "-o", "b"]]
        names_the_format = fmt != "zarr" and what == first_with(command, fmt)
        for way in ways if names_the_format else ways[:1]:
            inputs = [DATA / "blobs.png"] if (command, what) in OF_IMAGES else INPUTS[command]
            inputs = ["space.csv"] if (command, what) in OF_SPACE else inputs
            done = run(command, *inputs, "--what", what, *more, *picture, *frames, *way)
            assert done.err == "" or what in ("compare", "persistence"), fmt
        assert fmt == "zarr" or named.read_bytes() != b"", fmt
        assert not names_the_format or named.read_bytes() == chosen.read_bytes(), fmt


def first_with(command, fmt):
    """Return the product for which the format is named by `-f`, too: the first that is written in it."""
    return next(what for what, own in formats_of(command).items() if fmt in own)


def last_with(command, fmt):
    """Return the last product that is written in a format."""
    return next(what for what, own in reversed(formats_of(command).items()) if fmt in own)


OF_SEVERAL_KINDS = {("alphashape", "general", "shp"), ("alphashape", "hull", "shp")}
"""A Shapefile holds points, lines or polygons."""


OF_A_PICTURE = [
    (command, what) for command in INPUTS for what, product in PRODUCTS[command].items() if product.layers.get("svg")
]


@pytest.mark.parametrize(("command", "what"), OF_A_PICTURE)
def test_all_layers_are_drawn(run, folder, command, what):
    more = NEEDED.get(what, []) if command == "skeleton-exact" else []
    inputs = INPUTS[command]
    if (command, what) in OF_SPACE:
        (folder / "space.csv").write_text("x,y,z\n0,0,0\n4,0,0\n0,3,0\n0,0,2\n1,1,1\n")
        inputs, more = ["space.csv"], ["--space"]
    layers = layers_of(command)["svg"] if command == "tessellate" else PRODUCTS[command][what].layers["svg"]
    run(command, *inputs, "--what", what, *more, "--layers", ",".join(layers), "-o", "a.svg")
    assert (folder / "a.svg").read_bytes() != b""


def test_layers_of_label_images():
    assert layers_of("tessellate") == {
        "png": ("cells", "diagram", "objects", "seeds", "labels"),
        "svg": label_svg.LAYERS,
    }


@pytest.mark.parametrize(
    ("command", "what", "extension"),
    [
        *(("tessellate", "labels", "png"), ("tessellate", "labels", "tif"), ("tessellate", "table", "csv")),
        *(("delaunay", "edges", "npz"), ("delaunay", "triangles", "png"), ("alphashape", "hull", "geojson")),
        ("skeleton-exact", "skeleton", "json"),
    ],
)
def test_the_same_bytes_for_any_threads(run, folder, command, what, extension):
    rng = np.random.default_rng(0)
    points = rng.integers(0, 600, (500, 2)) if command == "tessellate" else rng.normal(size=(20_000, 2))
    np.save(folder / "many.npy", points.astype(float))
    source = DATA / "ne_110m_land.geojson" if command == "skeleton-exact" else "many.npy"
    width = ("--width", 300) if (command, extension) == ("delaunay", "png") else ()  # some bands of rows
    for threads in (1, 3):
        made = ("-o", f"{threads}.{extension}", "--threads", threads, *width)
        run(command, source, "-q", "--what", what, *made)
    one, three = ((folder / f"{k}.{extension}").read_bytes() for k in (1, 3))
    assert one == three
