"""All results that can be written: of which type each is, its layers, and what writes it in which format."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from types import MappingProxyType
from typing import Any, BinaryIO, NamedTuple

from vorotool.errors import UsageError, meant
from vorotool.products.formats import ANIMATIONS, FORMATS, GENERAL, PICTURES, TABLES, Writer, resolved


class Made(NamedTuple):
    """What makes, checks and counts a result that follows from a skeleton or its diagram."""

    make: str = ""  # `module:function` of `function(source, **options)`: it gets the options that its parameters name
    of: str = "skeleton"  # the source: `skeleton`, `whole` (before it is pruned) or `centerlines`
    check: str = ""  # `module:function` of `function(value, **options)`
    counted_as: str = ""  # what statistics call how many there are
    by: str = ""  # the method of the job that makes it, where one function does not


_NOTHING: Mapping[str, Any] = MappingProxyType({})


class Product(NamedTuple):
    """A result that can be written, as ``what`` has it."""

    what: str
    # public types of the values that it is written from; those of them that are not the whole value are its parts
    types: tuple[str, ...] = ()
    data: tuple[str, ...] = ()  # formats that it is written in, the default first
    # what writes it in formats that are not those of rows and features in general
    own: Mapping[str, Writer] = _NOTHING
    # layers of its pictures, from below, by the format of the picture
    layers: Mapping[str, Sequence[str]] = _NOTHING
    usual_layers: tuple[str, ...] = ()  # those that a picture has where none are chosen
    # `module:name`: `name_layers(value, page, layers)` makes the layers of values of its types
    drawn_by: str = ""
    made_by: Made | None = None  # of results that follow from a skeleton or its diagram
    has_page: bool = False  # the command line writes it as a page of HTML, too
    moves: bool = False  # the command line writes it as an animation, too
    is_curved: bool = False
    # formats for which it is taken where `what` is not given; else the first product that has the format is
    usual_for: tuple[str, ...] = ()

    @property
    def written(self) -> tuple[str, ...]:
        """Formats of data: its own, and those that name it or can be made from one of its own."""
        more = (
            each.name
            for each in FORMATS.values()
            if self.what in each.writers or not {each.beside, *each.made_from}.isdisjoint(self.data)
        )
        return tuple(dict.fromkeys([*self.data, *more]))

    @property
    def formats(self) -> tuple[str, ...]:
        """All formats, the default first."""
        pages = ("html",) if self.has_page else ()
        return tuple(dict.fromkeys((*self.written, *self.layers, *pages, *(ANIMATIONS if self.moves else ()))))


class Pictures(NamedTuple):
    """Layers of pictures by their format, and what draws them."""

    layers: Mapping[str, Sequence[str]]
    drawn_by: str = ""


def _product(
    what: str,
    types: str = "",
    data: str = "",
    pictures: Pictures | None = None,
    usual_layers: str = "",
    **more: Any,
) -> Product:
    """Give an entry of the lists below, in which blanks separate names."""
    layers, drawn_by = pictures or Pictures(_NOTHING)
    shown = tuple(usual_layers.split())
    return Product(
        what, tuple(types.split()), tuple(data.split()), layers=layers, usual_layers=shown, drawn_by=drawn_by, **more
    )


def _pictures(layers: str, drawn_by: str) -> Pictures:
    return Pictures(dict.fromkeys(PICTURES, tuple(layers.split())), drawn_by)


_TABLES = " ".join(TABLES)

# ---- tessellate ----------------------------------------------------------------------------------
_IMAGES = "png tiff npy text"
_LABELS = Writer("formats.images.label_images:write_labels", ("fmt",))
_COLORED = {"png": ("cells", "diagram", "objects", "seeds", "labels"), "svg": ("cells", "labels", "objects", "seeds")}
# Rows stay rows: one argument a line would hide the tables.
# fmt: off
_TESSELLATE = (
    _product("labels", "LabelImage", f"{_IMAGES} zarr", Pictures({"svg": _COLORED["svg"]}), "cells seeds labels",
        own=dict.fromkeys(_IMAGES.split(), _LABELS), has_page=True),
    _product("diagram", "", _IMAGES, Pictures({"png": _COLORED["png"]}), "diagram"),
    _product("color", "LabelImage", "", Pictures(_COLORED), "cells seeds", has_page=True, moves=True),
    _product("distance", "", "tiff npy zarr"),
    _product("distance2", "", "tiff npy zarr text"),
    _product("table", "Table", _TABLES),
    _product("neighbors", "", _TABLES),
)

# ---- tessellate, of volumes ----------------------------------------------------------------------
_STACKS = "tiff npy zarr"
_VOXELS = Writer("formats.images.tiff_writer:write_values", ("fmt",))
_SLICES = {fmt: (*layers[:1], *(name for name in layers[1:] if name != "objects")) for fmt, layers in _COLORED.items()}
_VOLUMES = (
    _product("labels", "LabelVolume", _STACKS, own=dict.fromkeys(("tiff", "npy"), _VOXELS), has_page=True),
    _product("diagram", "", _STACKS),
    _product("color", "", "", Pictures(_SLICES), "cells seeds", has_page=True),
    _product("distance", "", _STACKS),
    _product("distance2", "", _STACKS),
    _product("table", "Table", _TABLES),
    _product("neighbors", "", _TABLES),
)

# ---- delaunay ------------------------------------------------------------------------------------
_MESH = dict.fromkeys(("obj", "edge", "ele", "node"), Writer("formats.results.meshes:write_mesh"))
_CELLS = {
    "json": Writer("formats.results.features:write_cells_json", ()),
    "npz": Writer("formats.results.features:write_cells_arrays", ()),
}
_MESHES = "Triangulation DigitalTriangulation"
_EDGED = f"{_MESHES} ProximityGraph"
_MESH_LAYERS = _pictures("cells triangles diagram edges points labels", "render.layers.mesh:mesh")
_DELAUNAY = (
    _product("edges", _EDGED, "csv tsv json geojson npz npy edge obj", _MESH_LAYERS, "edges points", own=_MESH),
    _product("triangles", _MESHES, "csv tsv json geojson npz npy ele obj", _MESH_LAYERS, "triangles edges points",
        own=_MESH),
    _product("cells", "CellSet", "geojson csv tsv json npz wkt",
        _MESH_LAYERS._replace(drawn_by="render.layers.mesh:cell"), "cells points", own=_CELLS, has_page=True),
    _product("table", "Triangulation", f"{_TABLES} node", own=_MESH),
    _product("statistics", "CellStatistics", _TABLES),
    _product("measures", "CellStatistics", _TABLES),
    _product("compare", "", _TABLES),
)

# ---- delaunay, of points in space ----------------------------------------------------------------
_SOLIDS = Writer("formats.results.meshes:write_solid", ("fmt", "what"))
_SOLID = dict.fromkeys(("obj", "ply", "stl", "vtu"), _SOLIDS)
_SPACE_LAYERS = _pictures("hull edges points labels", "render.layers.mesh:space")
_TETRAHEDRA = _product("tetrahedra", "Tetrahedralization", f"{_TABLES} npy vtu", _SPACE_LAYERS, "hull edges points",
    own=_SOLID, has_page=True, usual_for=("vtu",))
_HULL = _product("hull", "Tetrahedralization", f"{_TABLES} npy obj ply stl vtu", _SPACE_LAYERS, "hull", own=_SOLID,
    has_page=True, usual_for=("ply", "stl"))
_SPACE = (
    _product("edges", "Tetrahedralization", f"{_TABLES} npy obj vtu", _SPACE_LAYERS, "edges points", own=_SOLID,
        has_page=True),
    _product("triangles", "Tetrahedralization", f"{_TABLES} npy obj ply stl vtu", _SPACE_LAYERS, "hull edges points",
        own=_SOLID, has_page=True),
    _TETRAHEDRA,
    _HULL._replace(usual_for=("obj", "ply", "stl")),
    _product("cells", "SpaceCellSet", f"{_TABLES} obj ply vtu",
        own=dict.fromkeys(("npz", "obj", "ply", "vtu"), Writer("formats.results.meshes:write_cells",
            ("fmt",)))),
    _product("table", "Tetrahedralization", _TABLES),
)

# ---- alphashape ----------------------------------------------------------------------------------
_POLYGON_FILES = dict.fromkeys(
    ("json", "poly"), Writer("formats.results.features:write_shapes", ("fmt", "what", "flatten"))
)
"""Of features that are polygons."""
_SHAPE_LAYERS = _pictures(
    "polygons delaunay interior boundary singular hull points labels", "render.layers.mesh:alpha"
)
_HULL_LAYERS = _SHAPE_LAYERS._replace(drawn_by="render.layers.mesh:hull")
_EDGES = ("AlphaShape", "csv tsv json geojson npz npy", _SHAPE_LAYERS)
_POLYGONS = ("AlphaShape", "geojson wkt json poly", _SHAPE_LAYERS)
_GENERAL = ("AlphaShape", "geojson wkt", _SHAPE_LAYERS)
_SURFACES = _pictures("surface edges points labels", "render.layers.mesh:surface")
_SURFACE = _product("surface", "SpaceAlphaShape", f"{_TABLES} npy obj ply stl vtu", _SURFACES, "surface", own=_SOLID,
    has_page=True, usual_for=("ply", "stl"))
_SHAPE_TETRAHEDRA = _product("tetrahedra", "SpaceAlphaShape", f"{_TABLES} npy vtu", own=_SOLID, has_page=True,
    usual_for=("vtu",))
_SHAPE_TRIANGLES = _product("triangles", "SpaceAlphaShape", f"{_TABLES} npy obj ply stl vtu", own=_SOLID,
    has_page=True)
_SPACE_SHAPES = (
    _SURFACE._replace(usual_for=("obj", "ply", "stl")),
    _SHAPE_TETRAHEDRA,
    _SHAPE_TRIANGLES,
    _product("edges", "SpaceAlphaShape", f"{_TABLES} npy obj vtu", _SURFACES, "surface edges points", own=_SOLID,
        has_page=True),
    _product("family", "SpaceAlphaComplex", _TABLES, has_page=True),
    _product("spectrum", "SpaceAlphaComplex", f"{_TABLES} npy"),
    _product("curves", "", _TABLES, has_page=True),
    _product("table", "SpaceAlphaShape", _TABLES),
)
_ALPHASHAPE = (
    _product("edges", *_EDGES, "boundary singular points", has_page=True, moves=True),
    _product("polygons", *_POLYGONS, "polygons", own=_POLYGON_FILES, has_page=True, moves=True,
        usual_for=("geojson", "wkt", "poly", "gpkg", "fgb", "shp", "parquet")),
    _product("complex", *_EDGES, "interior boundary singular points", has_page=True, moves=True),
    _product("general", *_GENERAL, "polygons boundary singular points", has_page=True, moves=True),
    _product("family", "AlphaComplex", _TABLES, has_page=True),
    _product("spectrum", "AlphaComplex", f"{_TABLES} npy"),
    _product("curves", "", _TABLES, Pictures({"svg": ()}), has_page=True),
    _product("persistence", "RegionPersistence", _TABLES, Pictures({"svg": ()})),
    _product("hull", "AlphaHull", f"geojson {_TABLES}", _HULL_LAYERS, "hull points"),
    _product("points", "AlphaShape", _TABLES),
    _product("table", "AlphaShape", _TABLES),
)

# ---- skeletons -----------------------------------------------------------------------------------
_DISC_LAYERS = _pictures("polygons discs feet labels", "render.layers.polygons:disc")
_DISC_PRODUCT = _product(
    "discs",
    "Discs",
    f"{_TABLES} geojson wkt",
    _DISC_LAYERS,
    "polygons discs",
    made_by=Made(check="engines.from_skeleton.verify_discs:verify_discs", by="inscribed_discs"),
    is_curved=True,
)


_SKELETON, _OFFSETS, _MAP = (  # all of a result, in JSON and as arrays
    dict.fromkeys(("json", "npz"), Writer(f"formats.results.{function}", ("fmt",)))
    for function in ("skeleton_files:write_skeleton", "skeleton_files:write_offsets", "voronoi_files:write_voronoi")
)
_THICKNESS = Writer("formats.images.label_images:write_thickness", ("fmt",))
_CURVES = "json csv tsv geojson npz wkt"
_ARCS = _pictures("polygons elements points skeleton nodes labels", "render.layers.skeleton:skeleton")
_DIAGRAM = _ARCS._replace(drawn_by="render.layers.skeleton:diagram")
_ALONG = _pictures("polygons skeleton transects points labels", "render.layers.skeleton:point")
_STEPS = Made(check="engines.from_skeleton.points_along:verify_sections", by="points_along")
_SKELETONS = (
    _product("skeleton", "Skeleton", _CURVES, _ARCS, "polygons skeleton", own=_SKELETON, has_page=True, is_curved=True),
    _product("diagram", "", _CURVES, _DIAGRAM, "polygons elements points skeleton", own=_SKELETON, is_curved=True),
    _product("elements", "Skeleton", _TABLES, _ARCS, "polygons elements points"),
    _product("centerline", "Centerlines ExtendedSkeleton SmoothLines", f"geojson {_TABLES} wkt",
        _ARCS._replace(drawn_by="render.layers.skeleton:line"), "polygons skeleton", is_curved=True),
    _product("offset", "Offsets", _CURVES, _pictures("polygons offset labels", "render.layers.polygons:offset"),
        "polygons offset", own=_OFFSETS, is_curved=True, moves=True,
        made_by=Made(check="engines.offsets.verify_offsets:verify_offsets", by="offset_curves")),
    _product("shape", "PolygonSet", "json geojson wkt poly", _pictures("shape labels", "render.layers.polygons:shape"),
        "shape", own=_POLYGON_FILES, made_by=Made("engines.from_skeleton.reconstruction:rebuild")),
    _DISC_PRODUCT,
    _product("points", "SkeletonPoints", f"{_TABLES} npy geojson wkt", _ALONG, "polygons skeleton points",
        made_by=_STEPS),
    _product("transects", "SkeletonPoints", f"geojson wkt {_TABLES}", _ALONG, "polygons skeleton transects",
        made_by=_STEPS),
    _product("thickness", "", "tiff npy", Pictures({"png": ("thickness",)}), "thickness",
        own=dict.fromkeys(("tiff", "npy"), _THICKNESS),
        made_by=Made(check="engines.from_skeleton.thickness:verify_thickness", by="thickness")),
    _product("branches", "Skeleton", _TABLES),
    _product("table", "Skeleton", _TABLES),
)
_OF_WHOLE_AXIS = (
    _product("necks", "Necks", f"{_TABLES} geojson wkt",
        _pictures("polygons skeleton necks labels", "render.layers.skeleton:neck"), "polygons necks",
        made_by=Made("engines.necks.necks:necks", "whole", "engines.necks.verify_necks:verify_necks", "necks")),
    _product("parts", "Parts", "geojson csv tsv npz json wkt poly",
        _pictures("parts skeleton cuts labels", "render.layers.skeleton:part"), "parts",
        made_by=Made("engines.necks.parts:parts", "whole", "engines.necks.verify_necks:verify_parts"),
        own=_POLYGON_FILES),
)
"""Only of exact skeletons."""
_WITHOUT_SAMPLES = {"offset", "discs", "thickness"}
"""Results of the shapes alone, which samples would not change."""


# ---- voronoi -------------------------------------------------------------------------------------
_MAP_LAYERS = _pictures("cells edges objects labels", "render.layers.voronoi:voronoi")
_VORONOI = (
    _product("cells", "VoronoiMap", "geojson csv tsv json npz wkt", _MAP_LAYERS, "cells objects",
        own=_MAP, has_page=True, is_curved=True),
    _product("edges", "VoronoiMap", f"{_TABLES} geojson wkt", _MAP_LAYERS, "edges objects", is_curved=True),
    _product("neighbors", "VoronoiMap", _TABLES),
    _product("table", "VoronoiMap", _TABLES),
    _DISC_PRODUCT,
)
# fmt: on


# ---- distance ------------------------------------------------------------------------------------
_APART_LAYERS = _pictures("first second distances", "render.layers.polygons:distance")
_DISTANCE = tuple(
    _product(what, types, f"{_TABLES} geojson wkt", _APART_LAYERS, "first second distances")
    for what, types in (("distances", "Distances"), ("hausdorff", ""), ("smallest", ""))
)


_BESIDE_EXACT = {fmt: (*layers, "exact") for fmt, layers in _ARCS.layers.items()}
"""Beside approximate skeletons pictures can show exact ones."""
_OF_ALL = {
    fmt: tuple(dict.fromkeys((*layers, *_ARCS.layers[fmt], "offset", "shape", *_MAP_LAYERS.layers[fmt])))
    for fmt, layers in {"png": ("cells", "diagram"), "svg": ("cells",)}.items()
}
"""Layers of pictures of results that were written before: those of all that is read again."""

_BY_COMMAND: dict[str, Sequence[Product]] = {
    "tessellate": _TESSELLATE,
    "delaunay": (*_DELAUNAY, _TETRAHEDRA, _HULL),
    "alphashape": (*_ALPHASHAPE, _SURFACE, _SHAPE_TETRAHEDRA, _SHAPE_TRIANGLES),
    "voronoi": _VORONOI,
    "skeleton-exact": (*_SKELETONS, *_OF_WHOLE_AXIS),
    "skeleton-approx": tuple(
        each._replace(layers=_BESIDE_EXACT) if each.layers is _ARCS.layers else each
        for each in _SKELETONS
        if each.what not in _WITHOUT_SAMPLES
    ),
    "distance": _DISTANCE,
    "draw": (Product("picture", layers=_OF_ALL, has_page=True),),
}
PRODUCTS = {command: {each.what: each for each in products} for command, products in _BY_COMMAND.items()}
"""Products of each command, by name."""
OF_ONE_SHAPE = frozenset(
    {"edges", "polygons", "complex", "general", "hull", "points", "table", "surface", "tetrahedra", "triangles"}
)
"""Results of `alphashape` that are of one radius; the others are of all."""
PLOTS = ("curves", "persistence")
"""Those whose picture is a plot over the radius."""
DERIVED = {each.what: each.made_by for each in PRODUCTS["skeleton-exact"].values() if each.made_by}
"""What makes the results of skeleton commands that follow from a skeleton or its diagram, by their names."""
VOLUME_PRODUCTS = {each.what: each for each in _VOLUMES}
"""Those of `tessellate` where the input is a volume."""
SPACE_PRODUCTS = {each.what: each for each in _SPACE}
"""Those of `delaunay` where the points lie in space."""
SPACE_SHAPES = {each.what: each for each in _SPACE_SHAPES}
"""Those of `alphashape` where the points lie in space."""
OF_SPACE = {"tessellate": VOLUME_PRODUCTS, "delaunay": SPACE_PRODUCTS, "alphashape": SPACE_SHAPES}
"""Those of commands whose inputs may have three axes, where they do."""


_OF_PARTS = "skeleton diagram elements branches points transects necks offset centerline"
NAMING_FEATURES = frozenset(f"edges triangles complex family neighbors {_OF_PARTS}".split(" "))
"""Products whose rows are parts of features, or about several: they have the columns of these that are asked for."""


@cache
def formats_of(command: str) -> dict[str, tuple[str, ...]]:
    """Give the formats of each product of a command, the default first."""
    return {what: product.formats for what, product in PRODUCTS[command].items()}


def layers_of(command: str) -> dict[str, tuple[str, ...]]:
    """Give the layers of all pictures of a command, by their format."""
    own = PRODUCTS[command].values()
    return {fmt: tuple(dict.fromkeys(name for each in own for name in each.layers.get(fmt, ()))) for fmt in PICTURES}


def all_layers(command: str) -> tuple[str, ...]:
    """Give the layers that a picture of a command can have, whatever its format."""
    by_format = layers_of(command)
    return tuple(dict.fromkeys([*by_format["png"], *by_format["svg"]]))


def is_of(value: object, *types: str) -> bool:
    """Whether a value is of one of the public types; none of them is imported to tell."""
    return any(base.__name__ in types and base.__module__.startswith("vorotool.") for base in type(value).__mro__)


def parts_of(value: object) -> dict[str, Product]:
    """Give the products that a value is written as, the usual first."""
    found: dict[str, Product] = {}
    for product in (
        each
        for own in (*PRODUCTS.values(), SPACE_PRODUCTS, SPACE_SHAPES)
        for each in own.values()
        if is_of(value, *each.types)
    ):
        found.setdefault(product.what, product)
    return found


def public_types() -> list[str]:
    """Give the names of all types that can be written."""
    return list(
        dict.fromkeys(
            name for own in (*PRODUCTS.values(), SPACE_SHAPES) for each in own.values() for name in each.types
        )
    )


# ---- what writes a value in a format ------------------------------------------------------------
_IN_PLACE = "Table", "LedOn", "SmoothLines"
"""Types that are written under the name of another result, in the formats of rows and features."""


def write_product(
    out: BinaryIO,
    value: Any,
    product: Product,
    fmt: str,
    *,
    flatten: float | None = None,
    path: str = "-",
) -> None:
    """Write a result in one of its formats; pictures and pages are none of these."""
    chosen = FORMATS[fmt]
    written = resolved("numeric.coordinates:current_written")()
    written.crs = getattr(value, "crs", None)
    written.has_y_down = written.has_y_down or getattr(value, "y_axis", None) == "down"
    writer = chosen.writers.get(product.what, chosen.writer)
    if writer is None and fmt not in product.data:
        source = next(name for name in chosen.made_from if name in product.data)
        with resolved(chosen.maker)(out, product.what, path) as taker:
            write_product(taker, value, product, source, flatten=flatten)
        return
    writer = writer or (GENERAL if is_of(value, *_IN_PLACE) else product.own.get(fmt, GENERAL))
    given = {"fmt": fmt, "what": product.what, "flatten": flatten, "product": product}
    resolved(writer.function)(out, value, **{name: given[name] for name in writer.takes})


def known_parts(value: Any) -> dict[str, Product]:
    """Give the parts of a value that can be written or drawn, or refuse one that is none of ours."""
    parts = parts_of(value)
    if not parts:
        *others, last = public_types()
        raise UsageError(f"a {type(value).__name__} cannot be written: give a {', '.join(others)} or {last}")
    return parts


def chosen_part(value: Any, fmt: str, what: str | None) -> Product:
    """Choose what of a value is written."""
    parts, name = known_parts(value), type(value).__name__
    if what is not None and not (isinstance(what, str) and what in parts):
        instead = f"use {' or '.join(parts)}" if len(parts) > 1 else "leave it out"
        shown = resolved("numeric.numbers:shown_number")(what)
        close = meant(what, parts) if isinstance(what, str) else ""
        raise UsageError(f"what={shown} is not a result of a {name}: {instead}{close}")
    having = [each for each in parts.values() if fmt in each.written]
    usual = [each for each in having if fmt in each.usual_for]
    chosen = parts[what] if what is not None else next(iter([*usual, *having, *parts.values()]))
    if fmt not in chosen.written:
        possible = dict.fromkeys([*chosen.written, *chosen.layers])
        part = chosen.what if len(parts) > 1 else f"a {name}"
        raise UsageError(f"{part} cannot be written as {fmt!r}: use one of {', '.join(possible)}")
    return chosen
