"""Features of any value as GeoJSON and as well-known text, polygons in all their formats, and cells as JSON and NPZ."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.polygons.json import feature_columns, feature_ranges, feature_texts, write_geojson, write_json
from vorotool.formats.text.rings import report_emptied, ring_texts, written_polygons, written_rings
from vorotool.formats.text.row_writer import Column, RowShape, coordinate_text, write_list_rows, write_rows
from vorotool.formats.text.tables import (
    json_column,
    json_text,
    object_shape,
    write_collection,
    write_npz,
)
from vorotool.numeric.arrays import Nesting, owners, within
from vorotool.numeric.coordinates import current_decimals, current_written, on_grid
from vorotool.products.formats import resolved
from vorotool.types.features import Areas, Corners, Lines, Mixture, Rows, features_of, parts_of, rows_of
from vorotool.types.fields import MEMBER as Y_AXIS
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.table import Computed, Lookup

if TYPE_CHECKING:
    from vorotool.types.mesh.cells import CellSet


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
    depth = index.shape[1]
    kind, brackets = _KINDS[depth], max(depth - 1, 1)
    if style == "wkt":
        opening, between, point, closing = f"{kind.upper()} {'(' * brackets}", " ", ", ", ")" * brackets
    else:
        opening, between, point = f'{{"type":"{kind}","coordinates":{"[" * depth}', ",", "],["
        closing = "]" * depth + "}"
    betweens = [point if k % 2 else between for k in range(len(columns) - 1)]
    return GeometryText(columns, (opening, *betweens, closing), "")


def _placed(xy: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Round x and y to the decimals of the file."""
    return [on_grid(np.ascontiguousarray(values)) for values in xy.T]


def line_column(geometry: Lines, style: str) -> Column:
    """Give the column of the text of lines."""
    xy, starts = np.stack(_placed(geometry.xy), axis=1), geometry.starts.astype(np.int64)
    every = np.arange(len(starts), dtype=np.int64)
    return Column("", ring_texts(xy, Nesting(starts, every, every), f"{style}_lines"))


class WrittenAreas(NamedTuple):
    """Areas as they are written: rounded to the decimals of the file, where they still share their borders."""

    points: NDArray[np.float64]
    nesting: Nesting

    def texts(self, style: str, rows: NDArray[np.int64] | None = None) -> Computed:
        """The column of their text, or that of other rows of polygons."""
        return ring_texts(self.points, self.nesting if rows is None else self.nesting._replace(cells=rows), style)


def written_areas(geometry: Areas) -> WrittenAreas:
    """Round areas, and say which have become empty."""
    made = written_rings(
        geometry.xy, geometry.nesting, decimals=current_decimals(), is_coverage=True, in_box=geometry.in_box
    )
    report_emptied(made.emptied, "cell")
    return WrittenAreas(made.points, made.nesting)


def geometry_text(rows: Rows, style: str) -> GeometryText:
    """Give the text of geometry in a style: ``wkt`` or ``geojson``."""
    if isinstance(rows.geometry, np.ndarray):
        import shapely

        texts = shapely.to_geojson(rows.geometry).tolist()
        return GeometryText([Column("", [text or "null" for text in texts])], ("", ""), "null")
    if isinstance(rows.geometry, Corners):
        return _of_corners(rows.geometry, style)
    if isinstance(rows.geometry, Lines):
        return GeometryText([line_column(rows.geometry, style)], ("", ""), "LINESTRING EMPTY")
    assert isinstance(rows.geometry, Areas)
    return GeometryText([Column("", written_areas(rows.geometry).texts(style))], ("", ""), "POLYGON EMPTY")


def with_shapes(rows: Rows) -> Rows:
    """Add a column with the geometry as well-known text."""
    current_written().has_places = True
    (shapes,) = geometry_text(rows, "wkt").columns
    return rows.with_columns(wkt=shapes.values)


def write_shapes(out: BinaryIO, value: Any, fmt: str, *, what: str, flatten: float | None = None) -> None:
    """Write the features of a value, which are polygons, as these."""
    features = features_of(value, what, flatten=flatten)
    assert isinstance(features, Rows)
    assert isinstance(features.geometry, PolygonSet)
    write_polygons(out, features.geometry, fmt)


def write_features(
    out: BinaryIO,
    value: Any,
    features: Rows | Mixture,
    fmt: str,
) -> None:
    """Write features as GeoJSON, or their geometry as well-known text, one a line."""
    if fmt == "wkt":
        for rows in parts_of(features):
            _write_wkt(out, rows)
    else:
        parts = list(parts_of(features))
        blocks = [_features(rows) for rows in parts]
        y_axis = getattr(parts[0].source, "y_axis", value.y_axis)
        write_collection(out, blocks, crs=value.crs, y_axis=y_axis)


def _write_wkt(out: BinaryIO, rows: Rows) -> None:
    if isinstance(rows.geometry, PolygonSet):
        write_wkt(out, written_polygons(rows.geometry))
        return
    columns, (opening, *between, closing), missing = geometry_text(rows, "wkt")
    write_rows(out, columns, RowShape((opening, *between, f"{closing}\n"), "", missing))


def _features(rows: Rows) -> tuple[Sequence[Column], RowShape]:
    if isinstance(rows.geometry, PolygonSet):
        return feature_columns(written_polygons(rows.geometry))
    table = rows.table(is_file=True, has_ids=False).stored()
    columns = [json_column(Column.of(name, column)) for name, column in table.items()]
    geometry, (before, *between, closing), _ = geometry_text(rows, "geojson")
    ids, opening, after = _ids(rows)
    first, *others = object_shape([column.name for column in columns], "", f',"geometry":{before}').around
    properties = f'{after}"properties":{first}', *others
    around = (opening, *properties) if ids else (opening + properties[0], *others)
    return [*ids, *columns, *geometry], RowShape((*around, *between, f"{closing}}}"), ",\n", "null")


def _ids(rows: Rows) -> tuple[list[Column], str, str]:
    """Give the column with the member ``id`` of features, if there is one, and what stands before and after it."""
    names, opening = rows.names, '{"type":"Feature",'
    if names is None:
        return [], opening, ""
    if isinstance(names, Lookup) and isinstance(names.values, list):
        return [Column("id", Lookup([_id(value) for value in names.values], names.index))], opening, ""
    column = Column.of("id", names)
    if isinstance(column.values, np.ndarray) and column.missing is None:
        return [column], f'{opening}"id":', ","
    return [Column("id", [_id(value) for value in names])], opening, ""


def _id(value: Any) -> str:
    return "" if value is None else f'"id":{json_text(value)},'


def write_wkt(out: BinaryIO, polygons: PolygonSet) -> None:
    """Write one geometry a line for each feature; WKT has no place for ids and properties."""
    texts = feature_texts(polygons, "wkt")
    if texts is not None:
        write_rows(out, [Column("", texts)], RowShape(("", "\n")))
        return
    is_line = polygons.is_line
    for first, last in feature_ranges(polygons):
        bodies = [_body(polygons, index) for index in range(first, last)]
        kinds = ["LINESTRING" if line else "POLYGON" for line in is_line[first:last]]
        if len(bodies) == 1:
            text = f"{kinds[0]} {bodies[0]}"
        elif len(set(kinds)) == 1:
            text = f"MULTI{kinds[0]} ({', '.join(bodies)})"
        else:
            parts = ", ".join(f"{kind} {body}" for kind, body in zip(kinds, bodies, strict=True))
            text = f"GEOMETRYCOLLECTION ({parts})"
        out.write(text.encode() + b"\n")


def _body(polygons: PolygonSet, index: int) -> str:
    rings = []
    for ring in polygons.rings_of(index):
        positions = [f"{coordinate_text(x)} {coordinate_text(y)}" for x, y in ring.tolist()]
        if polygons.is_line[index]:  # of a single vertex it would be no line
            return f"({', '.join(positions * 2 if len(positions) == 1 else positions)})"
        rings.append(f"({', '.join(positions + positions[:1] * max(1, 4 - len(positions)))})")
    return f"({', '.join(rings)})"


_WRITERS: dict[str, Callable[[BinaryIO, PolygonSet], None]] = {
    "json": write_json,
    "geojson": write_geojson,
    "wkt": write_wkt,
}


def write_polygons(out: BinaryIO, polygons: PolygonSet, fmt: str) -> None:
    """Write polygons and lines; polygons are valid on the grid of the file."""
    write = resolved("formats.polygons.poly:write_poly") if fmt == "poly" else _WRITERS[fmt]
    write(out, written_polygons(polygons))


# ---- cells ---------------------------------------------------------------------------------------
def write_cells_json(out: BinaryIO, cells: CellSet) -> None:
    """Write one item a polygon, and one for each empty cell."""
    rows, shapes = rows_of(cells), _written(cells)
    of_cells = shapes.nesting.cells
    sizes = np.maximum(np.diff(of_cells), 1)
    cell = owners(sizes, dtype=np.int32)
    part = within(sizes)
    polygons = np.append(of_cells[cell] + part, of_cells[-1])
    empty = np.diff(of_cells) == 0
    polygons[:-1][empty[cell]] = of_cells[1:][empty]  # an empty row ends where it begins
    table = rows.table(has_ids=False).stored()
    columns = [_looked_up(name, values, cell) for name, values in table.items()]
    around = object_shape([column.name for column in columns], ',"properties":', ",")
    head, opening = [_looked_up("id", rows.names, cell)], ['{"id":']
    if sizes.max(initial=1) > 1:
        head.append(Column.of("part", part + 1))
        opening.append(',"part":')
    shape = RowShape((*opening, *around.around, "}"), ",\n", "null")
    out.write(f'{{"{Y_AXIS}":"{cells.y_axis}","polygons":['.encode())
    columns = [*head, *columns, Column("", shapes.texts("json", polygons))]
    write_list_rows(out, columns, shape)
    out.write(b"]}\n")


def _written(cells: CellSet) -> Any:
    areas = rows_of(cells).geometry
    assert isinstance(areas, Areas)
    return written_areas(areas)


def _looked_up(name: str, values: Any, cell: NDArray[np.int32]) -> Column:
    """The column of the polygons from that of the cells."""
    column = json_column(Column.of(name, values))
    if isinstance(column.values, list):
        missing = None if column.missing is None else column.missing[cell]
        return Column(name, [column.values[i] for i in cell.tolist()], missing)
    whole = column.values[:] if isinstance(column.values, Computed) else column.values
    return Column(name, Lookup(np.asarray(whole), cell), column.missing, column.is_place)


def write_cells_arrays(out: BinaryIO, cells: CellSet) -> None:
    """Write the columns, and what the cells consist of, as NPZ."""
    shapes = _written(cells)
    rings, polygons, of_cells = shapes.nesting
    x, y = np.ascontiguousarray(shapes.points.T)
    arrays = {
        "cell_starts": of_cells,
        "polygon_starts": polygons,
        "ring_starts": rings,
        "vertex_x": x,
        "vertex_y": y,
        "frame": np.array(cells.frame.sides),
        Y_AXIS: np.array([cells.y_axis]),
    }
    write_npz(out, {**rows_of(cells).table().stored(), **arrays})
