"""Writing Voronoi cells: one feature a site, in the order of the input."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.formats.text.feature_collection import write_collection
from vorotool.formats.text.row_writer import Column, RowShape, write_list_rows, write_rows
from vorotool.formats.text.tables import json_column, json_text, object_shape, write_npz, write_table
from vorotool.formats.written.report import report_emptied
from vorotool.formats.written.rings import written_rings
from vorotool.geometry.coordinate_grid import current_decimals, on_grid
from vorotool.geometry.mesh.cells import CellSet, Nesting
from vorotool.geometry.ragged import owners, within
from vorotool.geometry.table import Computed, Lookup, Table
from vorotool.types.axis import MEMBER as Y_AXIS
from vorotool.types.axis import UNSTATED, YAxis


def write_cells(out: BinaryIO, cells: CellSet, fmt: str, *, precision: int | None = None, threads: int = 0) -> None:
    """Write cells; the bytes depend on nothing but the cells, the format and the precision."""
    if fmt in _WRITERS:
        _WRITERS[fmt](out, cells, precision, threads)
    else:
        write_shapes(out, _shapes_of(cells), fmt, precision=precision, threads=threads)


@dataclass(frozen=True, eq=False)
class CellShapes:
    """Cells as polygons, and what is known of each."""

    columns: Mapping[str, Any]  # ours, the label first
    properties: Mapping[str, Any]  # those of the input
    # (k, 2) float64 array: vertices, ring after ring, the first of each not repeated
    coordinates: NDArray[np.float64]
    nesting: Nesting  # where rings, polygons and cells begin
    ids: Sequence[Any] | None = None  # names of the features; by default the property `id`, else labels
    crs: Any = None  # the `crs` member of GeoJSON
    y_axis: YAxis = UNSTATED

    def texts(self, style: str, rows: NDArray[np.int64] | None = None) -> Computed:
        """The column of the cells' polygons, or that of other rows of polygons."""
        rings, polygons, of_cells = self.nesting
        starts = of_cells if rows is None else rows

        def texts(part: slice) -> Any:
            begin, end, _ = part.indices(len(starts) - 1)
            own = _core.text.PolygonStyle[style]
            return _core.text.PolygonTexts(self.coordinates, rings, polygons, starts[begin : end + 1], own)

        return Computed(texts, len(starts) - 1)

    def table(self, shapes: Computed | None = None) -> Table:
        """Our columns, with shapes their ids and WKT, too, and the input's own, before which ours take a prefix."""
        ours = dict(self.columns)
        if shapes is not None:
            names = {} if self.ids is None else {"id": list(self.ids)}
            ours = {"label": ours.pop("label"), **names, **ours, "wkt": shapes}
        return Table(ours).with_properties(self.properties)


def write_shapes(out: BinaryIO, cells: CellShapes, fmt: str, *, precision: int | None = None, threads: int = 0) -> None:
    """Write cells as GeoJSON, as WKT, or as a table with a column of WKT."""
    if fmt == "geojson":
        _write_geojson(out, cells, precision, threads)
    elif fmt == "wkt":
        shape = RowShape(("", "\n"), "", "POLYGON EMPTY")
        write_rows(out, [Column("", cells.texts("wkt"))], shape, precision=precision, threads=threads)
    else:
        table = cells.table(cells.texts("wkt"))
        write_table(out, table, fmt, precision=precision, threads=threads)


def _shapes_of(cells: CellSet) -> CellShapes:
    """Label and place of the sites are our columns."""
    x, y = np.ascontiguousarray(on_grid(cells.sites).T)
    columns = {"label": cells.label_array, "x": x, "y": y}
    made = written_cells(cells.coordinates, cells.nesting, in_box=cells.polygon_starts is None)
    return CellShapes(columns, cells.properties, *made, crs=cells.crs, y_axis=cells.y_axis)


def written_cells(
    points: NDArray[np.float64], nesting: Nesting, *, in_box: bool = False
) -> tuple[NDArray[np.float64], Nesting]:
    """Round the vertices of cells to the decimals of the file, where they are a valid coverage."""
    made = written_rings(points, nesting, decimals=current_decimals(), is_coverage=True, in_box=in_box)
    report_emptied(made.emptied, "cell")
    return made.points, made.nesting


def _write_geojson(out: BinaryIO, cells: CellShapes, precision: int | None, threads: int) -> None:
    table = cells.table().stored()
    ids = cells.ids if cells.ids is not None else table.pop("id", None)
    columns = [json_column(Column.of(name, values), precision) for name, values in table.items()]
    around = object_shape([column.name for column in columns], '"properties":', ',"geometry":').around
    if ids is None:
        head, opening = Column.of("id", cells.columns["label"]), ('{"type":"Feature","id":', "," + around[0])
    else:  # a feature may have none
        texts = ["" if value is None else f'"id":{json_text(value)},' for value in ids]
        head, opening = Column("id", texts), ('{"type":"Feature",', around[0])
    shape = RowShape((*opening, *around[1:], "}"), ",\n", "null")
    columns = [head, *columns, Column("", cells.texts("geojson"))]
    write_collection(out, columns, shape, crs=cells.crs, y_axis=cells.y_axis, precision=precision, threads=threads)


def _write_json(out: BinaryIO, cells: CellSet, precision: int | None, threads: int) -> None:
    """One item a polygon, and one for each empty cell."""
    shapes = _shapes_of(cells)
    of_cells = shapes.nesting.cells
    sizes = np.maximum(np.diff(of_cells), 1)
    cell = owners(sizes, dtype=np.int32)
    part = within(sizes)
    rows = np.append(of_cells[cell] + part, of_cells[-1])
    empty = np.diff(of_cells) == 0
    rows[:-1][empty[cell]] = of_cells[1:][empty]  # an empty row ends where it begins
    table = shapes.table().stored()
    ids = table.pop("id", cells.label_array)
    columns = [_looked_up(name, values, cell, precision) for name, values in table.items()]
    around = object_shape([column.name for column in columns], ',"properties":', ",")
    head, opening = [_looked_up("id", ids, cell, precision)], ['{"id":']
    if sizes.max(initial=1) > 1:
        head.append(Column.of("part", part + 1))
        opening.append(',"part":')
    shape = RowShape((*opening, *around.around, "}"), ",\n", "null")
    out.write(f'{{"{Y_AXIS}":"{cells.y_axis}","polygons":['.encode())
    columns = [*head, *columns, Column("", shapes.texts("json", rows))]
    write_list_rows(out, columns, shape, precision=precision, threads=threads)
    out.write(b"]}\n")


def _looked_up(name: str, values: Any, cell: NDArray[np.int32], precision: int | None) -> Column:
    """The column of the polygons from that of the cells."""
    column = json_column(Column.of(name, values), precision)
    if isinstance(column.values, list):
        missing = None if column.missing is None else column.missing[cell]
        return Column(name, [column.values[i] for i in cell.tolist()], missing)
    return Column(name, Lookup(np.asarray(column.values), cell), column.missing)


def _write_npz(out: BinaryIO, cells: CellSet, _precision: int | None, threads: int) -> None:
    shapes = _shapes_of(cells)
    rings, polygons, of_cells = shapes.nesting
    x, y = np.ascontiguousarray(shapes.coordinates.T)
    arrays = {
        **shapes.table().stored(),
        "cell_starts": of_cells,
        "polygon_starts": polygons,
        "ring_starts": rings,
        "vertex_x": x,
        "vertex_y": y,
        "frame": np.array(cells.frame.sides),
        Y_AXIS: np.array([cells.y_axis]),
    }
    write_npz(out, [Column.of(name, values) for name, values in arrays.items()], threads)


_WRITERS: dict[str, Callable[[BinaryIO, CellSet, int | None, int], None]] = {"json": _write_json, "npz": _write_npz}
