"""Tables of a triangulation: its edges, triangles and points, in labels; statistics and summaries of cells."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from math import sqrt
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.frozen import frozen
from vorotool.numeric.arrays import mask_of
from vorotool.products.registry import is_of
from vorotool.types.arguments import check_value
from vorotool.types.features import Corners, Rows, chosen, point_rows, without_places
from vorotool.types.identity import with_ends
from vorotool.types.mesh.triangulation import AnyTriangulation, Triangulation
from vorotool.types.table import Computed, Lookup, Table
from vorotool.types.values import Tabular, Value, counted

if TYPE_CHECKING:
    from vorotool.types.mesh.cells import ProximityGraph


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
    on_hull = mask_of(mesh.hull, count)
    labels = mesh.label_array
    return {
        "label": labels,
        "x": mesh.points[:, 0],
        "y": mesh.points[:, 1],
        "neighbors": np.ma.array(np.bincount(mesh.edges.reshape(-1), minlength=count), mask=is_duplicate),
        "on_hull": np.ma.array(on_hull, mask=is_duplicate),
        "duplicate_of_label": np.ma.array(labels[mesh.first], mask=~is_duplicate),
    }


def mesh_features(mesh: Any, what: str | None) -> Rows:
    """Return the rows of a part with their geometry, by default of the triangles."""
    parts: dict[str, Callable[[], Rows]] = {"edges": lambda: _of_corners(mesh, edge_table(mesh), mesh.edges)}
    if not is_of(mesh, "ProximityGraph"):
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


MEASURES = ("area", "perimeter", "roundness", "neighbors", "nearest_distance")
"""Columns of cells that are summarized."""


@frozen(eq=False, repr=False)
class CellStatistics(Value, Tabular):
    """Measures of cells, and their summary.

    Parameters
    ----------
    cells : Table
        ``label, x, y, area, perimeter, roundness, neighbors, nearest_distance, whole``: one row a point or region.
        ``roundness`` is 4 π area / perimeter², 1 of a circle. Cells that are not whole are left out of the summary.
    tree_lengths : (k,) float64 array
        Lengths of the edges of the minimum spanning tree of all points.
    area : float
        Of the region that the points lie in.
    properties : dict of str to sequence, optional
        Other columns of the input, one value a point or region.

    Examples
    --------
    >>> from vorotool import cell_statistics
    >>> grid = [[x, y] for x in range(4) for y in range(4)]
    >>> found = cell_statistics(grid)
    >>> found.cells["whole"].sum(), found.summary["measure"][:3], found.summary["mean"][:3].round(3).tolist()
    (np.int64(4), ['area', 'perimeter', 'roundness'], [1.0, 4.0, 0.785])
    """

    cells: Table
    tree_lengths: NDArray[np.float64]
    area: float
    properties: dict[str, Any] = field(default_factory=dict)

    @property
    def measures(self) -> Table:
        """The cells with the other columns of the input."""
        return self.cells.with_properties(self.properties)

    @property
    def summary(self) -> Table:
        """One row a measure of the whole cells, as `summary_table` has it, and two of the minimum spanning tree.

        The homogeneity of ``roundness`` is the roundness factor homogeneity RFH, the disorder of ``area`` the area
        disorder AD (Marcelpoil and Usson 1992). ``tree_length`` is of the edges of the tree; ``tree_normalized`` of
        these over √(A n) / (n - 1), for n places in an area A: its mean and sd are the (m, σ) of Dussert and others
        (1986).
        """
        whole = np.asarray(self.cells["whole"], dtype=bool)
        chosen = {name: np.ma.filled(np.ma.asanyarray(self.cells[name])[whole].astype(float)) for name in MEASURES}
        chosen["nearest_distance"] = chosen["nearest_distance"][np.isfinite(chosen["nearest_distance"])]
        edges = len(self.tree_lengths)
        unit = sqrt(self.area * (edges + 1)) / edges if edges else 1.0
        normalized = self.tree_lengths / unit if unit > 0 else self.tree_lengths[:0]
        return summary_table({**chosen, "tree_length": self.tree_lengths, "tree_normalized": normalized})

    def _rows(self, what: str | None = None) -> Rows:
        return Rows(self.measures if what == "measures" else self.summary)

    def _summary(self) -> str:
        whole = int(np.asarray(self.cells["whole"], dtype=bool).sum())
        return f"{counted(self.cells.rows, 'cell')}, {whole} of them whole"


MEASURE = "measure"
"""The first column of summaries: the name of what a row sums up."""
_QUANTILES = {"min": 0.0, "lower_quartile": 0.25, "median": 0.5, "upper_quartile": 0.75, "max": 1.0}


_POWERS = {"perimeter": "", "nearest_distance": "", "tree_length": "", "area": "2"}


def unit_of_measure(name: str, unit: str) -> str | None:
    """Return the unit of a row: of a length the unit, of an area its square, of counts and ratios none."""
    return f"{unit}{_POWERS[name]}" if name in _POWERS else None


def summary_table(measures: Mapping[str, NDArray[np.float64]]) -> Table:
    """Return one row a measure."""
    rows = [_row(np.asarray(values, dtype=np.float64)) for values in measures.values()]
    names = ("mean", "sd", "cv", *_QUANTILES, "homogeneity", "disorder")
    columns = np.array(rows).reshape(len(rows), len(names)).T
    numbers = {name: np.ma.masked_invalid(column) for name, column in zip(names, columns, strict=True)}
    counts = np.array([len(values) for values in measures.values()], dtype=np.int64)
    return Table({MEASURE: list(measures), "count": counts, **numbers})


def _row(values: NDArray[np.float64]) -> list[float]:
    if not len(values):
        return [np.nan] * (5 + len(_QUANTILES))
    mean, sd = float(values.mean()), float(values.std())
    cv = sd / mean if mean > 0 else np.nan
    homogeneity = 1 / (1 + cv)
    quantiles = np.quantile(values, list(_QUANTILES.values())).tolist()
    return [mean, sd, cv, *quantiles, homogeneity, 1 - homogeneity]
