"""Tables of alpha shapes and of their family, in labels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.numbers import distinct
from vorotool.types.alpha.complex import CLASSES, AlphaComplex
from vorotool.types.alpha.shape import POINT_CLASSES, AlphaShape
from vorotool.types.features import Corners, Mixture, Rows, chosen, of_points, point_rows, without_places
from vorotool.types.identity import with_ends
from vorotool.types.mesh.tables import end_columns
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.table import Lookup, Table


def shape_edge_table(shape: AlphaShape, *, interior: bool = False) -> Table:
    """Return one row an edge of a shape, in the order of the family."""
    family = shape.family
    classes = shape.edge_classes
    chosen = np.flatnonzero(classes).astype(np.int32) if interior else shape.edge_index
    columns = {
        **end_columns(family.mesh, family.edges[chosen]),
        "length": family.lengths[chosen],
        "r_min": family.r_min[chosen],
        "r_max": family.r_max[chosen],
        "class": _named(CLASSES, classes[chosen]),
    }
    return with_ends(columns, family.mesh.properties, dict(zip("ab", family.edges[chosen].T, strict=True)))


def family_table(family: AlphaComplex) -> Table:
    """Return one row a Delaunay edge: the radii at which it enters, bounds a triangle, and goes inside."""
    labels = family.mesh.label_array
    a, b = np.ascontiguousarray(family.edges.T)
    columns = {
        "label_a": Lookup(labels, a),
        "label_b": Lookup(labels, b),
        "r_min": family.r_min,
        "r_mid": family.r_mid,
        "r_max": family.r_max,
    }
    return with_ends(columns, family.mesh.properties, {"a": a, "b": b})


def shape_point_table(shape: AlphaShape) -> Table:
    """Return one row a point, in the order of the input."""
    mesh = shape.family.mesh
    x, y = np.ascontiguousarray(mesh.points.T)
    label, *others = _point_columns(shape).items()
    return Table(dict([label, ("x", x), ("y", y), *others])).with_properties(mesh.properties)


def _point_columns(shape: AlphaShape) -> dict[str, Any]:
    region = shape.point_regions
    return {
        "label": shape.family.mesh.label_array,
        "class": _named(POINT_CLASSES, shape.point_classes),
        "region": np.ma.array(region + 1, mask=region < 0),
    }


def region_table(shape: AlphaShape) -> Table:
    """Return one row a region of a shape."""
    inside, count = shape.inside, shape.region_count
    of = shape.region[inside]
    corners = shape.family.mesh.triangles[inside]
    pairs = distinct(of.astype(np.int64).repeat(3) << 32 | corners.reshape(-1))
    places = shape.points[corners]
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(low, of, places.min(axis=1))
    np.maximum.at(high, of, places.max(axis=1))
    return Table(
        {
            "region": np.arange(1, count + 1),
            "area": shape.region_areas,
            "perimeter": _perimeters(shape),
            "holes": shape.holes_of_regions,
            "points": np.bincount(pairs >> 32, minlength=count),
            "triangles": np.bincount(of, minlength=count),
            "bbox_x": low[:, 0],
            "bbox_y": low[:, 1],
            "bbox_w": high[:, 0] - low[:, 0],
            "bbox_h": high[:, 1] - low[:, 1],
        }
    )


def _perimeters(shape: AlphaShape) -> NDArray[np.float64]:
    boundary = shape.edge_index[shape.kind == CLASSES.index("boundary")]
    region = np.append(shape.region, np.int32(-1))[shape.family.sides[boundary]].max(axis=1)
    lengths = shape.family.lengths[boundary]
    return np.bincount(region, lengths, shape.region_count).astype(np.float64)


def _named(names: tuple[str, ...], numbers: NDArray[np.uint8]) -> list[str]:
    return [names[number] for number in numbers.tolist()]


def described_polygons(shape: AlphaShape) -> PolygonSet:
    """Return the polygons of a shape with the area, the perimeter and the number of holes of each."""
    described = {
        "area": shape.region_areas.tolist(),
        "perimeter": _perimeters(shape).tolist(),
        "holes": shape.holes_of_regions.tolist(),
    }
    return replace(shape.polygons, properties=described)


def shape_rows(shape: AlphaShape, what: str | None) -> Rows:
    """Return the rows of a part, by default of the regions."""
    makers: dict[str | None, Callable[[AlphaShape], Table]] = {
        "edges": shape_edge_table,
        "complex": partial(shape_edge_table, interior=True),
        "points": shape_point_table,
    }
    return Rows(makers.get(what, region_table)(shape))


def shape_features(shape: AlphaShape, what: str | None) -> Rows | Mixture:
    """Return the rows of a part with their geometry, by default of the polygons."""
    if what == "general":
        return _general(shape)
    return chosen(
        shape,
        what,
        {
            "polygons": lambda: _polygons(shape),
            "edges": lambda: _edges(shape),
            "complex": lambda: _edges(shape, interior=True),
            "points": lambda: point_rows(_point_columns(shape), shape.family.mesh, shape.points),
        },
    )


def _edges(shape: AlphaShape, *, interior: bool = False) -> Rows:
    family = shape.family
    columns = without_places(shape_edge_table(shape, interior=interior))
    index = family.edges[np.flatnonzero(shape.edge_classes)] if interior else shape.edges
    geometry = Corners(family.points, index)
    return Rows(columns, {}, family.mesh, None, geometry, ids=np.arange(1, len(index) + 1))


def _polygons(shape: AlphaShape) -> Rows:
    polygons = described_polygons(shape)
    return Rows({"region": _numbers(shape), **polygons.properties}, {}, shape.family.mesh, None, polygons)


def _numbers(shape: AlphaShape) -> list[int]:
    return list(range(1, shape.region_count + 1))


def _general(shape: AlphaShape) -> Mixture:
    """Return all of a shape: regions as polygons, singular edges as lines, isolated points."""
    mesh, count = shape.family.mesh, shape.region_count
    polygons = described_polygons(shape)
    named = {"class": ["region"] * count, "region": _numbers(shape), **polygons.properties}
    a, b = singular = shape.edges[shape.kind == CLASSES.index("singular")].T
    edges = {"class": ["singular"] * len(a), "label_a": mesh.label_array[a], "label_b": mesh.label_array[b]}
    points = {"class": ["isolated"] * len(shape.isolated), "label": mesh.label_array[shape.isolated]}
    return Mixture(
        (
            Rows(named, {}, mesh, None, replace(polygons, ids=None, properties=named)),
            Rows(edges, {}, mesh, None, Corners(mesh.points, singular.T)),
            Rows(points, {}, mesh, shape.isolated, of_points(mesh.points[shape.isolated])),
        )
    )
