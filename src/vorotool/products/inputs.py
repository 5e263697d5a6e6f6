"""All formats of inputs: a line each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple

from vorotool.errors import UsageError, meant, option

Holds = Literal["points", "polygons", "sites", "image", "skeleton", "offsets", "voronoi"]
"""What an input may hold: polygons stand for lines, too, and sites for all three; they are polygons by default."""


class InputFormat(NamedTuple):
    """A format of inputs."""

    name: str  # what it is called within the package
    names: tuple[str, ...]  # what `--input-format` accepts for it, which are the extensions of its files, too
    # what it may hold, and `module:function` of `function(source, options)` that reads it
    readers: Mapping[Holds, str]
    # `bytes`: it is no text. `layers`: it may hold several. `curves`: which become lines where it is read
    has: frozenset[str] = frozenset()
    # `module:function` of `function(source)` that reads the features of a map, which tell what it holds
    features: str = ""


def _of(name: str, *names: str, has: str = "", features: str = "", **readers: str) -> InputFormat:
    held: Mapping[Holds, str] = readers  # type: ignore[assignment]  # they are called as what is held
    return InputFormat(name, names or (name,), held, frozenset(has.split()), features)


def _of_maps(
    name: str, *names: str, reader: str = "vector_files:features_of", has: str = "bytes layers"
) -> InputFormat:
    """Give a format of features of maps: points, polygons and lines alike."""
    features = f"formats.gis.{reader}"
    return _of(name, *names, has=has, features=features, points=_FEATURES[0], polygons=_FEATURES[1], sites=_FEATURES[2])


_FEATURES = tuple(f"formats.gis.feature_table:read_{each}" for each in ("points", "polygons", "sites"))
_IMAGE = "formats.images.reader:read_image"
_ALL = (
    _of(
        "csv",
        *("csv", "tsv", "txt"),
        features="formats.gis.feature_table:features_of_rows",
        points="formats.points.delimited:read_text",
        polygons=_FEATURES[1],
        sites=_FEATURES[2],
    ),
    _of("node", points="formats.points.delimited:read_node"),
    _of("ply", has="bytes", points="formats.points.clouds:read_ply"),
    _of("obj", points="formats.points.clouds:read_obj"),
    _of("xyz", points="formats.points.clouds:read_xyz"),
    _of("las", "las", "laz", has="bytes", points="formats.points.las:read_las"),
    _of(
        "npz",
        has="bytes",
        points="formats.points.tables:read_npz",
        polygons="formats.results.npz_reader:read_polygons",
        sites="formats.results.npz_reader:read_sites",
        skeleton="formats.results.skeleton_files:read_skeleton",
        offsets="formats.results.skeleton_files:read_offsets",
        voronoi="formats.results.voronoi_files:read_voronoi",
    ),
    _of_maps("csv-wkt", reader="feature_table:features_of_rows", has=""),
    _of(
        "geojson",
        points="formats.points.tables:read_geojson",
        polygons="formats.polygons.json:read_geojson",
        sites="formats.polygons.json:read_geojson_sites",
    ),
    _of_maps("wkt", reader="feature_table:features_of_texts", has=""),
    _of(
        "json",
        points="formats.points.tables:read_json",
        polygons="formats.polygons.json:read_json",
        sites="formats.polygons.json:read_sites",
        skeleton="formats.results.skeleton_files:read_skeleton",
        offsets="formats.results.skeleton_files:read_offsets",
        voronoi="formats.results.voronoi_files:read_voronoi",
    ),
    _of(
        "jsonl",
        *("jsonl", "ndjson", "geojsonl", "geojsons"),
        points="formats.points.tables:read_json",
        polygons="formats.polygons.json:read_json",
        sites="formats.polygons.json:read_sites",
    ),
    _of("poly", polygons="formats.polygons.poly:read_poly"),
    _of_maps("gpkg", reader="geopackage:features_of"),
    _of_maps("fgb"),
    _of_maps("shp", "shp", "shz"),
    _of_maps("kml"),
    _of_maps("gpx"),
    _of_maps("parquet", "parquet", "geoparquet", reader="geoparquet:features_of", has="bytes"),
    _of_maps("wkb", reader="feature_table:features_of_binary", has="bytes"),
    _of("svg", "svg", "svgz", has="bytes curves", polygons="formats.drawing.svg_reader:read_svg"),
    _of("dxf", has="bytes curves", polygons="formats.drawing.dxf_reader:read_dxf"),
    _of("png", image=_IMAGE),
    _of("tiff", "tiff", "tif", image=_IMAGE),
    _of("pnm", "pnm", "pbm", "pgm", "ppm", image=_IMAGE),
    _of("npy", has="bytes", points="formats.points.tables:read_npy", image=_IMAGE),
    _of("zarr", image=""),  # a folder, which is read by its rows
    _of("jpeg", "jpeg", "jpg", image=_IMAGE),
    _of("bmp", image=_IMAGE),
    _of("gif", image=_IMAGE),
    _of("webp", image=_IMAGE),
    _of("avif", image=_IMAGE),
)
INPUTS = {each.name: each for each in _ALL}
"""By name."""
SPACE_FORMATS = tuple(each.name for each in _ALL if "points" in each.readers and each.name != "npy")
"""Formats whose points may have a z, which the same reader reads."""


def names_of(*held: Holds) -> dict[str, str]:
    """Give the names of all formats that may hold one of some things, and the format that each name stands for."""
    return {name: each.name for each in _ALL if each.readers.keys() & set(held) for name in each.names}


VOLUME_READER, SPACE_READER = "formats.volumes.opening:read_volume", "formats.volumes.opening:read_xyz"
"""``module:function`` that read volumes, and points with a z, from a path."""

IMAGE_NAMES = names_of("image")
"""Formats of images by name; NPY files hold either."""
VOLUME_NAMES = {name: kind for name, kind in IMAGE_NAMES.items() if kind in ("tiff", "npy", "zarr")}
"""Formats of images that volumes have, too."""
NAMES_WITH = {
    "points": names_of("points", "image"),
    "polygons": names_of("polygons", "image"),
    "sites": names_of("points", "polygons", "image"),
    None: names_of("points", "polygons", "image"),
}
"""Formats of inputs that hold an image or such geometry."""
TABLE_NAMES = frozenset({"csv", "tsv", "txt", "npz", "jsonl", "ndjson"})
"""Formats of which most files are tables: in a folder of polygons these are left alone."""
DRAWN_NAMES = NAMES_WITH["polygons"]
"""Formats of what is drawn again: label images, skeletons, offset curves, polygons and lines."""

TAKEN_BY: Mapping[Holds, tuple[str, ...]] = {
    "points": ("tessellate", "delaunay", "alphashape", "voronoi", "distance"),
    "polygons": ("voronoi", "skeleton-approx", "skeleton-exact", "distance", "draw"),
    "sites": ("voronoi", "distance"),
    "image": (
        *("tessellate", "delaunay", "alphashape", "voronoi", "skeleton-approx", "skeleton-exact", "distance", "draw"),
    ),
    "skeleton": ("voronoi", "skeleton-approx", "skeleton-exact", "distance", "draw"),
    "offsets": ("draw",),
    "voronoi": ("voronoi", "skeleton-approx", "skeleton-exact", "distance", "draw"),
}
"""Commands that take what an input may hold; of skeletons and Voronoi maps all but `draw` take the polygons."""


VOLUMES_TAKEN_BY = ("tessellate",)
"""Commands that take a volume."""

DRAWINGS = tuple(name for each in _ALL if "curves" in each.has for name in each.names)
"""Names of formats that have curves, which become lines where they are read."""


def known_input_format(name: str, names: Mapping[str, str]) -> str:
    """Return the format that a name stands for, in any case."""
    if not isinstance(name, str) or name.lower() not in names:
        raise UsageError(
            f"invalid {option('--input-format')} {name!r}: expected one of {', '.join(names)}{meant(str(name), names)}"
        )
    return names[name.lower()]
