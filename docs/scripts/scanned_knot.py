"""Write the points of a scanned knot: `docs/scripts/scanned_knot.py data/knot.xyz`.

Places on the surface of a tube of radius 1 along a trefoil knot, as a scanner would give them: at random, each off by
some hundredths, in no order.
"""

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

POINTS, RADIUS, NOISE = 4000, 1.0, 0.02
STEPS = 720
"""Of the curve."""


def knot() -> NDArray[np.float64]:
    """(n, 3) places."""
    random = np.random.default_rng(9)
    turn = np.arange(STEPS) * (2 * np.pi / STEPS)
    curve = np.stack(
        [np.sin(turn) + 2 * np.sin(2 * turn), np.cos(turn) - 2 * np.cos(2 * turn), -np.sin(3 * turn)], axis=1
    )
    along = np.roll(curve, -1, axis=0) - np.roll(curve, 1, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    chosen = random.integers(0, STEPS, POINTS)
    off = random.normal(size=(POINTS, 3))
    off -= (off * along[chosen]).sum(axis=1, keepdims=True) * along[chosen]
    off *= (RADIUS + random.normal(0, NOISE, (POINTS, 1))) / np.linalg.norm(off, axis=1, keepdims=True)
    return 4 * curve[chosen] + off


if __name__ == "__main__":
    Path(sys.argv[1]).write_text("".join(f"{x:.2f} {y:.2f} {z:.2f}\n" for x, y, z in knot()), encoding="utf-8")
