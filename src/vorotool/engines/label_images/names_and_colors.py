"""Objects of a label image: where their names are written, deep inside them, and colors where they lie apart."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.engines.common import label_array
from vorotool.engines.label_images.regions import region_colors
from vorotool.engines.tessellation.tessellator import Tessellator, surrounded
from vorotool.types.images import LabelImage
from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet


def label_places(
    image: LabelImage, *, threads: int = 0
) -> tuple[NDArray[np.uint32], NDArray[np.int64], NDArray[np.float64]]:
    """Find a pixel of each region that is as far as can be from its outermost pixels."""
    array = label_array(image.labels)
    known = np.unique(array)
    known = known[known > 0].astype(np.uint32)
    if not len(known):
        return known, np.empty((0, 2), np.int64), np.empty(0)
    squares = _squares_to_outermost(array, threads)
    largest = _core.label_images.max_by_label(array, squares, known, threads, None)
    row, column = np.nonzero(array)
    region = np.searchsorted(known, array[row, column])
    deepest = squares[row, column] == largest[region]
    row, column, region = row[deepest], column[deepest], region[deepest]
    count = np.bincount(region, minlength=len(known))
    # Twice the count times the coordinates, so that distances from the mean are whole numbers.
    dx, dy = (k - (np.bincount(region, k, len(known)) / count)[region] for k in (column, row))
    order = np.lexsort((np.arange(len(region)), dx * dx + dy * dy, region))
    chosen = order[np.searchsorted(region[order], np.arange(len(known)))]
    return known, np.stack([column[chosen], row[chosen]], axis=1), np.sqrt(largest.astype(np.float64))


def name_places(image: LabelImage, *, threads: int = 0) -> tuple[NDArray[np.uint32], NDArray[np.int64]]:
    """Find where each region is named: deep inside its object where there are some, else inside itself."""
    labels, places, _ = label_places(image, threads=threads)
    if image.seeds is None or image.seeds.frame is None or not len(labels):
        return labels, places
    named, own, _ = label_places(_painted(image, image.seeds), threads=threads)
    index = np.searchsorted(labels, named)
    index[index == len(labels)] = 0
    has_region = labels[index] == named
    places[index[has_region]] = own[has_region]
    return labels, places


def seed_objects(image: LabelImage) -> LabelImage | None:
    """Give the pixels of the objects whose tessellation an image is; of several in one the smallest label has it."""
    seeds = image.seeds
    if seeds is None or seeds.frame is None or seeds.site_labels is None or len(seeds) <= len(seeds.site_labels):
        return None
    return _painted(image, seeds)


def outermost_pixels(image: LabelImage) -> NDArray[np.bool_]:
    """Find the pixels of regions that lie beside another label, or on a side of the image."""
    labels = label_array(image.labels)
    return (labels != 0) & ~surrounded(labels)


def _painted(image: LabelImage, seeds: SeedSet) -> LabelImage:
    """The pixels of the seeds."""
    order = np.argsort(seeds.labels, kind="stable")[::-1]
    column, row = (
        np.floor(k[order] / seeds.scale + 0.5).astype(np.int64) - first
        for k, first in ((seeds.x, image.frame.x), (seeds.y, image.frame.y))
    )
    inside = (column >= 0) & (column < image.shape[1]) & (row >= 0) & (row < image.shape[0])
    objects = np.zeros(image.shape, np.uint32)
    objects[row[inside], column[inside]] = seeds.labels[order][inside]
    return LabelImage(objects, image.frame)


def _squares_to_outermost(labels: NDArray[np.unsignedinteger], threads: int) -> NDArray[np.unsignedinteger]:
    """Squared distance of each pixel from the nearest one that lies beside another label, or on a side of the image."""
    y, x = np.nonzero(~surrounded(labels))
    one = np.ones(len(x), np.uint32)
    seeds = SeedSet(x, y, one, sites=np.empty((0, 2)), site_labels=one[:0])
    return Tessellator(seeds, Frame(0, 0, labels.shape[1], labels.shape[0]), threads=threads).squared_distances()


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
