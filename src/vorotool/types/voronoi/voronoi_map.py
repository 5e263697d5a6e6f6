"""The Voronoi diagram of points, lines and polygons: a planar map of cells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats, owners
from vorotool.numeric.curves.mixed_arcs import MixedArcs
from vorotool.products.formats import resolved
from vorotool.types import fields as f
from vorotool.types.box import extent_sides
from vorotool.types.fields import record
from vorotool.types.identity import feature_labels, other_columns
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.table import Table
from vorotool.types.values import Curved, Graph, Pictured, Tabular, Value, counted

if TYPE_CHECKING:
    import pandas

    from vorotool.types.features import Rows

OUTSIDE = -1
"""The site of what belongs to no cell: the far side of the frame, or of another cut."""

_TABLES = "types.voronoi.tables"


@record
class VoronoiMap(Value, Tabular, Curved, Graph, Pictured):
    """Voronoi cells of sites in a frame: the points nearest to each site, at distance 0 inside its polygons.

    Of sites that are equally near to a whole region the smallest has it. Cells are bounded by arcs, straight lines,
    parabolas or circular ones, which two cells share, or a cell and what belongs to none. Each arc leads from the
    vertex with the smaller number to the other one.

    Parameters
    ----------
    vertices : (v, 2) float64 array
        Where arcs end, in input units: those inside, then those along the frame.
    radius : (v,) float64 array
        Distance of a vertex from the nearest sites; NaN at corners of the frame at which no border ends, and on
        enclosures.
    arcs : (a, 2) int32 array
        Source and target, the first below the second.
    sites : (a, 2) int32 array
        Left and right, from source to target; -1 of what belongs to no cell.
    control : (a, 2) float64 array
        Control point of a quadratic Bezier curve, which each parabola is; NaN of other arcs.
    center : (a, 2) float64 array
        Of the circle of each circular arc, a place of the site on its inner side: counter-clockwise around it where
        that is on the left, else clockwise; NaN of other arcs.
    is_cut : (a,) bool array
        Whether each arc is along the frame, the clip, the limit of distance or an enclosure, instead of where two
        sites are equally near.
    ring_arcs : (k,) int32 array
        The arcs along each ring, counted from 1, below 0 against their direction. The cell is on the left: shells go
        counter-clockwise, holes clockwise.
    ring_starts : (r + 1,) int64 array
        Where each ring begins in `ring_arcs`.
    polygon_starts : (q + 1,) int64 array
        The first ring of each polygon, its shell, and r.
    cell_starts : (s + 1,) int64 array
        The first polygon of each cell, and q. Cell i is of site i; it may be empty, or of several polygons.
    frame : (x, y, w, h)
        The rectangle that cells were cut by; with a clip or enclosures the bounds of the divided area.
    polygons : PolygonSet
        The input; points are lines of one vertex.
    polygon_site : (p,) int32 array
        The site that each polygon is a part of.
    ids : list, optional
        The input's name of each site, or the value that its features were joined by.
    properties : dict of str to list
        Other columns of the input, one value per site.
    index : pandas Index, array or sequence, optional
        Names of the sites in the input, such as the row index of a data frame.
    max_distance : float, optional
        The limit of distance: places farther from all sites belong to none.
    clip : PolygonSet, optional
        Polygons that cells were clipped to as well.
    enclosures : PolygonSet, optional
        Lines and polygons whose faces were partitioned separately.

    Raises
    ------
    InputError
        If an array has another shape.

    Examples
    --------
    >>> from vorotool import voronoi
    >>> cells = voronoi([[0, 0], [4, 0], [0, 4]], frame=(-2, -2, 8, 8))
    >>> cells.areas.tolist(), len(cells), cells.edges["length"].tolist()[:1]
    ([16.0, 24.0, 24.0], 3, [4.0])
    """

    maker = "voronoi"
    _plain = "shapes"

    vertices: Floats = f.position("vertices", 2)
    radius: Floats = f.length("vertices")
    arcs: NDArray[np.int32] = f.index("arcs", 2)
    sites: NDArray[np.int32] = f.index("arcs", 2)
    control: Floats = f.position("arcs", 2)
    center: Floats = f.position("arcs", 2)
    is_cut: NDArray[np.bool_] = f.numbers(np.bool_, "arcs")
    ring_arcs: NDArray[np.int32] = f.index("ring_arcs")
    ring_starts: NDArray[np.int64] = f.starts("rings", "ring_arcs", least=1)
    polygon_starts: NDArray[np.int64] = f.starts("shapes", "rings", least=1)
    cell_starts: NDArray[np.int64] = f.starts("cells", "shapes")
    frame: tuple[float, float, float, float] = f.position()
    max_distance: float | None = f.length(default=None, kw_only=True)
    clip: PolygonSet | None = f.nested(default=None, kw_only=True)
    enclosures: PolygonSet | None = f.nested(default=None, kw_only=True)
    polygons: PolygonSet = f.nested("polygons")
    polygon_site: NDArray[np.int32] = f.index("polygons")
    ids: Sequence[Any] | None = None
    properties: dict[str, Any] = field(default_factory=dict)
    index: Any = None

    def __len__(self) -> int:
        """Return the number of cells, empty ones too."""
        return len(self.cell_starts) - 1

    @cached_property
    def labels(self) -> NDArray[np.int64]:
        """(s,) label of each cell: what its column ``label`` holds, else its number from 1."""
        return feature_labels(np.arange(len(self)), self.properties)

    @cached_property
    def other_columns(self) -> dict[str, Any]:
        """The properties without the column that holds the labels."""
        return other_columns(self.properties, self.labels)

    @cached_property
    def is_parabola(self) -> NDArray[np.bool_]:
        """(a,) whether each arc is a parabola."""
        return ~np.isnan(self.control[:, 0])

    @cached_property
    def is_circle(self) -> NDArray[np.bool_]:
        """(a,) whether each arc is a circular one."""
        return ~np.isnan(self.center[:, 0])

    @cached_property
    def is_border(self) -> NDArray[np.bool_]:
        """(a,) whether each arc is between two cells; others are cuts."""
        return (self.sites != OUTSIDE).all(axis=1)

    @cached_property
    def mixed_arcs(self) -> MixedArcs:
        """Arcs with their ends, for measures and polylines."""
        source, target = self.vertices[self.arcs[:, 0]], self.vertices[self.arcs[:, 1]]
        return MixedArcs(source, target, self.control, self.center, self.sites[:, 0] != OUTSIDE)

    @cached_property
    def length(self) -> Floats:
        """(a,) lengths of the arcs."""
        return self.mixed_arcs.lengths

    @cached_property
    def cell_of_polygon(self) -> NDArray[np.int64]:
        """(q,) the cell that each polygon is of."""
        return owners(np.diff(self.cell_starts))

    @cached_property
    def is_hole(self) -> NDArray[np.bool_]:
        """(r,) whether each ring is a hole."""
        is_hole = np.ones(len(self.ring_starts) - 1, dtype=bool)
        is_hole[self.polygon_starts[:-1]] = False
        return is_hole

    @cached_property
    def areas(self) -> Floats:
        """(s,) areas of the cells, with the true curves."""
        x, y, w, h = self.frame
        center = np.array([x + w / 2, y + h / 2])
        beside = self.mixed_arcs.areas_beside(center)
        total = np.zeros(len(self))
        for hand, sign in ((0, 1), (1, -1)):
            inner = self.sites[:, hand] != OUTSIDE
            total += sign * np.bincount(self.sites[inner, hand], beside[inner], minlength=len(self))
        return total

    @cached_property
    def perimeters(self) -> Floats:
        """(s,) lengths of the boundaries of the cells, cuts included."""
        total = np.zeros(len(self))
        for hand in (0, 1):
            inner = self.sites[:, hand] != OUTSIDE
            total += np.bincount(self.sites[inner, hand], self.length[inner], minlength=len(self))
        return total

    @cached_property
    def own_areas(self) -> Floats:
        """(s,) areas of the site's own polygons that cells have; see `vorotool.engines.voronoi.voronoi.own_areas`."""
        return resolved("engines.voronoi.voronoi:own_areas")(self)

    @cached_property
    def reaches(self) -> Floats:
        """(s,) largest distances of cells from their sites; see `vorotool.engines.voronoi.voronoi.reaches`."""
        return resolved("engines.voronoi.voronoi:reaches")(self)

    @cached_property
    def components(self) -> NDArray[np.int64]:
        """(s,) number of polygons of each cell."""
        return np.diff(self.cell_starts)

    @property
    def edges(self) -> Table:
        """Table of the borders between cells; see `vorotool.types.voronoi.tables.border_table`."""
        return resolved(f"{_TABLES}:border_table")(self)

    @property
    def neighbors(self) -> Table:
        """Pairs of cells that share a border; see `vorotool.types.voronoi.tables.neighbor_table`."""
        return resolved(f"{_TABLES}:neighbor_table")(self)

    def table(self) -> Table:
        """Table with one row per cell; see `vorotool.types.voronoi.tables.cell_table`."""
        return resolved(f"{_TABLES}:cell_table")(self)

    def to_adjacency(self) -> pandas.DataFrame:
        """Return the pairs of neighbors in the format of libpysal; pandas must be installed.

        ``libpysal.graph.Graph.from_adjacency(cells.to_adjacency())`` is their graph, with the names of the rows of
        `to_geopandas`.

        Returns
        -------
        pandas.DataFrame
            ``focal, neighbor, weight``: each pair both ways, by what the input's index calls them, else by numbers from
            0, with the length of its border; a cell without neighbors once, with itself and the weight 0.

        Raises
        ------
        UsageError
            If pandas is not installed.

        Examples
        --------
        >>> from vorotool import voronoi
        >>> voronoi([[0, 0], [4, 0]], frame=(0, 0, 4, 2)).to_adjacency().values.tolist()
        [[0.0, 1.0, 2.0], [1.0, 0.0, 2.0]]
        """
        return resolved("convert.frames:adjacency")(self)

    def rings_of(self, cell: int) -> list[list[NDArray[np.int32]]]:
        """Return the arcs along the rings of each polygon of a cell."""
        polygons = range(*self.cell_starts[cell : cell + 2].tolist())
        return [
            [
                self.ring_arcs[self.ring_starts[ring] : self.ring_starts[ring + 1]]
                for ring in range(*self.polygon_starts[polygon : polygon + 2].tolist())
            ]
            for polygon in polygons
        ]

    def _rows(self, what: str | None = None) -> Rows | None:
        return resolved(f"{_TABLES}:map_rows")(self, what)

    def _features(self, what: str | None = None, flatten: float | None = None) -> Rows:
        return resolved("types.voronoi.tables:map_features")(self, what, flatten)

    def _shown_places(self) -> list[Floats]:
        return [np.array(extent_sides(self.frame)).reshape(2, 2)]

    def _summary(self) -> str:
        sizes = (
            counted(len(self), "cell"),
            counted(len(self.arcs), "arc"),
            counted(len(self.vertices), "vertex", "vertices"),
        )
        return ", ".join(sizes)
