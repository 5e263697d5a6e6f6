"""The geometry of rows as text, made in the core."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.formats.text.rings import report_emptied, written_rings
from vorotool.formats.text.row_writer import Column
from vorotool.numeric.arrays import Nesting
from vorotool.numeric.coordinates import current_decimals, on_grid, record_places
from vorotool.types.features import Areas, Corners, Lines, Rows
from vorotool.types.table import Computed, Lookup


class GeometryText(NamedTuple):
    """The columns that geometry is made of, what stands around them, and what stands for none."""

    columns: list[Column]
    around: tuple[str, ...]
    missing: str


_KINDS = {1: "Point", 2: "LineString", 3: "Polygon"}
"""By the number of corners."""


def _of_corners(geometry: Corners, style: str) -> GeometryText:
    x, y = _placed(geometry.xy)
    index = geometry.corners.astype(np.int32, copy=False)
    corners = [*index.T, *([index[:, 0]] if index.shape[1] == 3 else [])]
    columns = [Column("", Lookup(values, corner), is_place=True) for corner in corners for values in (x, y)]
    kind, depth = _KINDS[index.shape[1]], index.shape[1]
    if style == "wkt":
        opening, between, point, closing = (
            f"{kind.upper()} {'(' * max(depth - 1, 1)}",
            " ",
            ", ",
            ")" * max(depth - 1, 1),
        )
    else:
        opening, between, point = f'{{"type":"{kind}","coordinates":{"[" * depth}', ",", "],["
        closing = "]" * depth + "}"
    betweens = [point if k % 2 else between for k in range(len(columns) - 1)]
    return GeometryText(columns, (opening, *betweens, closing), "")


def _placed(xy: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Round x and y to the decimals of the file."""
    return [on_grid(np.ascontiguousarray(values)) for values in xy.T]


def _of_lines(geometry: Lines, style: str) -> GeometryText:
    return GeometryText([line_column(geometry, style)], ("", ""), "LINESTRING EMPTY")


def line_column(geometry: Lines, style: str) -> Column:
    """Give the column of the text of lines."""
    xy, starts = np.stack(_placed(geometry.xy), axis=1), geometry.starts.astype(np.int64)
    every = np.arange(len(starts), dtype=np.int64)
    return Column("", _texts(xy, Nesting(starts, every, every), f"{style}_lines"))


def _of_areas(geometry: Areas, style: str) -> GeometryText:
    return GeometryText([Column("", written_areas(geometry).texts(style))], ("", ""), "POLYGON EMPTY")


class WrittenAreas(NamedTuple):
    """Areas as they are written: rounded to the decimals of the file, where they still share their borders."""

    points: NDArray[np.float64]
    nesting: Nesting

    def texts(self, style: str, rows: NDArray[np.int64] | None = None) -> Computed:
        """The column of their text, or that of other rows of polygons."""
        return _texts(self.points, self.nesting if rows is None else self.nesting._replace(cells=rows), style)


def written_areas(geometry: Areas) -> WrittenAreas:
    """Round areas, and say which have become empty."""
    made = written_rings(
        geometry.xy, geometry.nesting, decimals=current_decimals(), is_coverage=True, in_box=geometry.in_box
    )
    report_emptied(made.emptied, "cell")
    return WrittenAreas(made.points, made.nesting)


def _texts(xy: NDArray[np.float64], nesting: Nesting, style: str) -> Computed:
    """Give a column of the text of rows of rings."""
    rings, polygons, rows = nesting

    def texts(part: slice) -> Any:
        begin, end, _ = part.indices(len(rows) - 1)
        return _core.text.PolygonTexts(xy, rings, polygons, rows[begin : end + 1], _core.text.PolygonStyle[style])

    return Computed(texts, len(rows) - 1)


def geometry_text(rows: Rows, style: str) -> GeometryText:
    """Give the text of geometry in a style: ``wkt`` or ``geojson``."""
    if isinstance(rows.geometry, Corners):
        return _of_corners(rows.geometry, style)
    if isinstance(rows.geometry, Lines):
        return _of_lines(rows.geometry, style)
    if isinstance(rows.geometry, np.ndarray):
        import shapely

        texts = shapely.to_geojson(rows.geometry).tolist()
        return GeometryText([Column("", [text or "null" for text in texts])], ("", ""), "null")
    assert isinstance(rows.geometry, Areas)
    return _of_areas(rows.geometry, style)


def with_shapes(rows: Rows) -> Rows:
    """Add a column with the geometry as well-known text."""
    record_places()
    (shapes,) = geometry_text(rows, "wkt").columns
    return rows.with_columns(wkt=shapes.values)
