from __future__ import annotations

import io

import numpy as np
import pytest
import shapely

from support.families.point_families import draw
from vorotool import cell_colors, delaunay, voronoi_cells
from vorotool.render.canvas.svg import write_layers_svg
from vorotool.render.layers.mesh import cell_lines, cell_page, cell_polygons


@pytest.mark.parametrize("name", ["uniform", "grid", "collinear", "exact_circle"])
def test_neighboring_cells_never_share_a_color(name):
    mesh = delaunay(np.unique(draw(name, 200, 3), axis=0))
    colors = cell_colors(mesh)
    assert colors.min() >= 1
    assert colors.max() <= 6
    shapes = voronoi_cells(mesh).to_shapely()
    a, b = shapely.STRtree(shapes).query(shapes, predicate="touches")
    beside = shapely.length(shapely.intersection(shapes[a], shapes[b])) > 0
    assert beside.any()
    assert (colors[a[beside]] != colors[b[beside]]).all()


def test_lines_are_the_sides_of_cells_each_once():
    cells = voronoi_cells(draw("uniform", 100, 1))
    lines = cell_lines(cells, cell_page(cells))
    ends = cells.coordinates[lines.pairs]
    length = np.hypot(*(ends[:, 0] - ends[:, 1]).T).sum()
    left, bottom, right, top = cells.frame.sides
    assert length == pytest.approx((cells.perimeters.sum() + 2 * (right - left + top - bottom)) / 2)


def test_svg_has_a_path_a_part():
    ring = shapely.box(0, 0, 6, 6).difference(shapely.box(1, 2, 5, 4))
    cells = voronoi_cells([[3, 1], [3, 3], [3, 5], [100, 3]], clip=ring)
    page = cell_page(cells, width=300)
    out = io.BytesIO()
    write_layers_svg(out, [cell_polygons(cells, np.array([1, 2, 1, 3]), page)], page)
    text = out.getvalue().decode()
    for name in ("cell-1", "cell-2-1", "cell-2-2", "cell-3"):
        assert text.count(f'id="{name}"') == 1
    assert text.count("<path") == 4


def test_no_cells_draw_nothing():
    cells = voronoi_cells(np.empty((0, 2)))
    page = cell_page(cells)
    assert len(cell_lines(cells, page).pairs) == 0
    assert len(cell_polygons(cells, np.empty(0, np.uint32), page).corners) == 0
