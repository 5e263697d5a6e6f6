"""Lines along skeletons as cubic Bézier curves that are near them."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, owners
from vorotool.numeric.curves.flatten import chained, cubic_polylines, curve_tolerances
from vorotool.numeric.numbers import checked_flatten
from vorotool.types import fields as f
from vorotool.types.features import Lines, Rows, of_polygons
from vorotool.types.fields import record
from vorotool.types.identity import names_of, part_table
from vorotool.types.skeleton.extended_lines import LedOn
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.table import Table
from vorotool.types.values import Curved, Pictured, Tabular, Value, counted


@record
class SmoothLines(Value, Tabular, Curved, Pictured):
    """Cubic Bézier curves along the branches of a skeleton or along centerlines, as `vorotool.smooth` fits them.

    Curves of one line follow each other with one tangent. Lines begin and end where the branches do: at junctions, and
    at ends with what leads on from there.

    Parameters
    ----------
    lines : Skeleton, Centerlines or ExtendedSkeleton
        What the curves are near to: a line for each of its branches.
    control : (k, 4, 2) float64 array
        Control points of the curves, line by line.
    start : (n + 1,) int64 array
        The first curve of each line, and ``k``.
    error : (n,) float64 array
        A bound on the distance between each line and its branch: no place of either is farther from the other.

    Raises
    ------
    InputError
        If an array has another shape.

    Examples
    --------
    >>> from vorotool import centerline, skeleton_exact, smooth
    >>> lines = smooth(centerline(skeleton_exact([[0, 0], [6, 0], [6, 2], [0, 2]])), 0.1)
    >>> lines.control.round(9).tolist()
    [[[0.0, 1.0], [2.0, 1.0], [4.0, 1.0], [6.0, 1.0]]]
    """

    maker = "smooth"

    lines: Skeleton | LedOn = f.nested()
    control: Floats = f.position("curves", 4, 2)
    start: NDArray[np.int64] = f.starts("lines", "curves", least=1)
    error: Floats = f.length("lines")

    def __len__(self) -> int:
        """Return the number of lines."""
        return len(self.error)

    @property
    def path(self) -> Skeleton:
        """Arcs approximated by the curves, without extensions."""
        return self.lines if isinstance(self.lines, Skeleton) else self.lines.path

    @cached_property
    def as_given(self) -> SmoothLines:
        """The same with ends at corners where the input has them."""
        lines = self.lines.as_given
        if lines is self.lines:
            return self
        control, ends = self.control.copy(), ends_of_lines(lines)
        control[self.start[:-1], 0], control[self.start[1:] - 1, 3] = ends[:, 0], ends[:, 1]
        return replace(self, lines=lines, control=control)

    @cached_property
    def polygon(self) -> NDArray[np.int32]:
        """(n,) the polygon of each line; -1 outside."""
        return self.path.polygon[self.path.branch_starts]

    @cached_property
    def line(self) -> NDArray[np.int64]:
        """(k,) the line of each curve."""
        return owners(np.diff(self.start))

    def flattened(self, tolerance: float | None = None) -> tuple[Floats, NDArray[np.int64]]:
        """Return the lines as polylines.

        Parameters
        ----------
        tolerance : float, optional
            How far a polyline may be from its curves; by default 1/2000 of the extent of each.

        Returns
        -------
        points : (m, 2) float64 array
            Places along each line, its ends included.
        start : (n + 1,) int64 array
            Where the points of each line begin.

        Raises
        ------
        UsageError
            If the tolerance is not a positive number.
        """
        each = curve_tolerances(self.control, 0.0, checked_flatten(tolerance))
        return chained(*cubic_polylines(self.control, each), self.start[:-1])

    def table(self) -> Table:
        """Return a table with one row per curve, line by line.

        Returns
        -------
        Table
            ``label, id, branch, curve, x0, y0, x1, y1, x2, y2, x3, y3, error``: the curves of each line are counted
            from 0, and have its error. Outside there is no polygon.
        """
        line, control = self.line, self.as_given.control
        return part_table(
            {
                **names_of(self.path.polygons, self.polygon[line]),
                "branch": line,
                "curve": np.arange(len(control)) - self.start[line],
                **{f"{axis}{k}": control[:, k, n].copy() for k in range(4) for n, axis in enumerate("xy")},
                "error": self.error[line],
            },
            self.path.polygons,
            self.polygon[line],
        )

    def _rows(self, _what: str | None = None) -> Rows:
        return Rows(self.table(), source=self.path.polygons, item=self.polygon[self.line])

    def _features(self, _what: str | None = None, flatten: float | None = None) -> Rows:
        columns: dict[str, Any] = {"branch": np.arange(len(self))} if self._has_branches else {}
        columns |= {"curves": np.diff(self.start), "error": self.error}
        geometry = Lines(*self.as_given.flattened(flatten))
        return of_polygons(columns, self.path.polygons, self.polygon, geometry=geometry, is_part=self._has_branches)

    @property
    def _has_branches(self) -> bool:
        """Whether lines are branches, and not the one of a polygon."""
        return isinstance(self.lines, Skeleton) or self.lines.has_branches

    def _summary(self) -> str:
        return f"{counted(len(self.control), 'curve')} in {counted(len(self), 'line')}"


def ends_of_lines(lines: Skeleton | LedOn) -> Floats:
    """(n, 2, 2) where each branch begins and ends, with what leads on."""
    path = lines if isinstance(lines, Skeleton) else lines.path
    ends: Floats = path.vertices[path.branch_ends.T]
    return ends if isinstance(lines, Skeleton) else np.where(np.isnan(lines.ends), ends, lines.ends)
