"""Seconds from a mask of 4096 x 4096 pixels to its pruned skeleton and tables, beside scikit-image's medial axis.

``masks.py [SIDE]``. The peer does what users do there: `medial_axis` with distances, and `skeletonize` for a thin line.
"""

import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from scipy.ndimage import gaussian_filter, zoom
from skimage.morphology import medial_axis, skeletonize

sys.path.insert(0, str(Path(__file__).parents[1]))
import vorotool
from benchmarks.timing import timed
from vorotool.engines.label_images.outlines import outlines
from vorotool.engines.pruning.pruning import default_pruning_for_masks

RUNS = 3
seconds = partial(timed, runs=RUNS)
"""Of several runs the least, and what the last one gave."""
FINE = 8
"""Pixels a sample of the smooth fields that masks are drawn from."""


def smooth(side, width, seed):
    """A random field that varies over so many pixels, with variance 1."""
    field = gaussian_filter(np.random.default_rng(seed).standard_normal((side // FINE,) * 2), width / FINE, mode="wrap")
    return zoom(field / field.std(), FINE, order=3)[:side, :side]


def masks(side):
    """Drawn by functions, so that every machine has the same."""
    yield "blobs, 60 px", smooth(side, 30, 1) > 0.4
    yield "vessels, 20 px", np.abs(smooth(side, 60, 2)) < 0.12
    yield "fine blobs, 20 px", smooth(side, 10, 3) > 0.4


def tables(skeleton):
    """Branches and polygons, nothing kept from an earlier call."""
    skeleton = replace(skeleton)
    return vorotool.branch_table(skeleton), vorotool.polygon_table(skeleton)


def pruned(skeleton):
    """By the default for masks."""
    criterion, threshold = default_pruning_for_masks()
    return vorotool.prune(replace(skeleton), **{criterion: threshold})


def main():
    side = int(sys.argv[1]) if len(sys.argv) > 1 else 4096
    print(f"masks of {side} x {side} pixels, seconds: outlines / skeleton / pruning / tables / all; scikit-image")
    for name, mask in masks(side):
        outlined, polygons = seconds(partial(outlines, mask))
        made, skeleton = seconds(partial(vorotool.skeleton_exact, polygons))
        cut, rest = seconds(partial(pruned, skeleton))
        listed, _ = seconds(partial(tables, rest))
        axis, _ = seconds(partial(medial_axis, mask, return_distance=True))
        thin, _ = seconds(partial(skeletonize, mask))
        total = outlined + made + cut + listed
        print(f"  {name}: {len(polygons)} objects, {len(polygons.xy)} vertices, {100 * mask.mean():.0f} % foreground")
        parts = f"{outlined:.3f} / {made:.3f} / {cut:.3f} / {listed:.3f} / {total:.3f}"
        print(f"    {parts}; medial_axis {axis:.1f}, skeletonize {thin:.1f}")
        print(f"    1/{axis / total:.1f} of the medial axis, 1/{(axis + thin) / total:.1f} of both")


if __name__ == "__main__":
    main()
