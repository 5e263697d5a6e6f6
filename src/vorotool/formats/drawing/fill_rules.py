"""Polygons of the rings of one shape, by the rule that says what of the plane they fill."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.drawing.nesting import OUTSIDE, Nesting, nesting_of
from vorotool.formats.drawing.windings import windings
from vorotool.types.box import bounds

Floats = NDArray[np.float64]

_MOST_PAIRS = 2**17
"""Of rings whose boxes meet, for which pairs are looked at one by one; beyond, a sweep finds how rings lie."""


def filled_polygons(rings: Sequence[Floats], rule: str) -> list[list[Floats]]:
    """Give shells, each with its holes, of what closed rings fill."""
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
    nesting = _nesting(scaled, shapes)
    if nesting is not None:
        if len(flat) == 1:
            return [*alone, [flat[0]]]
        return alone + _nested(flat, shapes, nesting, rule)
    return alone + [[np.ldexp(ring, exponent) + middle for ring in polygon] for polygon in _of_faces(scaled, rule)]


def nested_polygons(rings: Sequence[Floats]) -> list[list[Floats]]:
    """Return shells, each with its holes, of rings of which none is filled by itself."""
    import shapely

    flat = [ring for ring in rings if len(ring) > 2]
    shapes = np.array([shapely.Polygon(ring) for ring in flat], dtype=object)
    if len(rings) < 2 or _nesting(flat, shapes) is None:
        return [[ring] for ring in rings]
    return filled_polygons(rings, "evenodd")


def _nesting(rings: Sequence[Floats], shapes: Any) -> Nesting | None:
    """How rings lie in one another; None if one is not simple, or two cross or are the same."""
    import shapely

    if not shapely.is_valid(shapes).all():
        return None
    if _meet_often(shapes):
        return nesting_of(rings, _turns(shapes).tolist(), shapely.area(shapes).tolist())
    return None if _cross(shapes) else _nesting_of_pairs(shapes)


def _meet_often(shapes: Any) -> bool:
    """Whether more pairs of boxes meet than are looked at."""
    import shapely

    count = len(shapes)
    if count * count <= _MOST_PAIRS:
        return False
    tree = shapely.STRtree(shapes)
    met, step = 0, max(2**22 // count, 1)  # so many at once that their pairs take little memory
    for first in range(0, count, step):
        met += tree.query(shapes[first : first + step]).shape[1]
        if met > _MOST_PAIRS:
            return True
    return False


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


def _nesting_of_pairs(shapes: Any) -> Nesting:
    """Look at every ring that covers another; the smallest is its parent."""
    import shapely

    inner, outer = shapely.STRtree(shapes).query(shapes, predicate="covered_by")
    is_other = inner != outer
    inner, outer = inner[is_other], outer[is_other]
    parent = np.full(len(shapes), OUTSIDE)
    largest_first = np.argsort(-shapely.area(shapes)[outer], kind="stable")
    parent[inner[largest_first]] = outer[largest_first]
    order = np.argsort(np.bincount(inner, minlength=len(shapes)), kind="stable")
    return Nesting(parent.tolist(), order.tolist())


def _turns(shapes: Any) -> NDArray[np.int64]:
    """Give 1 for shapes that run counter-clockwise, else -1."""
    import shapely

    return np.where(shapely.is_ccw(shapely.get_exterior_ring(shapes)), 1, -1)


def _is_filled(winding: NDArray[Any], rule: str) -> NDArray[np.bool_]:
    return np.asarray(winding % 2 == 1 if rule == "evenodd" else winding != 0)


def _nested(rings: Sequence[Floats], shapes: Any, nesting: Nesting, rule: str) -> list[list[Floats]]:
    """By the rings around each: the smallest of those that are borders has it as a hole, if it is none itself."""
    turns, parent = _turns(shapes), nesting.parent
    inside = np.zeros(len(rings) + 1, dtype=np.int64)  # the winding; the last one is that outside of all
    for k in nesting.order:
        inside[k] = inside[parent[k]] + turns[k]
    within, beyond = _is_filled(inside[:-1], rule), _is_filled(inside[parent], rule)
    polygons: dict[int, list[Floats]] = {k: [rings[k]] for k in np.flatnonzero(within & ~beyond).tolist()}
    owner = [OUTSIDE] * (len(rings) + 1)  # the smallest shell around each
    for k in nesting.order:
        owner[k] = parent[k] if parent[k] in polygons else owner[parent[k]]
    for k in np.flatnonzero(~within & beyond).tolist():
        polygons[owner[k]].append(rings[k])
    return list(polygons.values())


def _of_faces(rings: Sequence[Floats], rule: str) -> list[list[Floats]]:
    """Cut rings where they cross, and join the faces that are filled."""
    import shapely

    lines = shapely.multilinestrings([shapely.LineString(np.concatenate([ring, ring[:1]])) for ring in rings])
    try:
        noded = shapely.node(lines)
    except shapely.errors.GEOSException:  # where rounding makes crossings anew
        noded = shapely.union_all(lines)
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(noded)))
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
        if polygon.geom_type == "Polygon" and not polygon.is_empty:  # which rounding may make of thin ones
            parts = [polygon.exterior, *polygon.interiors]
            polygons.append([shapely.get_coordinates(part)[:-1] for part in parts])
    return polygons
