"""What cells are like one by one and on the whole: the measures of cellular sociology."""

from __future__ import annotations

from dataclasses import field
from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.plain import plain
from vorotool.types.features import Rows
from vorotool.types.summaries import summary_table
from vorotool.types.table import Table
from vorotool.types.values import Tabular, Value, counted

MEASURES = ("area", "perimeter", "roundness", "neighbors", "nearest_distance")
"""Columns of cells that are summarized."""


@plain(eq=False, repr=False)
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
        disorder AD (Marcelpoil and Usson 1992). ``tree_length`` is of the edges of the tree; ``tree_normalised`` of
        these over √(A n) / (n - 1), for n places in an area A: its mean and sd are the (m, σ) of Dussert and others
        (1986).
        """
        whole = np.asarray(self.cells["whole"], dtype=bool)
        chosen = {name: np.ma.filled(np.ma.asanyarray(self.cells[name])[whole].astype(float)) for name in MEASURES}
        chosen["nearest_distance"] = chosen["nearest_distance"][np.isfinite(chosen["nearest_distance"])]
        edges = len(self.tree_lengths)
        unit = sqrt(self.area * (edges + 1)) / edges if edges else 1.0
        normalized = self.tree_lengths / unit if unit > 0 else self.tree_lengths[:0]
        return summary_table({**chosen, "tree_length": self.tree_lengths, "tree_normalised": normalized})

    def _rows(self, what: str | None = None) -> Rows:
        return Rows(self.measures if what == "measures" else self.summary)

    def _summary(self) -> str:
        whole = int(np.asarray(self.cells["whole"], dtype=bool).sum())
        return f"{counted(self.cells.rows, 'cell')}, {whole} of them whole"
