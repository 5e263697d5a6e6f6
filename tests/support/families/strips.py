"""Strips with known axes: lines, arcs, spirals and splines, with flat, round or oblique ends."""

from dataclasses import dataclass

import numpy as np
import shapely

SAMPLES = 4001
"""Of an axis, before vertices are chosen."""


@dataclass
class Strip:
    """A strip: its outline, its axis as far as the middles of its ends, and its width at these."""

    ring: np.ndarray
    axis: np.ndarray
    width: float
    kind: str


def line(random):
    """Along the x axis."""
    return np.outer(np.linspace(0, random.uniform(4, 20), SAMPLES), [1.0, 0.0])


def arc(random):
    """Radii of 3 to 12 widths."""
    radius, turn = random.uniform(3, 12), random.uniform(0.5, 4)
    return radius * _around(np.linspace(0, turn, SAMPLES))


def spiral(random):
    """An Archimedean spiral whose turns do not touch."""
    turns = np.linspace(6, 6 + random.uniform(4, 9), SAMPLES)
    return turns[:, None] * random.uniform(0.5, 0.8) * _around(turns)


def spline(random):
    """A curve whose curvature changes: its direction is a sum of three waves."""
    at, length = np.linspace(0, 1, SAMPLES), random.uniform(8, 20)
    turn = sum(
        random.uniform(-0.4, 0.4) / k * np.sin(2 * np.pi * k * at + random.uniform(0, 2 * np.pi)) for k in (1, 2, 3)
    )
    steps = _around(turn)[:-1] + np.diff(_around(turn), axis=0) / 2
    return np.concatenate([[[0, 0]], np.cumsum(steps, axis=0)]) * (length / SAMPLES)


def _around(turns):
    return np.stack([np.cos(turns), np.sin(turns)], axis=1)


FAMILIES = (line, arc, spiral, spline)
CAPS = ("flat", "round", "oblique")


def strip(random, *, vertices=None):
    """Draw a strip; None where its sides meet, or turn sharply from vertex to vertex."""
    family, cap = FAMILIES[int(random.integers(4))], CAPS[int(random.integers(3))]
    count = vertices or int(np.exp(random.uniform(np.log(5), np.log(2000))))
    axis = family(random)
    along = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(axis, axis=0).T))])
    if cap == "oblique":  # it runs straight there: else the middle of the cut would not be on the axis
        axis, along = _with_straight_ends(axis, along)
    width = np.full(len(axis), 1.0)
    if random.random() < 0.5:
        swell = random.uniform(0, 0.3) * np.sin(2 * np.pi * along / max(along[-1], 8) + random.uniform(0, 6))
        width += swell * np.clip(np.minimum(along, along[-1] - along) - 1.5, 0, 1)  # constant near its ends
    chosen = _vertices(along, max(count // 2, 2), has_straight_ends=cap == "oblique")
    axis, width = axis[chosen], width[chosen]
    if len(axis) > 2 and not _is_gentle(axis):
        return None
    left, right = (axis + side * _to_sides(axis) * width[:, None] / 2 for side in (1, -1))
    ring, ends = _closed(random, cap, axis, left, right, steps=max(8, min(count // 8, 64)))
    if not shapely.Polygon(ring).is_valid or shapely.LineString(left).distance(shapely.LineString(right)) < 0.4:
        return None
    turn, size = random.uniform(0, 2 * np.pi), np.exp(random.uniform(-3, 6))
    moved = size * np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    shift = size * random.uniform(-50, 50, 2)
    whole = np.concatenate([ends[:1], axis, ends[1:]])
    kind = f"{family.__name__}, {cap}, {len(ring)} vertices"
    return Strip(ring @ moved + shift, whole @ moved + shift, size, kind)


def _with_straight_ends(axis, along):
    """Go on straight by one and a half widths at both ends."""
    ways = [axis[0] - axis[1], axis[-1] - axis[-2]]
    far = [axis[end] + 1.5 * way / np.hypot(*way) for end, way in zip((0, -1), ways, strict=True)]
    longer = np.concatenate([far[:1], axis, far[1:]])
    return longer, np.concatenate([[0], along + 1.5, [along[-1] + 3]])


def _vertices(along, count, *, has_straight_ends):
    """Samples at even distances, and both ends."""
    wanted = np.linspace(0, along[-1], count)
    chosen = np.clip(np.searchsorted(along, wanted), 0, len(along) - 1)
    if has_straight_ends:
        chosen = np.append(chosen, [1, len(along) - 2])
    return np.unique(chosen)


def _is_gentle(axis):
    """Whether no corner turns by more than 45 degrees."""
    ways = np.diff(axis, axis=0)
    ways /= np.hypot(*ways.T)[:, None]
    return (ways[1:] * ways[:-1]).sum(axis=1).min() > np.sqrt(0.5)


def _to_sides(axis):
    """From vertices to those of the parallel at distance 1 on the left."""
    ways = np.diff(axis, axis=0)
    normals = np.stack([-ways[:, 1], ways[:, 0]], axis=1) / np.hypot(*ways.T)[:, None]
    both = np.concatenate([normals[:1], normals]) + np.concatenate([normals, normals[-1:]])
    return 2 * both / (both * both).sum(axis=1)[:, None]


def _closed(random, cap, axis, left, right, *, steps):
    """The ring with caps, and the middles of both."""
    ends = [axis[0], axis[-1]]
    ways = [axis[0] - axis[1], axis[-1] - axis[-2]]
    ways = [way / np.hypot(*way) for way in ways]
    caps = [np.zeros((0, 2))] * 2
    if cap == "round":
        turns = np.linspace(-np.pi / 2, np.pi / 2, 2 * steps + 1)[1:-1]
        caps = [
            end + (np.outer(np.cos(turns), way) + np.outer(np.sin(turns), [-way[1], way[0]])) / 2
            for end, way in zip(ends, ways, strict=True)
        ]
        ends = [end + way / 2 for end, way in zip(ends, ways, strict=True)]
    if cap == "oblique":
        for k, end in enumerate((0, -1)):
            cut = ways[k] * np.tan(random.uniform(-0.7, 0.7)) / 2
            left[end], right[end] = left[end] + cut, right[end] - cut
    ring = np.concatenate([right, caps[1], left[::-1], caps[0]])
    return ring, np.array(ends)
