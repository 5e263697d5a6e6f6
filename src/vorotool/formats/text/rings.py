"""Rings as they are written: their coordinates rounded, and repaired where that leaves them invalid."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import RepairWarning, VerificationError, warn
from vorotool.numeric.arrays import Floats, Indices, Nesting, following, owners, ranges, starts_of
from vorotool.numeric.checks import index_of_rows
from vorotool.numeric.coordinates import Grid, current_decimals, current_written, on_grid, rounded
from vorotool.types.polygons.polygon_set import HOLE, SHELL, PolygonSet
from vorotool.types.table import Computed

_UNSOUND, _CLASHES = 1, 2


class WrittenRings(NamedTuple):
    """Vertices of rings on the grid of a file, where rings, polygons and features begin, and what was repaired."""

    points: Floats
    nesting: Nesting
    repaired: int = 0
    """Features whose rings had to change."""
    emptied: Indices = np.zeros(0, dtype=np.int64)
    """Features that had area, and are without it on the grid."""


def written_rings(
    points: Floats,
    nesting: Nesting,
    *,
    decimals: int | None = None,
    is_coverage: bool = False,
    in_box: bool = False,
) -> WrittenRings:
    """Round the vertices of rings, and repair features that are invalid then."""
    given = points if decimals is None else rounded(points, decimals), nesting
    if is_coverage or decimals is not None:
        given = _compact(*given)
    made, repaired = given, 0
    bad = _invalid(*given, is_coverage=is_coverage, in_box=in_box)
    if bad.any():
        grid = Grid.of(points, decimals)
        repair = _repair_coverage if is_coverage else _repair_each
        made, repaired = repair(given, bad, grid)
    if current_written().how.is_verified:
        verify_written(geometry(*made), geometry(points, nesting), decimals, is_coverage=is_coverage)
    had, has = np.diff(nesting.cells) > 0, np.diff(made[1].cells) > 0
    return WrittenRings(*made, repaired, np.flatnonzero(had & ~has))


def valid_coverage(points: Floats, nesting: Nesting, *, in_box: bool = False) -> NDArray[Any]:
    """(f,) shapely geometry of the features of a coverage, valid and still a coverage; see `written_rings`."""
    made = written_rings(points, nesting, is_coverage=True, in_box=in_box)
    return geometry(made.points, made.nesting)


Rings = tuple[Floats, Nesting]


def _compact(points: Floats, nesting: Nesting) -> Rings:
    """Leave out vertices that repeat the one before, rings of two vertices, and polygons without a shell."""
    rings, polygons, cells = nesting
    (x, y), after = points.T, following(rings)
    kept = (x != x[after]) | (y != y[after])
    sizes = np.add.reduceat(kept, rings[:-1]) if len(rings) > 1 else np.zeros(0, dtype=np.int64)
    if kept.all() and (sizes > 2).all():
        return points, nesting
    polygon_of_ring = owners(np.diff(polygons))
    stays = (sizes > 2)[polygons[:-1]][polygon_of_ring] & (sizes > 2)
    kept &= np.repeat(stays, np.diff(rings))
    polygon_stays = stays[polygons[:-1]]
    ring_counts = np.add.reduceat(stays, polygons[:-1])[polygon_stays] if len(polygons) > 1 else stays
    return points[kept], Nesting(starts_of(sizes[stays]), starts_of(ring_counts), starts_of(polygon_stays)[cells])


# ---- what is invalid -----------------------------------------------------------------------------
def _invalid(points: Floats, nesting: Nesting, *, is_coverage: bool, in_box: bool = False) -> NDArray[np.bool_]:
    """(f,) whether each feature is invalid, or overlaps or misses the vertices of others of its coverage."""
    rings, polygons, cells = nesting
    faults = _core.arrangement.polygon_faults(
        np.ascontiguousarray(points), rings, polygons, is_coverage and not in_box, 0, None
    )
    feature = owners(np.diff(cells))
    bad = np.zeros(len(cells) - 1, dtype=bool)
    bad[feature[(faults & _CLASHES) != 0]] = True
    doubtful = np.diff(cells) > 1  # parts may overlap each other
    doubtful[feature[(faults & _UNSOUND) != 0]] = True
    doubtful &= ~bad
    chosen = np.flatnonzero(doubtful)
    if chosen.size:
        import shapely

        own = select(points, nesting, chosen)
        bad[chosen] = ~shapely.is_valid(geometry(*own)) | (_is_turned_over(*own) if is_coverage else False)
    if in_box and bad.any():
        return _invalid(points, nesting, is_coverage=is_coverage)
    return bad


def _is_turned_over(points: Floats, nesting: Nesting) -> NDArray[np.bool_]:
    """(f,) whether the shell of a polygon runs clockwise or a hole counter-clockwise: other features lie in it."""
    import shapely

    rings, polygons, cells = nesting
    lines = shapely.linearrings(points, indices=owners(np.diff(rings)))
    is_shell = np.zeros(len(lines), dtype=bool)
    is_shell[polygons[:-1]] = True
    return np.logical_or.reduceat(shapely.is_ccw(lines) != is_shell, polygons[cells[:-1]])


def select(points: Floats, nesting: Nesting, features: Indices) -> Rings:
    """Return the rings of some features alone."""
    rings, polygons, cells = nesting
    parts = ranges(cells[features], np.diff(cells)[features])
    own = ranges(polygons[parts], np.diff(polygons)[parts])
    vertices = ranges(rings[own], np.diff(rings)[own])
    return points[vertices], Nesting(
        starts_of(np.diff(rings)[own]), starts_of(np.diff(polygons)[parts]), starts_of(np.diff(cells)[features])
    )


def geometry(points: Floats, nesting: Nesting) -> NDArray[Any]:
    """(f,) polygons and multipolygons of shapely; empty polygons of features without rings."""
    import shapely

    rings, polygons, cells = nesting
    closed = np.insert(points, rings[1:], points[rings[:-1]], axis=0) if len(rings) > 1 else points
    parts = shapely.from_ragged_array(
        shapely.GeometryType.POLYGON, np.ascontiguousarray(closed), (rings + np.arange(len(rings)), polygons)
    )
    counts = np.diff(cells)
    made = np.full(len(counts), shapely.Polygon(), dtype=object)
    made[counts == 1] = parts[cells[:-1][counts == 1]]
    several = np.flatnonzero(counts > 1)
    if several.size:
        chosen = ranges(cells[several], counts[several])
        made[several] = shapely.multipolygons(parts[chosen], indices=owners(counts[several]))
    return made


# ---- repairs -------------------------------------------------------------------------------------
def _repair_each(given: Rings, bad: NDArray[np.bool_], grid: Grid) -> tuple[Rings, int]:
    """Repair features one by one: others may overlap them."""
    import shapely

    from vorotool.formats.text.snapping import snapped

    chosen = np.flatnonzero(bad)
    pieces = []
    for feature in chosen.tolist():
        own = select(*given, np.array([feature]))
        piece = snapped(*own, grid).rings
        if not shapely.is_valid(geometry(*piece)).all():
            piece = snapped(*own, grid, keeps_vertices=False).rings
        pieces.append(piece)
    return _replaced(given, chosen, _joined(pieces)), len(chosen)


def _repair_coverage(given: Rings, bad: NDArray[np.bool_], grid: Grid) -> tuple[Rings, int]:
    """Repair features along with those that share vertices with them, more of them until all fit together."""
    from vorotool.formats.text.snapping import snapped

    made, touched, tries = given, np.zeros_like(bad), 0
    while bad.any():
        if touched.all() and tries > 1:
            raise VerificationError("rings that were repaired together are invalid")
        touched = _with_neighbors(*made, touched | bad)
        chosen = np.flatnonzero(touched)
        repaired = snapped(*select(*given, chosen), grid, is_coverage=True, keeps_vertices=tries == 0)
        tries += 1
        made = _replaced(repaired.applied_to(*given, ~touched), chosen, repaired.rings)
        bad = _invalid(*made, is_coverage=True)
    return made, int(np.count_nonzero(touched))


def _with_neighbors(points: Floats, nesting: Nesting, chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Add the features that have a vertex in common with chosen ones."""
    from vorotool.formats.text.snapping import is_among

    feature = owners(np.diff(nesting.rings[nesting.polygons[nesting.cells]]))
    wider = chosen.copy()
    wider[feature[is_among(points, points[chosen[feature]])]] = True
    return wider


def _joined(pieces: list[Rings]) -> Rings:
    """Put rings of features one after the other."""
    sizes = [np.concatenate([np.diff(piece[1][k]) for piece in pieces]) for k in range(3)]
    return np.concatenate([piece[0] for piece in pieces]), Nesting(*map(starts_of, sizes))


def _replaced(given: Rings, features: Indices, by: Rings) -> Rings:
    """Put the rings of some features in the place of their old ones."""
    count = len(given[1].cells) - 1
    together = _joined([given, by])
    order = np.arange(count)
    order[features] = count + np.arange(len(features))
    return select(*together, order)


def ring_texts(points: Floats, nesting: Nesting, style: str) -> Computed:
    """Give a column of the text of features, made in the core."""
    rings, polygons, rows = nesting

    def texts(part: slice) -> Any:
        begin, end, _ = part.indices(len(rows) - 1)
        return _core.text.PolygonTexts(points, rings, polygons, rows[begin : end + 1], _core.text.PolygonStyle[style])

    return Computed(texts, len(rows) - 1)


# ---- reports and checks --------------------------------------------------------------------------
_NAMED = 10


def report_emptied(rows: NDArray[np.integer], what: str) -> None:
    """Warn of cells or features that are without area on the grid of the file, counted from 1."""
    if not len(rows):
        return
    named = ", ".join(str(row + 1) for row in rows[:_NAMED].tolist()) + (", ..." if len(rows) > _NAMED else "")
    number = f"{len(rows)} {what} has" if len(rows) == 1 else f"{len(rows)} {what}s have"
    grid = "" if current_decimals() is None else f" with {current_decimals()} decimals"
    warn(f"{number} no area{grid} and {'is' if len(rows) == 1 else 'are'} empty: {named}", RepairWarning)


_COARSEST = 2.0**-28
"""Of the extent: the lattice that rings are repaired on is finer."""


def verify_written(made: NDArray[Any], given: NDArray[Any], decimals: int | None, *, is_coverage: bool) -> None:
    """Check features as they are written, by GEOS."""
    import shapely

    bad = np.flatnonzero(~shapely.is_valid(made))
    if bad.size:
        reason = shapely.is_valid_reason(made[bad[0]])
        raise VerificationError(f"feature {bad[0] + 1} is invalid as it is written: {reason}")
    if is_coverage and not shapely.coverage_is_valid(made[~shapely.is_empty(made)]):
        raise VerificationError("cells overlap, or do not share their vertices, as they are written")
    xy = shapely.get_coordinates(made)
    extent = float(np.abs(xy).max(initial=0))
    step = extent * _COARSEST
    if decimals is not None and extent * float(10**decimals) < 2.0**52:
        bad = np.flatnonzero((np.round(xy, decimals) != xy).any(axis=1))
        if bad.size:
            raise VerificationError(f"coordinate {xy[bad[0]].tolist()} has more than {decimals} decimals")
        step = max(step, 1 / float(10**decimals))
    bound = 2 * step * (shapely.length(made) + shapely.length(given)) + 16 * step * step
    far = np.flatnonzero(np.abs(shapely.area(made) - shapely.area(given)) > bound)
    if far.size and not is_coverage:
        areas = shapely.area(given[far[0]]), shapely.area(made[far[0]])
        raise VerificationError(f"feature {far[0] + 1} has the area {areas[0]:g}, but {areas[1]:g} as it is written")


def written_polygons(polygons: PolygonSet) -> PolygonSet:
    """Round polygons to the decimals of the file, and repair those that are invalid then."""
    if polygons.is_line.any() or (np.diff(polygons.ring_starts) < 3).any():
        return replace(polygons, xy=on_grid(polygons.xy))
    first = np.flatnonzero(np.diff(polygons.feature, prepend=-1))
    nesting = Nesting(polygons.ring_starts, polygons.polygon_starts, np.append(first, len(polygons)))
    made = written_rings(polygons.xy, nesting, decimals=current_decimals())
    if made.nesting is nesting:
        return polygons if made.points is polygons.xy else replace(polygons, xy=made.points)
    report_emptied(made.emptied, "feature")
    return _with_rings(polygons, made.points, made.nesting, first)


def _with_rings(polygons: PolygonSet, points: NDArray[np.float64], nesting: Nesting, first: NDArray[Any]) -> PolygonSet:
    """Give the features of polygons other rings; what is known of a feature is that of its first polygon."""
    rings, parts, cells = nesting
    feature = owners(np.diff(cells))
    source = first[feature]
    kind = np.full(len(rings) - 1, HOLE)
    kind[parts[:-1]] = SHELL
    rows = source.tolist()
    _, numbered = np.unique(feature, return_inverse=True)
    return replace(
        polygons,
        xy=points,
        ring_starts=rings,
        ring_kind=kind,
        ring_polygon=owners(np.diff(parts), dtype=np.int32),
        ids=None if polygons.ids is None else [polygons.ids[i] for i in rows],
        feature=numbered.reshape(-1).astype(np.int32),
        properties={name: [values[i] for i in rows] for name, values in polygons.properties.items()},
        index=index_of_rows(polygons.index, source),
    )
