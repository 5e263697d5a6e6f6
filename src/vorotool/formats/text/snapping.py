"""Snap rounding of the rings of features, on a lattice of multiples of the grid of a file."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Floats, Indices, Nesting, following, owners, starts_of
from vorotool.numeric.coordinates import Grid

Rings = tuple[Floats, Nesting]


@frozen(eq=False)
class Snapped:
    """Features after snap rounding, and what that means for others with the same vertices and edges."""

    rings: Rings  # pair of array and Nesting: of the features, in their order; those without area have none
    before: Floats  # (k, 2) float64 array: vertices of the features, and where they are now
    after: Floats  # (k, 2) float64 array: vertices of the features, and where they are now
    edges: Floats  # (e, 2, 2) float64 array: edges, by their ends before, that have further vertices now
    chains: list[Floats]  # list of (c, 2) float64 array: these, from the first end to the second

    def applied_to(self, points: Floats, nesting: Nesting, features: NDArray[np.bool_]) -> Rings:
        """Move the vertices of other features, and lead their edges along the chains, which run the other way."""
        rings = nesting.rings
        of_these = np.repeat(features, np.diff(rings[nesting.polygons[nesting.cells]]))
        at = np.flatnonzero(of_these & is_among(points, self.before))
        new = points.copy()
        names, name_of = _Names.of(self.before), np.full(len(points), -1, dtype=np.int64)
        name_of[at] = names.find(points[at])
        shared = np.flatnonzero(name_of >= 0)
        new[shared] = self.after[names.first[name_of[shared]]]
        if not self.chains:
            return new, nesting
        ends = names.find(self.edges.reshape(-1, 2)).reshape(-1, 2)
        chain_of = {(b, a): chain[::-1] for (a, b), chain in zip(ends.tolist(), self.chains, strict=True)}
        after = following(rings)
        both = shared[name_of[after[shared]] >= 0]
        pairs = zip(name_of[both].tolist(), name_of[after[both]].tolist(), strict=True)
        inserted = {i: chain_of[pair] for i, pair in zip(both.tolist(), pairs, strict=True) if pair in chain_of}
        counts = np.zeros(len(points), dtype=np.int64)
        counts[list(inserted)] = [len(chain) for chain in inserted.values()]
        behind = np.repeat(np.arange(1, len(points) + 1), counts)
        longer = np.insert(new, behind, np.concatenate([np.empty((0, 2)), *inserted.values()]), axis=0)
        return longer, nesting._replace(rings=starts_of(1 + counts)[rings])


def is_among(points: Floats, others: Floats) -> NDArray[np.bool_]:
    """(n,) whether points may be among others: false for most that are not, true for all that are."""
    return _ranks(np.sort(_hashes(others)), _hashes(points)) >= 0


def _ranks(keys: NDArray[Any], wanted: NDArray[Any]) -> Indices:
    """(n,) where each is among sorted keys, -1 for those that are not."""
    if not len(keys):
        return np.full(len(wanted), -1)
    ranks = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return np.where(keys[ranks] == wanted, ranks, -1)


def _hashes(points: Floats) -> NDArray[np.uint64]:
    x, y = (np.ascontiguousarray(points + 0.0).view(np.uint64)).T  # no negative zeros
    return (x * np.uint64(0x9E3779B97F4A7C15)) ^ (y * np.uint64(0xC2B2AE3D27D4EB4F) + (y >> np.uint64(29)))


@frozen(eq=False)
class _Names:
    """Numbers of distinct points: the points in order, and one index of each."""

    points: NDArray[np.complex128]
    first: Indices

    @classmethod
    def of(cls, points: Floats) -> _Names:
        made, first = np.unique(_complex(points), return_index=True)
        return cls(made, first)

    def find(self, points: Floats) -> Indices:
        """(n,) the number of each point, -1 of those that are not here."""
        return _ranks(self.points, _complex(points))


def _complex(points: Floats) -> NDArray[np.complex128]:
    """Points as numbers that numpy sorts by x, then by y."""
    return np.ascontiguousarray(points + 0.0).view(np.complex128).reshape(-1)


def snapped(
    points: Floats, nesting: Nesting, grid: Grid, *, is_coverage: bool = False, keeps_vertices: bool = True
) -> Snapped:
    """Make the rings of features valid by snap rounding, together."""
    rings, polygons, cells = nesting
    lattice = _Lattice.of(points, grid)
    vertices = lattice.places(points)
    places = _Places.of(lattice, points, vertices, keeps_vertices=keeps_vertices)
    outer = _outer_edges(points, rings) if is_coverage else np.zeros(0, dtype=np.int64)
    ends = np.stack([outer, following(rings)[outer]], axis=1)
    graph = _graph(vertices, vertices[ends.reshape(-1)], rings, polygons)
    faces = _features_of_faces(graph, owners(np.diff(cells)), first_only=is_coverage)
    core = _core.kernel.PlanarGraph(graph["points"], graph["segments"], graph["segment_faces"])
    found = _core.arrangement.boundary_rings(core, *faces, None)
    part_sizes = np.bincount(found["ring_part"], minlength=len(found["part_polygon"]))
    made = Nesting(
        found["start"].astype(np.int64),
        starts_of(part_sizes),
        starts_of(np.bincount(found["part_polygon"], minlength=len(cells) - 1)),
    )
    chains = _chains(graph, vertices[ends.reshape(-1)]) if len(outer) else []
    longer = [k for k, chain in enumerate(chains) if len(chain)]
    return Snapped(
        (places.coordinates(graph["points"])[found["point"]], made),
        points,
        places.coordinates(vertices),
        points[ends[longer]],
        [places.coordinates(chains[k]) for k in longer],
    )


def _graph(
    vertices: NDArray[np.int32], line_ends: NDArray[np.int32], rings: Indices, polygons: Indices
) -> dict[str, Any]:
    """Arrange rings of polygons, and lines of two vertices each, which stay in the graph whatever they bound."""
    lines = len(line_ends) // 2
    kind = np.full(len(rings) - 1 + lines, 1, dtype=np.int8)
    kind[polygons[:-1]], kind[len(rings) - 1 :] = 0, 2
    polygon = owners(np.diff(polygons), dtype=np.int32)
    graph = _core.arrangement.make_planar_graph(
        np.concatenate([vertices, line_ends]),
        np.concatenate([rings, rings[-1] + 2 * np.arange(1, lines + 1)]),
        kind,
        np.concatenate([polygon, len(polygons) - 1 + np.arange(lines, dtype=np.int32)]),
        None,
    )
    return graph | {"vertex_count": len(vertices) + len(line_ends)}


@frozen
class _Lattice:
    """Multiples of the grid by a power of two, from an origin on."""

    grid: Grid
    origin: Indices
    shift: int

    @classmethod
    def of(cls, points: Floats, grid: Grid) -> _Lattice:
        if grid.decimals is None:
            grid = Grid.of(points, None)  # of these points alone: finer than that of all
        steps = grid.steps(points)
        low, high = steps.min(axis=0), steps.max(axis=0)
        half = int((high - low).max()) // 2 + 1
        shift = max(0, half.bit_length() - 29)
        return cls(grid, ((low + high) // 2) >> shift << shift, shift)

    def places(self, points: Floats) -> NDArray[np.int32]:
        """Return the nearest lattice point of each point."""
        offset = self.grid.steps(points) - self.origin
        return ((offset + (1 << self.shift >> 1)) >> self.shift).astype(np.int32)

    def values(self, places: NDArray[np.integer]) -> Floats:
        """Return coordinates of lattice points."""
        return self.grid.values(self.origin + (places.astype(np.int64) << self.shift))


@frozen(eq=False)
class _Places:
    """Coordinates of places of a lattice."""

    lattice: _Lattice
    keys: Indices
    kept: Floats

    @classmethod
    def of(cls, lattice: _Lattice, points: Floats, vertices: NDArray[np.int32], *, keeps_vertices: bool) -> _Places:
        keys, first = np.unique(_place_keys(vertices), return_index=True)
        return cls(lattice, keys if keeps_vertices else keys[:0], points[first])

    def coordinates(self, places: NDArray[np.int32]) -> Floats:
        """Return those of the first vertex at each place, else those of the lattice."""
        made = self.lattice.values(places)
        if not len(self.keys):
            return made
        rank = _ranks(self.keys, _place_keys(places))
        return np.where((rank >= 0)[:, None], self.kept[rank], made)


def _place_keys(places: NDArray[np.int32]) -> Indices:
    x, y = places.astype(np.int64).T
    return (x << 32) + y


def _features_of_faces(
    graph: dict[str, Any], feature: Indices, *, first_only: bool
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return the features of each face, ascending: where each begins, and all; of a coverage the first alone."""
    start, polygon = graph["face_starts"], graph["face_polygon"]
    of_face = owners(np.diff(start))
    features = feature[polygon].astype(np.int32)
    kept = np.ones(len(features), dtype=bool)
    same_face = np.diff(of_face) == 0
    kept[1:] = ~same_face if first_only else ~(same_face & (np.diff(features) == 0))
    return starts_of(np.bincount(of_face[kept], minlength=len(start) - 1)).astype(np.int32), features[kept]


def _outer_edges(points: Floats, rings: Indices) -> Indices:
    """Return the edges, by their first vertex, that no ring runs along the other way."""
    after = following(rings)
    places, name = np.unique(_complex(points), return_inverse=True)
    name = name.reshape(-1)
    width = len(places)
    return np.flatnonzero(~np.isin(name * width + name[after], name[after] * width + name))


def _chains(graph: dict[str, Any], vertices: NDArray[np.int32]) -> list[NDArray[np.int32]]:
    """Return the places inside each of the last edges of a graph, in order; they are lines of two vertices."""
    points, source = graph["points"], graph["source_edge"].astype(np.int64)
    lines = len(vertices) // 2
    line, rest = np.divmod(source - (graph["vertex_count"] - 2 * lines), 2)
    at = np.flatnonzero((line >= 0) & (rest == 0))
    segment = owners(np.diff(graph["source_starts"]))[at]
    line = np.repeat(line[at], 2)
    places = points[graph["segments"][segment].reshape(-1)]
    first, last = vertices[0::2][line], vertices[1::2][line]
    inner = (places != first).any(axis=1) & (places != last).any(axis=1)
    along = ((places.astype(np.int64) - first) * (last.astype(np.int64) - first)).sum(axis=1)
    order = np.flatnonzero(inner)
    order = order[np.lexsort((along[order], line[order]))]
    kept = np.ones(len(order), dtype=bool)
    kept[1:] = (np.diff(line[order]) > 0) | (np.diff(places[order], axis=0) != 0).any(axis=1)
    order = order[kept]
    return np.split(places[order], np.searchsorted(line[order], np.arange(1, lines)))
