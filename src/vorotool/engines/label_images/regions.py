"""Measures of a label image: its regions, their neighbors, the diagram, a coloring (section 2.1)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.convert.images import as_label_image
from vorotool.convert.volumes import is_of_space
from vorotool.engines.common import (
    described,
    in_unit,
    label_array,
    largest_by_label,
    nearest_sites,
    next_row,
    refuse_negative,
    rows_of,
    spread,
)
from vorotool.engines.tessellation.raster_objects import numbered_components
from vorotool.errors import InputError, LimitError
from vorotool.numeric.checks import as_array, checked_flag, checked_threads
from vorotool.numeric.numbers import finite_double
from vorotool.numeric.parallel import Progress
from vorotool.plain import plain
from vorotool.products.formats import resolved
from vorotool.types.points.label_image import LabelImage
from vorotool.types.table import Table

if TYPE_CHECKING:
    from vorotool.typing import ImageLike, VolumeLike

_IN_SPACE = "engines.volumes.volume_"
"""Modules of what is made of volumes, whose room is above this one."""

LARGEST_COLOR_TABLE = 1 << 28
"""Entries that an array indexed by label may have."""


class Bordered(Protocol):
    """Measures that say which regions are neighbors, of an image or of a volume."""

    @property
    def labels(self) -> NDArray[np.uint32]:
        """(k,) of the regions, increasing."""

    @property
    def borders(self) -> NDArray[np.uint32]:
        """(b, 2) indices of neighbors."""


@plain
class RegionMeasures:
    """Measures of the regions of a label image; what `measure_regions` gives."""

    labels: NDArray[np.uint32]  # (k,) uint32 array: the labels that occur, increasing, without 0
    # dict of str to (k,) int64 array: `area`, `perimeter`, `vertical_sides`, `components`, `sum_x`, `sum_y`, and the
    # pixels `left`, `right`, `top` and `bottom` of the bounding box, both ends inside, counted from the corner of the
    # image. A perimeter counts sides of pixels, and `vertical_sides` those of them that are left or right of a pixel
    columns: dict[str, NDArray[np.int64]]
    # (b, 2) uint32 array: indices of two regions that share a pixel side, the smaller first, in lexicographic order
    borders: NDArray[np.uint32]
    border_length: NDArray[np.int64]  # (b,) int64 array: pixel sides that the two share
    border_vertical: NDArray[np.int64]  # (b,) int64 array: of these, the vertical ones


def measure_regions(image: Any, *, threads: int = 0, progress: Progress = None) -> RegionMeasures:
    """Measure all regions of a label image in one pass."""
    image = _labeled(image)
    found = _core.label_images.measure_regions(label_array(image.labels), checked_threads(threads), progress)
    labels = found.pop("labels")
    refuse_negative(image.labels.dtype, int(labels.max(initial=0)))
    borders = np.stack([found.pop("border_a"), found.pop("border_b")], axis=1)
    length, vertical = (found.pop(name) for name in ("border_length", "border_vertical"))
    return RegionMeasures(labels, found, borders, length, vertical)


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
    measures : RegionMeasures or VolumeMeasures, optional
        The result of `measure_regions` for this image, or of `measure_volume`.
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
    >>> table = region_table(LabelImage(np.array([[1, 1, 2], [1, 2, 2]], dtype=np.uint16)))
    >>> table["perimeter"].tolist(), table["nearest_label"].tolist()
    ([8, 8], [2, 1])
    """
    if is_of_space(image):
        options = {"distance2": distance2, "distance_scale": distance_scale, "measures": measures}
        own: Table = _in_space("tables:volume_table", image, threads, progress, properties=properties, **options)
        return own
    image = _labeled(image)
    threads = checked_threads(threads)
    measures = _checked_measures(measures) or measure_regions(image, threads=threads, progress=progress)
    labels, sites = _sites(image, measures)
    rows = _rows_of(measures.labels, labels, image)
    nearest_label, nearest_distance = nearest_sites(labels, sites, threads, progress)
    degree = np.bincount(measures.borders.ravel(), minlength=len(measures.labels))
    area = spread(_areas(image, measures.columns["area"]), rows, len(labels))
    around = _border_lengths(image, measures.columns["perimeter"], measures.columns["vertical_sides"])
    absent = area == 0
    columns: dict[str, Any] = {
        "label": labels.astype(np.int64),
        "x": sites[:, 0].copy(),
        "y": sites[:, 1].copy(),
        "area": area,
        "perimeter": spread(around, rows, len(labels)),
        "neighbors": spread(degree.astype(np.int64), rows, len(labels)),
        "nearest_label": nearest_label,
        "nearest_distance": nearest_distance,
    }
    box = _box_columns(image, measures)
    if distance_scale is not None:
        finite_double(distance_scale, "distance_scale")
    largest = _max_distance(image, distance2, distance_scale, labels, threads, progress)
    columns["touches_frame"] = np.ma.array(spread(box.pop("touches_frame"), rows, len(labels)), mask=absent)
    columns["max_distance"] = np.ma.array(largest, mask=absent | (distance2 is None))
    columns["components"] = spread(measures.columns["components"], rows, len(labels))
    for name, values in box.items():
        columns[name] = np.ma.array(spread(values, rows, len(labels)), mask=absent)
    return _with_input_columns(columns, image, properties)


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
    measures : RegionMeasures or VolumeMeasures, optional
        The result of `measure_regions` for this image, or of `measure_volume`.
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
    >>> table = neighbor_table(LabelImage(np.array([[1, 1, 2], [3, 3, 2]], dtype=np.uint16)))
    >>> list(zip(*(table[name].tolist() for name in ("label_a", "label_b", "border_length"))))
    [(1, 2, 1), (1, 3, 2), (2, 3, 1)]
    """
    if is_of_space(image):
        own: Table = _in_space("tables:volume_neighbors", image, threads, progress, measures=measures)
        return own
    image = _labeled(image)
    measures = _checked_measures(measures) or measure_regions(image, threads=threads, progress=progress)
    labels, sites = _sites(image, measures)
    position = sites[_rows_of(measures.labels, labels, image)]
    step = position[measures.borders[:, 0]] - position[measures.borders[:, 1]]
    table = Table(
        {
            "label_a": measures.labels[measures.borders[:, 0]].astype(np.int64),
            "label_b": measures.labels[measures.borders[:, 1]].astype(np.int64),
            "border_length": _border_lengths(image, measures.border_length, measures.border_vertical),
            "centroid_distance": np.sqrt(step[:, 0] * step[:, 0] + step[:, 1] * step[:, 1]),
        }
    )
    return in_unit(table, image.sides)


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
    if is_of_space(image):
        given = {"before": above, "after": below, "out": out}
        return np.asarray(_in_space("measures:volume_diagram", image, threads, progress, **given))
    labels = label_array(_labeled(image).labels)
    if out is None:
        out = np.empty(labels.shape, dtype=np.uint8)
    elif described(out) != f"uint8 of shape {labels.shape}" or not out.flags.c_contiguous:
        raise InputError(f"out must be a C-contiguous uint8 array of shape {labels.shape}, but is {described(out)}")
    rows = [next_row(row, name, labels) for row, name in ((above, "above"), (below, "below"))]
    _core.label_images.mark_diagram(labels, rows[0], rows[1], out, checked_threads(threads), progress)
    return out


def region_colors(
    image: Any,
    *,
    measures: Bordered | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
    """Color the regions so that neighbors never share a color."""
    if measures is None and is_of_space(image):
        measures = _in_space("measures:measure_volume", image, threads, progress)
    measures = _checked_measures(measures) or measure_regions(image, threads=threads, progress=progress)
    a, b = (np.ascontiguousarray(measures.borders[:, side]) for side in (0, 1))
    return measures.labels, _core.graphs.color_graph(len(measures.labels), a, b, progress)


def color_regions(
    image: ImageLike | VolumeLike,
    *,
    measures: Bordered | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> NDArray[Any]:
    """Return colors of the regions, as an array indexed by label: ``colors[image.labels]``.

    Parameters
    ----------
    image : LabelImage, LabelVolume, or (H, W) or (D, H, W) array of integers or truth values
        Label 0 is no region.
    measures : RegionMeasures or VolumeMeasures, optional
        The result of `measure_regions` for this image, or of `measure_volume`.
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


def _in_space(function: str, image: Any, threads: int, progress: Progress, **options: Any) -> Any:
    return resolved(f"{_IN_SPACE}{function}")(image, threads=threads, progress=progress, **options)


def _labeled(image: Any) -> LabelImage:
    return as_label_image(image, "image", numbered_components)


# ---- columns of the table -------------------------------------------------------------------------------


def _sites(image: LabelImage, measures: RegionMeasures) -> tuple[NDArray[np.uint32], NDArray[np.float64]]:
    """Labels and positions of the sites, in steps of the sides: those of the seeds, else the regions' centroids."""
    sides = np.array([image.sides.x, image.sides.y])
    if image.seeds is not None:
        assert image.seeds.site_labels is not None
        assert image.seeds.sites is not None
        return image.seeds.site_labels, image.seeds.sites * sides
    frame, columns = image.frame, measures.columns
    assert frame is not None
    x = columns["sum_x"] / columns["area"] + frame.x
    y = columns["sum_y"] / columns["area"] + frame.y
    return measures.labels, np.stack([x, y], axis=1) * sides


def _areas(image: LabelImage, pixels: NDArray[Any]) -> NDArray[Any]:
    """Areas in squares of a step of the sides."""
    square = image.sides.x * image.sides.y
    return pixels if square == 1 else pixels * float(square)


def _border_lengths(image: LabelImage, count: NDArray[np.int64], vertical: NDArray[np.int64]) -> NDArray[np.int64]:
    """Lengths in steps of the sides, of so many sides of pixels of which some are vertical."""
    return (count - vertical) * image.sides.x + vertical * image.sides.y


def _checked_measures(measures: Any) -> Any:
    """Refuse what is not measures of regions."""
    if measures is not None and not (hasattr(measures, "labels") and hasattr(measures, "borders")):
        raise InputError(f"invalid measures: expected None or RegionMeasures, but got a {type(measures).__name__}")
    return measures


def _rows_of(found: NDArray[np.uint32], labels: NDArray[np.uint32], image: LabelImage) -> NDArray[np.intp]:
    """Row of the table for each label that occurs in the image."""
    rows, label = rows_of(found, labels)
    if label is not None:
        row, column = (int(k[0]) for k in np.nonzero(image.labels == label))
        raise InputError(
            f"pixel (row {row}, column {column}) has label {label}, which is not one of the {len(labels)} sites: pass "
            "the seeds that the image was computed from"
        )
    return rows


def _box_columns(image: LabelImage, measures: RegionMeasures) -> dict[str, NDArray[np.int64]]:
    frame = image.frame
    assert frame is not None
    left, right, top, bottom = (measures.columns[side] for side in ("left", "right", "top", "bottom"))
    touches = (left == 0) | (top == 0) | (right == frame.width - 1) | (bottom == frame.height - 1)
    return {
        "touches_frame": touches.astype(np.int64),
        "bbox_x": (left + frame.x) * image.sides.x,
        "bbox_y": (top + frame.y) * image.sides.y,
        "bbox_w": (right - left + 1) * image.sides.x,
        "bbox_h": (bottom - top + 1) * image.sides.y,
    }


def _max_distance(
    image: LabelImage,
    distance2: NDArray[Any] | None,
    scale: int | None,
    labels: NDArray[np.uint32],
    threads: int,
    progress: Progress,
) -> NDArray[np.float64]:
    if distance2 is None:
        return np.zeros(len(labels))
    values = np.ascontiguousarray(as_array(distance2, "distance2"))
    if values.shape != image.shape or (values.dtype.kind not in "ui" and values.dtype != np.float64):
        raise InputError(
            f"distance2 must be an array of integers or float64 of shape {image.shape}, but is {values.dtype} of shape "
            f"{values.shape}"
        )
    if scale is None:
        scale = image.seeds.scale if image.seeds is not None else 1
    largest = largest_by_label(label_array(image.labels), values, labels, threads, progress)
    return np.sqrt(largest.astype(np.float64)) / scale


def _with_input_columns(columns: dict[str, Any], image: LabelImage, properties: bool) -> Table:
    seeds = image.seeds
    if seeds is not None and seeds.object_area is not None:
        columns["object_area"] = _areas(image, np.asarray(seeds.object_area, dtype=np.int64))
    table = in_unit(Table(columns), image.sides)
    if seeds is None or not checked_flag(properties, "properties") or not seeds.properties:
        return table
    return table.with_properties(seeds.properties)
