"""Polygons and lines in the ``.poly`` files of Triangle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.errors import InputError
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions, shortened
from vorotool.formats.text.row_writer import coordinate_text
from vorotool.frozen import frozen
from vorotool.numeric.numbers import distinct
from vorotool.types.box import bounds
from vorotool.types.polygons.polygon_set import HOLE, LINE, SHELL, PolygonSet, set_of_rings
from vorotool.types.polygons.shapely_geometry import to_shapely
from vorotool.types.values import counted

_VERTICES = "<vertices> 2 <attributes> <0 or 1 boundary markers>"
_SEGMENTS = "<segments> <0 or 1 boundary markers>"


def read_poly(source: Source, options: ReadOptions) -> PolygonSet:
    """Read the closed loops of segments as rings and other chains of segments as lines."""
    lines = _Lines(source)
    xy, base = _read_vertices(lines, options)
    segments = _read_segments(lines, len(xy), base)
    holes = _read_holes(lines)
    chains = _chains(segments)
    unused = len(xy) - len(distinct(segments))
    if unused:
        options.note(f"{source.name}: {counted(unused, 'vertex', 'vertices')} without a segment skipped")
    loops = {i: xy[chain[:-1]] for i, chain in enumerate(chains) if len(chain) > 3 and chain[0] == chain[-1]}
    polygons = _nested(loops, holes, _Frame.of(xy), source.name)
    polygons |= {i: [xy[chain]] for i, chain in enumerate(chains) if i not in loops}
    ordered = [(i in loops, polygons[i]) for i in sorted(polygons)]
    rings = [ring for _, polygon in ordered for ring in polygon]
    kinds = [HOLE if k else SHELL if is_loop else LINE for is_loop, polygon in ordered for k in range(len(polygon))]
    owners = [i for i, (_, polygon) in enumerate(ordered) for _ in polygon]
    return set_of_rings(np.concatenate([np.empty((0, 2)), *rings]), [len(r) for r in rings], kinds, owners)


class _Lines:
    """The lines of a file that hold something, without comments."""

    def __init__(self, source: Source) -> None:
        self.name = source.name
        text = source.data.decode("utf-8", "replace").splitlines()
        split = ((number, line.split("#", 1)[0].split()) for number, line in enumerate(text, 1))
        self.rows = [(number, fields) for number, fields in split if fields]
        self.next = 0

    def place(self, row: int) -> str:
        return f"{self.name}, line {self.rows[row][0]}"

    def header(self, form: str, defaults: list[int]) -> list[int]:
        """Numbers of a header: a count, and others that may be left out."""
        if self.next == len(self.rows):
            raise InputError(f"{self.name}: the file ends before a header; write {form}")
        fields = self.rows[self.next][1]
        if len(fields) > 1 + len(defaults) or not all(field.isdecimal() and len(field) < 10 for field in fields):
            raise InputError(f"{self.place(self.next)}: {shortened(' '.join(fields))} is not a header; write {form}")
        self.next += 1
        return [int(field) for field in fields] + defaults[len(fields) - 1 :]

    def table(self, rows: int, columns: int, most: int, noun: str) -> NDArray[np.float64]:
        """The leading columns of the next rows, each numbered; what follows them is left out."""
        taken = self.rows[self.next : self.next + rows]
        if len(taken) < rows:
            raise InputError(
                f"{self.place(self.next - 1)}: the header states {rows} {noun}, but {len(taken)} lines follow; "
                "correct the number, or complete the file"
            )
        values = np.empty((rows, columns))
        for row, (_, fields) in enumerate(taken):
            values[row] = self._numbers(self.next + row, fields, columns, most, noun)
        self.next += rows
        return values

    def _numbers(self, row: int, fields: list[str], columns: int, most: int, noun: str) -> list[float]:
        if not columns <= len(fields) <= most:
            raise InputError(
                f"{self.place(row)}: {len(fields)} fields where the {noun} have "
                f"{columns if columns == most else f'{columns} to {most}'}; correct the line, or the header"
            )
        try:
            numbers = [float(field) for field in fields[:columns]]
        except ValueError:
            numbers = [float("nan")]
        if not np.isfinite(numbers).all():
            raise InputError(f"{self.place(row)}: {shortened(' '.join(fields))} are not finite numbers; correct them")
        return numbers


def _read_vertices(lines: _Lines, options: ReadOptions) -> tuple[NDArray[np.float64], int]:
    """Give coordinates, and the number of the first vertex: 0 or 1."""
    count, dimension, attributes, markers = lines.header(_VERTICES, [2, 0, 0])
    if count == 0:
        raise InputError(
            f"{lines.name}: the vertices are in a separate .node file; copy its lines in place of the first line"
        )
    if dimension != 2:
        raise InputError(f"{lines.place(lines.next - 1)}: the vertices have {dimension} dimensions; only 2 are read")
    options.check_vertices(lines.name, count)
    first_row = lines.next
    table = lines.table(count, 3, 3 + attributes + markers, "vertices")
    base = 0 if table[0, 0] == 0 else 1
    bad = np.flatnonzero(table[:, 0] != np.arange(base, base + count))
    if bad.size:
        row = int(bad[0])
        raise InputError(
            f"{lines.place(first_row + row)}: vertex {table[row, 0]:.17g} should be {row + base}; number the vertices "
            "from 0 or 1 without gaps"
        )
    if attributes or markers:
        options.note(f"{lines.name}: attributes and boundary markers are ignored")
    return table[:, 1:], base


def _read_segments(lines: _Lines, vertices: int, base: int) -> NDArray[np.int64]:
    """(m, 2) ends of each segment, from 0."""
    count, markers = lines.header(_SEGMENTS, [0])
    first_row = lines.next
    ends = lines.table(count, 3, 3 + markers, "segments")[:, 1:]
    bad = np.argwhere((ends != np.floor(ends)) | (ends < base) | (ends >= base + vertices))
    if len(bad):
        row, column = bad[0]
        raise InputError(
            f"{lines.place(first_row + int(row))}: there is no vertex {ends[row, column]:.17g}; "
            f"they are numbered from {base} to {base + vertices - 1}"
        )
    return ends.astype(np.int64) - base


def _read_holes(lines: _Lines) -> NDArray[np.float64]:
    """(h, 2) a point in each hole."""
    if lines.next == len(lines.rows):
        return np.empty((0, 2))
    return lines.table(lines.header("<holes>", [])[0], 3, 3, "holes")[:, 1:]


def _chains(segments: NDArray[np.int64]) -> list[list[int]]:
    """Vertices along each maximal chain of segments that meet at vertices of exactly two segments."""
    pairs: list[Any] = segments[segments[:, 0] != segments[:, 1]].tolist()
    return [
        [pairs[path[0][0]][0 if path[0][1] else 1], *(pairs[k][1 if is_forward else 0] for k, is_forward in path)]
        for _, path, _ in chains_of(pairs)
    ]


def chains_of(ends: Sequence[tuple[int, int] | None]) -> Iterator[tuple[int, list[tuple[int, bool]], bool]]:
    """Go along edges where exactly two meet: the first edge of each chain, all with their directions, if it closes."""
    at: dict[int, list[int]] = {}
    for index, pair in enumerate(ends):
        for place in pair or ():
            at.setdefault(place, []).append(index)
    used = [False] * len(ends)

    def walk(index: int, place: int) -> list[tuple[int, bool]]:
        """Go along an edge that begins at a place, and on while there is one way only."""
        path = []
        while not used[index]:
            used[index] = True
            a, b = ends[index] or (-1, -1)
            path.append((index, a == place))
            place = b if a == place else a
            here = at[place]
            if len(here) != 2:
                break
            index = here[0] if here[1] == index else here[1]
        return path

    for index, pair in enumerate(ends):
        if pair is None or used[index]:
            continue
        path = walk(index, pair[0])
        last, is_forward = path[-1]
        is_closed = (ends[last] or pair)[1 if is_forward else 0] == pair[0]
        behind = [other for other in at[pair[0]] if other != index]
        if not is_closed and len(at[pair[0]]) == 2 and behind and not used[behind[0]]:
            path = [(number, not way) for number, way in reversed(walk(behind[0], pair[0]))] + path
        yield index, path, is_closed


@frozen
class _Frame:
    """A frame in which coordinates are at most about 1, so that areas neither overflow nor vanish."""

    middle: NDArray[np.float64]
    exponent: int

    @staticmethod
    def of(xy: NDArray[np.float64]) -> _Frame:
        low, high = bounds(xy)
        return _Frame(low / 2 + high / 2, int(np.frexp((high / 2 - low / 2).max())[1]))

    def scaled(self, xy: NDArray[np.float64]) -> NDArray[np.float64]:
        with np.errstate(over="ignore", under="ignore"):  # of hole points far outside
            return np.nan_to_num(np.ldexp(xy - self.middle, -self.exponent))

    def unscaled(self, x: float, y: float) -> tuple[float, float]:
        return tuple((np.ldexp([x, y], self.exponent) + self.middle).tolist())


def _nested(
    loops: dict[int, NDArray[np.float64]], holes: NDArray[np.float64], frame: _Frame, name: str
) -> dict[int, list[NDArray[np.float64]]]:
    """Shell and holes of each polygon, by the number of its shell."""
    import shapely

    if not len(holes):
        return {number: [loop] for number, loop in loops.items()}
    numbers = list(loops)
    scaled = [frame.scaled(loop) for loop in loops.values()]
    shapes = np.array([shapely.make_valid(shapely.Polygon(loop)) for loop in scaled], dtype=object)
    hole_of = _smallest_around(shapes, shapely.points(frame.scaled(holes)), None)
    if -1 in hole_of:
        at = hole_of.index(-1)
        raise InputError(
            f"{name}: hole {at + 1}, ({holes[at, 0]:g}, {holes[at, 1]:g}), lies in no closed loop; move or remove it"
        )
    around = _smallest_around(shapes, shapely.points([loop[0] for loop in scaled]), np.arange(len(shapes)))
    is_hole = np.isin(np.arange(len(shapes)), hole_of)
    polygons = {numbers[i]: [loops[numbers[i]]] for i in np.flatnonzero(~is_hole).tolist()}
    for loop in np.flatnonzero(is_hole).tolist():
        shell = around[loop]
        while shell >= 0 and is_hole[shell]:
            shell = around[shell]
        if shell < 0:
            at = hole_of.index(loop)
            raise InputError(
                f"{name}: hole {at + 1}, ({holes[at, 0]:g}, {holes[at, 1]:g}), lies in a loop that no other one "
                "surrounds; move or remove it"
            )
        polygons[numbers[shell]].append(loops[numbers[loop]])
    return polygons


def _smallest_around(shapes: Any, points: Any, own: Any) -> list[int]:
    """For each point the loop of least area that it lies in; with ``own``, of those larger than its own; -1 if none."""
    import shapely

    found = [-1] * len(points)
    if not len(shapes):
        return found
    areas = shapely.area(shapes)
    for point, loop in zip(*shapely.STRtree(shapes).query(points, predicate="intersects").tolist(), strict=True):
        if own is not None and (own[point] == loop or areas[loop] <= areas[own[point]]):
            continue
        if found[point] < 0 or areas[loop] < areas[found[point]]:
            found[point] = loop
    return found


def write_poly(out: BinaryIO, polygons: PolygonSet) -> None:
    """Write vertices from 1, segments, and a point in each hole; the format has no place for ids and properties."""
    write = out.write
    write(f"{len(polygons.xy)} 2 0 0\n".encode())
    for number, (x, y) in enumerate(polygons.xy.tolist(), 1):
        write(f"{number} {coordinate_text(x)} {coordinate_text(y)}\n".encode())
    segments = _segments_of(polygons)
    write(f"{len(segments)} 0\n".encode())
    for number, (a, b) in enumerate((segments + 1).tolist(), 1):
        write(f"{number} {a} {b}\n".encode())
    holes = _hole_points(polygons)
    write(f"{len(holes)}\n".encode())
    for number, (x, y) in enumerate(holes, 1):
        write(f"{number} {coordinate_text(x)} {coordinate_text(y)}\n".encode())


def _segments_of(polygons: PolygonSet) -> NDArray[np.int64]:
    """(m, 2) ends of the edges of all rings and lines."""
    a = np.arange(len(polygons.xy))
    b = a + 1
    last = polygons.ring_starts[1:] - 1
    b[last] = polygons.ring_starts[:-1]
    keep = np.ones(len(a), dtype=bool)
    keep[last[(polygons.ring_kind == LINE) | (np.diff(polygons.ring_starts) == 1)]] = False
    return np.stack([a, b], axis=1)[keep]


def _hole_points(polygons: PolygonSet) -> list[tuple[float, float]]:
    """Give a point in each hole that is in no polygon within it."""
    import shapely

    if not (polygons.ring_kind == HOLE).any():
        return []
    frame = _Frame.of(polygons.xy)
    polygons = replace(polygons, xy=frame.scaled(polygons.xy))
    shapes = to_shapely(polygons)
    shells = shapely.make_valid(shapely.polygons(shapely.get_exterior_ring(shapes[~polygons.is_line])))
    tree = shapely.STRtree(shells)
    points = []
    for index in np.flatnonzero((polygons.ring_kind == HOLE) & (np.diff(polygons.ring_starts) > 2)).tolist():
        hole = shapely.make_valid(shapely.Polygon(polygons.ring(index)))
        inside = shapely.union_all(shells[tree.query(hole, predicate="contains")])
        point = shapely.difference(hole, inside).representative_point()
        if not point.is_empty:
            points.append(frame.unscaled(point.x, point.y))
    return points
