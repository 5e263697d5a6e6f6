"""Files of maps as other programs write them: through geopandas, which is no part of what is tested."""

import warnings

import geopandas
import pandas
import shapely

DRIVERS = {"gpkg": "GPKG", "fgb": "FlatGeobuf", "shp": "ESRI Shapefile", "parquet": None}

SHAPES = [
    shapely.Polygon([(0, 0), (9, 0), (9, 9), (0, 9)], [[(1, 1), (2, 1), (2, 2), (1, 2)]]),
    shapely.MultiPolygon([shapely.box(20, 0, 30, 4), shapely.box(40, 0.1, 41, 1 / 3)]),
    shapely.box(50, 0, 60, 4),
]
ATTRIBUTES = {
    "name": ["Zürichsee", None, "c"],
    "code": ["007", "010", "99"],
    "count": [3, 2**40 + 1, -4],
    "depth": [143.0, 2.5, None],
}


def frame(geometry=None, crs="EPSG:2056", **columns):
    """A data frame of shapes and attributes."""
    table = pandas.DataFrame(columns or ATTRIBUTES)
    return geopandas.GeoDataFrame(table, geometry=SHAPES if geometry is None else geometry, crs=crs)


def save(table, path, **options):
    """Write a data frame as its extension says, and give the path."""
    driver = DRIVERS[path.suffix.removeprefix(".")]
    if driver is None:
        table.to_parquet(path, **options)
    else:
        ordered = {"SPATIAL_INDEX": "NO"} if driver == "FlatGeobuf" else {}  # the index would sort the features
        with warnings.catch_warnings():  # of data without a reference system
            warnings.simplefilter("ignore")
            table.to_file(path, driver=driver, **ordered, **options)
    return path


def load(path):
    """Read a file as others do."""
    return geopandas.read_parquet(path) if path.suffix == ".parquet" else geopandas.read_file(path)
