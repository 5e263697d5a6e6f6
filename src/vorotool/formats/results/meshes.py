"""Writing the edges, triangles and points of a triangulation, in every format that has a place for them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError
from vorotool.formats.text.row_writer import Column, RowShape, write_rows
from vorotool.types.mesh.cells import ProximityGraph
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
    if isinstance(mesh, DigitalTriangulation) and fmt != "obj":
        raise UsageError(
            f"{what} as {fmt!r} needs a triangulation, but the result is of a digital tessellation; write its edges "
            "or triangles as csv, json, geojson, npz or obj"
        )
    _WRITERS[fmt](out, mesh, what, precision, threads)


# ---- OBJ -----------------------------------------------------------------------------------------
def _write_obj(
    out: BinaryIO, mesh: AnyTriangulation | ProximityGraph, what: str, precision: int | None, threads: int
) -> None:
    x, y = map(Column.of_places, mesh.points.T)
    write_rows(out, [x, y], RowShape(("v ", " ", " 0\n")), precision=precision, threads=threads)
    if what == "edges":
        write_rows(out, _numbers(mesh, mesh.edges), RowShape(("l ", " ", "\n")), threads=threads)
    else:
        write_rows(out, _numbers(mesh, mesh.triangles), RowShape(("f ", " ", " ", "\n")), threads=threads)


# ---- Triangle ------------------------------------------------------------------------------------
def _write_edge(
    out: BinaryIO, mesh: Triangulation | ProximityGraph, _what: str, _precision: int | None, threads: int
) -> None:
    """``<edges> <markers>``, then ``<number> <end> <end> <marker>``."""
    out.write(f"{len(mesh.edges)} 1\n".encode())
    ends = _numbers(mesh, mesh.edges, mesh.first_number)
    columns = [_counted(mesh, len(mesh.edges)), *ends, Column.of("", mesh.hull_edges.astype(np.int64))]
    write_rows(out, columns, RowShape(("", " ", " ", " ", "\n")), threads=threads)


def _write_ele(out: BinaryIO, mesh: Triangulation, _what: str, _precision: int | None, threads: int) -> None:
    """``<triangles> <nodes a triangle> <attributes>``, then ``<number> <node> <node> <node>``."""
    out.write(f"{len(mesh.triangles)} 3 0\n".encode())
    columns = [_counted(mesh, len(mesh.triangles)), *_numbers(mesh, mesh.triangles, mesh.first_number)]
    write_rows(out, columns, RowShape(("", " ", " ", " ", "\n")), threads=threads)


def _write_node(out: BinaryIO, mesh: Triangulation, _what: str, precision: int | None, threads: int) -> None:
    """``<vertices> <dimension> <attributes> <markers>``, then ``<number> <x> <y> <marker>``."""
    out.write(f"{len(mesh.points)} 2 0 1\n".encode())
    x, y = map(Column.of_places, mesh.points.T)
    on_hull = np.zeros(len(mesh.points), dtype=np.int64)
    on_hull[mesh.hull] = 1
    columns = [_counted(mesh, len(mesh.points)), x, y, Column("", on_hull)]
    write_rows(out, columns, RowShape(("", " ", " ", " ", "\n")), precision=precision, threads=threads)


def _counted(mesh: Triangulation | ProximityGraph, rows: int) -> Column:
    return Column("", np.arange(rows, dtype=np.int64) + mesh.first_number)


def _numbers(mesh: AnyTriangulation | ProximityGraph, rows: NDArray[np.int32], first: int = 1) -> list[Column]:
    """Columns of vertices by their numbers, the first of which is given."""
    numbers = np.arange(len(mesh.points), dtype=np.int64) + first
    return [Column("", Lookup(numbers, index)) for index in rows.T]


_WRITERS: dict[str, Callable[[BinaryIO, Any, str, int | None, int], None]] = {
    "obj": _write_obj,
    "edge": _write_edge,
    "ele": _write_ele,
    "node": _write_node,
}
