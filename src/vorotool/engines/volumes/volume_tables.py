"""Tables of a label volume: its regions, and which are neighbors."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.engines.common import label_array, largest_by_label, nearest_sites, spread
from vorotool.engines.volumes.volume_measures import VolumeMeasures, labeled, measure_volume
from vorotool.engines.volumes.volume_regions import VolumeRegions
from vorotool.errors import InputError
from vorotool.numeric.checks import checked_threads
from vorotool.numeric.numbers import finite_double
from vorotool.numeric.parallel import Progress
from vorotool.types.spacing import PixelSides
from vorotool.types.table import Table
from vorotool.types.volumes.label_volume import LabelVolume

if TYPE_CHECKING:
    from vorotool.typing import VolumeLike

_AXES = ("x", "y", "z")
_SIDES = ("w", "h", "d")


def volume_table(
    volume: VolumeLike,
    *,
    distance2: NDArray[Any] | None = None,
    distance_scale: int | None = None,
    measures: VolumeMeasures | None = None,
    properties: bool = True,
    threads: int = 0,
    progress: Progress = None,
) -> Table:
    """Tabulate the regions of a tessellation: one row a site, in increasing label order."""
    volume = labeled(volume)
    threads = checked_threads(threads)
    if distance_scale is not None:
        finite_double(distance_scale, "distance_scale")
    regions = _regions_of(volume, measures, threads, progress)
    if distance2 is not None:
        squares = _largest_squares(volume, distance2, regions.labels, threads, progress)
        regions = replace(regions, largest_squares=squares)
    return table_of_regions(
        regions, distance_scale=distance_scale, properties=properties, threads=threads, progress=progress
    )


def table_of_regions(
    regions: VolumeRegions,
    *,
    distance_scale: int | None = None,
    properties: bool = True,
    threads: int = 0,
    progress: Progress = None,
) -> Table:
    """Give the table of `volume_table` of what was measured."""
    measures, sides = regions.measures, regions.sides
    labels, sites, rows = regions.labels, regions.sites, regions.rows
    step, count = sides.step, len(labels)
    nearest_label, nearest_distance = nearest_sites(labels, sites, threads, progress)
    degree = np.bincount(measures.borders.ravel(), minlength=len(measures.labels)).astype(np.int64)
    voxels = spread(measures.voxels, rows, count)
    absent = voxels == 0
    largest = _largest_distance(regions, distance_scale)
    columns: dict[str, Any] = {
        "label": labels.astype(np.int64),
        **{name: _times(sites[:, axis].copy(), step) for axis, name in enumerate(_AXES)},
        "volume": _volumes(voxels, sides),
        "surface": _areas(spread(measures.faces, rows, count), sides),
        "neighbors": spread(degree, rows, count),
        "nearest_label": nearest_label,
        "nearest_distance": _times(nearest_distance, step),
        "touches_frame": np.ma.array(
            spread(measures.touches_frame(regions.frame.shape).astype(np.int64), rows, count), mask=absent
        ),
        "max_distance": np.ma.array(_times(largest, step), mask=absent | (regions.largest_squares is None)),
        "components": spread(measures.components, rows, count),
    }
    for name, values in _boxes(regions).items():
        columns[name] = np.ma.array(_times(spread(values, rows, count), step), mask=absent)
    return _with_input_columns(columns, regions, properties)


def volume_neighbors(
    volume: VolumeLike,
    *,
    measures: VolumeMeasures | None = None,
    threads: int = 0,
    progress: Progress = None,
) -> Table:
    """Tabulate the neighboring regions: one row a pair of labels that share a face."""
    return neighbors_of_regions(_regions_of(labeled(volume), measures, threads, progress))


def neighbors_of_regions(regions: VolumeRegions) -> Table:
    """Give the table of `volume_neighbors` of what was measured."""
    measures, sides = regions.measures, regions.sides
    position = regions.sites[regions.rows]
    a, b = measures.borders.T
    way = position[a] - position[b]
    return Table(
        {
            "label_a": measures.labels[a].astype(np.int64),
            "label_b": measures.labels[b].astype(np.int64),
            "border_area": _areas(measures.border_faces, sides),
            "centroid_distance": _times(np.sqrt((way * way).sum(axis=1)), sides.step),
        }
    )


# ---- columns --------------------------------------------------------------------------------------------


def _times(values: Any, factor: Fraction) -> Any:
    """Values times a factor; integers where it is 1."""
    return values if factor == 1 else values * float(factor)


def _volumes(voxels: NDArray[np.int64], sides: PixelSides) -> NDArray[Any]:
    """Volumes of so many voxels, in the unit of the sides."""
    depth, height, width = sides.units
    made: NDArray[Any] = _times(voxels, depth * height * width * sides.step * sides.step * sides.step)
    return made


def _areas(faces: NDArray[np.int64], sides: PixelSides) -> NDArray[Any]:
    """Areas of so many faces across x, y and z, in the unit of the sides."""
    depth, height, width = sides.units
    across = (height * depth, width * depth, width * height)
    fits = int(faces.max(initial=0)) * sum(across) < 2**63
    kind = np.int64 if fits else object
    exact = (faces.astype(kind) * np.array(across, kind)).sum(axis=1)
    made: NDArray[Any] = _times(exact if fits else exact.astype(np.float64), sides.step * sides.step)
    return made


def _regions_of(
    volume: LabelVolume, measures: VolumeMeasures | None, threads: int, progress: Progress
) -> VolumeRegions:
    """Measure a volume, of whose labels each is that of a site."""
    frame, seeds = volume.frame, volume.seeds
    assert frame is not None  # LabelVolume has filled it in
    regions = VolumeRegions(
        measures or measure_volume(volume, threads=threads, progress=progress), frame, volume.sides, seeds
    )
    label = regions.stranger
    if label is not None:
        place = np.unravel_index(int(np.argmax(volume.labels == label)), volume.shape)
        slice_, row, column = map(int, place)
        raise InputError(
            f"voxel (slice {slice_}, row {row}, column {column}) has label {label}, which is not one of the "
            f"{len(regions.labels)} sites: pass the seeds that the volume was computed from"
        )
    return regions


def _boxes(regions: VolumeRegions) -> dict[str, NDArray[np.int64]]:
    """Bounding boxes, in steps."""
    measures, steps = regions.measures, regions.steps
    low = (measures.low + regions.corner) * steps
    size = (measures.high - measures.low + 1) * steps
    return {
        **{f"bbox_{name}": low[:, axis] for axis, name in enumerate(_AXES)},
        **{f"bbox_{name}": size[:, axis] for axis, name in enumerate(_SIDES)},
    }


def _largest_squares(
    volume: LabelVolume, distance2: NDArray[Any], labels: NDArray[np.uint32], threads: int, progress: Progress
) -> NDArray[np.uint64]:
    """The largest squared distance in each region."""
    values = np.asarray(distance2)
    if values.shape != volume.shape or values.dtype.kind not in "ui":
        raise InputError(
            f"distance2 must be an integer array of shape {volume.shape}, but is {values.dtype} of shape {values.shape}"
        )
    return largest_by_label(label_array(volume.labels, "voxel"), values, labels, threads, progress)


def _largest_distance(regions: VolumeRegions, scale: int | None) -> NDArray[np.float64]:
    """The largest distance in each region, in steps."""
    squares, seeds = regions.largest_squares, regions.seeds
    if squares is None:
        return np.zeros(len(regions.labels))
    if scale is None:
        scale = 1 if seeds is None else seeds.scale
    distances: NDArray[np.float64] = np.sqrt(squares.astype(np.float64)) / scale
    return distances


def _with_input_columns(columns: dict[str, Any], regions: VolumeRegions, properties: bool) -> Table:
    seeds = regions.seeds
    if seeds is not None and seeds.object_volume is not None:
        columns["object_volume"] = _volumes(np.asarray(seeds.object_volume, dtype=np.int64), regions.sides)
    table = Table(columns)
    return table.with_properties(seeds.properties) if seeds is not None and properties and seeds.properties else table
