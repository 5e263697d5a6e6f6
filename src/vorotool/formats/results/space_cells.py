"""Writing Voronoi cells of points in space as VTU (polyhedra), OBJ, PLY (faces) and NPZ."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.results.meshes import VTU_END, VTU_HEAD, write_array
from vorotool.formats.text.row_writer import Column, RowShape, write_rows
from vorotool.formats.text.tables import placed_column, write_npz
from vorotool.numeric.arrays import Floats, starts_of
from vorotool.numeric.coordinates import on_grid
from vorotool.types.features import rows_of
from vorotool.types.mesh.space_cells import SpaceCellSet

_POLYHEDRON = 42
_BLOCK = 1 << 16
"""Faces of one size that become bytes at a time."""


def write_cells(out: BinaryIO, cells: SpaceCellSet, fmt: str, *, threads: int = 0) -> None:
    """Write cells; the bytes depend on nothing but these, the format and the rounding of coordinates."""
    places = [on_grid(column) for column in np.ascontiguousarray(cells.vertices.T)]
    if fmt == "obj":
        _write_obj(out, places, cells, threads)
    elif fmt == "ply":
        _write_ply(out, places, cells)
    elif fmt == "vtu":
        _write_vtu(out, np.stack(places, axis=1), cells)
    else:
        _write_npz(out, places, cells, threads)


def labels_of_faces(cells: SpaceCellSet) -> NDArray[np.int64]:
    """(f, 2) labels of the cells on both sides; in place of the second -1 to -6 for a side of the box."""
    first, second = cells.face_cells.T
    labels = cells.label_array
    return np.stack([labels[first], np.where(second < 0, second, labels[np.maximum(second, 0)])], axis=1)


# ---- faces ---------------------------------------------------------------------------------------
def _write_obj(out: BinaryIO, places: list[Floats], cells: SpaceCellSet, threads: int) -> None:
    """Lines ``v x y z``, and a group ``g label_a label_b`` of faces ``f …`` by the numbers of their corners from 1."""
    vertices = [Column("", column, is_place=True) for column in places]
    write_rows(out, vertices, RowShape(("v ", " ", " ", "\n")), threads=threads)
    starts, numbers = cells.face_starts.tolist(), (cells.corners + np.int64(1)).tolist()
    last = None
    lines = []
    for face, (a, b) in enumerate(labels_of_faces(cells).tolist()):
        if (a, b) != last:
            lines.append(f"g cell_{a} {f'cell_{b}' if b > 0 else f'side_{-b}'}\n")
        last = a, b
        lines.append(f"f {' '.join(map(str, numbers[starts[face] : starts[face + 1]]))}\n")
        if len(lines) >= _BLOCK:
            out.write("".join(lines).encode())
            lines.clear()
    out.write("".join(lines).encode())


def _write_ply(out: BinaryIO, places: list[Floats], cells: SpaceCellSet) -> None:
    """Vertices and faces with the labels of their cells, as little-endian numbers."""
    labels = labels_of_faces(cells)
    if labels.max(initial=0) > np.iinfo(np.int32).max:
        raise InputError("PLY holds labels up to 2147483647: write VTU, or leave the labels out")
    sizes = np.diff(cells.face_starts)
    if sizes.max(initial=0) > np.iinfo(np.uint8).max:
        raise InputError(f"PLY holds faces of up to 255 corners, but one has {sizes.max()}: write VTU or OBJ")
    header = [
        *("ply", "format binary_little_endian 1.0", f"element vertex {len(cells.vertices)}"),
        *(f"property double {axis}" for axis in "xyz"),
        *(f"element face {len(sizes)}", "property list uchar int vertex_indices"),
        *("property int label_a", "property int label_b", "end_header"),
    ]
    out.write("".join(f"{line}\n" for line in header).encode())
    out.write(np.stack(places, axis=1).astype("<f8").tobytes())
    for begin in range(0, len(sizes), _BLOCK):
        rows = slice(begin, begin + _BLOCK)
        out.write(_ply_faces(cells, labels[rows], cells.face_starts[begin : begin + _BLOCK + 1]))


def _ply_faces(cells: SpaceCellSet, labels: NDArray[np.int64], starts: NDArray[np.int64]) -> bytes:
    """Some faces: a byte with their number of corners, these, and two labels, of four bytes each."""
    sizes = np.diff(starts)
    rows = starts_of(4 * sizes + 9)
    data = np.zeros(rows[-1], dtype=np.uint8)
    data[rows[:-1]] = sizes
    four = np.arange(4)
    within = np.arange(sizes.sum()) - np.repeat(starts[:-1] - starts[0], sizes)
    corners = np.repeat(rows[:-1] + 1, sizes) + 4 * within
    data[corners[:, None] + four] = cells.corners[starts[0] : starts[-1]].astype("<i4").view(np.uint8).reshape(-1, 4)
    ends = (rows[1:] - 8)[:, None] + np.arange(8)
    data[ends] = labels.astype("<i4").view(np.uint8).reshape(-1, 8)
    return data.tobytes()


# ---- polyhedra -----------------------------------------------------------------------------------
def _write_vtu(out: BinaryIO, places: Floats, cells: SpaceCellSet) -> None:
    """An unstructured grid of the cells that have a volume, with their labels and sizes."""
    kept = np.flatnonzero(~cells.is_empty)
    stream, ends = _face_stream(cells, kept)
    corners, corner_ends = _corners_of_cells(cells, kept)
    out.write(VTU_HEAD)
    out.write(f'<Piece NumberOfPoints="{len(places)}" NumberOfCells="{len(kept)}">\n<CellData>\n'.encode())
    write_array(out, "label", cells.label_array[kept].astype("<i8"))
    write_array(out, "volume", cells.volumes[kept].astype("<f8"))
    write_array(out, "area", cells.areas[kept].astype("<f8"))
    out.write(b"</CellData>\n<Points>\n")
    write_array(out, "Points", places.astype("<f8", copy=False))
    out.write(b"</Points>\n<Cells>\n")
    write_array(out, "connectivity", corners.astype("<i4", copy=False))
    write_array(out, "offsets", corner_ends.astype("<i8"))
    write_array(out, "types", np.full(len(kept), _POLYHEDRON, dtype="u1"))
    write_array(out, "faces", stream.astype("<i8", copy=False))
    write_array(out, "faceoffsets", ends.astype("<i8"))
    out.write(VTU_END)


def _listed(cells: SpaceCellSet) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """For each entry of `cell_faces` the number of corners; for each corner of these its place in `corners`."""
    sizes = np.diff(cells.face_starts)[cells.cell_faces]
    starts = starts_of(sizes)
    within = np.arange(starts[-1]) - np.repeat(starts[:-1], sizes)
    owner = np.repeat(np.arange(len(cells)), np.diff(cells.cell_starts))
    turned = np.repeat(cells.face_cells[cells.cell_faces, 0] != owner, sizes)  # seen from outside the second cell
    step = np.where(turned, np.repeat(sizes, sizes) - 1 - within, within)
    return sizes, np.repeat(cells.face_starts[:-1][cells.cell_faces], sizes) + step


def _face_stream(cells: SpaceCellSet, kept: NDArray[np.intp]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Number of faces of each cell, and of each face the number of corners and these; where each cell ends."""
    sizes, places = _listed(cells)
    counts = np.diff(cells.cell_starts)
    owner = np.repeat(np.arange(len(cells)), counts)
    lengths = np.bincount(owner, sizes + 1, len(cells)).astype(np.int64) + (counts > 0)
    begins = starts_of(lengths)
    stream = np.empty(begins[-1], dtype=np.int64)
    stream[begins[kept]] = counts[kept]
    rank = np.cumsum(counts > 0)[owner]  # heads of cells up to that of each face
    heads = starts_of(sizes + 1)[:-1] + rank
    stream[heads] = sizes
    within = np.arange(len(places)) - np.repeat(starts_of(sizes)[:-1], sizes)
    stream[np.repeat(heads + 1, sizes) + within] = cells.corners[places]
    return stream, begins[1:][kept]


def _corners_of_cells(cells: SpaceCellSet, kept: NDArray[np.intp]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The vertices of each cell, once, and where each ends."""
    sizes, places = _listed(cells)
    owner = np.repeat(np.repeat(np.arange(len(cells)), np.diff(cells.cell_starts)), sizes)
    count = max(len(cells.vertices), 1)
    keys = np.sort(owner * count + cells.corners[places])
    keys = keys[np.diff(keys, prepend=-1) > 0]
    ends = starts_of(np.bincount(keys // count, minlength=len(cells)))[1:]
    return keys % count, ends[kept]


# ---- arrays --------------------------------------------------------------------------------------
def _write_npz(out: BinaryIO, places: list[Floats], cells: SpaceCellSet, threads: int) -> None:
    """The columns, and what the cells consist of."""
    x, y, z = places
    arrays: dict[str, Any] = {
        "vertex_x": x,
        "vertex_y": y,
        "vertex_z": z,
        "face_starts": cells.face_starts,
        "corners": cells.corners,
        "face_label_a": labels_of_faces(cells)[:, 0].copy(),
        "face_label_b": labels_of_faces(cells)[:, 1].copy(),
        "face_area": cells.face_areas,
        "cell_starts": cells.cell_starts,
        "cell_faces": cells.cell_faces,
        "box": cells.box.reshape(-1),
    }
    table = rows_of(cells).table().stored()
    columns = [placed_column(Column.of(name, values)) for name, values in table.items()]
    write_npz(out, [*columns, *(Column.of(name, values) for name, values in arrays.items())], threads)
