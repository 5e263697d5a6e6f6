"""Sites from whatever a caller holds: points, lines and polygons, and what is known of each."""

import geopandas
import numpy as np
import pytest
import shapely

from vorotool import LabelImage, PointSet, Raster
from vorotool.convert.sites import as_sites
from vorotool.errors import InputError, UsageError
from vorotool.numeric.crs import crs_name, member_of_text
from vorotool.types.pixels import Frame, map_grid
from vorotool.types.polygons.shapely_geometry import to_shapely

MIXED = [
    shapely.Point(0, 0),
    shapely.LineString([(1, 0), (2, 0)]),
    None,
    shapely.MultiPoint([(5, 5), (6, 6)]),
    shapely.box(8, 8, 9, 9),
    shapely.Polygon(),
]
KINDS = [2, 2, 2, 2, 0]
SITE = [0, 1, 3, 3, 4]


def forms():
    frame = geopandas.GeoDataFrame({"name": list("abcdef")}, geometry=MIXED, index=list("uvwxyz"), crs="EPSG:2056")
    yield "list", MIXED
    yield "iterator", iter(MIXED)
    yield "array", np.array(MIXED, dtype=object)
    yield "series", frame.geometry
    yield "frame", frame
    yield "WKT", [None if each is None else each.wkt for each in MIXED]
    yield "GeoJSON", [None if each is None else shapely.geometry.mapping(each) for each in MIXED]


@pytest.mark.parametrize(("name", "source"), list(forms()))
def test_mixed_geometry(name, source):
    sites = as_sites(source)
    assert sites.polygons.ring_kind.tolist() == KINDS, name
    assert (sites.site.tolist(), sites.count) == (SITE, 6)
    assert sites.polygons.ring(0).tolist() == [[0, 0]]
    assert sites.polygons.ring(2).tolist() == [[5, 5]]


def test_what_is_known_of_features():
    frame = dict(forms())["frame"]
    sites = as_sites(frame)
    assert sites.index.tolist() == list("uvwxyz")
    assert sites.properties == {"name": list("abcdef")}
    joined = as_sites(frame, by="name")
    assert (joined.ids, joined.index, joined.properties) == (list("abcdef"), None, {"name": list("abcdef")})
    with pytest.raises(UsageError, match=r"'x'"):
        as_sites(frame, by="x")


# ---- images ------------------------------------------------------------------------------------------
LABELS = np.zeros((9, 20), dtype=np.int64)
LABELS[2:4, 2:5], LABELS[6:8, 10:15], LABELS[2:4, 5:8], LABELS[0, 19] = 7, 3, 9, 7


@pytest.mark.parametrize("image", [LABELS, Raster(LABELS), LabelImage(LABELS), LABELS.astype(np.uint8)])
def test_labels_are_sites_with_all_their_parts(image):
    sites = as_sites(image)
    assert (sites.count, sites.ids) == (3, [3, 7, 9])
    areas = np.bincount(sites.site, shapely.area(to_shapely(sites.polygons)))
    assert areas.tolist() == [10, 7, 6]


def test_images_on_maps_give_sites_on_the_map():
    grid = map_grid((30.0, 0.0, 2600000.0, 0.0, -10.0, 1200000.0), unit="m", crs=member_of_text("EPSG:2056"))
    sites = as_sites(Raster(LABELS, grid))
    assert crs_name(sites.polygons.crs) == "EPSG:2056"
    assert sites.polygons.y_axis == "up"
    assert shapely.total_bounds(to_shapely(sites.polygons)).tolist() == [
        2600060, 1199920, 2600600, 1200000,
    ]  # fmt: skip
    moved = LabelImage(LABELS, Frame(-5, 40, 20, 9), grid=grid)
    assert np.array_equal(as_sites(moved).polygons.xy, sites.polygons.xy)


def test_labels_of_points_are_ids():
    assert as_sites(PointSet([[2, 1], [7, 5]], labels=[9, 4])).ids == [9, 4]


def test_grey_values_are_none():
    with pytest.raises(InputError, match=r"seeds_from_raster\(sites, threshold"):
        as_sites(np.linspace(0, 1, 1200).reshape(30, 40))
