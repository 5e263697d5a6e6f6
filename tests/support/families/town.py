"""A generated town: houses in turned blocks, some in rows that share their walls."""

import numpy as np

LOT = 24.0
"""Metres from one lot to the next."""
BLOCK = (6, 3)
"""Lots of a block."""
STREET = 16.0
ROWS = 0.2
"""Of the blocks are rows of houses wall to wall."""

RECTANGLE = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
L_SHAPE = [(-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1)]
T_SHAPE = [(-1, 0), (-0.3, 0), (-0.3, -1), (0.3, -1), (0.3, 0), (1, 0), (1, 1), (-1, 1)]
PLUS = [
    *((-0.4, -1), (0.4, -1), (0.4, -0.4), (1, -0.4), (1, 0.4), (0.4, 0.4)),
    *((0.4, 1), (-0.4, 1), (-0.4, 0.4), (-1, 0.4), (-1, -0.4), (-0.4, -0.4)),
]
SHAPES = (RECTANGLE, L_SHAPE, T_SHAPE, PLUS)
SHARES = (0.45, 0.30, 0.15, 0.10)


def town(count, seed=1):
    """Give the corners of houses, about 5.6 each, and where those of each begin.

    Returns
    -------
    xy : (n, 2) float64 array
        Counter-clockwise around each house, in meters.
    start : (count + 1,) int64 array
        Where each begins.
    """
    random = np.random.default_rng(seed)
    wide, deep = BLOCK
    house = np.arange(count)
    block, lot = np.divmod(house, wide * deep)
    blocks = int(block[-1]) + 1
    across = int(np.ceil(np.sqrt(blocks / 2)))  # blocks are twice as wide as deep
    is_row = (random.random(blocks) < ROWS)[block]
    kind = np.where(is_row, 0, random.choice(len(SHAPES), count, p=SHARES))
    sizes = np.array([len(shape) for shape in SHAPES])[kind]
    start = np.concatenate([[0], np.cumsum(sizes)])
    corner = np.arange(start[-1]) - np.repeat(start[:-1], sizes)
    table = np.zeros((len(SHAPES), max(map(len, SHAPES)), 2))
    for k, shape in enumerate(SHAPES):
        table[k, : len(shape)] = shape
    half = random.uniform(0.25, 0.40, (count, 2)) * LOT
    half[is_row, 0] = LOT / 2
    turn = np.where(is_row, 0, random.integers(4, size=count) * np.pi / 2 + random.normal(0, 0.1, count))
    column, row = lot % wide, lot // wide
    xy = _turned(table[kind[_of(sizes)], corner] * half[_of(sizes)], turn[_of(sizes)])
    xy += np.stack([(column - (wide - 1) / 2) * LOT, (row - (deep - 1) / 2) * LOT], axis=1)[_of(sizes)]
    room = np.array([wide, deep]) * LOT + STREET
    center = np.stack([block % across, block // across], axis=1) * room + random.normal(0, 1, (blocks, 2))[block]
    angle = random.normal(0, 0.04, blocks)[block]
    return _turned(xy, angle[_of(sizes)]) + center[_of(sizes)], start


def _of(sizes):
    """The house of each corner."""
    return np.repeat(np.arange(len(sizes)), sizes)


def _turned(xy, angle):
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.stack([cosine * xy[:, 0] - sine * xy[:, 1], sine * xy[:, 0] + cosine * xy[:, 1]], axis=1)


def polygons_of(xy, start):
    """The houses as polygons of shapely."""
    import shapely

    closed = np.insert(xy, start[1:], xy[start[:-1]], axis=0)
    houses = np.arange(len(start))
    return shapely.from_ragged_array(shapely.GeometryType.POLYGON, closed, (start + houses, houses))
