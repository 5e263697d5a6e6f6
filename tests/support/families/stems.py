"""Discs with stems, and letters: shapes whose skeletons have branches that no leading on to ends may lose."""

from itertools import pairwise

import numpy as np
import shapely

LETTERS = "abdfghkmpqrstwxyzABEKQRSWXYZ0234578&%@?"
FONTS = ("DejaVu Sans", "DejaVu Sans:bold", "DejaVu Serif", "DejaVu Serif:italic", "DejaVu Sans Mono", "STIXGeneral")


def disc_with_stems(random):
    """Draw a shape, and of each stem the place half a width before its end, and the width."""
    radius, count = random.uniform(8, 40), int(random.integers(5, 200))
    turns = np.arange(count) * 2 * np.pi / count + random.random()
    stretch = [1, 1 if random.random() < 0.7 else random.uniform(0.6, 1)]
    body = shapely.Polygon(radius * np.stack([np.cos(turns), np.sin(turns)], axis=1) * stretch)
    stems = []
    number, first = int(random.integers(1, 4)), random.uniform(0, 2 * np.pi)
    for k in range(number):
        angle = first + 2 * np.pi * k / number + random.uniform(-0.3, 0.3)
        width = max(random.uniform(0.16, 0.9) * radius, 3.0)
        far = (radius + width * random.uniform(1.1, 4) + 2) * np.array([np.cos(angle), np.sin(angle)])
        near = far * (1 - width / 2 / np.hypot(*far))
        cap = ("flat", "round")[int(random.integers(2))]
        axis = shapely.LineString([[0, 0], far if cap == "flat" else near])
        body |= axis.buffer(width / 2, cap_style=cap, quad_segs=16)
        if random.random() < 0.3:  # a ball at the end
            body |= shapely.Point(far).buffer(width * random.uniform(0.6, 1.2), quad_segs=16)
        stems.append((near, width))
    return body, stems


def letter(random, size):
    """Draw the outlines of a letter that matplotlib has."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    family, _, style = FONTS[int(random.integers(len(FONTS)))].partition(":")
    font = FontProperties(
        family=family,
        weight="bold" if style == "bold" else "normal",
        style="italic" if style == "italic" else "normal",
    )
    text = LETTERS[int(random.integers(len(LETTERS)))]
    shape = shapely.Polygon()
    for ring in TextPath((0, 0), text, size=size, prop=font).to_polygons():
        if len(ring) > 3:
            shape ^= shapely.Polygon(ring).buffer(0)
    return f"{text} in {family} {style}", shape


def mask_of(shape):
    """Return the pixels whose centers are in a shape, and the place of the center of the first one."""
    corner = np.floor(shape.bounds[:2]) - 2
    columns, rows = (np.ceil(shape.bounds[2:]) + 3 - corner).astype(int)
    y, x = np.mgrid[:rows, :columns]
    return shapely.contains_xy(shape, x + corner[0], y + corner[1]), corner


def lost(pruned, extended):
    """Find the nodes of a skeleton that are farther from what it was led on to than their branch is wide."""
    line = shapely.union_all(extended.to_shapely(flatten=0.01))
    _, most, _ = pruned.arc_radii
    width = np.zeros(int(pruned.branch.max(initial=-1)) + 1)
    np.maximum.at(width, pruned.branch, 2 * most)
    far = shapely.distance(line, shapely.points(pruned.vertices[pruned.arcs])) > width[pruned.branch][:, None]
    return pruned.vertices[pruned.arcs[far]].tolist()


def lines_of(skeleton):
    """Return the arcs of a skeleton as one shape."""
    points, start = skeleton.flattened(0.01)
    return shapely.MultiLineString([points[a:b] for a, b in pairwise(start)])
