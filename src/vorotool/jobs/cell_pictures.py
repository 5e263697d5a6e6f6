"""Pictures of Voronoi cells alone, without what they are cells of."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

from vorotool.engines.delaunay.cells import cell_colors
from vorotool.engines.delaunay.delaunay import delaunay
from vorotool.errors import VorotoolWarning
from vorotool.render.canvas.layers import Layer, Page, Points
from vorotool.render.label_images.png import checked_layers
from vorotool.render.layers.cells import cell_lines, cell_polygons, cells_page
from vorotool.render.layers.mesh import site_names
from vorotool.types.mesh.cells import CellSet

cell_page = cells_page


def cell_layers(cells: CellSet, page: Page, layers: Sequence[str]) -> list[Layer]:
    """Make layers of cells, in colors that neighbors never share, which their triangulation tells."""
    wanted = checked_layers(layers, ("cells", "diagram", "points", "labels"))
    made: list[Layer] = []
    if "cells" in wanted:
        with warnings.catch_warnings():  # that points lie on others was said where the cells were made
            warnings.simplefilter("ignore", VorotoolWarning)
            mesh = delaunay(cells.sites)
        made.append(cell_polygons(cells, cell_colors(mesh), page))
    if "diagram" in wanted:
        made.append(cell_lines(cells, page))
    if "points" in wanted:
        made.append(Points("points", cells.sites, radius=min(max(page.spacing(len(cells)) / 12, 0.3), 4.0)))
    if "labels" in wanted:
        made.append(site_names(cells, page))
    return made
