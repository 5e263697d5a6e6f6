"""Points, polygons and lines of files of features, whatever their format."""

from __future__ import annotations

from vorotool.convert.sites import Sites
from vorotool.formats.gis.feature_table import (
    Features,
    feature_points,
    polygons_of_features,
    sites_of_features,
)
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.reader_options import ReadOptions
from vorotool.formats.points.columns import PointRows, point_set
from vorotool.formats.points.tables import rows_of_columns
from vorotool.products.formats import resolved
from vorotool.products.inputs import INPUTS
from vorotool.types.points.point_set import PointSet
from vorotool.types.polygons.polygon_set import PolygonSet


def features_of(source: Source) -> Features:
    """Give the features of a source; those that were read to tell what it holds come with it."""
    if isinstance(source.document, Features):
        return source.document
    read: Features = resolved(INPUTS[source.format].features)(source)
    return read


def read_points(source: Source, options: ReadOptions) -> PointSet:
    """Read points with their attributes; where there is no geometry, as tables have them."""
    return point_set(point_rows(source, options))


def point_rows(source: Source, options: ReadOptions) -> PointRows:
    """Read what `read_points` reads, with a z where the options want it."""
    features = features_of(source)
    if features.is_table:
        return rows_of_columns(source.name, {name: list(values) for name, values in features.columns.items()}, options)
    return feature_points(features, options)


def read_sites(source: Source, options: ReadOptions) -> Sites:
    """Read points, lines and polygons with their attributes, each feature a site."""
    return sites_of_features(features_of(source), options)


def read_polygons(source: Source, options: ReadOptions) -> PolygonSet:
    """Read polygons and lines with their attributes."""
    return polygons_of_features(features_of(source), options)
