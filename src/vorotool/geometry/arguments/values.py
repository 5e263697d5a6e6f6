"""Values of the library as arguments: what is none is refused by name, with what makes one."""

from __future__ import annotations

from typing import Any

from vorotool.errors import InputError
from vorotool.geometry.arguments.descriptions import described

_MAKERS = {
    "Frame": "Frame",
    "LabelImage": "tessellate",
    "Triangulation": "delaunay",
    "DigitalTriangulation": "digital_triangulation",
    "ProximityGraph": "proximity_graph",
    "CellSet": "voronoi_cells",
    "AlphaComplex": "alpha_complex",
    "AlphaShape": "alpha_shape",
    "PlanarGraph": "planar_graph",
    "Skeleton": "skeleton_exact",
    "Centerlines": "centerline",
    "ExtendedSkeleton": "extend_ends",
    "SmoothLines": "smooth",
    "Offsets": "offset",
    "Discs": "largest_discs",
    "Necks": "necks",
    "Parts": "parts",
    "VoronoiMap": "voronoi",
    "Distances": "hausdorff",
}
"""The function that makes a value of each type."""


def check_value(value: Any, name: str, *types: type) -> None:
    """Refuse what is not of a type of the library."""
    if isinstance(value, types):
        return
    expected = " or ".join(f"{_article(each.__name__)} of vorotool.{_MAKERS[each.__name__]}" for each in types)
    raise InputError(f"invalid {name}: expected {expected}, but got {described(value)}")


def _article(name: str) -> str:
    return f"{'an' if name[0] in 'AO' else 'a'} {name}"
