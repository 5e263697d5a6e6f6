"""Writing edges, triangles, tetrahedra and points in every format that has a place for them."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterator
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError, warn
from vorotool.formats.text.row_writer import Column, RowShape, write_rows
from vorotool.numeric.arrays import Floats
from vorotool.numeric.coordinates import on_grid
from vorotool.types.mesh.cells import ProximityGraph
from vorotool.types.mesh.tetrahedralization import Tetrahedralization
from vorotool.types.mesh.triangulation import AnyTriangulation, DigitalTriangulation, Triangulation
from vorotool.types.table import Lookup


def write_mesh(
    out: BinaryIO,
    mesh: AnyTriangulation | ProximityGraph,
    fmt: str,
    *,
    what: str = "edges",
    precision: int | None = None,
    threads: int = 0,
) -> None:
    """Write edges, triangles or points; the bytes depend on nothing but the mesh, the format and the precision."""
    if fmt == "obj":
        rows = mesh.edges if what == "edges" else mesh.triangles
        between = [" "] * (rows.shape[1] - 1)
        write_rows(out, _places(mesh), RowShape(("v ", " ", " 0\n")), precision=precision, threads=threads)
        shape = RowShape(("l " if what == "edges" else "f ", *between, "\n"))
        write_rows(out, _numbers(mesh, rows, 1), shape, threads=threads)
        return
    if isinstance(mesh, DigitalTriangulation):
        raise UsageError(
            f"{what} as {fmt!r} needs a triangulation, but the result is of a digital tessellation; write its edges "
            "or triangles as csv, json, geojson, npz or obj"
        )
    counts, columns = _TRIANGLE[fmt](mesh)
    rows_of_columns = len(columns[0].values)
    out.write(f"{rows_of_columns} {counts}\n".encode())
    numbers = Column("", np.arange(rows_of_columns, dtype=np.int64) + mesh.first_number)
    shape = RowShape(("", *[" "] * len(columns), "\n"))
    write_rows(out, [numbers, *columns], shape, precision=precision, threads=threads)


def _places(mesh: AnyTriangulation | ProximityGraph) -> list[Column]:
    return [Column.of_places(values) for values in mesh.points.T]


def _numbers(mesh: AnyTriangulation | ProximityGraph, rows: NDArray[np.int32], first: int) -> list[Column]:
    """Columns of vertices by their numbers, the first of which is given."""
    numbers = np.arange(len(mesh.points), dtype=np.int64) + first
    return [Column("", Lookup(numbers, index)) for index in rows.T]


# ---- Triangle: what follows the number of rows in the header, and the number of a row -------------------------------
def _edge(mesh: Triangulation | ProximityGraph) -> tuple[str, list[Column]]:
    """Give the number of markers; two ends and the marker of each edge."""
    return "1", [*_numbers(mesh, mesh.edges, mesh.first_number), Column.of("", mesh.hull_edges.astype(np.int64))]


def _ele(mesh: Triangulation) -> tuple[str, list[Column]]:
    """Give the numbers of nodes and attributes a triangle; its nodes."""
    return "3 0", _numbers(mesh, mesh.triangles, mesh.first_number)


def _node(mesh: Triangulation) -> tuple[str, list[Column]]:
    """Give the numbers of dimensions, attributes and markers; x, y and the marker of each vertex."""
    on_hull = np.zeros(len(mesh.points), dtype=np.int64)
    on_hull[mesh.hull] = 1
    return "2 0 1", [*_places(mesh), Column("", on_hull)]


_TRIANGLE: dict[str, Callable[[Any], tuple[str, list[Column]]]] = {"edge": _edge, "ele": _ele, "node": _node}


Index = NDArray[np.int32]

_BLOCK = 3 << 18
"""Bytes that become text at a time: threes become fours, so that only the last block is padded."""


def write_solid(out: BinaryIO, mesh: Tetrahedralization, fmt: str, *, what: str, threads: int = 0) -> None:
    """Write tetrahedra, triangles, the hull or edges; the bytes depend on nothing but these and the format."""
    places = np.ascontiguousarray(np.stack([on_grid(column) for column in np.ascontiguousarray(mesh.points.T)], axis=1))
    _SOLIDS[fmt](out, places, getattr(mesh, what), mesh.label_array, threads)


# ---- OBJ -----------------------------------------------------------------------------------------
def _write_obj(out: BinaryIO, places: Floats, corners: Index, _labels: Any, threads: int) -> None:
    """Lines ``v x y z``, then faces or lines by the numbers of their corners from 1."""
    vertices = [Column("", np.ascontiguousarray(column), is_place=True) for column in places.T]
    write_rows(out, vertices, RowShape(("v ", " ", " ", "\n")), threads=threads)
    numbers = [Column("", column + np.int64(1)) for column in np.ascontiguousarray(corners.T)]
    kind = "f " if len(numbers) == 3 else "l "
    write_rows(out, numbers, RowShape((kind, *[" "] * (len(numbers) - 1), "\n")), threads=threads)


# ---- PLY -----------------------------------------------------------------------------------------
def _write_ply(out: BinaryIO, places: Floats, corners: Index, labels: Any, _threads: int) -> None:
    """Vertices with their labels, and faces, as little-endian numbers."""
    vertices = np.empty(len(places), dtype=[("xyz", "<f8", 3), ("label", "<i4")])
    if labels.max(initial=0) > np.iinfo(np.int32).max:
        raise InputError("PLY holds labels up to 2147483647: write VTU, or leave the labels out")
    vertices["xyz"], vertices["label"] = places, labels
    faces = np.empty(len(corners), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, corners
    header = [
        *("ply", "format binary_little_endian 1.0", f"element vertex {len(places)}"),
        *(f"property double {axis}" for axis in "xyz"),
        *("property int label", f"element face {len(corners)}", "property list uchar int vertex_indices", "end_header"),
    ]
    out.write("".join(f"{line}\n" for line in header).encode())
    for rows in (vertices, faces):
        for part in _parts(rows):
            out.write(part.tobytes())


# ---- STL -----------------------------------------------------------------------------------------
def _write_stl(out: BinaryIO, places: Floats, corners: Index, _labels: Any, _threads: int) -> None:
    """Triangles with their normals, in single precision."""
    with np.errstate(over="ignore"):
        single = places.astype("<f4")
    if not np.isfinite(single).all():
        raise InputError("STL holds coordinates up to 3.4e38: write PLY, OBJ or VTU")
    used = np.unique(corners)
    lost = len(used) - len(np.unique(single[used], axis=0))
    if lost:
        warn(f"STL holds 7 digits, in which {lost} corners coincide with others: PLY, OBJ and VTU hold all digits")
    out.write(b"vorotool".ljust(80) + len(corners).to_bytes(4, "little"))
    for part in _parts(corners):
        rows = np.zeros(len(part), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        a, b, c = np.moveaxis(places[part], 1, 0)
        rows["normal"], rows["corners"] = _normals(b - a, c - a), single[part]
        out.write(rows.tobytes())


def _normals(u: Floats, v: Floats) -> Floats:
    """Normals of length 1; zero where a triangle is too thin to have one."""
    with np.errstate(all="ignore"):
        normals = np.cross(u / np.abs(u).max(axis=1, keepdims=True), v / np.abs(v).max(axis=1, keepdims=True))
        normals /= np.sqrt((normals * normals).sum(axis=1, keepdims=True))
    return np.nan_to_num(normals, nan=0.0, posinf=0.0, neginf=0.0)


# ---- VTU -----------------------------------------------------------------------------------------
VTU_HEAD = (
    b'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
    b'header_type="UInt64">\n<UnstructuredGrid>\n'
)
VTU_END = b"</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
_CELL_TYPES = {2: 3, 3: 5, 4: 10}
"""Numbers of lines, triangles and tetrahedra, by how many corners they have."""


def _write_vtu(out: BinaryIO, places: Floats, corners: Index, labels: Any, _threads: int) -> None:
    """An unstructured grid, with the labels of the points."""
    count, width = corners.shape
    out.write(VTU_HEAD)
    out.write(f'<Piece NumberOfPoints="{len(places)}" NumberOfCells="{count}">\n<PointData>\n'.encode())
    write_array(out, "label", labels.astype("<i8", copy=False))
    out.write(b"</PointData>\n<Points>\n")
    write_array(out, "Points", places.astype("<f8", copy=False))
    out.write(b"</Points>\n<Cells>\n")
    write_array(out, "connectivity", corners.reshape(-1).astype("<i4", copy=False))
    write_array(out, "offsets", np.arange(1, count + 1, dtype="<i8") * width)
    write_array(out, "types", np.full(count, _CELL_TYPES[width], dtype="u1"))
    out.write(VTU_END)


_VTK_NAMES = {"<i8": "Int64", "<f8": "Float64", "<i4": "Int32", "|u1": "UInt8"}


def write_array(out: BinaryIO, name: str, values: NDArray[Any]) -> None:
    """An array in base 64, after its size."""
    several = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    kind = _VTK_NAMES[values.dtype.newbyteorder("<").str]
    out.write(f'<DataArray type="{kind}" Name="{name}"{several} format="binary">\n'.encode())
    data: Any = np.ascontiguousarray(values).reshape(-1).view(np.uint8).data
    head = len(data).to_bytes(8, "little")
    first = _BLOCK - len(head)
    out.write(b64encode(head + bytes(data[:first])))
    for begin in range(first, len(data), _BLOCK):
        out.write(b64encode(data[begin : begin + _BLOCK]))
    out.write(b"\n</DataArray>\n")


def _parts(rows: NDArray[Any], size: int = 1 << 16) -> Iterator[NDArray[Any]]:
    """Some rows at a time."""
    return (rows[begin : begin + size] for begin in range(0, len(rows), size))


_SOLIDS: dict[str, Callable[[BinaryIO, Floats, Index, Any, int], None]] = {
    "obj": _write_obj,
    "ply": _write_ply,
    "stl": _write_stl,
    "vtu": _write_vtu,
}
