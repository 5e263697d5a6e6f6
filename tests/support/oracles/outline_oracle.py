"""What crack outlines must be, from pixel sides one by one; and images to try."""

import numpy as np
from skimage.measure import label

SIDES = (
    ((0, 0), (1, 0), (-1, 0)),
    ((1, 0), (1, 1), (0, 1)),
    ((1, 1), (0, 1), (1, 0)),
    ((0, 1), (0, 0), (0, -1)),
)
"""Of a pixel: where each begins and ends, x and y from the pixel's corner; row and column of the pixel across."""


def numbered_objects(labels, connectivity):
    """Number of the object of each pixel from 1, 0 for none: by label, then by first pixels; and the labels."""
    found = label(labels, connectivity=1 if connectivity == 4 else 2, background=0)
    first = np.unique(found, return_index=True)[1][int((found == 0).any()) :]
    values = labels.ravel()[first]
    order = np.lexsort((first, values))
    rank = np.zeros(len(first) + 1, dtype=np.int64)
    rank[order + 1] = np.arange(1, len(first) + 1)
    return rank[found], values[order].tolist()


def pixel_sides(objects):
    """Rows of object (from 0), x and y where a side begins and ends: what is between an object and anything else."""
    padded = np.pad(objects, 1)
    rows = []
    for (ax, ay), (bx, by), (down, right) in SIDES:
        other = padded[1 + down : padded.shape[0] - 1 + down, 1 + right : padded.shape[1] - 1 + right]
        y, x = np.nonzero((objects > 0) & (objects != other))
        rows.append(np.stack([objects[y, x] - 1, x + ax, y + ay, x + bx, y + by], axis=1))
    return np.unique(np.concatenate(rows), axis=0)


def unit_sides(polygons):
    """The same of crack outlines: each edge cut into sides of length 1."""
    corners = np.rint(polygons.xy + 0.5).astype(np.int64)
    assert np.array_equal(corners - 0.5, polygons.xy)
    following = np.arange(1, len(corners) + 1)
    following[polygons.ring_starts[1:] - 1] = polygons.ring_starts[:-1]
    way = corners[following] - corners
    assert ((way == 0).sum(axis=1) == 1).all()
    length = np.abs(way).sum(axis=1)
    step = np.repeat(np.sign(way), length, axis=0)
    along = np.arange(length.sum()) - np.repeat(np.cumsum(length) - length, length)
    begin = np.repeat(corners, length, axis=0) + along[:, None] * step
    owner = np.repeat(np.repeat(polygons.ring_polygon, np.diff(polygons.ring_starts)), length)
    sides = np.column_stack([owner, begin, begin + step])
    found = np.unique(sides, axis=0)
    assert len(found) == len(sides)  # no side twice
    return found


def ring_areas(polygons):
    """Signed areas of rings, and the sum of each polygon's."""
    following = np.arange(1, len(polygons.xy) + 1)
    following[polygons.ring_starts[1:] - 1] = polygons.ring_starts[:-1]
    (x, y), (nx, ny) = polygons.xy.T, polygons.xy[following].T
    rings = np.add.reduceat(x * ny - nx * y, polygons.ring_starts[:-1]) / 2
    return rings, np.bincount(polygons.ring_polygon, rings)


def hole_count(labels, connectivity):
    """Holes of all objects together, each alone in the image."""
    objects, _ = numbered_objects(labels, connectivity)
    count = 0
    for number in range(1, objects.max() + 1):
        outside = np.pad(objects != number, 1, constant_values=True)
        count += label(outside, connectivity=2 if connectivity == 4 else 1).max() - 1
    return int(count)


def all_masks(rows, columns):
    """One image of all masks of a size, apart from each other."""
    count = 1 << rows * columns
    bits = (np.arange(count)[:, None] >> np.arange(rows * columns) & 1).reshape(count, rows, columns)
    across = 1 << rows * columns // 2
    tiles = np.pad(bits, ((0, 0), (1, 0), (1, 0))).reshape(count // across, across, rows + 1, columns + 1)
    return tiles.swapaxes(1, 2).reshape(count // across * (rows + 1), -1).astype(np.uint8)


def random_labels(random, side=40):
    """Noise, blobs and thin lines of up to four labels and background."""
    from scipy.ndimage import gaussian_filter

    shape = random.integers(1, side, 2)
    fields = random.standard_normal((int(random.integers(2, 6)), *shape))
    fields = gaussian_filter(fields, (0, *[float(random.choice([0, 0.6, 1.2, 3]))] * 2))
    return (fields.argmax(axis=0) + int(random.integers(0, 2))).astype(np.uint8)
