"""All results that can be written: of which type each is, its layers, and what writes it in which format."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from vorotool.products.formats import FORMATS, PICTURES, TABLE_WRITER, TABLES, Format, Writer


@dataclass(frozen=True, slots=True)
class Product:
    """A result that can be written, as ``what`` has it.

    Parameters
    ----------
    what : str
        Its name.
    types : tuple of str
        Public types of the values that it is written from; those of them that are not the whole value are its parts.
    data : tuple of str
        Formats that ``writer`` writes, the default first.
    writer : Writer
        Of all these but tables, which have one of their own.
    layers : mapping of str to sequence of str
        Layers of its pictures, from below, by the format of the picture.
    usual_layers : tuple of str
        Those that a picture has where none are chosen.
    has_page : bool
        The command line writes it as a page of HTML, too.
    is_curved : bool
        It has curves.
    usual_for : tuple of str
        Formats for which it is taken where ``what`` is not given; else the first product that has the format is.
    """

    what: str
    types: tuple[str, ...] = ()
    data: tuple[str, ...] = ()
    writer: Writer | None = None
    layers: Mapping[str, Sequence[str]] = field(default_factory=dict)
    usual_layers: tuple[str, ...] = ()
    has_page: bool = False
    is_curved: bool = False
    usual_for: tuple[str, ...] = ()

    @property
    def written(self) -> tuple[str, ...]:
        """Formats of data: its own, and those that name it or can be made from one of its own."""
        return (
            *self.data,
            *(each.name for each in FORMATS.values() if each.name not in self.data and self._fits(each)),
        )

    def _fits(self, each: Format) -> bool:
        return self.what in each.writers or any(name in self.data for name in each.made_from)

    @property
    def formats(self) -> tuple[str, ...]:
        """All formats, the default first."""
        pages = ("html",) if self.has_page else ()
        return tuple(dict.fromkeys((*self.written, *self.layers, *pages)))


def _pictures(*layers: str) -> dict[str, Sequence[str]]:
    return dict.fromkeys(PICTURES, layers)


# ---- tessellate ----------------------------------------------------------------------------------
_IMAGES = ("png", "tiff", "npy", "text")
_COLOURED = {"png": ("cells", "diagram", "seeds", "labels"), "svg": ("cells", "labels", "seeds")}
_TESSELLATE = (
    Product(
        "labels",
        ("LabelImage",),
        (*_IMAGES, "zarr"),
        Writer("formats.images.label_images:write_labels", ("fmt", "threads")),
        layers={"svg": _COLOURED["svg"]},
        usual_layers=("cells", "seeds", "labels"),
    ),
    Product("diagram", (), _IMAGES, layers={"png": _COLOURED["png"]}, usual_layers=("diagram",)),
    Product("colour", ("LabelImage",), layers=_COLOURED, usual_layers=("cells", "seeds")),
    Product("distance", (), ("tiff", "npy", "zarr")),
    Product("distance2", (), ("tiff", "npy", "zarr", "text")),
    Product("table", ("Table",), TABLES, TABLE_WRITER),
    Product("neighbours", (), TABLES, TABLE_WRITER),
)

# ---- delaunay ------------------------------------------------------------------------------------
_MESH = Writer("formats.results.meshes:write_mesh")
_MESHES = ("Triangulation", "DigitalTriangulation")
_MESH_LAYERS = _pictures("cells", "triangles", "diagram", "edges", "points", "labels")
_DELAUNAY = (
    Product(
        "edges",
        _MESHES,
        ("csv", "json", "geojson", "npz", "edge", "obj"),
        _MESH,
        _MESH_LAYERS,
        usual_layers=("edges", "points"),
    ),
    Product(
        "triangles",
        _MESHES,
        ("csv", "json", "geojson", "npz", "ele", "obj"),
        _MESH,
        _MESH_LAYERS,
        usual_layers=("triangles", "edges", "points"),
    ),
    Product(
        "cells",
        ("CellSet",),
        ("geojson", "csv", "json", "npz", "wkt"),
        Writer("formats.results.cells:write_cells", ("fmt", "precision", "threads")),
        _MESH_LAYERS,
        usual_layers=("cells", "points"),
    ),
    Product("table", _MESHES, (*TABLES, "node"), _MESH),
    Product("compare", (), TABLES, TABLE_WRITER),
)

# ---- alphashape ----------------------------------------------------------------------------------
_SHAPE = Writer("formats.results.alpha:write_shape")
_SHAPE_LAYERS = _pictures("polygons", "delaunay", "interior", "boundary", "singular", "hull", "points", "labels")
_EDGE_FORMATS = ("csv", "json", "geojson", "npz")
_ALPHASHAPE = (
    Product(
        "edges",
        ("AlphaShape",),
        _EDGE_FORMATS,
        _SHAPE,
        _SHAPE_LAYERS,
        usual_layers=("boundary", "singular", "points"),
        has_page=True,
    ),
    Product(
        "polygons",
        ("AlphaShape",),
        ("geojson", "wkt", "json", "poly"),
        _SHAPE,
        _SHAPE_LAYERS,
        usual_layers=("polygons",),
        has_page=True,
        usual_for=("geojson", "wkt", "poly"),
    ),
    Product(
        "complex",
        ("AlphaShape",),
        _EDGE_FORMATS,
        _SHAPE,
        _SHAPE_LAYERS,
        usual_layers=("interior", "boundary", "singular", "points"),
        has_page=True,
    ),
    Product(
        "general",
        ("AlphaShape",),
        ("geojson", "wkt"),
        _SHAPE,
        _SHAPE_LAYERS,
        usual_layers=("polygons", "boundary", "singular", "points"),
        has_page=True,
    ),
    Product("family", ("AlphaComplex",), TABLES, _SHAPE, has_page=True),
    Product("spectrum", ("AlphaComplex",), TABLES, _SHAPE),
    Product("curves", (), TABLES, TABLE_WRITER, layers={"svg": ()}, has_page=True),
    Product("hull", ("AlphaHull",), ("geojson", *TABLES), _SHAPE, _SHAPE_LAYERS, usual_layers=("hull", "points")),
    Product("points", ("AlphaShape",), TABLES, _SHAPE),
    Product("table", ("AlphaShape",), TABLES, _SHAPE),
)

# ---- skeletons -----------------------------------------------------------------------------------
_SKELETON = Writer("formats.results.skeletons:write_skeleton", ("fmt", "what", "flatten", "precision", "threads"))
_POINTS = Writer("formats.results.points_along:write_skeleton_points")
_LINES = ("fmt", "flatten", "precision", "threads")
_SKELETON_FORMATS = ("json", "csv", "geojson", "npz", "wkt")
_SKELETON_LAYERS = _pictures("polygons", "elements", "points", "skeleton", "nodes", "labels")
_OF_POINTS = _pictures("polygons", "skeleton", "transects", "points")
_SKELETONS = (
    Product(
        "skeleton",
        ("Skeleton",),
        _SKELETON_FORMATS,
        _SKELETON,
        _SKELETON_LAYERS,
        usual_layers=("polygons", "skeleton"),
        has_page=True,
        is_curved=True,
    ),
    Product(
        "diagram",
        (),
        _SKELETON_FORMATS,
        _SKELETON,
        _SKELETON_LAYERS,
        usual_layers=("polygons", "elements", "points", "skeleton"),
        is_curved=True,
    ),
    Product(
        "elements",
        ("Skeleton",),
        TABLES,
        _SKELETON,
        _SKELETON_LAYERS,
        usual_layers=("polygons", "elements", "points"),
    ),
    Product(
        "centerline",
        ("Centerlines",),
        ("geojson", *TABLES, "wkt"),
        Writer("formats.results.centerlines:write_centerlines", _LINES),
        _SKELETON_LAYERS,
        usual_layers=("polygons", "skeleton"),
        is_curved=True,
    ),
    Product(
        "offset",
        ("Offsets",),
        _SKELETON_FORMATS,
        Writer("formats.results.offsets:write_offsets", _LINES),
        _pictures("polygons", "offset"),
        usual_layers=("polygons", "offset"),
        is_curved=True,
    ),
    Product(
        "shape",
        ("PolygonSet",),
        ("json", "geojson", "wkt", "poly"),
        Writer("formats.polygons.reader:write_polygons", ("fmt", "precision")),
        _pictures("shape"),
        usual_layers=("shape",),
    ),
    Product(
        "points",
        ("SkeletonPoints",),
        (*TABLES, "geojson", "wkt"),
        _POINTS,
        _OF_POINTS,
        usual_layers=("polygons", "skeleton", "points"),
    ),
    Product(
        "transects",
        ("SkeletonPoints",),
        ("geojson", "wkt", *TABLES),
        _POINTS,
        _OF_POINTS,
        usual_layers=("polygons", "skeleton", "transects"),
    ),
    Product("branches", ("Skeleton",), TABLES, _SKELETON),
    Product("table", ("Skeleton",), TABLES, _SKELETON),
)


def _beside_exact(product: Product) -> Product:
    """Beside approximate skeletons pictures can show exact ones."""
    shown = product.layers is _SKELETON_LAYERS
    return replace(product, layers=_pictures(*_SKELETON_LAYERS["svg"], "exact")) if shown else product


def _drawn() -> Product:
    """The picture of a result that was written before: the layers of all that is read again."""
    of_labels = {"png": ("cells", "diagram"), "svg": ("cells",)}
    of_lines = (*_SKELETON_LAYERS["svg"], "offset", "shape")
    return Product("picture", layers={fmt: (*layers, *of_lines) for fmt, layers in of_labels.items()})


_BY_COMMAND: dict[str, Sequence[Product]] = {
    "tessellate": _TESSELLATE,
    "delaunay": _DELAUNAY,
    "alphashape": _ALPHASHAPE,
    "skeleton-exact": _SKELETONS,
    "skeleton-approx": tuple(map(_beside_exact, _SKELETONS)),
    "draw": (_drawn(),),
}
PRODUCTS = {command: {each.what: each for each in products} for command, products in _BY_COMMAND.items()}
"""Products of each command, by name."""


def formats_of(command: str) -> dict[str, tuple[str, ...]]:
    """Give the formats of each product of a command, the default first.

    Examples
    --------
    >>> formats_of("tessellate")["distance"]
    ('tiff', 'npy', 'zarr')
    """
    return {what: product.formats for what, product in PRODUCTS[command].items()}


def layers_of(command: str) -> tuple[str, ...]:
    """Give the layers of all pictures of a command.

    Examples
    --------
    >>> layers_of("tessellate")
    ('cells', 'diagram', 'seeds', 'labels')
    """
    products = PRODUCTS[command].values()
    return tuple(
        dict.fromkeys(name for fmt in ("png", "svg") for each in products for name in each.layers.get(fmt, ()))
    )


def is_of(value: object, *types: str) -> bool:
    """Whether a value is of one of the public types; none of them is imported to tell.

    Examples
    --------
    >>> from vorotool import Table
    >>> is_of(Table({"a": [1]}), "Table"), is_of([1], "Table")
    (True, False)
    """
    return any(base.__name__ in types and base.__module__.startswith("vorotool.") for base in type(value).__mro__)


def parts_of(value: object) -> dict[str, Product]:
    """Give the products that a value is written as, the usual first.

    Examples
    --------
    >>> from vorotool import delaunay
    >>> list(parts_of(delaunay([[0, 0], [4, 0], [0, 3]])))
    ['edges', 'triangles', 'table']
    """
    found: dict[str, Product] = {}
    for product in (each for own in PRODUCTS.values() for each in own.values() if is_of(value, *each.types)):
        found.setdefault(product.what, product)
    return found


def public_types() -> list[str]:
    """Give the names of all types that can be written.

    Examples
    --------
    >>> public_types()[:4]
    ['LabelImage', 'Table', 'Triangulation', 'DigitalTriangulation']
    """
    return list(dict.fromkeys(name for own in PRODUCTS.values() for each in own.values() for name in each.types))
