"""What values of the library have in common: how they compare, what they say of themselves, and what they turn into.

Methods are here, so that each type has them where it is defined; what they do is in rooms above, which are loaded by
name when a method is called.
"""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from numpy.typing import NDArray

from vorotool.numeric.arrays import Floats
from vorotool.numeric.checks import is_equal
from vorotool.numeric.crs import crs_name
from vorotool.products.formats import resolved
from vorotool.types.fields import UNSTATED, Record, YAxis
from vorotool.types.pixels import Elements

if TYPE_CHECKING:
    import geopandas
    import networkx
    import pandas
    from matplotlib.axes import Axes

    from vorotool.numeric.numbers import Flatten
    from vorotool.types.table import Table

_GEOMETRY = "convert.frames:geometry_of"
_FRAMES = "convert.frames"
_SHOWING = "render.showing"


_MADE_OF = ("path", "skeleton", "shape", "necks", "family", "mesh", "polygons")
"""Names of fields with what a value is made of."""


class Value(Record):
    """A value: equal to another one of its type if all fields are; like an array it is no key of a dictionary."""

    maker: ClassVar[str] = ""
    """The function of the library that makes one, for messages."""

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return False  # an index of pandas would be asked next, and compare all of its entries
        names = (each.name for each in fields(self) if each.compare)  # type: ignore[arg-type]  # all are dataclasses
        return self is other or all(is_equal(getattr(self, name), getattr(other, name)) for name in names)

    __hash__ = None  # type: ignore[assignment]  # what compares by the elements of arrays has no hash that lasts

    @property
    def _made_of(self) -> object:
        """The value whose coordinates these are, if it is not this one."""
        held = (getattr(self, name, None) for name in _MADE_OF)
        return next((each for each in held if isinstance(each, Value)), None)

    @property
    def y_axis(self) -> YAxis:
        """Direction of y where the coordinates come from."""
        return getattr(self._made_of, "y_axis", UNSTATED)

    @property
    def crs(self) -> Any:
        """The ``crs`` member of GeoJSON; None where the input has none."""
        return getattr(self._made_of, "crs", None)

    @property
    def unit(self) -> str | None:
        """The unit of length of the coordinates; None where the input has none."""
        return getattr(self._made_of, "unit", None)

    def __repr__(self) -> str:
        words = self._summary(), None if self.crs is None else crs_name(self.crs), self.unit
        return f"{type(self).__name__}: {', '.join(filter(None, words))}"

    def _shown_places(self) -> list[Floats]:
        """Return places that bound the picture of it: by default those of what it was made of, else its points."""
        made_of = self._made_of
        return made_of._shown_places() if isinstance(made_of, Value) else [self.points]  # type: ignore[attr-defined]

    def _summary(self) -> str:
        """Words for what it holds, on one line, found without going through it; its map and unit follow."""
        raise NotImplementedError


def input_of(value: Any) -> Any:
    """Return what a value was made of in the end, which has the columns and the reference system of the input."""
    inner = value._made_of if isinstance(value, Value) else None
    return value if inner is None else input_of(inner)


class Tabular:
    """A value with a table."""

    def table(self) -> Table:
        """Return the table.

        Returns
        -------
        Table
            One row an object, such as an edge of a triangulation, a region of a label image, or an arc of a skeleton;
            fields that do not exist are masked, None, or NaN.

        Examples
        --------
        >>> import vorotool
        >>> vorotool.skeleton_exact([[0, 0], [4, 0], [0, 3]]).table()["kind"].tolist()
        ['line', 'line', 'line']
        """
        return resolved("types.features:rows_of")(self).table()

    def to_pandas(self) -> pandas.DataFrame:
        """Return the table as a data frame, which needs pandas.

        Returns
        -------
        pandas.DataFrame
            The columns of the table. Rows that come from rows of the input have its index; where a row of
            the input has several, its entry is repeated. Integers of which some do not exist are of type ``Int64``.

        Raises
        ------
        UsageError
            If pandas is not installed.

        Examples
        --------
        >>> import vorotool
        >>> vorotool.delaunay([[0, 0], [4, 0], [0, 3]]).to_pandas()["length"].tolist()
        [3.0, 4.0, 5.0]
        """
        return resolved(f"{_FRAMES}:to_pandas")(self)


class _Places:
    """A value with places in the plane."""

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        """A feature collection of GeoJSON, as many libraries take it."""
        return resolved("jobs.writing:feature_collection")(self)


class Geometric(_Places):
    """A value with one kind of geometry."""

    def to_shapely(self) -> NDArray[Any]:
        """Return the geometry of each row, in order.

        Returns
        -------
        (n,) array of shapely geometry
            In the coordinates of the input; of a label image on a map, in those of the map.

        Examples
        --------
        >>> import vorotool
        >>> vorotool.PointSet([[2, 1], [7, 5]]).to_shapely()[1].wkt
        'POINT (7 5)'
        """
        return resolved(_GEOMETRY)(self)

    def to_geopandas(self) -> geopandas.GeoDataFrame:
        """Return the geometry and the columns that go with it, which needs geopandas.

        Returns
        -------
        geopandas.GeoDataFrame
            With the coordinate reference system, the index and the columns of the input, if it had them. Where a row of
            the input has several rows, its entry of the index is repeated.

        Raises
        ------
        UsageError
            If geopandas is not installed.

        Examples
        --------
        >>> import vorotool
        >>> points = vorotool.PointSet([[2, 1], [7, 5]], properties={"name": ["a", "b"]})
        >>> points.to_geopandas()["name"].tolist()
        ['a', 'b']
        """
        return resolved(f"{_FRAMES}:to_geopandas")(self)


class WithParts(_Places):
    """A value of which each part has geometry of its own."""

    def to_shapely(self, *, what: str | None = None) -> NDArray[Any]:
        """Return the geometry of each row of a part, in order.

        Parameters
        ----------
        what : str, optional
            The part: of triangulations ``triangles``, ``edges`` or ``points``, of alpha shapes ``polygons``, ``edges``
            or ``points``, of points along skeletons ``points`` or ``transects``; by default the first.

        Returns
        -------
        (n,) array of shapely geometry
            In the coordinates of the input.

        Raises
        ------
        UsageError
            If it has no such part.

        Examples
        --------
        >>> import vorotool
        >>> mesh = vorotool.delaunay([[0, 0], [4, 0], [0, 3]])
        >>> mesh.to_shapely()[0].area, len(mesh.to_shapely(what="edges"))
        (6.0, 3)
        """
        return resolved(_GEOMETRY)(self, what)

    def to_geopandas(self, *, what: str | None = None) -> geopandas.GeoDataFrame:
        """Return the geometry of a part and the columns that go with it, which needs geopandas.

        Parameters
        ----------
        what : str, optional
            As of `to_shapely`.

        Returns
        -------
        geopandas.GeoDataFrame
            With the coordinate reference system of the input, and where rows come from rows of the input, with its
            index and columns.

        Raises
        ------
        UsageError
            If it has no such part, or geopandas is not installed.

        Examples
        --------
        >>> import vorotool
        >>> vorotool.delaunay([[0, 0], [4, 0], [0, 3]]).to_geopandas(what="edges")["length"].tolist()
        [3.0, 4.0, 5.0]
        """
        return resolved(f"{_FRAMES}:to_geopandas")(self, what)


class Curved(_Places):
    """A value of curves, which are flattened where there are none."""

    _plain: ClassVar[str | None] = None
    """The part of which rows have the same geometry, and no columns."""

    def to_shapely(self, *, flatten: Flatten = None) -> NDArray[Any]:
        """Return the geometry of each row, in order, with lines instead of curves.

        Parameters
        ----------
        flatten : float or "auto", optional
            How far lines may be from curves; by default, or with "auto", as of `vorotool.to_geojson`.

        Returns
        -------
        (n,) array of shapely geometry
            In the coordinates of the input.

        Raises
        ------
        InputError
            If the tolerance is not positive.
        UsageError
            If it is no number.

        Examples
        --------
        >>> import vorotool
        >>> vorotool.offset([[0, 0], [4, 0], [4, 2], [0, 2]], [-0.5]).to_shapely()[0].area
        3.0
        """
        return resolved(_GEOMETRY)(self, self._plain, flatten=flatten)

    def to_geopandas(self, *, flatten: Flatten = None) -> geopandas.GeoDataFrame:
        """Return the geometry and the columns that go with it, which needs geopandas.

        Parameters
        ----------
        flatten : float, optional
            As of `to_shapely`.

        Returns
        -------
        geopandas.GeoDataFrame
            With the coordinate reference system of the input, and the index and the columns of the polygon that each
            row comes from.

        Raises
        ------
        InputError
            If the tolerance is not positive.
        UsageError
            If it is no number, or geopandas is not installed.

        Examples
        --------
        >>> import vorotool
        >>> vorotool.offset([[0, 0], [4, 0], [4, 2], [0, 2]], [-0.5]).to_geopandas()["distance"].tolist()
        [-0.5]
        """
        return resolved(f"{_FRAMES}:to_geopandas")(self, flatten=flatten)


class Branched(_Places):
    """A value of arcs, which follow each other in branches."""

    def to_shapely(self, *, by: Literal["arc", "branch"] = "arc", flatten: Flatten = None) -> NDArray[Any]:
        """Return each arc or branch as a line, in order.

        Parameters
        ----------
        by : {"arc", "branch"}
            What a line is.
        flatten : float or "auto", optional
            How far lines may be from parabolas; by default, or with "auto", as of `vorotool.to_geojson`.

        Returns
        -------
        (n,) array of shapely geometry
            In the coordinates of the input.

        Raises
        ------
        InputError
            If the tolerance is not positive.
        UsageError
            If it is no number, or a line is to be something else.

        Examples
        --------
        >>> import vorotool
        >>> vorotool.skeleton_exact([[0, 0], [4, 0], [4, 4], [0, 4]]).to_shapely()[0].wkt
        'LINESTRING (0 0, 2 2)'
        """
        return resolved(_GEOMETRY)(self, by, flatten=flatten)

    def to_geopandas(self, *, by: Literal["arc", "branch"] = "arc", flatten: Flatten = None) -> geopandas.GeoDataFrame:
        """Return each arc or branch as a line with its columns, which needs geopandas.

        Parameters
        ----------
        by, flatten : optional
            As of `to_shapely`.

        Returns
        -------
        geopandas.GeoDataFrame
            With the coordinate reference system of the input, and the index and the columns of the polygon that each
            line is in.

        Raises
        ------
        InputError
            If the tolerance is not positive.
        UsageError
            If it is no number, a line is to be something else, or geopandas is not installed.

        Examples
        --------
        >>> import vorotool
        >>> vorotool.skeleton_exact([[0, 0], [4, 0], [4, 4], [0, 4]]).to_geopandas()["r_max"].tolist()
        [2.0, 2.0, 2.0, 2.0]
        """
        return resolved(f"{_FRAMES}:to_geopandas")(self, by, flatten=flatten)

    def to_networkx(
        self, *, by: Literal["branch", "arc"] = "branch", flatten: Flatten = None
    ) -> networkx.MultiGraph[int]:
        """Return the graph as a networkx graph; networkx must be installed.

        Parameters
        ----------
        by : {"branch", "arc"}
            What an edge is.
        flatten : float or "auto", optional
            How far the geometry of edges may be from parabolas.

        Returns
        -------
        networkx.MultiGraph
            Undirected, with ``crs`` if the input had one. Nodes are numbers of vertices, with ``x``, ``y``, the radius
            ``r`` and the ``degree``. Edges have the number of their branch or arc for a key, and ``branch`` (also
            ``arc``), ``label``, ``id``, ``side``, ``kind``, ``length``, ``r_min``, ``r_max``, ``r_mean``, those that
            are branches ``type`` and ``tortuosity`` as `branch_table` has them, and ``geometry``, a shapely
            LineString; the properties of the polygon, too. A closed branch joins a node with itself. Missing values
            are left out.

        Raises
        ------
        UsageError
            If networkx is not installed, an edge is to be something else, or the tolerance is not positive.

        Examples
        --------
        >>> import vorotool
        >>> len(vorotool.skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]]).to_networkx())
        6
        """
        return resolved("convert.frames:to_networkx")(self, by=by, flatten=flatten)


class Graph:
    """A value that is a graph, or has one."""

    def to_networkx(self) -> networkx.Graph[int]:
        """Return the graph as a networkx graph; networkx must be installed.

        Returns
        -------
        networkx.Graph
            Undirected, with ``crs`` if the input had one; missing values are left out of the attributes. Triangulation:
            nodes are numbers of points, from 0, with ``x``, ``y``, ``label`` and the properties, edges have ``length``.
            Label image or volume: nodes are labels, with the columns of the table, edges join neighbors, with those of
            `neighbor_table`. Planar graph: nodes are numbers of its points, with ``x`` and ``y``, edges have
            ``segment``, ``length``, ``face_left`` and ``face_right``. Voronoi map: nodes are numbers of its cells, from
            0, with the columns of its table, edges join neighbors, with ``border_length`` and ``distance``.

        Raises
        ------
        UsageError
            If networkx is not installed.

        Examples
        --------
        >>> import vorotool
        >>> vorotool.delaunay([[0, 0], [4, 0], [0, 3]]).to_networkx().edges[0, 1]["length"]
        4.0
        """
        return resolved("convert.frames:to_networkx")(self)


class Pictured:
    """A value that there is a picture of."""

    def plot(self, ax: Axes | None = None, **style: Any) -> Axes:
        """Draw the value with matplotlib, in the colors of vorotool's pictures and in data coordinates.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; by default axes of a new figure.
        **style
            What matplotlib takes for collections of lines and polygons, or for images, such as ``alpha``; and ``what``
            and ``layers``, as of `vorotool.write`, where the value has them.

        Returns
        -------
        matplotlib.axes.Axes
            With equal scales (longitudes by the cosine of the middle latitude) and y as in our pictures.

        Raises
        ------
        UsageError
            If matplotlib is not installed, or there is no such part or layer.

        Examples
        --------
        >>> from matplotlib.figure import Figure
        >>> import vorotool
        >>> axes = vorotool.delaunay([[0, 0], [4, 0], [0, 3]]).plot(Figure().add_subplot())
        >>> [collection.get_label() for collection in axes.collections]
        ['edges', 'points']
        """
        return resolved(f"{_SHOWING}:plotted")(self, ax, **style)

    def _repr_svg_(self) -> str | None:
        """The picture that notebooks show; None of what has too many elements."""
        return resolved(f"{_SHOWING}:svg_of")(self)

    def _repr_html_(self) -> str | None:
        """A picture as pixels with one line below, where there is none as SVG."""
        return resolved(f"{_SHOWING}:html_of")(self)


class Pixels(Pictured, Elements):
    """A value that is an image."""

    grid: Any

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self._array().shape[:2]

    @property
    def crs(self) -> Any:
        """The ``crs`` member of GeoJSON for the map that the image lies on; None without one."""
        return None if self.grid is None else self.grid.crs


def counted(number: int, noun: str, several: str | None = None) -> str:
    """Return a number with its noun."""
    return f"{number} {noun if number == 1 else several or noun + 's'}"
