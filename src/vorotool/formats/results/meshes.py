"""Writing edges, triangles, tetrahedra, points, and cells in space in every format that has a place for them."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterator, Mapping
from itertools import chain
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError, UsageError, warn
from vorotool.formats.text.row_writer import Column, RowShape, write_rows
from vorotool.formats.text.tables import write_npz
from vorotool.numeric.arrays import Floats, owners, starts_of, within
from vorotool.numeric.coordinates import on_grid
from vorotool.types.features import rows_of
from vorotool.types.mesh.cells import ProximityGraph
from vorotool.types.mesh.tetrahedralization import SpaceCellSet, Tetrahedralization
from vorotool.types.mesh.triangulation import AnyTriangulation, DigitalTriangulation, Triangulation
from vorotool.types.table import Lookup


def write_mesh(
    out: BinaryIO,
    mesh: AnyTriangulation | ProximityGraph,
    fmt: str,
    *,
    what: str = "edges",
) -> None:
    """Write edges, triangles or points; the bytes depend on nothing but the mesh, the format and the precision."""
    if fmt == "obj":
        rows = mesh.edges if what == "edges" else mesh.triangles
        between = [" "] * (rows.shape[1] - 1)
        write_rows(out, _places(mesh), RowShape(("v ", " ", " 0\n")))
        shape = RowShape(("l " if what == "edges" else "f ", *between, "\n"))
        write_rows(out, _numbers(mesh, rows, 1), shape)
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
    write_rows(out, [numbers, *columns], shape)


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


def _node(mesh: Triangulation) -> tuple[str, list[Column]]:
    """Give the numbers of dimensions, attributes and markers; x, y and the marker of each vertex."""
    on_hull = np.zeros(len(mesh.points), dtype=np.int64)
    on_hull[mesh.hull] = 1
    return "2 0 1", [*_places(mesh), Column("", on_hull)]


_TRIANGLE: dict[str, Callable[[Any], tuple[str, list[Column]]]] = {
    "edge": _edge,
    "ele": lambda mesh: ("3 0", _numbers(mesh, mesh.triangles, mesh.first_number)),
    "node": _node,
}


# ---- points in space -----------------------------------------------------------------------------
Index = NDArray[np.int32]


def write_solid(out: BinaryIO, mesh: Tetrahedralization, fmt: str, *, what: str) -> None:
    """Write tetrahedra, triangles, the hull or edges; the bytes depend on nothing but these and the format."""
    places, corners, labels = _placed(mesh.points), getattr(mesh, what), mesh.label_array
    if fmt == "obj":
        _write_obj_vertices(out, places)
        numbers = [Column("", column + np.int64(1)) for column in np.ascontiguousarray(corners.T)]
        kind = "f " if len(numbers) == 3 else "l "
        write_rows(out, numbers, RowShape((kind, *[" "] * (len(numbers) - 1), "\n")))
    elif fmt == "ply":
        faces = np.empty(len(corners), dtype=[("count", "u1"), ("corners", "<i4", 3)])
        faces["count"], faces["corners"] = 3, corners
        _write_ply(out, places, _parts(faces), len(faces), labels={"label": labels}, of_points=True)
    elif fmt == "stl":
        _write_stl(out, places, corners)
    else:
        count, width = corners.shape
        cells = {
            "connectivity": corners.reshape(-1).astype("<i4", copy=False),
            "offsets": np.arange(1, count + 1, dtype="<i8") * width,
            "types": np.full(count, _CELL_TYPES[width], dtype="u1"),
        }
        _write_vtu(out, places, "PointData", {"label": labels.astype("<i8", copy=False)}, cells)


def write_cells(out: BinaryIO, cells: SpaceCellSet, fmt: str) -> None:
    """Write Voronoi cells as polyhedra (VTU), faces (OBJ, PLY), or arrays; the bytes depend on nothing but these."""
    places = _placed(cells.vertices)
    if fmt == "obj":
        _write_obj_vertices(out, places)
        _write_groups(out, cells)
    elif fmt == "ply":
        sizes, labels = np.diff(cells.face_starts), labels_of_faces(cells)
        if sizes.max(initial=0) > np.iinfo(np.uint8).max:
            raise InputError(f"PLY holds faces of up to 255 corners, but one has {sizes.max()}: write VTU or OBJ")
        starts = range(0, len(sizes), _ROWS)
        faces = (_ply_faces(cells, labels[k : k + _ROWS], cells.face_starts[k : k + _ROWS + 1]) for k in starts)
        _write_ply(out, places, faces, len(sizes), labels=dict(zip(("label_a", "label_b"), labels.T, strict=True)))
    elif fmt == "vtu":
        kept = np.flatnonzero(~cells.is_empty)
        data = {
            "label": cells.label_array[kept].astype("<i8"),
            "volume": cells.volumes[kept].astype("<f8"),
            "area": cells.areas[kept].astype("<f8"),
        }
        _write_vtu(out, places, "CellData", data, _polyhedra(cells, kept))
    else:
        _write_npz(out, places, cells)


def _placed(points: Floats) -> Floats:
    """Round places to the decimals of the file."""
    return np.ascontiguousarray(np.stack([on_grid(column) for column in np.ascontiguousarray(points.T)], axis=1))


def labels_of_faces(cells: SpaceCellSet) -> NDArray[np.int64]:
    """(f, 2) labels of the cells on both sides; in place of the second -1 to -6 for a side of the box."""
    first, second = cells.face_cells.T
    labels = cells.label_array
    return np.stack([labels[first], np.where(second < 0, second, labels[np.maximum(second, 0)])], axis=1)


_ROWS = 1 << 16
"""Triangles or faces that become bytes at a time."""


def _parts(rows: NDArray[Any]) -> Iterator[NDArray[Any]]:
    """Some rows at a time."""
    return (rows[begin : begin + _ROWS] for begin in range(0, len(rows), _ROWS))


# ---- OBJ -----------------------------------------------------------------------------------------
def _write_obj_vertices(out: BinaryIO, places: Floats) -> None:
    """Lines ``v x y z``; lines and faces name them by their numbers from 1."""
    vertices = [Column("", np.ascontiguousarray(column), is_place=True) for column in places.T]
    write_rows(out, vertices, RowShape(("v ", " ", " ", "\n")))


def _write_groups(out: BinaryIO, cells: SpaceCellSet) -> None:
    """A group ``g label_a label_b`` for the faces between two cells."""
    starts, numbers = cells.face_starts.tolist(), (cells.corners + np.int64(1)).tolist()
    last = None
    lines = []
    for face, (a, b) in enumerate(labels_of_faces(cells).tolist()):
        if (a, b) != last:
            lines.append(f"g cell_{a} {f'cell_{b}' if b > 0 else f'side_{-b}'}\n")
        last = a, b
        lines.append(f"f {' '.join(map(str, numbers[starts[face] : starts[face + 1]]))}\n")
        if len(lines) >= _ROWS:
            out.write("".join(lines).encode())
            lines.clear()
    out.write("".join(lines).encode())


# ---- PLY -----------------------------------------------------------------------------------------
def _write_ply(
    out: BinaryIO,
    places: Floats,
    faces: Iterator[Any],
    count: int,
    *,
    labels: Mapping[str, NDArray[Any]],
    of_points: bool = False,
) -> None:
    """Vertices and so many faces, and the labels of either, as little-endian numbers."""
    if max(each.max(initial=0) for each in labels.values()) > np.iinfo(np.int32).max:
        raise InputError("PLY holds labels up to 2147483647: write VTU, or leave the labels out")
    named = [f"property int {name}" for name in labels]
    header = [
        *("ply", "format binary_little_endian 1.0", f"element vertex {len(places)}"),
        *(f"property double {axis}" for axis in "xyz"),
        *(named if of_points else ()),
        *(f"element face {count}", "property list uchar int vertex_indices"),
        *(() if of_points else named),
        "end_header",
    ]
    out.write("".join(f"{line}\n" for line in header).encode())
    vertices = np.empty(len(places), dtype=[("xyz", "<f8", 3), *((name, "<i4") for name in labels if of_points)])
    vertices["xyz"] = places
    for name in labels if of_points else ():
        vertices[name] = labels[name]
    for rows in chain(_parts(vertices), faces):
        out.write(rows.tobytes())


def _ply_faces(cells: SpaceCellSet, labels: NDArray[np.int64], starts: NDArray[np.int64]) -> NDArray[np.uint8]:
    """Some faces: a byte with their number of corners, these, and two labels, of four bytes each."""
    sizes = np.diff(starts)
    rows = starts_of(4 * sizes + 9)
    data = np.zeros(rows[-1], dtype=np.uint8)
    data[rows[:-1]] = sizes
    four = np.arange(4)
    corners = np.repeat(rows[:-1] + 1, sizes) + 4 * within(sizes)
    data[corners[:, None] + four] = cells.corners[starts[0] : starts[-1]].astype("<i4").view(np.uint8).reshape(-1, 4)
    ends = (rows[1:] - 8)[:, None] + np.arange(8)
    data[ends] = labels.astype("<i4").view(np.uint8).reshape(-1, 8)
    return data


# ---- STL -----------------------------------------------------------------------------------------
def _write_stl(out: BinaryIO, places: Floats, corners: Index) -> None:
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
_CELL_TYPES = {2: 3, 3: 5, 4: 10}
"""Numbers of lines, triangles and tetrahedra, by how many corners they have."""

_POLYHEDRON = 42
_VTK_NAMES = {"<i8": "Int64", "<f8": "Float64", "<i4": "Int32", "|u1": "UInt8"}
_BLOCK = 3 << 18
"""Bytes that become text at a time: threes become fours, so that only the last block is padded."""


def _write_vtu(
    out: BinaryIO, places: Floats, of: str, data: Mapping[str, NDArray[Any]], cells: Mapping[str, NDArray[Any]]
) -> None:
    """An unstructured grid, with data of its points or its cells."""
    out.write(
        b'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
        b'header_type="UInt64">\n<UnstructuredGrid>\n'
    )
    out.write(f'<Piece NumberOfPoints="{len(places)}" NumberOfCells="{len(cells["types"])}">\n'.encode())
    for section, arrays in ((of, data), ("Points", {"Points": places.astype("<f8", copy=False)}), ("Cells", cells)):
        out.write(f"<{section}>\n".encode())
        for name, values in arrays.items():
            _write_array(out, name, values)
        out.write(f"</{section}>\n".encode())
    out.write(b"</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")


def _write_array(out: BinaryIO, name: str, values: NDArray[Any]) -> None:
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


def _polyhedra(cells: SpaceCellSet, kept: NDArray[np.intp]) -> dict[str, NDArray[Any]]:
    """Corners and faces of the cells that have a volume."""
    stream, ends = _face_stream(cells, kept)
    corners, corner_ends = _corners_of_cells(cells, kept)
    return {
        "connectivity": corners.astype("<i4", copy=False),
        "offsets": corner_ends.astype("<i8"),
        "types": np.full(len(kept), _POLYHEDRON, dtype="u1"),
        "faces": stream.astype("<i8", copy=False),
        "faceoffsets": ends.astype("<i8"),
    }


def _listed(cells: SpaceCellSet) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """For each entry of `cell_faces` the number of corners; for each corner of these its place in `corners`."""
    sizes = np.diff(cells.face_starts)[cells.cell_faces]
    along = within(sizes)
    owner = owners(np.diff(cells.cell_starts))
    turned = np.repeat(cells.face_cells[cells.cell_faces, 0] != owner, sizes)  # seen from outside the second cell
    step = np.where(turned, np.repeat(sizes, sizes) - 1 - along, along)
    return sizes, np.repeat(cells.face_starts[:-1][cells.cell_faces], sizes) + step


def _face_stream(cells: SpaceCellSet, kept: NDArray[np.intp]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Number of faces of each cell, and of each face the number of corners and these; where each cell ends."""
    sizes, places = _listed(cells)
    counts = np.diff(cells.cell_starts)
    owner = owners(counts)
    lengths = np.bincount(owner, sizes + 1, len(cells)).astype(np.int64) + (counts > 0)
    begins = starts_of(lengths)
    stream = np.empty(begins[-1], dtype=np.int64)
    stream[begins[kept]] = counts[kept]
    rank = np.cumsum(counts > 0)[owner]  # heads of cells up to that of each face
    heads = starts_of(sizes + 1)[:-1] + rank
    stream[heads] = sizes
    stream[np.repeat(heads + 1, sizes) + within(sizes)] = cells.corners[places]
    return stream, begins[1:][kept]


def _corners_of_cells(cells: SpaceCellSet, kept: NDArray[np.intp]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The vertices of each cell, once, and where each ends."""
    sizes, places = _listed(cells)
    owner: NDArray[np.int64] = np.repeat(owners(np.diff(cells.cell_starts)), sizes)
    count = max(len(cells.vertices), 1)
    keys = np.sort(owner * count + cells.corners[places])
    keys = keys[np.diff(keys, prepend=-1) > 0]
    ends = starts_of(np.bincount(keys // count, minlength=len(cells)))[1:]
    return keys % count, ends[kept]


# ---- arrays --------------------------------------------------------------------------------------
def _write_npz(out: BinaryIO, places: Floats, cells: SpaceCellSet) -> None:
    """The columns, and what the cells consist of."""
    x, y, z = np.ascontiguousarray(places.T)
    label_a, label_b = np.ascontiguousarray(labels_of_faces(cells).T)
    arrays: dict[str, Any] = {
        "vertex_x": x,
        "vertex_y": y,
        "vertex_z": z,
        "face_starts": cells.face_starts,
        "corners": cells.corners,
        "face_label_a": label_a,
        "face_label_b": label_b,
        "face_area": cells.face_areas,
        "cell_starts": cells.cell_starts,
        "cell_faces": cells.cell_faces,
        "box": cells.box.reshape(-1),
    }
    write_npz(out, {**rows_of(cells).table().stored(), **arrays})
