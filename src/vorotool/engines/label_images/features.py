"""The regions of a label image as rows, and as features with their outlines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from vorotool.engines.label_images.outlines import outlines
from vorotool.engines.label_images.regions import region_table
from vorotool.types.features import Rows
from vorotool.types.fields import UP
from vorotool.types.images import LabelImage
from vorotool.types.pixels import SQUARE, PixelSides
from vorotool.types.polygons.shapely_geometry import to_shapely
from vorotool.types.scaling import AREAS, LENGTHS, scaled_table
from vorotool.types.table import Table
from vorotool.types.volumes.volume import LabelVolume


def region_rows(image: LabelImage | LabelVolume) -> Rows:
    """Give the rows of regions."""
    own, seeds = region_table(image), image.seeds
    if seeds is None or seeds.site_labels is None:
        return Rows(own)
    return Rows(own, source=seeds, item=np.searchsorted(seeds.site_labels, _labels(own, seeds.properties)))


def region_features(image: LabelImage) -> Rows:
    """Give the rows of regions, each a polygon or several, in the order of the table."""
    rows, seeds = region_rows(image), image.seeds
    own = {} if seeds is None else seeds.properties
    table = _on_map(rows.table(), image, own)
    is_on_map = image.grid is not None and image.grid.transform is not None
    # of the seeds, in the coordinate reference system of the grid
    known = {"index": getattr(seeds, "index", None), "crs": image.crs, "y_axis": UP if is_on_map else image.y_axis}
    return replace(rows, columns=table, source=SimpleNamespace(**known), geometry=_regions(image, _labels(table, own)))


def _labels(table: Table, own: Mapping[str, Any]) -> NDArray[Any]:
    return np.asarray(table["voro_label" if "label" in own else "label"])


def _on_map(table: Table, image: LabelImage, own: Mapping[str, Any]) -> Table:
    """A table of regions in the unit of the map, without boxes; as it is where the image lies on none."""
    left_out = {"bbox_x", "bbox_y", "bbox_w", "bbox_h"}
    grid = image.grid
    if grid is not None and grid.transform is not None:
        if grid.is_square and grid.is_upright and image.sides == SQUARE:
            table = scaled_table(table, grid.width, properties=own, origin=grid.center, y_up=grid.is_north_up)
        else:  # a length in pixels, or in the unit of a spacing, is none on the map
            left_out |= LENGTHS | AREAS
    columns = table.stored().items()
    return Table(
        {name: column for name, column in columns if name in own or name.removeprefix("voro_") not in left_out}
    )


def _regions(image: LabelImage, labels: NDArray[Any]) -> NDArray[Any]:
    """(n,) outlines of the pixels of each label, on the map where the image lies on one, else in pixels."""
    geometry = np.full(len(labels), None, dtype=object)
    if not image.labels.any():
        return geometry
    found = outlines(image, connectivity=4)
    parts, row = to_shapely(found), np.searchsorted(labels, np.array(found.ids))
    first = np.flatnonzero(np.diff(row, prepend=-1))
    several = np.diff(np.append(first, len(row))) > 1
    geometry[row[first]] = parts[first]
    within = np.isin(row, row[first[several]])
    if several.any():
        numbers = np.cumsum(np.diff(row[within], prepend=-1) > 0) - 1
        geometry[row[first[several]]] = shapely.multipolygons(parts[within], indices=numbers)
    grid = image.grid
    if grid is None or grid.transform is None:
        return _in_unit(geometry, image.sides)
    a, b, c, d, e, f = grid.transform
    left, top = image.frame.x - 0.5, image.frame.y - 0.5

    def on_map(xy: NDArray[np.float64]) -> NDArray[np.float64]:
        column, row = xy[:, 0] - left, xy[:, 1] - top
        return np.stack([a * column + b * row + c, d * column + e * row + f], axis=1)

    return shapely.transform(geometry, on_map)


def _in_unit(geometry: NDArray[Any], sides: PixelSides) -> NDArray[Any]:
    """Shapes of pixels in the unit of their sides."""
    if sides == SQUARE:
        return geometry
    height, width = (float(side) for side in sides.lengths)
    return shapely.transform(geometry, lambda xy: xy * (width, height))
