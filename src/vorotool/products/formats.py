"""All formats of outputs: a line each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from types import MappingProxyType
from typing import Any, NamedTuple

from vorotool.errors import option


class Writer(NamedTuple):
    """A function ``function(out, value, **options)``, named so that nothing is imported before something is written."""

    function: str
    """``module:name`` within the package."""
    takes: tuple[str, ...] = ("fmt", "what")
    """Options that it has, of these, ``flatten`` and ``product``."""


class Format(NamedTuple):
    """A format of outputs."""

    name: str  # as `-f` and `fmt` have it
    title: str  # as documents have it
    extensions: tuple[str, ...] = ()  # without dots, the one that files are given first; by default the name
    is_text: bool = True  # it may go to a terminal
    has_digits: bool = False  # it has floating-point numbers in text, so that `--precision` acts on it
    is_image: bool = False  # it holds pixels, or shows a result: coordinates have no units in it
    flattens: bool = False  # it has no curves: lines stand for them
    family: str = ""  # formats of one family are written together, each result in its own
    # what writes results, by their names, beside those formats that a product lists itself
    writers: Mapping[str, Writer] = MappingProxyType({})
    beside: str = ""  # results that have this format are written by `writer`, too
    writer: Writer | None = None
    # it is made from the text of the first of these formats that a product has, by `maker`
    made_from: tuple[str, ...] = ()
    # `module:name` of `maker(out, what, path)`: a context in which there is a file that takes that text
    maker: str = ""
    is_map: bool = False  # whoever reads it takes y to go upwards
    parts: tuple[str, ...] = ()  # extensions of further files that each consists of

    @property
    def endings(self) -> tuple[str, ...]:
        """Extensions with their dots."""
        return tuple(f".{extension}" for extension in self.extensions or (self.name,))


_GRAPHML = Writer("formats.results.graphml:write_graphml", ("flatten",))
_DXF = Writer("formats.drawing.dxf_writer:write_dxf", ("product",))
_ALL = (
    Format("png", "PNG", is_text=False, is_image=True),
    Format("tiff", "TIFF", ("tif", "tiff"), is_text=False, is_image=True),
    Format("npy", "NPY", is_text=False, is_image=True),
    Format("text", "text", ("txt",), is_image=True),
    Format("svg", "SVG", is_image=True),
    Format("csv", "CSV", has_digits=True),
    Format("tsv", "TSV", has_digits=True),
    Format("json", "JSON", has_digits=True),
    Format("npz", "NPZ", is_text=False),
    Format("geojson", "GeoJSON", has_digits=True, flattens=True),
    Format("edge", "Triangle", family="Triangle"),
    Format("ele", "Triangle", family="Triangle"),
    Format("node", "Triangle", has_digits=True, family="Triangle"),
    Format("obj", "OBJ", has_digits=True),
    Format("ply", "PLY", is_text=False),
    Format("stl", "STL", is_text=False),
    Format("vtu", "VTU", is_text=False),
    Format("wkt", "WKT", has_digits=True, flattens=True, is_map=True),
    Format("poly", "Triangle", has_digits=True),
    Format("graphml", "GraphML", has_digits=True, flattens=True, writers={"skeleton": _GRAPHML}),
    Format(
        "jsonl",
        "JSON lines",
        ("jsonl", "ndjson"),
        has_digits=True,
        flattens=True,
        made_from=("geojson", "json"),
        maker="formats.text.tables:JsonLines",
    ),
    *(  # of features of maps, or of the rows of tables where they can hold these
        Format(
            name,
            title,
            extensions,
            is_text=False,
            flattens=True,
            made_from=sources,
            maker=f"formats.gis.{maker}:{title}",
            is_map=True,
            parts=parts,
        )
        for name, title, extensions, sources, maker, parts in (
            ("gpkg", "GeoPackage", (), ("geojson", "json"), "geopackage", ()),
            ("fgb", "FlatGeobuf", (), ("geojson",), "vector_files", ()),
            ("shp", "Shapefile", (), ("geojson",), "vector_files", (".shx", ".dbf", ".prj", ".cpg")),
            ("parquet", "GeoParquet", ("parquet", "geoparquet"), ("geojson", "json"), "geoparquet", ()),
        )
    ),
    Format("dxf", "DXF", writer=_DXF, beside="geojson"),
    Format("html", "HTML"),
    Format("gif", "GIF", is_text=False, is_image=True),
    Format("apng", "APNG", is_text=False, is_image=True),
    Format("webp", "WebP", is_text=False, is_image=True),
    Format("zarr", "Zarr", is_text=False, is_image=True),
)
FORMATS = {each.name: each for each in _ALL}
"""By name."""
EXTENSIONS = {f".{extension}": each.name for each in _ALL for extension in each.extensions or (each.name,)}
"""The format that an extension stands for."""
PICTURES = ("svg", "png")
"""Formats of pictures."""

AS_SVG, AS_PNG = (option(f"-f {name}", f'fmt="{name}"') for name in PICTURES)
AS_PICTURE = option("-f svg or png", 'fmt="svg" or "png"')
"""Pictures, in messages that advise one."""
AS_MESH = option("-f ply or vtu", 'fmt="ply" or "vtu"')
"""Meshes in space, for other programs."""

TABLES = ("csv", "tsv", "json", "npz")
"""Formats of tables."""
GENERAL = Writer("formats.text.tables:write_value", ("fmt", "what", "flatten"))
"""What writes the rows or the features of any value."""
ANIMATIONS = ("gif", "apng", "webp")
"""Formats of pictures that move."""
SHOWN_AS = dict.fromkeys(ANIMATIONS, "png")
"""The format of a picture that a frame of an animation is like."""


def format_named(name: str) -> str | None:
    """Give the format that a name or an extension stands for, in any case; None if there is no such."""
    lower = name.lower().removeprefix(".")
    return lower if lower in FORMATS else EXTENSIONS.get(f".{lower}")


def resolved(function: str) -> Callable[..., Any]:
    """Give the function that ``module:name`` stands for."""
    module, name = function.split(":")
    return getattr(import_module(f"vorotool.{module}"), name)
