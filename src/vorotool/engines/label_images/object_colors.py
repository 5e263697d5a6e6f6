"""Colors of objects that lie apart: those of the regions that are nearest to them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import label_array
from vorotool.engines.label_images.regions import region_colors
from vorotool.engines.tessellation.interior_seeds import surrounded
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.types.images import LabelImage
from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet


def object_colors(image: LabelImage, *, threads: int = 0) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
    """Color the labels of an image so that neighbors differ, also those with background between them."""
    labels = label_array(image.labels)
    if labels.all() or not labels.any():
        return region_colors(image, threads=threads)
    # Of an object the pixels inside it are nearest to no other pixel: its outermost ones are enough.
    y, x = np.nonzero((labels != 0) & ~surrounded(labels))
    found = np.unique(labels)[1:].astype(np.uint32)
    seeds = SeedSet(x, y, labels[y, x].astype(np.uint32), sites=np.empty((len(found), 2)), site_labels=found)
    frame = Frame(0, 0, labels.shape[1], labels.shape[0])
    nearest = Tessellator(seeds, frame, threads=threads).labels(dtype=np.uint32)
    np.copyto(nearest, labels, where=labels != 0, casting="unsafe")
    return region_colors(nearest, threads=threads)
