"""Draw the stack of made nuclei: `docs/scripts/nuclei_stack.py data/nuclei.tif`, as ImageJ writes one.

Ellipsoids at random places, none nearer than a micrometre to another one: a mask of 192 x 144 x 24 voxels of
0.325 x 0.325 x 1.5 µm.
"""

import sys

import numpy as np
import tifffile
from numpy.typing import NDArray

SHAPE, SIDES = (24, 144, 192), (1.5, 0.325, 0.325)
WANTED = 40


def nuclei() -> NDArray[np.uint8]:
    """A mask."""
    random = np.random.default_rng(21)
    places = np.indices(SHAPE).reshape(3, -1).T * SIDES
    room, mask = np.array(SHAPE) * SIDES, np.zeros(len(places), bool)
    taken: list[tuple[NDArray[np.float64], float]] = []
    while len(taken) < WANTED:
        center, radii = random.uniform(0, room), random.uniform(2.8, 4.6, 3)
        if any(np.linalg.norm(center - other) < max(radii) + reach + 1 for other, reach in taken):
            continue
        taken.append((center, max(radii)))
        turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
        mask |= (((places - center) @ turn / radii) ** 2).sum(axis=1) <= 1
    return 255 * mask.reshape(SHAPE).astype(np.uint8)


if __name__ == "__main__":
    about = {"spacing": SIDES[0], "unit": "um", "axes": "ZYX"}
    steps = (1 / SIDES[2], 1 / SIDES[1])
    tifffile.imwrite(sys.argv[1], nuclei(), imagej=True, resolution=steps, metadata=about, compression="zlib")
