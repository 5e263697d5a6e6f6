"""Borders between the places of different sites: edges of the segment Voronoi diagram, and walls."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.segment_voronoi.segment_voronoi import core_diagram
from vorotool.engines.voronoi.elements import OwnedGraph
from vorotool.errors import VerificationError
from vorotool.geometry.skeleton.segment_voronoi import SegmentVoronoiDiagram

Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Borders:
    """Pieces of borders in the plane, before a frame cuts them.

    A cell of an element, one side of it, or a covered face is a part. Parts between which there is no border are
    joined; all that is joined has one number.

    Parameters
    ----------
    ends : (b, 2) int64 array
        Source and target, numbers of `places`; -1 at infinity.
    elements : (b, 2) int64 array
        Elements of the graph left and right, which the piece is equally far from; a wall has itself twice.
    sites : (b, 2) int32 array
        Left and right.
    parts : (b, 2) int64 array
        Left and right.
    order : (b, 2) int64 array
        Of the piece among those that leave its source, and its target: rising counter-clockwise.
    places : (v, 2) float64 array
        On the lattice: vertices of the diagram, then points that are none.
    radius : (v,) float64 array
        There.
    """

    ends: Indices
    elements: Indices
    sites: NDArray[np.int32]
    parts: Indices
    order: Indices
    places: NDArray[np.float64]
    radius: NDArray[np.float64]


def borders_of(owned: OwnedGraph, diagram: SegmentVoronoiDiagram, *, threads: int = 0) -> Borders:
    """Choose the borders among the edges of a diagram and the segments of its graph.

    Nothing is decided by coordinates but where a point lies on a straight line between two others, which is exact.

    Parameters
    ----------
    owned : OwnedGraph
        Of all sites.
    diagram : SegmentVoronoiDiagram
        Of its points and segments; vertices in covered faces may be left out.
    threads : int
        0 uses all.

    Raises
    ------
    VerificationError
        If a border ends where its elements are not.
    """
    graph = owned.graph
    whole = core_diagram(diagram, graph.segment_faces)
    try:
        made = _core.voronoi.site_borders(whole, owned.element, owned.face, threads, None)
    except RuntimeError as error:
        raise VerificationError(f"{error}: a defect of vorotool, please report it") from None
    added = made.pop("added")
    return Borders(
        **made,
        places=np.concatenate([diagram.vertices, graph.points[added].astype(np.float64)]),
        radius=np.concatenate([diagram.radius, np.zeros(len(added))]),
    )
