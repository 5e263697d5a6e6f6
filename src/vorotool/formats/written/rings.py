"""Rings as they are written: their coordinates rounded, and repaired where that leaves them invalid."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import VerificationError
from vorotool.formats.written.snapping import is_among, snapped
from vorotool.formats.written.verify import verify_written
from vorotool.numeric.coordinate_grid import Grid, is_verified, rounded
from vorotool.numeric.ragged import Nesting, following, owners, ranges, starts_of

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

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
    threads: int = 0,
) -> WrittenRings:
    """Round the vertices of rings, and repair features that are invalid then."""
    given = rounded(points, decimals), nesting
    if is_coverage or decimals is not None:
        given = _compact(*given)
    made, repaired = given, 0
    bad = _invalid(*given, is_coverage=is_coverage, in_box=in_box, threads=threads)
    if bad.any():
        grid = Grid.of(points, decimals)
        repair = _repair_coverage if is_coverage else _repair_each
        made, repaired = repair(given, bad, grid, threads)
    if is_verified():
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
    kept = (points != points[following(rings)]).any(axis=1)
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
def _invalid(
    points: Floats, nesting: Nesting, *, is_coverage: bool, in_box: bool = False, threads: int = 0
) -> NDArray[np.bool_]:
    """(f,) whether each feature is invalid, or overlaps or misses the vertices of others of its coverage."""
    import shapely

    rings, polygons, cells = nesting
    faults = _core.arrangement.polygon_faults(
        np.ascontiguousarray(points), rings, polygons, is_coverage and not in_box, threads, None
    )
    feature = owners(np.diff(cells))
    bad = np.zeros(len(cells) - 1, dtype=bool)
    bad[feature[(faults & _CLASHES) != 0]] = True
    doubtful = np.diff(cells) > 1  # parts may overlap each other
    doubtful[feature[(faults & _UNSOUND) != 0]] = True
    doubtful &= ~bad
    chosen = np.flatnonzero(doubtful)
    if chosen.size:
        own = select(points, nesting, chosen)
        bad[chosen] = ~shapely.is_valid(geometry(*own)) | (_is_turned_over(*own) if is_coverage else False)
    if in_box and bad.any():
        return _invalid(points, nesting, is_coverage=is_coverage, threads=threads)
    return bad


def _is_turned_over(points: Floats, nesting: Nesting) -> NDArray[np.bool_]:
    """(f,) whether the shell of a polygon runs clockwise or a hole counter-clockwise: other features lie in it."""
    import shapely

    rings, polygons, cells = nesting
    lines = shapely.linearrings(points, indices=owners(np.diff(rings)))
    is_shell = np.zeros(len(lines), dtype=bool)
    is_shell[polygons[:-1]] = True
    turned: NDArray[np.bool_] = np.logical_or.reduceat(shapely.is_ccw(lines) != is_shell, polygons[cells[:-1]])
    return turned


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
def _repair_each(given: Rings, bad: NDArray[np.bool_], grid: Grid, _threads: int) -> tuple[Rings, int]:
    """Repair features one by one: others may overlap them."""
    import shapely

    chosen = np.flatnonzero(bad)
    pieces = []
    for feature in chosen.tolist():
        own = select(*given, np.array([feature]))
        piece = snapped(*own, grid).rings
        if not shapely.is_valid(geometry(*piece)).all():
            piece = snapped(*own, grid, keeps_vertices=False).rings
        pieces.append(piece)
    return _replaced(given, chosen, _joined(pieces)), len(chosen)


def _repair_coverage(given: Rings, bad: NDArray[np.bool_], grid: Grid, threads: int) -> tuple[Rings, int]:
    """Repair features along with those that share vertices with them, more of them until all fit together."""
    made, touched, tries = given, np.zeros_like(bad), 0
    while bad.any():
        if touched.all() and tries > 1:
            raise VerificationError("rings that were repaired together are invalid")
        touched = _with_neighbors(*made, touched | bad)
        chosen = np.flatnonzero(touched)
        repaired = snapped(*select(*given, chosen), grid, is_coverage=True, keeps_vertices=tries == 0)
        tries += 1
        made = _replaced(repaired.applied_to(*given, ~touched), chosen, repaired.rings)
        bad = _invalid(*made, is_coverage=True, threads=threads)
    return made, int(np.count_nonzero(touched))


def _with_neighbors(points: Floats, nesting: Nesting, chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Add the features that have a vertex in common with chosen ones."""
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
