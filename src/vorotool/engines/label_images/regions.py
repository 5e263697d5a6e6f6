"""Measures of a label image or volume: its regions, their neighbors, the diagram, a coloring (section 2.1)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.images import as_label_image
from vorotool.convert.volumes import as_volume, is_of_space
from vorotool.engines.common import described, label_array, next_row
from vorotool.engines.label_images.measured_regions import (
    RegionMeasures,
    Regions,
    largest_by_label,
    measure_parts,
)
from vorotool.engines.tessellation.raster_objects import numbered_components
from vorotool.engines.tessellation.tessellator import Tessellator, surrounded
from vorotool.errors import InputError, LimitError
from vorotool.numeric.checks import as_array, checked_flag, checked_threads, naming
from vorotool.numeric.numbers import finite_double
from vorotool.numeric.parallel import Progress, Run, running
from vorotool.types.images import LabelImage
from vorotool.types.pixels import CELL, Frame
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.table import Table
from vorotool.types.volumes.volume import LabelVolume

if TYPE_CHECKING:
    from vorotool.typing import ImageLike, VolumeLike

LARGEST_COLOR_TABLE = 1 << 28
"""Entries that an array indexed by label may have."""


def measure_regions(image: Any, **run: Unpack[Run]) -> RegionMeasures:
    """Measure all regions of a label image or volume in one pass."""
    return measure_parts([_labeled(image).labels], **run)


def region_table(
    image: ImageLike | VolumeLike,
    *,
    distance2: NDArray[Any] | None = None,
    distance_scale: int | None = None,
    measures: Any = None,
    properties: bool = True,
    threads: int = 0,
    progress: Progress = None,
) -> Table:
    """Tabulate the regions of a tessellation: one row per site, in increasing label order.

    Parameters
    ----------
    image : LabelImage, LabelVolume, or (H, W) or (D, H, W) array of integers or truth values
        With ``seeds``, every site has a row, also one without pixels (a duplicate, or a seed far outside the
        frame): its area is 0, and its bounding box, ``touches_frame`` and ``max_distance`` do not exist.
        Without ``seeds`` every label that occurs has a row, and the centroid of its region is its site.
    distance2 : array of integers or float64 of the same shape, optional
        Squared distance of each pixel to its site, in steps of the sides of the image over ``distance_scale``; without
        it ``max_distance`` does not exist.
    distance_scale : int, optional
        Lattice steps a pixel of ``distance2``; by default the scale of the seeds, else 1.
    measures : RegionMeasures, optional
        The result of `measure_regions` for this image.
    properties : bool
        Whether to add the input's own columns.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    Table
        ``label, x, y, area, perimeter, neighbors, nearest_label, nearest_distance, touches_frame,
        max_distance, components, bbox_x, bbox_y, bbox_w, bbox_h`` (and ``object_area`` for objects of several
        pixels). Areas in pixels; perimeters in pixel sides, those on the frame included; lengths in pixels.
        ``neighbors`` counts the labels that share a side (section 2.1); ``components`` are 4-connected.
        ``nearest_label`` is the site nearest to (x, y), ties to the smallest label; another site at the same
        place is at distance 0. Fields that do not exist are masked. Of an image whose ``sides`` are not 1, all is in
        their unit. Of volumes ``z``, ``volume`` and ``surface``, ``bbox_z`` and ``bbox_d`` are beside or instead of
        these, neighbors share a face, and components are 6-connected.

    Raises
    ------
    InputError
        If a label of the image is none of the seeds, or ``distance2`` does not fit the image.

    Examples
    --------
    >>> import numpy as np
    >>> from vorotool import LabelImage
    >>> table = region_table(LabelImage(np.array([[1, 1, 2], [1, 2, 2]], dtype=np.uint16)))
    >>> table["perimeter"].tolist(), table["nearest_label"].tolist()
    ([8, 8], [2, 1])
    """
    image = _labeled(image)
    run, properties = running(threads, progress), checked_flag(properties, "properties")
    regions = _regions(image, measures, run)
    if distance_scale is not None:
        finite_double(distance_scale, "distance_scale")
    if distance2 is not None:
        squares = _largest_squares(image, distance2, regions.labels, run)
        scale = 1 if regions.seeds is None else regions.seeds.scale
        scale = scale if distance_scale is None else distance_scale
        regions = replace(regions, largest_squares=squares, scale=scale)
    return regions.table(properties=properties, **run)


def neighbor_table(
    image: ImageLike | VolumeLike,
    *,
    measures: Any = None,
    threads: int = 0,
    progress: Progress = None,
) -> Table:
    """Tabulate neighboring regions: one row per pair of labels that share a pixel side (section 2.1) or a face.

    Parameters
    ----------
    image : LabelImage, LabelVolume, or (H, W) or (D, H, W) array of integers or truth values
        Label 0 is no region.
    measures : RegionMeasures, optional
        The result of `measure_regions` for this image.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    Table
        ``label_a, label_b, border_length, centroid_distance``, ordered by the labels, ``label_a < label_b``:
        the pixel sides that the two share, and the distance between their sites (region centroids, if the
        image has no seeds); in the unit of the ``sides`` of the image. Of volumes ``border_area``, the area of the
        faces that the two share, is instead of the length.

    Raises
    ------
    InputError
        If a label of the image is none of the seeds.

    Examples
    --------
    >>> import numpy as np
    >>> from vorotool import LabelImage
    >>> table = neighbor_table(LabelImage(np.array([[1, 1, 2], [3, 3, 2]], dtype=np.uint16)))
    >>> list(zip(*(table[name].tolist() for name in ("label_a", "label_b", "border_length"))))
    [(1, 2, 1), (1, 3, 2), (2, 3, 1)]
    """
    return _regions(_labeled(image), measures, running(threads, progress)).neighbors()


def voronoi_diagram(
    image: ImageLike | VolumeLike,
    *,
    above: NDArray[Any] | None = None,
    below: NDArray[Any] | None = None,
    out: NDArray[np.uint8] | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> NDArray[np.uint8]:
    """Mark the digital Voronoi diagram: pixels with a 4-neighbor of larger label (section 2.1), voxels with one of 6.

    Parameters
    ----------
    image : LabelImage, LabelVolume, or (H, W) or (D, H, W) array of integers or truth values
        Pixels of label 0 are never marked, and as neighbors never larger.
    above, below : (W,) or (H, W) integer array, optional
        The rows next to a band of a larger image, which then can be streamed in bands of any height; of a volume the
        slices before and after.
    out : uint8 array of the same shape, optional
        C-contiguous array to write to; it must not overlap the labels.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    uint8 array of the same shape
        1 on the diagram, else 0.

    Raises
    ------
    InputError
        If the shapes do not fit.

    Examples
    --------
    >>> import numpy as np
    >>> voronoi_diagram(np.array([[1, 1, 2, 2], [3, 3, 3, 0]], dtype=np.uint16))
    array([[1, 1, 1, 0],
           [0, 0, 0, 0]], dtype=uint8)
    """
    labels = _labeled(image).labels
    return diagram_of(labels, above=above, below=below, out=out, threads=threads, progress=progress)


def diagram_of(
    labels: NDArray[Any],
    *,
    above: NDArray[Any] | None = None,
    below: NDArray[Any] | None = None,
    out: NDArray[np.uint8] | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> NDArray[np.uint8]:
    """Mark the diagram of labels with two axes or three: see `voronoi_diagram`."""
    is_flat = labels.ndim == 2
    labels = label_array(labels, CELL[labels.ndim])
    if out is None:
        out = np.empty(labels.shape, dtype=np.uint8)
    elif described(out) != f"uint8 of shape {labels.shape}" or not out.flags.c_contiguous:
        raise InputError(f"out must be a C-contiguous uint8 array of shape {labels.shape}, but is {described(out)}")
    names = ("above", "below") if is_flat else ("before", "after")
    beside = [next_row(each, name, labels) for each, name in zip((above, below), names, strict=True)]
    mark: Any = (_core.label_images if is_flat else _core.volumes).mark_diagram
    mark(labels, *beside, out, checked_threads(threads), progress)
    return out


def region_colors(
    image: Any,
    *,
    measures: RegionMeasures | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
    """Color the regions so that neighbors never share a color."""
    measures = _checked_measures(measures) or measure_regions(image, threads=threads, progress=progress)
    a, b = (np.ascontiguousarray(measures.borders[:, side]) for side in (0, 1))
    return measures.labels, _core.graphs.color_graph(len(measures.labels), a, b, progress)


def color_regions(
    image: ImageLike | VolumeLike,
    *,
    measures: RegionMeasures | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> NDArray[Any]:
    """Return colors of the regions, as an array indexed by label: ``colors[image.labels]``.

    Parameters
    ----------
    image : LabelImage, LabelVolume, or (H, W) or (D, H, W) array of integers or truth values
        Label 0 is no region.
    measures : RegionMeasures, optional
        The result of `measure_regions` for this image.
    threads : int
        Number of threads; 0 uses all. The result does not depend on it.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    (largest label + 1,) uint8 or uint32 array
        The colors of `region_colors`; 0 for label 0 and for labels that do not occur.

    Raises
    ------
    LimitError
        If the largest label is above 2^28: use `region_colors`.

    Examples
    --------
    >>> import numpy as np
    >>> from vorotool import LabelImage
    >>> color_regions(LabelImage(np.array([[0, 1, 4]], dtype=np.uint16)))
    array([0, 2, 0, 0, 1], dtype=uint8)
    """
    labels, colors = region_colors(image, measures=measures, threads=threads, progress=progress)
    largest = int(labels.max(initial=0))
    if largest > LARGEST_COLOR_TABLE:
        raise LimitError(
            f"the largest label is {largest}: colors by label are limited to {LARGEST_COLOR_TABLE}; "
            "renumber the labels, or use region_colors"
        )
    by_label = np.zeros(largest + 1, dtype=np.uint8 if colors.max(initial=0) <= 255 else np.uint32)
    by_label[labels] = colors
    return by_label


def _labeled(image: Any) -> Any:
    """Give a label image or volume: of truth values the components are numbered, integers are labels."""
    if isinstance(image, LabelVolume) or not is_of_space(image):
        return image if isinstance(image, LabelVolume) else as_label_image(image, "image", numbered_components)
    made = as_volume(image, "volume")
    values = made.values
    if values.dtype.kind == "f":
        with naming("volume"):
            raise InputError(f"expected labels, a 3-D array of integers, but got {described(values)}")
    return LabelVolume(numbered_components(values, 26) if values.dtype == bool else values, grid=made.grid)


def _checked_measures(measures: Any) -> Any:
    """Refuse what is not measures of regions."""
    if measures is not None and not (hasattr(measures, "labels") and hasattr(measures, "borders")):
        raise InputError(f"invalid measures: expected None or RegionMeasures, but got a {type(measures).__name__}")
    return measures


def _regions(image: Any, measures: Any, run: Run) -> Regions:
    """Measure an image or a volume, of whose labels each is that of a site."""
    measures = _checked_measures(measures) or measure_regions(image, **run)
    regions = Regions(measures, image.frame, image.sides, image.seeds)
    if (label := regions.stranger) is not None:
        place = np.unravel_index(int(np.argmax(image.labels == label)), image.shape)
        axes, what = ("slice", "row", "column")[-len(place) :], "image" if len(place) == 2 else "volume"
        at = ", ".join(f"{axis} {int(number)}" for axis, number in zip(axes, place, strict=True))
        raise InputError(
            f"{CELL[len(place)]} ({at}) has label {label}, which is not one of the {len(regions.labels)} sites: pass "
            f"the seeds that the {what} was computed from"
        )
    return regions


def _largest_squares(image: Any, distance2: Any, labels: NDArray[np.uint32], run: Run) -> NDArray[Any]:
    """The largest squared distance in each region."""
    values = np.ascontiguousarray(as_array(distance2, "distance2"))
    if values.shape != image.shape or (values.dtype.kind not in "ui" and values.dtype != np.float64):
        raise InputError(
            f"distance2 must be an array of integers or float64 of shape {image.shape}, but is {values.dtype} of shape "
            f"{values.shape}"
        )
    return largest_by_label(label_array(image.labels), values, labels, **run)


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
