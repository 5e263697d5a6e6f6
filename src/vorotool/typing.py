"""Types of arguments that have many forms, for annotations of functions that hand them on.

Nothing of this is needed to call the library: any value of one of these forms will do.

Examples
--------
>>> from vorotool.typing import PointsLike
>>> def count(points: PointsLike) -> int:
...     import vorotool
...     return len(vorotool.delaunay(points).points)
>>> count([[0, 0], [4, 0], [0, 3]])
3
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, Literal, Protocol, TypeAlias, runtime_checkable

from numpy.typing import ArrayLike

from vorotool.types.box import Box
from vorotool.types.images import LabelImage, Raster
from vorotool.types.mesh.triangulation import Triangulation
from vorotool.types.points.point_set import PointSet, VolumePoints
from vorotool.types.points.seed_set import SeedSet
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.volumes.volume import LabelVolume, Volume, VolumeSeeds


@runtime_checkable
class HasGeoInterface(Protocol):
    """What gives itself as GeoJSON: geometry of shapely, rows and frames of geopandas, and others."""

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        """A geometry, a feature or a collection."""


@runtime_checkable
class DataFrameLike(Protocol):
    """What has named columns: data frames of pandas and polars."""

    @property
    def columns(self) -> Any:
        """Their names."""

    def __getitem__(self, name: Any, /) -> Any:
        """Give one."""


GeometryLike: TypeAlias = HasGeoInterface | Mapping[str, Any] | str
"""A geometry, or several in one: shapely's, GeoJSON as a dict, WKT."""

PointsLike: TypeAlias = PointSet | ArrayLike | DataFrameLike | GeometryLike | Sequence[GeometryLike]
"""Points: an (n, 2) array or list of pairs, a data frame, geometry of points."""

ImageLike: TypeAlias = Raster | LabelImage | ArrayLike
"""A mask, a label image or gray values: a 2-D array, or what numpy makes one of."""

SeedsLike: TypeAlias = SeedSet | PointsLike | ImageLike
"""Seeds of a tessellation: points or an image."""

VolumeLike: TypeAlias = Volume | LabelVolume | ArrayLike
"""A mask, a label volume or gray values: a 3-D array, or what numpy makes one of."""

VolumePointsLike: TypeAlias = VolumePoints | ArrayLike | DataFrameLike | Mapping[str, Any]
"""Points of space: an (n, 3) array or list of triples x, y, z, or a data frame or mapping with these columns."""

VolumeSeedsLike: TypeAlias = VolumeSeeds | VolumePointsLike | VolumeLike
"""Seeds of the tessellation of a volume: points in space or a volume."""

MeshLike: TypeAlias = Triangulation | SeedsLike
"""Points, or their triangulation, which is used as it is."""

PolygonsLike: TypeAlias = PolygonSet | GeometryLike | Sequence[GeometryLike] | DataFrameLike | ArrayLike
"""Polygons and lines: geometry, an (n, 2) array or list of pairs that is one ring, data frames with geometry."""

ShapesLike: TypeAlias = Skeleton | PolygonsLike
"""Polygons and lines, or their skeleton."""

FrameLike: TypeAlias = Box | Sequence[float] | ArrayLike
"""A box, or its (x, y, width, height)."""

RealLike: TypeAlias = float | Fraction
"""A number, which is taken exactly."""

Spacing: TypeAlias = float | Fraction | Sequence[float | Fraction] | Literal["auto"]
"""The side of a pixel or voxel, or its (height, width), or (depth, height, width)."""

Side: TypeAlias = Literal["interior", "exterior", "both"]
"""Of a skeleton."""

FeaturesChoice: TypeAlias = Literal["separate", "together"]
"""Whether features are looked at one by one."""

OutlineKind: TypeAlias = Literal["crack", "contour"]
"""The line around pixels."""

AlphaRule: TypeAlias = Literal["corrected", "printed"]
"""Which edges an alpha complex has."""

ProximityKind: TypeAlias = Literal["gabriel", "relative", "mst"]
"""Rules by which points are joined."""

Sampling: TypeAlias = Literal["paper", "symmetric"]
"""How edges are sampled for the approximate skeleton."""

Criterion: TypeAlias = Literal["angle", "chord", "scale", "length", "ratio"]
"""What branches are pruned by."""
