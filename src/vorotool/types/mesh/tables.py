"""Tables of a triangulation: its edges, triangles and points, in labels."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import UsageError
from vorotool.types.arguments import check_value
from vorotool.types.features import Corners, Rows, chosen, point_rows, without_places
from vorotool.types.identity import with_ends
from vorotool.types.mesh.digital_triangulation import AnyTriangulation, DigitalTriangulation
from vorotool.types.mesh.proximity import ProximityGraph
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.table import Computed, Lookup, Table


def edge_table(mesh: AnyTriangulation | ProximityGraph) -> Table:
    """Tabulate the edges: labels, ends and length.

    Parameters
    ----------
    mesh : Triangulation, DigitalTriangulation or ProximityGraph
        Rows are in the order of its edges, ends as there.

    Returns
    -------
    Table
        ``label_a, label_b, x_a, y_a, x_b, y_b, length``; coordinates and lengths in input units.

    Examples
    --------
    >>> from vorotool import delaunay
    >>> table = edge_table(delaunay([[0, 0], [4, 0], [0, 3]]))
    >>> table["label_a"].tolist(), table["label_b"].tolist(), table["length"].tolist()
    ([1, 1, 2], [3, 2, 3], [3.0, 4.0, 5.0])
    """
    check_value(mesh, "mesh", "Triangulation", "DigitalTriangulation", "ProximityGraph")
    columns = {**end_columns(mesh, mesh.edges), "length": Computed(mesh.edge_lengths, len(mesh.edges))}
    return with_ends(columns, mesh.properties, dict(zip("ab", mesh.edges.T, strict=True)))


def end_columns(mesh: AnyTriangulation | ProximityGraph, edges: NDArray[np.int32]) -> dict[str, Lookup]:
    """Return the labels and the places of the ends of edges."""
    labels, (x, y), (a, b) = mesh.label_array, np.ascontiguousarray(mesh.points.T), edges.T
    ends = {"label_a": (labels, a), "label_b": (labels, b), "x_a": (x, a), "y_a": (y, a), "x_b": (x, b), "y_b": (y, b)}
    return {name: Lookup(values, end) for name, (values, end) in ends.items()}


def triangle_table(mesh: AnyTriangulation) -> Table:
    """Tabulate the triangles: their labels, counter-clockwise.

    Parameters
    ----------
    mesh : Triangulation or DigitalTriangulation
        Rows are in the order of its triangles, vertices as there.

    Returns
    -------
    Table
        ``label_a, label_b, label_c``.

    Examples
    --------
    >>> from vorotool import delaunay
    >>> {name: column.tolist() for name, column in triangle_table(delaunay([[0, 0], [4, 0], [0, 3]])).items()}
    {'label_a': [1], 'label_b': [2], 'label_c': [3]}
    """
    check_value(mesh, "mesh", "Triangulation", "DigitalTriangulation")
    labels = mesh.label_array
    corners = dict(zip("abc", mesh.triangles.T, strict=True))
    columns = {f"label_{name}": Lookup(labels, corner) for name, corner in corners.items()}
    return with_ends(columns, mesh.properties, corners)


def point_table(mesh: Triangulation) -> Table:
    """Tabulate the points, in the order of the input.

    Parameters
    ----------
    mesh : Triangulation
        Its properties are the further columns.

    Returns
    -------
    Table
        ``label, x, y, neighbors, on_hull, duplicate_of_label``: edges that end at the point, whether it is on the
        hull, and the label of the first point of the same place. Of a point that lies on an earlier one the second
        and third do not exist, of the others the last.

    Examples
    --------
    >>> from vorotool import delaunay
    >>> point_table(delaunay([[0, 0], [4, 0], [0, 3], [1, 1]]))["neighbors"].tolist()
    [3, 3, 3, 3]
    """
    check_value(mesh, "mesh", "Triangulation")
    return Table(_point_columns(mesh)).with_properties(mesh.properties)


def _point_columns(mesh: Triangulation) -> dict[str, Any]:
    count = len(mesh.points)
    is_duplicate = mesh.first != np.arange(count)
    on_hull = np.zeros(count, dtype=bool)
    on_hull[mesh.hull] = True
    labels = mesh.label_array
    return {
        "label": labels,
        "x": mesh.points[:, 0],
        "y": mesh.points[:, 1],
        "neighbors": np.ma.array(np.bincount(mesh.edges.reshape(-1), minlength=count), mask=is_duplicate),
        "on_hull": np.ma.array(on_hull, mask=is_duplicate),
        "duplicate_of_label": np.ma.array(labels[mesh.first], mask=~is_duplicate),
    }


def mesh_rows(mesh: AnyTriangulation | ProximityGraph, what: str | None) -> Rows:
    """Return the rows of a part, by default of the edges."""
    if what == "table" and isinstance(mesh, DigitalTriangulation):
        raise UsageError("a table of points needs a triangulation: write the edges or triangles of this result")
    makers: dict[str | None, Callable[[Any], Table]] = {"triangles": triangle_table, "table": point_table}
    return Rows(makers.get(what, edge_table)(mesh))


def mesh_features(mesh: AnyTriangulation | ProximityGraph, what: str | None) -> Rows:
    """Return the rows of a part with their geometry, by default of the triangles."""
    parts: dict[str, Callable[[], Rows]] = {"edges": lambda: _of_corners(mesh, edge_table(mesh), mesh.edges)}
    if not isinstance(mesh, ProximityGraph):
        parts = {
            "triangles": lambda: _of_corners(mesh, triangle_table(mesh), mesh.triangles),
            **parts,
            "points": lambda: _of_points(mesh),
        }
    return chosen(mesh, what, parts)


def _of_corners(mesh: AnyTriangulation | ProximityGraph, table: Table, index: NDArray[np.int32]) -> Rows:
    numbers = np.arange(1, len(index) + 1)
    return Rows(without_places(table), {}, mesh, None, Corners(mesh.points, index), ids=numbers)


def _of_points(mesh: Any) -> Rows:
    columns: dict[str, Any] = {"label": mesh.label_array}
    if isinstance(mesh, Triangulation):
        columns = without_places(Table(_point_columns(mesh)))
    return point_rows(columns, mesh, mesh.points)
