"""Slow and obvious answers to compare with. They share no code with the package."""

import numpy as np


def nearest_labels(x, y, labels, frame, scale=1, most_squared=None):
    """Label every pixel by looking at every seed: smallest squared distance, then smallest label."""
    if frame[3] > frame[2]:  # long rows are done at once
        return nearest_labels(y, x, labels, (frame[1], frame[0], frame[3], frame[2]), scale, most_squared).T
    x, y, labels = (np.asarray(v, dtype=np.int64) for v in (x, y, labels))
    order = np.argsort(labels, kind="stable")
    x, y, labels = x[order], y[order], labels[order]
    fx, fy, width, height = frame
    across = ((fx + np.arange(width, dtype=np.int64))[:, None] * scale - x) ** 2
    squares = np.empty_like(across)
    out = np.empty((height, width), dtype=np.uint32)
    for row in range(height):
        np.add(across, ((fy + row) * scale - y) ** 2, out=squares)
        nearest = squares.argmin(axis=1)  # the first of equal ones, hence the smallest label
        out[row] = labels[nearest]
        if most_squared is not None:
            out[row][squares[np.arange(width), nearest] > most_squared] = 0
    return out


def nearest_labels_of_fine_seeds(x, y, labels, frame, scale, units=(1, 1)):
    """The same for any lattice: in long doubles, and in whole numbers where those may hide which is nearest."""
    order = np.argsort(labels, kind="stable")
    x, y, labels = x[order], y[order], labels[order]
    fx, fy, width, height = frame
    steps = (((fx + np.arange(width)) * scale)[:, None] - x) * units[1]
    across = steps.astype(np.longdouble) ** 2
    out = np.empty((height, width), dtype=np.uint32)
    for row in range(height):
        rise = ((fy + row) * scale - y) * units[0]
        squares = across + rise.astype(np.longdouble) ** 2
        near = squares <= squares.min(axis=1, keepdims=True) * (1 + np.longdouble(2) ** -58)
        first = near.argmax(axis=1)
        for column in np.flatnonzero(near.sum(axis=1) > 1):
            first[column] = min(
                np.flatnonzero(near[column]), key=lambda i, c=column: int(steps[c, i]) ** 2 + int(rise[i]) ** 2
            )
        out[row] = labels[first]
    return out


def nearest_squares(x, y, frame, scale=1):
    """Squared lattice distance of every pixel to the nearest seed."""
    fx, fy, width, height = frame
    rows, columns = np.mgrid[0:height, 0:width].astype(np.int64)
    columns, rows = (fx + columns) * scale, (fy + rows) * scale
    squares = [(columns - int(a)) ** 2 + (rows - int(b)) ** 2 for a, b in zip(x, y, strict=True)]
    return np.min(squares, axis=0)


def paper_passes(seeds, m_columns, m_rows, passes=2):
    """Section 2.2 to the letter, with loops over 2 … m - 1 of an image that has a frame of zeros.

    ``seeds`` maps a label to its (i, j), counted from 1 inside the frame's border at 1.
    """
    v = np.zeros((m_columns + 2, m_rows + 2), dtype=np.int64)
    for label in sorted(seeds, reverse=True):
        v[seeds[label]] = label

    def distance(i, j, k):
        return (i - seeds[k][0]) ** 2 + (j - seeds[k][1]) ** 2

    def sweep(j, other):
        for i in range(1, m_columns + 1):
            around = [v[i, j], v[i - 1, other], v[i, other], v[i + 1, other], v[i - 1, j]]
            around = [int(k) for k in around if k != 0]
            if around:
                v[i, j] = min(around, key=lambda k: (distance(i, j, k), k))
        for i in range(m_columns, 0, -1):
            k0, k5 = int(v[i, j]), int(v[i + 1, j])
            if k5 > 0 and (k0 == 0 or (distance(i, j, k5), k5) < (distance(i, j, k0), k0)):
                v[i, j] = k5

    for j in range(1, m_rows + 1):
        sweep(j, j - 1)
    for j in range(m_rows, 0, -1):
        if passes == 2:
            sweep(j, j + 1)
    return v[1:-1, 1:-1].T


def nearest_seeds(places, labels, window, scale=1, units=(1, 1, 1)):
    """Give for each pixel or voxel the smallest and the largest label of its nearest seeds, and the squared distance.

    The places and the window have x first, the units, as the results, the slices or rows. In Python's integers where
    those of 64 bits may not hold the squares.
    """
    places, count = np.asarray(places, dtype=object), len(window) // 2
    units, sides = units[:count], window[count:][::-1]
    axes = [
        unit * scale * (start + np.arange(side).astype(object))
        for unit, start, side in zip(units, window[:count][::-1], sides, strict=True)
    ]
    places = places[:, ::-1] * np.array(units, dtype=object)
    reach = sum(
        max(axis[-1] - each.min(), each.max() - axis[0]) ** 2 for axis, each in zip(axes, places.T, strict=True)
    )
    kind = np.int64 if reach < 2**62 else object
    least = np.full(sides, -1, dtype=kind)
    first, last = np.zeros(sides, np.int64), np.zeros(sides, np.int64)
    for k in np.argsort(labels, kind="stable"):
        square = 0
        for axis, place in zip(axes, places[k], strict=True):
            square = np.add.outer(square, ((axis - place) ** 2).astype(kind))
        nearer = (least < 0) | (square < least)
        last[nearer | (square == least)] = labels[k]
        least[nearer], first[nearer] = square[nearer], labels[k]
    return first, last, least
