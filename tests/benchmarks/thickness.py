"""Seconds from a mask of 4096 x 4096 pixels to its local thickness, beside the way by distance transforms.

``thickness.py [SIDE]``. The peer is what `porespy.filters.local_thickness` does by default, with SciPy's transform: for
25 radii at even steps of their logarithm, from the largest distance to the background down to 1, all pixels nearer than
the radius to a pixel that is so far from the background. Its values are these radii, and distances end in centers of
pixels; how far they are from ours is printed, twice the radius less a pixel.
"""

import sys
from functools import partial
from pathlib import Path

import numpy as np
from scipy.ndimage import distance_transform_edt

sys.path.insert(0, str(Path(__file__).parents[1]))
import vorotool
from benchmarks.masks import masks
from benchmarks.timing import timed
from vorotool.engines.from_skeleton.thickness import thickness_of_pixels

RUNS = 3
SIZES = 25


def by_transforms(mask):
    """Radii of the largest discs, of 25 ones."""
    distance = distance_transform_edt(mask)
    found = np.zeros(mask.shape)
    for radius in np.logspace(np.log10(distance.max()), 0, SIZES):
        centers = distance >= radius
        covered = distance_transform_edt(~centers) < radius
        found[(found == 0) & covered] = radius
    return found


def main():
    side = int(sys.argv[1]) if len(sys.argv) > 1 else 4096
    print(f"local thickness of masks of {side}², seconds: outlines / skeleton / thickness / all; transforms")
    for name, mask in masks(side):
        outlined, polygons = timed(partial(vorotool.outlines, mask), runs=RUNS)
        made, skeleton = timed(partial(vorotool.skeleton_exact, polygons), runs=RUNS)
        drawn, thickness = timed(partial(thickness_of_pixels, skeleton, mask.shape), runs=RUNS)
        other, radii = timed(partial(by_transforms, mask), runs=1)
        total = outlined + made + drawn
        apart = np.abs(thickness - (2 * radii - 1))[mask & (radii > 0)]
        print(
            f"  {name}: {100 * mask.mean():.0f} % foreground, mean {thickness[mask].mean():.2f}, {len(skeleton)} arcs"
        )
        print(f"    {outlined:.2f} / {made:.2f} / {drawn:.2f} / {total:.2f}; {other:.1f}, 1/{other / total:.0f}")
        print(f"    the transforms' values are off by {apart.mean():.2f} in the mean, {apart.max():.1f} at most")


if __name__ == "__main__":
    main()
