"""Voronoi cells of points in JSON and as arrays."""

from __future__ import annotations

from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from vorotool.formats.results.geometry_text import written_areas
from vorotool.formats.text.row_writer import Column, RowShape, write_list_rows
from vorotool.formats.text.tables import json_column, object_shape, placed_column, write_npz
from vorotool.numeric.ragged import owners, within
from vorotool.types.axis import MEMBER as Y_AXIS
from vorotool.types.features import Areas, rows_of
from vorotool.types.mesh.cells import CellSet
from vorotool.types.table import Computed, Lookup


def write_json(out: BinaryIO, cells: CellSet, *, precision: int | None = None, threads: int = 0) -> None:
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
    columns = [_looked_up(name, values, cell, precision) for name, values in table.items()]
    around = object_shape([column.name for column in columns], ',"properties":', ",")
    head, opening = [_looked_up("id", rows.names, cell, precision)], ['{"id":']
    if sizes.max(initial=1) > 1:
        head.append(Column.of("part", part + 1))
        opening.append(',"part":')
    shape = RowShape((*opening, *around.around, "}"), ",\n", "null")
    out.write(f'{{"{Y_AXIS}":"{cells.y_axis}","polygons":['.encode())
    columns = [*head, *columns, Column("", shapes.texts("json", polygons))]
    write_list_rows(out, columns, shape, precision=precision, threads=threads)
    out.write(b"]}\n")


def _written(cells: CellSet) -> Any:
    areas = rows_of(cells).geometry
    assert isinstance(areas, Areas)
    return written_areas(areas)


def _looked_up(name: str, values: Any, cell: NDArray[np.int32], precision: int | None) -> Column:
    """The column of the polygons from that of the cells."""
    column = json_column(placed_column(Column.of(name, values)), precision)
    if isinstance(column.values, list):
        missing = None if column.missing is None else column.missing[cell]
        return Column(name, [column.values[i] for i in cell.tolist()], missing)
    whole = column.values[:] if isinstance(column.values, Computed) else column.values
    return Column(name, Lookup(np.asarray(whole), cell), column.missing, column.is_place)


def write_arrays(out: BinaryIO, cells: CellSet, *, threads: int = 0) -> None:
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
    table = rows_of(cells).table().stored()
    columns = [placed_column(Column.of(name, values)) for name, values in table.items()]
    write_npz(out, [*columns, *(Column.of(name, values) for name, values in arrays.items())], threads)
