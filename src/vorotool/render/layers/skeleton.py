"""The layers of pictures of skeletons, and of what lies along them or follows from them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.render.canvas.layers import (
    CubicCurves,
    Curves,
    Layer,
    Lines,
    Makers,
    Page,
    Points,
    Polygons,
    Texts,
    made_layers,
    name_size,
    without_empty,
)
from vorotool.render.canvas.styles import EDGE as CELL_EDGE
from vorotool.render.canvas.styles import FAINT, INK, RESULT, SEED, WHITE, cell_color
from vorotool.render.layers.polygons import feature_names, names_of_features, polygon_layers
from vorotool.types.skeleton.lines import Centerlines, LedOn, SmoothLines
from vorotool.types.skeleton.necks import Necks, Parts
from vorotool.types.skeleton.points_along import SkeletonPoints
from vorotool.types.skeleton.segment_voronoi import EDGE
from vorotool.types.skeleton.skeleton import INTERIOR, Skeleton
from vorotool.types.skeleton.tables import site_labels

_WIDEST_CUT = 2.0
"""Px."""
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
    names = list(layers)
    places = skeleton.site_ends[skeleton.site_table.kind != EDGE, 0] if points is None else points
    spacing = page.spacing(max(len(skeleton.site_table), len(places)))
    width = min(max(spacing / 16, 0.2), WIDEST)
    radius = min(max(spacing / 16, 0.3), 3.0)
    make: Makers = {
        "polygons": lambda: polygon_layers(skeleton.polygons, width),
        "elements": lambda: [
            Lines.between("elements", skeleton.site_ends[skeleton.site_table.kind == EDGE], INK, width)
        ],
        "points": lambda: [Points("points", places, radius=radius)],
        "skeleton": lambda: [_arcs(skeleton, name, color, max(width, _room(skeleton, page)))],
        "exact": lambda: [] if exact is None else [replace(_arcs(exact, "exact", INK, width), is_broken=True)],
        "nodes": lambda: [Points("nodes", skeleton.vertices, color=color, radius=radius)],
        "labels": lambda: [
            _labels(skeleton, min(max(spacing / 6, 2.0), 16.0)) if "elements" in names else _names(skeleton, page)
        ],
    }
    return made_layers(names, make)


def diagram_layers(skeleton: Skeleton, page: Page, layers: Iterable[str], **more: Any) -> list[Layer]:
    """Make layers of a whole diagram, which is another layer than a skeleton, in another color."""
    return skeleton_layers(skeleton, page, layers, name="diagram", color=SEED, **more)


def _room(skeleton: Skeleton, page: Page) -> float:
    """How wide arcs may be that were pruned: they cover a fortieth of the page at most."""
    covered = 40 * page.length(float(skeleton.length.sum()))
    return min(page.width * page.height / covered, WIDEST) if covered > 0 else WIDEST


def _labels(skeleton: Skeleton, size: float) -> Texts:
    pairs = [[label for label in pair if label] for pair in site_labels(skeleton).tolist()]
    return Texts("labels", skeleton.site_ends.mean(axis=1), [",".join(map(str, pair)) for pair in pairs], size=size)


def _names(skeleton: Skeleton, page: Page) -> Texts:
    """Ids of the objects, each in the middle of the largest disc of its interior skeleton, else at its first vertex."""
    polygons = skeleton.polygons
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


# ---- lines along skeletons: centerlines, skeletons with their ends, smooth lines
def line_layers(
    lines: LedOn | SmoothLines,
    page: Page,
    layers: Iterable[str],
    *,
    points: NDArray[np.float64] | None = None,
    exact: Skeleton | None = None,
) -> list[Layer]:
    """Make layers of lines along skeletons: those of the skeleton, but "skeleton" are the lines."""
    near_to = lines.lines if isinstance(lines, SmoothLines) else lines
    name = "centerline" if isinstance(near_to, Centerlines) else "skeleton"
    made = skeleton_layers(lines.path, page, layers, name=name, points=points, exact=exact)

    def shown(layer: Layer) -> Layer:
        if not isinstance(layer, Curves) or layer.name != name:
            return layer
        return _smooth(layer, lines) if isinstance(lines, SmoothLines) else _led_on(layer, lines)

    return [shown(layer) for layer in made]


def _led_on(curves: Curves, lines: LedOn) -> Curves:
    """With the straight lines that lead to the boundary."""
    first, last = lines.extended
    nodes = np.concatenate([lines.end_nodes[first, 0], lines.end_nodes[last, 1]])
    ends = np.concatenate([lines.ends[first, 0], lines.ends[last, 1]])
    pairs = np.stack([nodes, len(curves.points) + np.arange(len(ends))], axis=1)
    return replace(
        curves,
        points=np.concatenate([curves.points, ends]),
        pairs=np.concatenate([curves.pairs, pairs]).astype(np.int32),
        control=np.concatenate([curves.control, np.full(len(ends), -1, dtype=np.int32)]),
    )


def _smooth(layer: Curves, smoothed: SmoothLines) -> CubicCurves:
    """With the name, color and width of another layer."""
    control = smoothed.control.reshape(-1, 2)
    first = 4 * np.arange(len(smoothed.control), dtype=np.int32)
    # the end of a curve is the begin of the next one on the same line
    goes_on = np.ones(len(first), dtype=bool)
    goes_on[smoothed.start[1:] - 1] = False
    last = np.where(goes_on, first + 4, first + 3)
    pairs = np.stack([first, last], axis=1).astype(np.int32)
    return CubicCurves(layer.name, control, pairs, first + 1, layer.color, layer.width, second=first + 2)


# ---- places along skeletons, necks, and the parts between them
def point_layers(points: SkeletonPoints, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of places along a skeleton; discs and lines get finer where there are many."""
    spacing = page.spacing(len(points))
    make: Makers = {
        "transects": lambda: [
            Lines.between("transects", points.transects().feet, RESULT, min(max(spacing / 24, 0.2), 1.5))
        ],
        "points": lambda: [Points("points", points.xy, SEED, min(max(spacing / 16, 0.3), 3.0))],
    }
    return made_layers(layers, _around(make, points.skeleton, page))


def _around(make: Makers, skeleton: Skeleton, page: Page) -> Makers:
    """Put a skeleton and its polygons beneath layers, and names over them."""
    return {
        "polygons": lambda: skeleton_layers(skeleton, page, ["polygons"]),
        "skeleton": lambda: skeleton_layers(skeleton, page, ["skeleton"], color=FAINT),
        **make,
        "labels": lambda: skeleton_layers(skeleton, page, ["labels"]),
    }


def neck_layers(necks: Necks, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of necks: lines from foot to foot, which get finer where there are many."""
    return made_layers(layers, _around({"necks": lambda: _cuts(necks, page, "necks", RESULT)}, necks.skeleton, page))


def part_layers(parts: Parts, page: Page, layers: Iterable[str]) -> list[Layer]:
    """Make layers of parts, in colors that differ on both sides of a cut."""
    make: Makers = {
        "parts": lambda: _colored(parts, page),
        "skeleton": lambda: skeleton_layers(parts.necks.skeleton, page, ["skeleton"], color=FAINT),
        "cuts": lambda: _cuts(parts.necks, page, "cuts", INK),
        "labels": lambda: [names_of_features(parts.polygons, page)],
    }
    return made_layers(layers, make)


def _colored(parts: Parts, page: Page) -> list[Layer]:
    a, b = np.ascontiguousarray(parts.between.T).astype(np.uint32)
    colors = _core.graphs.color_graph(len(parts), a, b, None).astype(np.int64)
    palette = [cell_color(c) for c in range(int(colors.max(initial=0)) + 1)]
    width = min(max(page.spacing(len(parts.polygons.xy)) / 16, 0.2), 1.0)
    made = polygon_layers(parts.polygons, width, name="parts", edge=CELL_EDGE)
    return [replace(layer, colors=palette, color_of=colors) for layer in made if isinstance(layer, Polygons)]


def _cuts(necks: Necks, page: Page, name: str, color: str) -> list[Layer]:
    return [Lines.between(name, necks.feet, color, min(max(page.spacing(len(necks)) / 16, 0.3), _WIDEST_CUT))]
