"""The layers of a skeleton's picture."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool.render.canvas.layers import Curves, Layer, Lines, Page, Points, Texts, bounds_of, name_size
from vorotool.render.canvas.names import without_empty
from vorotool.render.canvas.palettes import INK, RESULT, SEED, WHITE
from vorotool.render.label_images.png import checked_layers
from vorotool.render.layers.polygons import feature_names, polygon_layers
from vorotool.types.axis import is_up
from vorotool.types.skeleton.skeleton import EDGE, INTERIOR, Skeleton
from vorotool.types.skeleton.tables import site_labels

LAYERS = ("polygons", "elements", "points", "skeleton", "exact", "nodes", "labels")
"""From below."""

WIDEST = 1.5
"""Lines, in px."""


def skeleton_layers(
    skeleton: Skeleton,
    page: Page,
    layers: Iterable[str],
    *,
    name: str = "skeleton",
    color: str = RESULT,
    points: NDArray[np.float64] | None = None,
    exact: Skeleton | None = None,
) -> list[Layer]:
    """Make layers of a skeleton; lines get finer where there are many."""
    wanted = checked_layers(layers, LAYERS)
    places = _site_places(skeleton) if points is None else points
    spacing = page.spacing(max(len(skeleton.site_table), len(places), 1))
    width = min(max(spacing / 16, 0.2), WIDEST)
    radius = min(max(spacing / 16, 0.3), 3.0)
    make: dict[str, Callable[[], list[Layer]]] = {
        "polygons": lambda: polygon_layers(skeleton.polygons, width),
        "elements": lambda: [_edges(skeleton, width)],
        "points": lambda: [Points("points", places, radius=radius)],
        "skeleton": lambda: [_arcs(skeleton, name, color, max(width, _room(skeleton, page)))],
        "exact": lambda: [] if exact is None else [replace(_arcs(exact, "exact", INK, width), is_broken=True)],
        "nodes": lambda: [Points("nodes", skeleton.vertices, color=color, radius=radius)],
        "labels": lambda: [
            _labels(skeleton, min(max(spacing / 6, 2.0), 16.0)) if "elements" in wanted else _names(skeleton, page)
        ],
    }
    return [layer for layer_name in LAYERS if layer_name in wanted for layer in make[layer_name]()]


def diagram_layers(skeleton: Skeleton, page: Page, layers: Iterable[str], **more: Any) -> list[Layer]:
    """Make layers of a whole diagram, which is another layer than a skeleton, in another color."""
    return skeleton_layers(skeleton, page, layers, name="diagram", color=SEED, **more)


def skeleton_page(
    skeleton: Skeleton,
    *,
    width: int = 1000,
    bounds: tuple[float, float, float, float] | None = None,
) -> Page:
    """The page of a picture, as of `mesh_page`: with all polygons and the frame, if arcs are cut by one."""
    shown = [skeleton.polygons.xy]
    if skeleton.frame is not None:
        x, y, w, h = skeleton.frame
        shown.append(np.array([[x, y], [x + w, y + h]]))
    up = is_up(skeleton)
    return Page(bounds or bounds_of([Points("shown", np.concatenate(shown))]), width=width, y_up=up)


diagram_page = skeleton_page


def _room(skeleton: Skeleton, page: Page) -> float:
    """How wide arcs may be that were pruned: they cover a fortieth of the page at most."""
    covered = 40 * page.length(float(skeleton.length.sum()))
    return min(page.width * page.height / covered, WIDEST) if covered > 0 else WIDEST


def _edges(skeleton: Skeleton, width: float) -> Lines:
    ends = skeleton.site_ends[skeleton.site_table.kind == EDGE]
    pairs = np.arange(2 * len(ends), dtype=np.int32).reshape(-1, 2)
    return Lines("elements", ends.reshape(-1, 2), pairs, INK, width)


def _site_places(skeleton: Skeleton) -> NDArray[np.float64]:
    places: NDArray[np.float64] = skeleton.site_ends[skeleton.site_table.kind != EDGE, 0]
    return places


def _labels(skeleton: Skeleton, size: float) -> Texts:
    pairs = [[label for label in pair if label] for pair in site_labels(skeleton).tolist()]
    return Texts("labels", skeleton.site_ends.mean(axis=1), [",".join(map(str, pair)) for pair in pairs], size=size)


def _names(skeleton: Skeleton, page: Page) -> Texts:
    """Ids of the objects, each in the middle of the largest disc of its interior skeleton, else at its first vertex."""
    polygons = skeleton.polygons
    assert polygons.feature is not None  # PolygonSet has filled it in
    _, first = np.unique(polygons.feature, return_index=True)
    owner = polygons.feature[polygons.ring_polygon]
    places = polygons.xy[polygons.ring_starts[:-1][np.searchsorted(owner, polygons.feature[first])]]
    arcs = np.flatnonzero((skeleton.side == INTERIOR) & (skeleton.polygon >= 0))
    nodes = skeleton.arcs[arcs].reshape(-1)
    of = np.repeat(np.searchsorted(polygons.feature[first], polygons.feature[skeleton.polygon[arcs]]), 2)
    order = np.lexsort((nodes, -skeleton.radius[nodes], of))
    found, best = np.unique(of[order], return_index=True)
    places[found] = skeleton.vertices[nodes[order][best]]
    names = feature_names(polygons, page)
    return without_empty(Texts("labels", places, names, size=name_size(page, len(names)), halo=WHITE, is_centered=True))


def _arcs(skeleton: Skeleton, name: str, color: str, width: float) -> Curves:
    bent = np.flatnonzero(skeleton.is_parabola)
    control = np.full(len(skeleton), -1, dtype=np.int32)
    control[bent] = len(skeleton.vertices) + np.arange(len(bent))
    points = np.concatenate([skeleton.vertices, skeleton.control[bent]])
    # single places on the frame are what is left of arcs that went on beyond
    shown = (skeleton.length > 0) | ~skeleton.touches_frame[skeleton.arcs[:, 0]]
    return Curves(name, points, skeleton.arcs[shown], control[shown], color, width)
