from __future__ import annotations

import numpy as np
import pytest
import shapely

from support.families.point_families import draw
from vorotool import cell_colors, delaunay, voronoi_cells
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


def test_no_cells_draw_nothing():
    cells = voronoi_cells(np.empty((0, 2)))
    page = cell_page(cells)
    assert len(cell_lines(cells, page).pairs) == 0
    assert len(cell_polygons(cells, np.empty(0, np.uint32), page).corners) == 0
