"""Polygons of the rings of one shape, by the rule that says what of the plane they fill."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.drawing.windings import windings
from vorotool.geometry.box import bounds

Floats = NDArray[np.float64]


def filled_polygons(rings: Sequence[Floats], rule: str) -> list[list[Floats]]:
    """Give shells, each with its holes, of what closed rings fill.

    Rings that are simple and do not cross keep their vertices: by how they lie in one another each is a shell, a hole,
    or a border of nothing. Others are cut where they cross, by shapely, and faces are put together again.

    Parameters
    ----------
    rings : sequence of (n, 2) float64 array
        Each without its first vertex at its end.
    rule : {"nonzero", "evenodd"}
        As SVG has it.

    Returns
    -------
    list of list of (n, 2) array
        Of each polygon the shell, then its holes.

    Examples
    --------
    >>> outer, inner = ([[0, 0], [9, 0], [9, 9], [0, 9]], [[3, 3], [6, 3], [6, 6], [3, 6]])
    >>> rings = [np.array(ring, dtype=float) for ring in (outer, inner)]
    >>> [[len(filled) for filled in filled_polygons(rings, rule)] for rule in ("nonzero", "evenodd")]
    [[1], [2]]
    """
    import shapely

    flat = [ring for ring in rings if len(ring) > 2]
    if len(rings) == 1 and (rule == "evenodd" or not flat):
        return [[rings[0]]]
    alone = [[ring] for ring in rings if len(ring) <= 2]  # places and segments fill nothing, and stay what they are
    if not flat:
        return alone
    low, high = bounds(np.concatenate(flat))
    middle = low / 2 + high / 2
    exponent = int(np.frexp((high / 2 - low / 2).max())[1])
    if not np.isfinite(middle).all():
        return [[ring] for ring in rings]
    scaled = [np.ldexp(ring - middle, -exponent) for ring in flat]
    shapes = np.array([shapely.Polygon(ring) for ring in scaled], dtype=object)
    if shapely.is_valid(shapes).all() and not _cross(shapes):
        if len(flat) == 1:
            return [*alone, [flat[0]]]
        return alone + _nested(flat, shapes, rule)
    return alone + [[np.ldexp(ring, exponent) + middle for ring in polygon] for polygon in _of_faces(scaled, rule)]


def nested_polygons(rings: Sequence[Floats]) -> list[list[Floats]]:
    """Give shells, each with its holes, of rings of which none is filled by itself; where some cross, each is a shell.

    Examples
    --------
    >>> outer, inner = ([[0, 0], [9, 0], [9, 9], [0, 9]], [[3, 3], [6, 3], [6, 6], [3, 6]])
    >>> [len(polygon) for polygon in nested_polygons([np.array(inner, dtype=float), np.array(outer, dtype=float)])]
    [2]
    """
    import shapely

    flat = [ring for ring in rings if len(ring) > 2]
    shapes = np.array([shapely.Polygon(ring) for ring in flat], dtype=object)
    if len(rings) < 2 or not shapely.is_valid(shapes).all() or _cross(shapes):
        return [[ring] for ring in rings]
    return filled_polygons(rings, "evenodd")


def _cross(shapes: Any) -> bool:
    """Whether any two lie over one another, neither within the other, or are the same."""
    import shapely

    if len(shapes) < 2:
        return False
    tree = shapely.STRtree(shapes)
    first, second = tree.query(shapes, predicate="overlaps")
    if len(first):
        return True
    first, second = (indices.tolist() for indices in tree.query(shapes, predicate="covers"))
    pairs = {pair for pair in zip(first, second, strict=True) if pair[0] != pair[1]}
    return any((second, first) in pairs for first, second in pairs)


def _is_filled(winding: NDArray[Any], rule: str) -> NDArray[np.bool_]:
    return np.asarray(winding % 2 == 1 if rule == "evenodd" else winding != 0)


def _nested(rings: Sequence[Floats], shapes: Any, rule: str) -> list[list[Floats]]:
    """By the rings around each: the smallest of those that are borders has it as a hole, if it is none itself."""
    import shapely

    inner, outer = shapely.STRtree(shapes).query(shapes, predicate="covered_by")
    is_other = inner != outer
    inner, outer = inner[is_other], outer[is_other]
    turns = np.where(shapely.is_ccw(shapely.get_exterior_ring(shapes)), 1, -1)
    around = np.bincount(inner, weights=turns[outer], minlength=len(shapes)).astype(np.int64)
    within, beyond = _is_filled(around + turns, rule), _is_filled(around, rule)
    areas = shapely.area(shapes)
    polygons: dict[int, list[Floats]] = {k: [rings[k]] for k in np.flatnonzero(within & ~beyond).tolist()}
    order = np.argsort(areas[outer], kind="stable")
    owner: dict[int, int] = {}
    for k, container in zip(inner[order].tolist(), outer[order].tolist(), strict=True):
        if container in polygons:
            owner.setdefault(k, container)
    for k in np.flatnonzero(~within & beyond).tolist():
        polygons[owner[k]].append(rings[k])
    return list(polygons.values())


def _of_faces(rings: Sequence[Floats], rule: str) -> list[list[Floats]]:
    """Cut rings where they cross, and join the faces that are filled."""
    import shapely

    lines = [shapely.LineString(np.concatenate([ring, ring[:1]])) for ring in rings]
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(shapely.node(shapely.multilinestrings(lines)))))
    if not len(faces):
        return []
    winding = windings(rings, shapely.get_coordinates(shapely.point_on_surface(faces)))
    filled = faces[_is_filled(winding, rule)]
    try:
        whole = shapely.coverage_union_all(filled)  # faces meet in whole edges
    except shapely.errors.GEOSException:  # but where rounded crossings moved edges over one another
        whole = shapely.union_all(filled)
    polygons = []
    for polygon in shapely.get_parts(whole):
        parts = [polygon.exterior, *polygon.interiors] if polygon.geom_type == "Polygon" else []
        if parts:
            polygons.append([shapely.get_coordinates(part)[:-1] for part in parts])
    return polygons
