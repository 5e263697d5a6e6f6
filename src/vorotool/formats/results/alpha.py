"""GeoJSON and WKT of alpha shapes: edges, all parts of a shape, the hull."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.io.npy_arrays import write_array
from vorotool.formats.polygons.writer import write_polygons
from vorotool.formats.results.meshes import write_features
from vorotool.formats.text.coordinate_text import coordinate_text
from vorotool.formats.text.feature_collection import collection_opening
from vorotool.formats.text.tables import json_text, write_table
from vorotool.formats.written.polygons import written_polygons
from vorotool.geometry.alpha.complex import CLASSES, AlphaComplex
from vorotool.geometry.alpha.hull import AlphaHull
from vorotool.geometry.alpha.persistence import RegionPersistence
from vorotool.geometry.alpha.shape import AlphaShape
from vorotool.geometry.alpha.tables import (
    described_polygons,
    family_table,
    region_table,
    shape_edge_table,
    shape_point_table,
)
from vorotool.geometry.coordinate_grid import on_grid
from vorotool.geometry.mesh.tables import END_PLACES
from vorotool.geometry.mesh.triangulation import Triangulation
from vorotool.geometry.polygons.polygon_set import HOLE, SHELL, PolygonSet, set_of_rings
from vorotool.geometry.ragged import owners, within
from vorotool.geometry.table import Table
from vorotool.products.formats import TABLES

_TABLES: dict[str, Callable[[Any], Table]] = {
    "edges": shape_edge_table,
    "complex": partial(shape_edge_table, interior=True),
    "points": shape_point_table,
    "table": region_table,
    "family": family_table,
    "spectrum": lambda family: Table({"r": family.spectrum}),
    "hull": AlphaHull.table,
    "persistence": RegionPersistence.table,
}


def write_shape(
    out: BinaryIO,
    value: AlphaShape | AlphaComplex | AlphaHull | RegionPersistence,
    fmt: str,
    *,
    what: str,
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write a part of a shape, the radii of a family, a hull, or the persistence of regions."""
    shape: Any = value
    if fmt == "npy":
        write_array(out, _array(shape, what))
    elif fmt in TABLES and what in _TABLES:
        write_table(out, _TABLES[what](shape), fmt, precision=precision, threads=threads)
    elif what == "polygons":
        write_polygons(out, described_polygons(shape), fmt)
    elif what == "general":
        write_general(out, shape, fmt)
    elif what == "hull":
        write_hull_geojson(out, shape)
    else:
        write_shape_edges(out, shape, interior=what == "complex", precision=precision, threads=threads)


def _array(shape: Any, what: str) -> NDArray[Any]:
    """Points of edges, from 0 in the order of the input; or the radii of the spectrum."""
    if what == "spectrum":
        radii: NDArray[np.float64] = shape.spectrum
        return radii
    chosen: NDArray[np.int32] = shape.family.edges[np.flatnonzero(shape.edge_classes)]
    return chosen if what == "complex" else shape.edges


def write_shape_edges(
    out: BinaryIO, shape: AlphaShape, *, interior: bool = False, precision: int | None = None, threads: int = 0
) -> None:
    """Write edges as GeoJSON: LineStrings with labels, length, radii and class."""
    table = shape_edge_table(shape, interior=interior).stored()
    chosen = np.flatnonzero(shape.edge_classes) if interior else shape.edge_index
    columns = {name: column for name, column in table.items() if name.removeprefix("voro_") not in END_PLACES}
    mesh = shape.family.mesh
    write_features(out, columns, shape.family.edges[chosen], mesh, precision=precision, threads=threads)


def write_general(out: BinaryIO, shape: AlphaShape, fmt: str) -> None:
    """Write all of a shape: regions as polygons, singular edges as lines, isolated points."""
    if fmt == "wkt":
        for geometry, _ in _parts(shape):
            out.write(f"{geometry['type'].upper()} {_wkt(geometry)}\n".encode())
    else:
        _write_collection(out, shape.family.mesh, _parts(shape))


def write_hull_geojson(out: BinaryIO, hull: AlphaHull) -> None:
    """Write a hull as GeoJSON: its rings flattened to polygons, and points without extent."""
    mesh = hull.shape.family.mesh

    def parts() -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
        polygons = written_polygons(_polygon_set(hull.polygons()))
        for k in range(len(polygons)):
            yield {"type": "Polygon", "coordinates": _closed_rings(polygons, k)}, {"class": "hull"}
        for v in hull.points.tolist():
            place = on_grid(mesh.points[v]).tolist()
            yield {"type": "Point", "coordinates": place}, {"class": "point", "label": int(mesh.label_array[v])}

    _write_collection(out, mesh, parts())


def _polygon_set(polygons: list[list[NDArray[np.float64]]]) -> PolygonSet:
    rings = [ring for polygon in polygons for ring in polygon]
    counts = np.array([len(polygon) for polygon in polygons], dtype=np.int64)
    kinds = np.where(within(counts) == 0, SHELL, HOLE)
    xy = np.concatenate([np.empty((0, 2)), *rings])
    return set_of_rings(xy, [len(ring) for ring in rings], kinds, owners(counts))


def _closed_rings(polygons: PolygonSet, index: int) -> list[list[list[float]]]:
    return [[*ring, ring[0]] for ring in (each.tolist() for each in polygons.rings_of(index))]


def _parts(shape: AlphaShape) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    """Geometry and properties of each part."""
    mesh = shape.family.mesh
    polygons = written_polygons(described_polygons(shape))
    for k in range(len(polygons)):
        values = {name: column[k] for name, column in polygons.properties.items()}
        yield (
            {"type": "Polygon", "coordinates": _closed_rings(polygons, k)},
            {"class": "region", "region": k + 1, **values},
        )
    for a, b in shape.edges[shape.kind == CLASSES.index("singular")].tolist():
        labels = {"label_a": int(mesh.label_array[a]), "label_b": int(mesh.label_array[b])}
        yield (
            {"type": "LineString", "coordinates": on_grid(mesh.points[[a, b]]).tolist()},
            {"class": "singular", **labels},
        )
    for v in shape.isolated.tolist():
        place = on_grid(mesh.points[v]).tolist()
        yield {"type": "Point", "coordinates": place}, {"class": "isolated", "label": int(mesh.label_array[v])}


def _write_collection(
    out: BinaryIO, mesh: Triangulation, parts: Iterator[tuple[dict[str, Any], dict[str, Any]]]
) -> None:
    out.write(collection_opening(mesh.crs, mesh.y_axis))
    separator = "\n"
    for geometry, properties in parts:
        feature = {"type": "Feature", "properties": properties, "geometry": geometry}
        out.write((separator + json_text(feature)).encode())
        separator = ",\n"
    out.write(b"\n]}\n" if separator != "\n" else b"]}\n")


def _wkt(geometry: dict[str, Any]) -> str:
    def position(place: list[float]) -> str:
        return " ".join(map(coordinate_text, place))

    def line(places: list[list[float]]) -> str:
        return f"({', '.join(map(position, places))})"

    coordinates = geometry["coordinates"]
    if geometry["type"] == "Point":
        return f"({position(coordinates)})"
    return line(coordinates) if geometry["type"] == "LineString" else f"({', '.join(map(line, coordinates))})"
