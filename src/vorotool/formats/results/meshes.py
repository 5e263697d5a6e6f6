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
