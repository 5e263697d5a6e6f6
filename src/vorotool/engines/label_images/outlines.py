"""Polygons from masks and label images: outlines along pixels, or contours of marching squares."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.images import as_raster
from vorotool.engines.common import twice_areas
from vorotool.engines.tessellation.cleaned_masks import Cleaning, cleaned_values
from vorotool.engines.tessellation.raster_objects import (
    Note,
    Objects,
    Threshold,
    check_objects,
    default_objects,
    foreground_values,
    gray_values,
    label_values,
    report_no_foreground,
    settled_threshold,
)
from vorotool.errors import InputError, LimitError, UsageError, option
from vorotool.frozen import frozen
from vorotool.numeric.arrays import Indices, following, owners, ranges, starts_of, within
from vorotool.numeric.checks import checked_threads, is_choice
from vorotool.numeric.lazy import shapely
from vorotool.numeric.numbers import distinct, finite_double, shown_number, whole_number
from vorotool.numeric.parallel import Progress
from vorotool.types.images import LabelImage, Raster
from vorotool.types.pixels import Frame
from vorotool.types.polygons.polygon_set import LINE, PolygonSet

if TYPE_CHECKING:
    from vorotool.typing import ImageLike, OutlineKind, RealLike

Border = Literal["closed", "open"]

KINDS = ("crack", "contour")
BORDERS = ("closed", "open")
MOST_VERTICES = 2**28
"""As many as a planar graph may have."""

LARGEST_SIDE = 2**31 - 2
"""Corners of pixels are numbered in 31 bits."""

_CORNER_RULES = {
    ("crack", 4): "divided",
    ("crack", 8): "joined",
    ("contour", 4): "apart",
    ("contour", 8): "yielding",
}
"""Rules of the core where two pixels of an object meet at a corner only."""


def outlines(
    image: ImageLike,
    *,
    outline: OutlineKind = "crack",
    border: Border = "closed",
    mode: Objects | None = None,
    connectivity: int = 8,
    threshold: Threshold = None,
    invert: bool = False,
    min_area: RealLike | None = None,
    fill_holes: bool | RealLike = False,
    simplify: float | None = None,
    strict: bool = False,
    max_sites: int = MOST_VERTICES,
    threads: int = 0,
    progress: Progress = None,
    note: Note = None,
) -> PolygonSet:
    """Return the outlines of the objects of a mask or a label image as polygons with holes.

    The crack outline follows the sides of the pixels of an object: its corners are at half-integers, and its area is
    the number of pixels. The contour is that of marching squares, as in scikit-image for an image padded with
    background: it runs half-way between the centers of pixels inside and outside, or, with a threshold, where the
    interpolated gray value equals it.

    An object is a component of a mask, or all pixels of one label; each component of a label is a polygon. Touching
    labels are never merged: their outlines share the border between them, vertex by vertex.

    Where two pixels meet only at a corner, 8-connectivity connects them and separates the background there. The crack
    outline then touches itself in that corner, and a skeleton passes through it with radius 0; the contour leaves a
    passage, where two labels cross only for the smaller one. With 4-connectivity it is the other way round: the object
    ends there, the background passes, and no ring of a crack outline visits a corner twice.

    Parameters
    ----------
    image : Raster, LabelImage, or (H, W) array of any library
        Nonzero pixels are foreground. Pixel (x, y) is in column x and row y, and covers half a unit on each side.
    outline : {"crack", "contour"}
        The kind of outline.
    border : {"closed", "open"}
        Contours at the border of the image: closed around its corners and those of objects there, or meeting it at a
        right angle, as if the outermost pixels continued beyond it. See ``border`` of `skeleton_exact`.
    mode : {"components", "labels"}, optional
        Kind of objects: by default components of a mask (its only value besides 0 is 1, 255, the largest of its type,
        or True), else labels.
    connectivity : {8, 4}
        Of the pixels of an object.
    threshold : float or "otsu", optional
        Pixels above the threshold are foreground.
    invert : bool
        Exchange foreground and background.
    min_area : number, optional
        Leave out objects of a mask with fewer pixels, their filled holes included.
    fill_holes : bool or number
        Whether to fill the holes of the objects of a mask first; a number fills those of at most so many pixels.
    simplify : float, optional
        Largest distance that outlines may move when vertices are dropped; shared borders stay shared.
    strict : bool
        Refuse an image without foreground.
    max_sites : int
        More vertices are refused before memory is allocated for them.
    threads : int
        Number of threads; 0 uses all.
    progress : callable, optional
        Called with the fraction done.
    note : callable, optional
        Called with a text if an image was taken for a mask or for labels and that may surprise.

    Returns
    -------
    PolygonSet
        Polygons in the order of labels, then of first pixels, row by row. The id of a polygon is its label, as is its
        column ``label`` in an image of labels; components of a mask have the labels 1, 2, …. Shells have a positive
        area, holes a negative one.

    Raises
    ------
    InputError
        If the image has colors or looks like a photograph and there is no threshold; if a value is not finite; if a
        cleaning option is used on labels; or if `strict` and there is no foreground.
    LimitError
        If there are more vertices than `max_sites`.
    UsageError
        If an option is none.

    Warns
    -----
    VorotoolWarning
        If there is no foreground, hence no polygon.

    References
    ----------
    Lorensen and Cline, "Marching cubes", 1987.

    Examples
    --------
    >>> ring = outlines(np.array([[1, 1, 1], [1, 0, 1], [1, 1, 1]], dtype=bool))
    >>> ring.ring(0).tolist(), ring.ring(1).tolist()
    ([[-0.5, -0.5], [2.5, -0.5], [2.5, 2.5], [-0.5, 2.5]], [[0.5, 0.5], [0.5, 1.5], [1.5, 1.5], [1.5, 0.5]])
    >>> outlines(np.array([[7, 7, 2]])).ids
    [2, 7]
    """
    if not is_choice(outline, KINDS):
        raise UsageError(f"the outline is {shown_number(outline)}: it must be one of {', '.join(KINDS)}")
    if not is_choice(border, BORDERS):
        raise UsageError(f"the border is {shown_number(border)}: it must be one of {', '.join(BORDERS)}")
    check_objects(mode, get_args(Objects), connectivity)
    origin = (0, 0)
    if isinstance(image, LabelImage):
        mode, origin, image = mode or "labels", (image.frame.x, image.frame.y), image.labels
    raster = as_raster(image, "image", is_gray=True)
    if threshold is not None:
        threshold, invert = settled_threshold(raster, threshold, invert=invert)
        raster = Raster(gray_values(raster), mask=raster.mask, y_axis=raster.y_axis)
    height, width = raster.values.shape[:2]
    values = foreground_values(raster, threshold, invert=invert)
    if cleaning := Cleaning.of(min_area, fill_holes):
        values = cleaned_values(values, cleaning, mode, connectivity=connectivity, missing=raster.mask).mask
    by_label = (mode or default_objects(values, note=note)) == "labels"
    labels = label_values(values) if by_label or values.dtype == bool else values != 0
    is_open = outline == "contour" and border == "open"
    rule = _CORNER_RULES[outline, connectivity]
    made = _traced(np.pad(labels, 1, mode="edge") if is_open else labels, rule, max_sites, threads, progress)
    if not len(made["labels"]):
        report_no_foreground(strict=strict)
    if outline == "crack":
        xy, start = made["corners"] - 0.5, made["start"]
    elif threshold is None:
        xy, start = half_way_contours(made["corners"], made["start"])
    else:
        gray = np.pad(raster.values, 1, mode="edge") if is_open else raster.values
        xy, start = gray_contours(made["corners"], made["start"], gray, gray_level(gray, threshold))
    if is_open:
        xy, start = _cut_at_border(xy - 1, start, labels.shape)
    ids = made["labels"] if by_label else np.arange(1, len(made["labels"]) + 1)
    polygons = PolygonSet(
        xy if origin == (0, 0) else xy + origin,
        start,
        made["is_hole"],
        made["ring_object"],
        ids.tolist(),
        np.cumsum(np.diff(ids, prepend=ids[:1]) > 0),
        properties={"label": ids.tolist()} if by_label else {},
        connectivity=connectivity if outline == "crack" else None,
        y_axis=raster.y_axis,
        frame=Frame(*origin, width, height).box,
    )
    return polygons if simplify is None else simplified_polygons(polygons, simplify)


def _cut_at_border(
    xy: NDArray[np.float64], start: NDArray[np.int64], shape: tuple[int, ...]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Cut contours of an image whose outermost pixels are there twice: beyond its border they are at right angles."""
    height, width = shape
    cut = np.clip(xy, -0.5, [width - 0.5, height - 0.5])
    ring = owners(np.diff(start))
    following_place = cut[following(start)]
    kept = (cut != following_place).any(axis=1)
    return cut[kept], starts_of(np.bincount(ring[kept], minlength=len(start) - 1))


def _traced(
    labels: NDArray[Any], rule: str, max_sites: int, threads: int, progress: Progress
) -> dict[str, NDArray[Any]]:
    """Crack outlines as the core gives them: SHELL is 0 there and HOLE 1, too."""
    if max(labels.shape) > LARGEST_SIDE:
        raise LimitError(
            f"the image is {labels.shape[1]} x {labels.shape[0]} pixels: a side has at most {LARGEST_SIDE}"
        )
    labels = np.array(labels, order="C")  # a copy: vertices are counted, then filled in, and links followed
    labels = labels.view(np.uint8) if labels.dtype == bool else labels
    most, threads = min(whole_number(max_sites, "max_sites"), MOST_VERTICES), checked_threads(threads)
    count = _core.label_images.count_crack_vertices(labels, threads, progress)
    if count > most:
        raise LimitError(
            f"the outlines have {count} vertices, more than {option(f'--max-sites {most}')}: smooth the image, or use "
            "a larger limit"
        )
    return _core.label_images.trace_cracks(labels, _core.label_images.CornerRule[rule], threads, progress)


_CRACKS = option("--outline crack", 'outline="crack"')

Corners = NDArray[np.int32]
Rings = tuple[NDArray[np.float64], NDArray[np.int64]]
"""Vertices, and where each ring begins among them."""


def gray_level(gray: NDArray[Any], threshold: float) -> float:
    """Give the level of a threshold: where pixels have just this value, half-way to the next larger one."""
    if gray.dtype.kind == "f" and not np.isfinite(gray).all():
        raise InputError("the image holds NaN or infinite values: contours need finite values; use " + _CRACKS)
    above = gray > threshold
    if above.any() and (gray == threshold).any():
        return threshold + (float(gray[above].min()) - threshold) / 2
    return threshold


def half_way_contours(corners: Corners, start: NDArray[np.int64]) -> Rings:
    """Contours of a mask or of labels: through the middles of the cracks between pixels."""
    a, b = corners.astype(np.int64), corners[following(start)].astype(np.int64)
    way = np.sign(b - a)
    is_long = np.abs(b - a).sum(axis=1) > 1
    count = 1 + is_long
    at = starts_of(count)
    doubled = np.empty((at[-1], 2), dtype=np.int64)  # the first and the last middle along each crack
    doubled[at[:-1]] = 2 * a + way
    doubled[(at[:-1] + 1)[is_long]] = (2 * b - way)[is_long]
    start = at[start]
    kept = ~_is_straight(doubled, start)
    first = starts_of(kept)
    return doubled[kept] / 2 - 0.5, first[start]


def gray_contours(corners: Corners, start: NDArray[np.int64], gray: NDArray[Any], level: float) -> Rings:
    """Contours of gray values: a vertex where the line between two pixels' centers reaches the level."""
    a, b = corners.astype(np.int64), corners[following(start)].astype(np.int64)
    length = np.abs(b - a).sum(axis=1)
    way = np.repeat(np.sign(b - a), length, axis=0)
    here = np.repeat(a, length, axis=0) + within(length)[:, None] * way
    after = np.minimum(here, here + way)  # the pixel below or on the right of each crack of unit length
    across = (way == 0).astype(np.int64)
    before = after - across
    height, width = gray.shape
    is_inner = ((before >= 0) & (after < [width, height])).all(axis=1)
    share = np.full(len(here), 0.5)
    low, high = (gray[places[is_inner, 1], places[is_inner, 0]].astype(float) for places in (before, after))
    crosses = (low > level) != (high > level)
    share[is_inner] = np.divide(level - low, high - low, out=np.full(len(low), 0.5), where=crosses)
    return before + share[:, None] * across, starts_of(length)[start]


def _is_straight(places: NDArray[np.int64], start: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether all rings that have a place go straight through it."""
    after = following(start)
    before = np.empty_like(after)
    before[after] = np.arange(len(places))
    (ax, ay), (bx, by) = (places - places[before]).T, (places[after] - places).T
    turns = ax * by != ay * bx
    _, place = np.unique(places[:, 1] << 32 | places[:, 0] & 0xFFFFFFFF, return_inverse=True)
    return np.bincount(place, turns)[place] == 0


# ---- fewer vertices: polygons and lines meet where they met
# shapely's `coverage_simplify` is faster, but goes by areas: for a tolerance of 1 pixel borders move by 1.11, and keep
# twice as many vertices (`tests/benchmarks/libraries.py simplify`). It takes no lines.
def simplified_polygons(polygons: PolygonSet, tolerance: float) -> PolygonSet:
    """Leave out vertices of polygons and lines that touch each other in vertices and along whole edges only."""
    tolerance = finite_double(tolerance, "the tolerance of a simplification")
    if tolerance < 0:
        raise UsageError(
            f"the tolerance of a simplification is {shown_number(tolerance)}: it must be a length of 0 or more"
        )
    if not len(polygons.xy) or not tolerance:
        return polygons
    chains = _chains(polygons)
    points, start = _simplified_chains(chains, tolerance)
    index, sizes = _along_rings(polygons, chains, start)
    last = polygons.xy[polygons.ends_line]
    xy = np.concatenate([points, last])[index]
    return _turned_as(replace(polygons, xy=xy, ring_starts=starts_of(sizes)), polygons)


@frozen
class _Chains:
    """Chains of edges, and the stretches of rings along them."""

    places: NDArray[np.float64]
    point: Indices  # places along each chain, its ends included
    start: Indices  # where each chain begins among these, and their number
    used: Indices  # the chain of each stretch, ring after ring
    is_back: NDArray[np.bool_]  # whether the ring runs along it the other way
    ring: Indices  # of each stretch


def _chains(polygons: PolygonSet) -> _Chains:
    places, point = np.unique(polygons.xy, axis=0, return_inverse=True)
    point = point.reshape(-1)
    node = _nodes(polygons, point, len(places))
    walk, ring = _closed_walks(polygons, node[point])
    along = point[walk]
    stops = np.flatnonzero(node[along])
    is_begin = ring[stops[:-1]] == ring[stops[1:]]
    begin, end = stops[:-1][is_begin], stops[1:][is_begin]
    edge = _edge_keys(along[:-1], along[1:], len(places))
    edge[ring[:-1] != ring[1:]] = np.iinfo(np.int64).max
    key = np.minimum.reduceat(edge, begin) if len(begin) else edge[:0]
    _, first, used = np.unique(key, return_index=True, return_inverse=True)
    steps = end - begin
    stretch = owners(steps)
    position = ranges(begin, steps)
    at = position[edge[position] == key[stretch]]  # where each stretch has the edge that names its chain
    is_up = along[at] < along[at + 1]
    sizes = steps[first] + 1
    return _Chains(
        places,
        along[ranges(begin[first], sizes)],
        starts_of(sizes),
        used,
        is_up != is_up[first][used],
        ring[begin],
    )


def _edge_keys(a: Indices, b: Indices, count: int) -> Indices:
    return np.minimum(a, b) * count + np.maximum(a, b)


def _nodes(polygons: PolygonSet, point: Indices, count: int) -> NDArray[np.bool_]:
    """(p,) places where chains end."""
    start = polygons.ring_starts
    is_line = np.equal(polygons.ring_kind, LINE)
    last = (start[1:] - 1)[is_line]
    after = polygons.following.copy()
    after[last] = last
    edges = distinct(_edge_keys(point, point[after], count))
    a, b = edges // count, edges % count
    a, b = a[a != b], b[a != b]
    degree = np.bincount(a, minlength=count) + np.bincount(b, minlength=count)
    node: NDArray[np.bool_] = degree != 2
    node[b[degree[a] >= 4]] = node[a[degree[b] >= 4]] = True
    node[point[start[:-1][is_line]]] = node[point[start[1:][is_line] - 1]] = True
    is_free = ~np.logical_or.reduceat(node[point], start[:-1])
    node[np.minimum.reduceat(point, start[:-1])[is_free]] = True
    return node


def _closed_walks(polygons: PolygonSet, is_node: NDArray[np.bool_]) -> tuple[Indices, Indices]:
    """Vertices around each ring, from one node to the same one again, or along a line; and the ring of each."""
    start, sizes = polygons.ring_starts[:-1], np.diff(polygons.ring_starts)
    first = np.minimum.reduceat(np.where(is_node, np.arange(len(is_node)), len(is_node)), start)
    lengths = sizes + ~np.equal(polygons.ring_kind, LINE)
    ring = owners(lengths)
    return start[ring] + (first[ring] - start[ring] + within(lengths)) % sizes[ring], ring


def _simplified_chains(chains: _Chains, tolerance: float) -> tuple[NDArray[np.float64], Indices]:
    """Places along each chain that are left, and where each begins."""
    owner = owners(np.diff(chains.start))
    lines = shapely.linestrings(chains.places[chains.point], indices=owner)
    parts = shapely.get_parts(shapely.simplify(shapely.multilinestrings(lines), tolerance, preserve_topology=True))
    assert len(parts) == len(lines)  # a chain keeps its ends
    points, index = shapely.get_coordinates(parts, return_index=True)
    return points, np.searchsorted(index, np.arange(len(parts) + 1))


def _along_rings(polygons: PolygonSet, chains: _Chains, start: Indices) -> tuple[Indices, Indices]:
    """The places along each ring, as numbers of the simplified ones, and how many each ring has."""
    steps = np.diff(start)[chains.used] - 1
    back = np.repeat(chains.is_back, steps)
    along = within(steps)
    begin, end = np.repeat(start[chains.used], steps), np.repeat(start[chains.used + 1] - 1, steps)
    lines = np.flatnonzero(np.equal(polygons.ring_kind, LINE))
    ring = np.concatenate([np.repeat(chains.ring, steps), lines])
    index = np.concatenate([np.where(back, end - along, begin + along), start[-1] + np.arange(len(lines))])
    order = np.argsort(ring, kind="stable")
    return index[order], np.bincount(ring, minlength=len(polygons.ring_kind))


def _turned_as(made: PolygonSet, given: PolygonSet) -> PolygonSet:
    """Turn rings round that have been folded over, so that shells and holes keep their directions."""
    start, sizes = made.ring_starts[:-1], np.diff(made.ring_starts)
    turned = (_area_signs(made) * _area_signs(given) < 0) & ~np.equal(made.ring_kind, LINE)
    if not turned.any():
        return made
    ring, place = owners(sizes), within(sizes)
    index = start[ring] + np.where(turned[ring], -place % sizes[ring], place)
    return replace(made, xy=made.xy[index])


def _area_signs(polygons: PolygonSet) -> NDArray[np.float64]:
    return np.sign(twice_areas(polygons.xy, polygons.ring_starts))
