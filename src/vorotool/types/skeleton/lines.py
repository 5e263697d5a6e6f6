"""Lines along a skeleton whose ends are extended straight to the boundary."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, mask_of, norms, owners
from vorotool.numeric.curves.flatten import chained, cubic_polylines, curve_tolerances
from vorotool.numeric.numbers import checked_flatten, difference, product
from vorotool.types import fields as f
from vorotool.types.features import Lines, Rows, of_polygons
from vorotool.types.fields import record
from vorotool.types.identity import names_of, part_table, place_columns
from vorotool.types.polygons.planar_graph import places_as_given
from vorotool.types.skeleton.skeleton import KINDS, Skeleton
from vorotool.types.table import Lookup, Table
from vorotool.types.values import Curved, Pictured, Tabular, Value, counted

EXTENSION = "extension"
"""Kind of the straight lines that lead on to the ends."""


@record
class LedOn(Value, Tabular, Curved, Pictured):
    """Branches of a skeleton, and straight lines that lead on from their ends.

    Parameters
    ----------
    path : Skeleton
        The arcs without what leads on.
    ends : (b, 2, 2) float64 array
        The place on the boundary that the start and the end of each branch are led on to; NaN where they are not.

    Raises
    ------
    InputError
        If `ends` has another shape.
    """

    path: Skeleton = f.nested()
    ends: Floats = f.position("lines", 2, 2)
    has_branches: ClassVar[bool] = True

    def __post_init__(self) -> None:
        super().__post_init__()
        lines = len(self.arc_starts) - 1
        if len(self.ends) != lines:
            raise InputError(f"ends must have shape ({lines}, 2, 2), but have {self.ends.shape}")

    def __len__(self) -> int:
        """Return the number of lines."""
        return len(self.arc_starts) - 1

    @cached_property
    def as_given(self) -> Self:
        """The same with the corners where the input has them: those of `path` are on a lattice."""
        path, polygons = self.path.as_given, self.path.polygons
        if path is self.path:
            return self
        polygon, together = np.repeat(self.polygon, 2), self.path.features == "together"
        ends = places_as_given(self.ends.reshape(-1, 2), polygon, polygons, together=together)
        return replace(self, path=path, ends=ends.reshape(-1, 2, 2))

    @cached_property
    def arc_starts(self) -> NDArray[np.int64]:
        """(k + 1,) the first arc of each path, and the number of arcs."""
        return np.append(self.path.branch_starts, len(self.path))

    @cached_property
    def polygon(self) -> NDArray[np.int32]:
        """(k,) the polygon of each path."""
        return self.path.polygon[self.arc_starts[:-1]]

    @cached_property
    def end_nodes(self) -> NDArray[np.int32]:
        """(k, 2) the first and the last node of each path."""
        return self.path.branch_ends.T

    @cached_property
    def extended(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """The paths whose start is extended, and those whose end is."""
        has_start, has_end = ~np.isnan(self.ends[:, :, 0]).T
        return np.flatnonzero(has_start), np.flatnonzero(has_end)

    @cached_property
    def extension_length(self) -> Floats:
        """(k, 2) how far the start and the end are extended; 0 where they are not."""
        way = self.ends - self.path.vertices[self.end_nodes]
        return np.nan_to_num(norms(way), nan=0.0)

    @cached_property
    def line_of_row(self) -> NDArray[np.intp]:
        """(m,) the path of each row of the table, in which extensions are rows, too."""
        return np.sort(self._paths_of_rows)

    @cached_property
    def _paths_of_rows(self) -> NDArray[np.intp]:
        """Paths of extensions at starts, of arcs, and of extensions at ends."""
        first, last = self.extended
        return np.concatenate([first, owners(np.diff(self.arc_starts)), last])

    def in_rows(self, at_starts: Any, of_arcs: Any, at_ends: Any) -> NDArray[Any]:
        """Return values of extensions at starts, of arcs, and of extensions at ends in the order of rows."""
        order = np.argsort(self._paths_of_rows, kind="stable")  # starts before the arcs of their line, ends behind them
        return np.concatenate([at_starts, of_arcs, at_ends])[order]

    @cached_property
    def length(self) -> Floats:
        """(k,) lengths, extensions included."""
        return self._summed(self.path.length) + self.extension_length.sum(axis=1)

    @cached_property
    def width_mean(self) -> Floats:
        """(k,) twice the mean of the radius along each path, or at a single point, without extensions."""
        length, radius = self._summed(self.path.length), self.path.radius[self.end_nodes[:, 0]]
        mean = np.divide(self._summed(self.path.arc_radii[2]), length, out=radius, where=length > 0)
        return np.asarray(2 * mean)

    @cached_property
    def width_range(self) -> tuple[Floats, Floats]:
        """(k,) twice the smallest and twice the largest radius on each path."""
        if not len(self):
            return np.zeros(0), np.zeros(0)
        least, most, _ = self.path.arc_radii
        start = self.arc_starts[:-1]
        return 2 * np.minimum.reduceat(least, start), 2 * np.maximum.reduceat(most, start)

    def _summed(self, values: Floats) -> Floats:
        return np.add.reduceat(values, self.arc_starts[:-1]) if len(self) else np.zeros(0)

    def flattened(self, tolerance: float | None = None) -> tuple[Floats, NDArray[np.int64]]:
        """Whole lines as polylines, as of `Skeleton.flattened`; no vertex is where an extension is exactly straight."""
        points, start = chained(*self.path.flattened(tolerance), self.arc_starts[:-1])
        first, last = self.extended
        whole = np.concatenate([self.ends[first, 0], points, self.ends[last, 1]])
        line = np.concatenate([first, owners(np.diff(start)), last])
        whole, line = whole[np.argsort(line, kind="stable")], np.sort(line)
        for extended, place in ((first, 1), (last, -2)):
            start = np.searchsorted(line, np.arange(len(self) + 1))
            joint = (start[:-1] if place > 0 else start[1:])[extended] + place
            straight = joint[is_straight(whole[joint - 1], whole[joint], whole[joint + 1])]
            whole, line = np.delete(whole, straight, axis=0), np.delete(line, straight)
        return whole, np.searchsorted(line, np.arange(len(self) + 1))

    def _rows(self, _what: str | None = None) -> Rows:
        table = led_on_table(self, has_branches=self.has_branches)
        return Rows(table, source=self.path.polygons, item=self.polygon[self.line_of_row])

    def _features(self, _what: str | None = None, flatten: float | None = None) -> Rows:
        least, most = self.width_range
        columns: dict[str, Any] = {"branch": np.arange(len(self))} if self.has_branches else {}
        columns |= {"length": self.length, "width_mean": self.width_mean, "width_min": least, "width_max": most}
        geometry = Lines(*self.as_given.flattened(flatten))
        return of_polygons(columns, self.path.polygons, self.polygon, geometry=geometry, is_part=self.has_branches)


def led_on_table(lines: LedOn, *, has_branches: bool) -> Table:
    """Return one row an arc, line by line, with the straight lines that lead on."""
    given, nodes = lines.as_given, lines.end_nodes
    path = given.path
    (first, last), line = lines.extended, lines.line_of_row
    at_start, at_end = np.zeros(len(first)), np.zeros(len(last))
    source, target = path.vertices[path.arcs].swapaxes(0, 1)
    r0, r1 = path.radius[path.arcs].T
    start_node, end_node = nodes[first, 0], nodes[last, 1]
    begin = lines.in_rows(given.ends[first, 0], source, path.vertices[end_node])
    end = lines.in_rows(path.vertices[start_node], target, given.ends[last, 1])
    blank = [np.full((len(some), 2), np.nan) for some in (first, last)]
    control = lines.in_rows(blank[0], path.control, blank[1])
    kind = lines.in_rows(at_start + 2, path.is_parabola, at_end + 2)
    polygon = lines.polygon[line]
    start = np.searchsorted(line, np.arange(len(lines)))
    extension = lines.extension_length
    return part_table(
        {
            **names_of(path.polygons, polygon),
            **({"branch": line} if has_branches else {}),
            "arc": np.arange(len(line)) - start[line],
            **place_columns(begin, "0"),
            "r0": lines.in_rows(at_start, r0, path.radius[end_node]),
            **place_columns(end, "1"),
            "r1": lines.in_rows(path.radius[start_node], r1, at_end),
            "kind": Lookup([*KINDS, EXTENSION], kind.astype(np.int32)),
            "cx": control[:, 0].copy(),
            "cy": control[:, 1].copy(),
            "length": lines.in_rows(extension[first, 0], path.length, extension[last, 1]),
        },
        path.polygons,
        polygon,
    )


@frozen(eq=False, repr=False)
class ExtendedSkeleton(LedOn):
    """Skeleton with straight lines that extend its ends to the boundary; see `vorotool.extend_ends`.

    Parameters
    ----------
    path : Skeleton
        The skeleton, with arcs inside polygons alone. All that is told of widths is of these.
    ends : (b, 2, 2) float64 array
        The place on the boundary that the start and the end of each branch are led on to; NaN where they are not: at
        junctions, and at corners.

    Raises
    ------
    InputError
        If `ends` has another shape.

    Examples
    --------
    >>> from vorotool import extend_ends, prune, skeleton_exact
    >>> extended = extend_ends(prune(skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]]), scale=1.5))
    >>> extended.ends.tolist(), extended.length.tolist()
    ([[[0.0, 1.0], [4.0, 1.0]]], [4.0])
    """

    maker = "extend_ends"

    def _summary(self) -> str:
        return f"{counted(len(self), 'branch', 'branches')} of {counted(len(self.path.polygons), 'polygon')}"


def is_straight(a: Floats, b: Floats, c: Floats) -> NDArray[np.bool_]:
    """Tell where b is certainly between a and c: the products compared are exact, where differences are."""
    (ux, uy), (ux_lost, uy_lost) = (part.T for part in difference(b, a))
    (vx, vy), (vx_lost, vy_lost) = (part.T for part in difference(c, b))
    one, lost = product(ux, vy)
    other, other_lost = product(uy, vx)
    is_exact = (ux_lost == 0) & (uy_lost == 0) & (vx_lost == 0) & (vy_lost == 0)
    is_zero = is_exact & (one == other) & (lost == other_lost)
    is_level = ((ux == 0) & (vx == 0)) | ((uy == 0) & (vy == 0))
    return np.asarray((is_zero | is_level) & (ux * vx + uy * vy >= 0))


@frozen(eq=False, repr=False)
class Centerlines(LedOn):
    """Paths along a skeleton, at most one per polygon, with straight lines that extend them.

    Parameters
    ----------
    path : Skeleton
        The arcs of the paths, without the forks at their ends: one branch a path, from its start to its end. All that
        is told of widths is of these.
    ends : (k, 2, 2) float64 array
        The place on the boundary that the start and the end of each path are led on to; NaN where they are not.

    Raises
    ------
    InputError
        If `ends` has another shape.

    Examples
    --------
    >>> from vorotool import centerline, prune, skeleton_exact
    >>> lines = centerline(prune(skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]]), angle=100))
    >>> lines.ends.tolist(), lines.length.tolist(), lines.width_mean.tolist()
    ([[[0.0, 1.0], [4.0, 1.0]]], [4.0], [2.0])
    """

    maker = "centerline"

    has_branches = False

    def _summary(self) -> str:
        return f"{counted(len(self), 'line')} of {counted(len(self.path.polygons), 'polygon')}"


def without_centerline(lines: Centerlines) -> NDArray[np.int64]:
    """Polygons that have none; open lines are not counted."""
    polygons = lines.path.polygons
    has = mask_of(lines.polygon, len(polygons))
    return np.flatnonzero(~has & ~polygons.is_line)


def centerline_columns(lines: Centerlines) -> dict[str, Any]:
    """Length and mean width by polygon, as columns of the table of polygons."""
    columns = {}
    for name, values in (("centerline_length", lines.length), ("centerline_width_mean", lines.width_mean)):
        column, has_none = np.zeros(len(lines.path.polygons)), np.ones(len(lines.path.polygons), dtype=bool)
        column[lines.polygon], has_none[lines.polygon] = values, False
        columns[name] = np.ma.array(column, mask=has_none)
    return columns


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
