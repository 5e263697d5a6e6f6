"""Outlines of the regions of a label image along the cracks between pixels, as closed rectilinear loops."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

Loop = list[tuple[int, int]]


def crack_loops(labels: NDArray[Any]) -> Iterator[tuple[int, list[Loop]]]:
    """Give each label's boundary as loops of corners, for filling by the even-odd rule."""
    owner, x, y = _corners(labels)
    beside, below = _partners(owner, y, x), _partners(owner, x, y)
    order, owners = np.lexsort((x, y, owner)).tolist(), owner.tolist()
    places, used = list(zip(x.tolist(), y.tolist(), strict=True)), bytearray(len(owners))
    for label, starts in groupby(order, key=owners.__getitem__):
        yield label, [_loop(start, places, beside, below, used) for start in starts if not used[start]]


def _corners(labels: NDArray[Any]) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Label and place of each corner: where one or three of the pixels around a point have the label."""
    padded = np.pad(labels.astype(np.int64), 1)
    rows, columns = labels.shape[0] + 1, labels.shape[1] + 1
    quarters = {(dy, dx): padded[dy : dy + rows, dx : dx + columns] for dy in (0, 1) for dx in (0, 1)}
    found = []
    for (dy, dx), own in quarters.items():
        horizontal = quarters[dy, 1 - dx] == own
        vertical = quarters[1 - dy, dx] == own
        diagonal = quarters[1 - dy, 1 - dx] == own
        corner = (own != 0) & ((~horizontal & ~vertical) | (horizontal & vertical & ~diagonal))
        y, x = np.nonzero(corner)
        found.append((own[corner], x, y))
    owner, x, y = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return owner, x, y


def _partners(owner: NDArray[np.int64], line: NDArray[np.int64], along: NDArray[np.int64]) -> list[int]:
    """Other end of each corner's crack on its line: there the corners of a label pair up in order."""
    order = np.lexsort((along, line, owner))
    partner = np.empty(len(order), np.int64)
    partner[order[0::2]], partner[order[1::2]] = order[1::2], order[0::2]
    return partner.tolist()


def _loop(start: int, places: list[tuple[int, int]], beside: list[int], below: list[int], used: bytearray) -> Loop:
    loop, corner = Loop(), start
    while not used[corner]:
        other = beside[corner]
        used[corner] = used[other] = 1
        loop += [places[corner], places[other]]
        corner = below[other]
    return loop
