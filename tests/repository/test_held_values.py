"""Every function of the library takes whatever callers hold, and refuses the rest by the name of its parameter."""

import re

import dask.array
import geopandas
import numpy as np
import pandas as pd
import pytest
import shapely
import xarray
import zarr
from numpy.random import default_rng

import vorotool as v
from support.refusals import refused
from vorotool import InputError, UsageError

XY = default_rng(7).permutation(np.stack(np.meshgrid(np.arange(3, 40, 6), np.arange(2, 30, 7)), axis=-1).reshape(-1, 2))
INDEX = pd.Index([f"row {k}" for k in range(len(XY))], name="row")
SITES = geopandas.GeoSeries.from_xy(*XY.T, index=INDEX, crs=2056)


class Located:
    """What says where it lies, as objects of many libraries do."""

    def __init__(self, document):
        self.__geo_interface__ = document


POINT_FORMS = {
    "integers": XY,
    "list": XY.tolist(),
    "frame": pd.DataFrame(XY, columns=["x", "y"], index=INDEX),
    "columns": pd.DataFrame(XY, columns=["lon", "lat"])[["lon", "lat"]],
    "two columns": pd.DataFrame(XY, columns=["a", "b"]),
    "coordinates": SITES.get_coordinates(),
    "shapely": list(SITES),
    "object array": SITES.to_numpy(),
    "multipoint": shapely.MultiPoint(list(SITES)),
    "GeometryArray": SITES.values,
    "GeoSeries": SITES,
    "GeoDataFrame": geopandas.GeoDataFrame({"n": range(len(XY))}, geometry=SITES.values, index=INDEX),
    "geo interface": Located(SITES.__geo_interface__),
    "GeoJSON": SITES.__geo_interface__,
    "WKT": [each.wkt for each in SITES],
    "PointSet": v.PointSet(XY),
}
POINT_FUNCTIONS = {
    "delaunay": (v.delaunay, "points", lambda mesh: mesh.triangles),
    "insert_points": (lambda points: v.insert_points(v.delaunay([[0, 0], [50, 1], [1, 50]]), points), "points",
                      lambda mesh: mesh.triangles),
    "voronoi_cells": (v.voronoi_cells, "points", lambda cells: cells.coordinates),
    "alpha_complex": (v.alpha_complex, "points", lambda family: family.spectrum),
    "alpha_shape": (lambda points: v.alpha_shape(points, r=6), "points", lambda shape: shape.edges),
    "seeds_from_points": (v.seeds_from_points, "points", lambda seeds: seeds.x),
    "tessellate": (v.tessellate, "seeds", lambda image: image.labels),
    "digital_triangulation": (v.digital_triangulation, "source", lambda mesh: mesh.triangles),
    "digital_delaunay": (v.digital_delaunay, "source", lambda mesh: mesh.triangles),
    "repair_digital": (v.repair_digital, "source", lambda made: made[0].triangles),
    "compare_digital": (v.compare_digital, "source", lambda made: np.array([made.edge_recall, made.triangle_recall])),
}  # fmt: skip


def some(functions, forms, all_forms_of, few):
    """Functions with forms of their argument: all with those that read it in their own way, a few with the others."""
    return [(name, form) for name in functions for form in (forms if name in all_forms_of else few)]


@pytest.mark.parametrize(
    ("function", "form"),
    some(POINT_FUNCTIONS, POINT_FORMS, {"delaunay", "tessellate"}, ["list", "GeoDataFrame", "PointSet"]),
)
def test_points(function, form):
    call, _, read = POINT_FUNCTIONS[function]
    expected = read(call(XY.astype(float)))
    assert np.array_equal(read(call(POINT_FORMS[form])), expected)


NO_POINTS = {
    "None": None,
    "number": 5,
    "path": "points.csv",
    "four columns": XY.repeat(2, axis=1).astype(float),
    "transposed": XY.T.astype(float),
    "ragged": [[1, 2], [3]],
    "texts": np.array([["a", "b"]]),
    "frame": pd.DataFrame({"a": [1], "b": [2], "c": [3]}),
    "mapping": {"a": [1, 2]},
    "polygon": shapely.box(0, 0, 1, 1),
    "GeoSeries of polygons": geopandas.GeoSeries([shapely.box(0, 0, 1, 1)]),
    "PolygonSet": v.outlines(np.ones((3, 3), bool)),
    "infinite": [[0, 0], [np.inf, 1]],
    "masked": np.ma.array(XY, mask=XY > 20),
}


@pytest.mark.parametrize(
    ("function", "form"), some(POINT_FUNCTIONS, NO_POINTS, {"delaunay", "tessellate"}, ["None", "ragged", "polygon"])
)
def test_what_are_no_points(function, form):
    call, name, _ = POINT_FUNCTIONS[function]
    refused(InputError, f"^invalid {name}: ", call, NO_POINTS[form])


# ---- polygons ----------------------------------------------------------------------------------------
HOUSE = shapely.Polygon([(0, 0), (12, 0), (12, 8), (6, 12), (0, 8)], [[(4, 2), (4, 5), (8, 5), (8, 2)]])
YARD = shapely.box(20, 1, 30, 6)
PARCELS = geopandas.GeoSeries([HOUSE, YARD], index=["house", "yard"], crs=2056)
POLYGON_FUNCTIONS = {
    "skeleton_exact": (v.skeleton_exact, "polygons", lambda made: made.radius),
    "skeleton_approx": (lambda polygons: v.skeleton_approx(polygons, step=1), "polygons", lambda made: made.radius),
    "planar_graph": (v.planar_graph, "polygons", lambda made: made.points),
    "offset": (lambda shapes: v.offset(shapes, [-1, 2]), "shapes", lambda made: made.start),
    "offset together": (lambda shapes: v.offset(shapes, 1, features="together"), "shapes", lambda made: made.start),
    "clip": (lambda clip: v.voronoi_cells(XY, clip=clip), "clip", lambda made: made.areas),
}


NO_POLYGONS = {
    "None": None,
    "number": 5,
    "path": "parcels.gpkg",
    "frame": pd.DataFrame(XY, columns=["x", "y"]),
    "mapping": {"hull": [[0, 0], [1, 0], [0, 1]]},
    "three columns": np.ones((4, 3)),
    "Raster": v.Raster(np.ones((9, 9), bool)),
    "infinite": [[0, 0], [np.inf, 1], [1, 1]],
    "WKT": "POLYGON ((0 0, 1 1",
    "points": SITES,
}


@pytest.mark.parametrize(
    ("function", "form"),
    some(POLYGON_FUNCTIONS, NO_POLYGONS, {"planar_graph", "clip"}, ["number", "three columns", "WKT"]),
)
def test_what_are_no_polygons(function, form):
    call, name, _ = POLYGON_FUNCTIONS[function]
    if (function, form) == ("clip", "None"):
        return  # that is the default
    refused(InputError, f"^invalid {name}: ", call, NO_POLYGONS[form])


@pytest.mark.parametrize("function", POLYGON_FUNCTIONS)
def test_a_mask_is_its_outlines(function):
    call, _, read = POLYGON_FUNCTIONS[function]
    mask = np.zeros((9, 12), bool)
    mask[1:8, 2:7], mask[3:5, 4:6], mask[4:8, 9:11] = True, False, True
    assert np.array_equal(read(call(mask)), read(call(v.outlines(mask))))


def test_systems_that_differ_are_not_mixed():
    mesh = v.delaunay(SITES)
    with pytest.raises(InputError, match=r"^invalid clip: it is in EPSG:4326, but the points in EPSG:2056"):
        v.voronoi_cells(mesh, clip=PARCELS.set_crs(4326, allow_override=True))
    assert v.voronoi_cells(mesh, clip=PARCELS).crs == mesh.crs
    assert v.voronoi_cells(mesh, clip=list(PARCELS)).crs == mesh.crs


# ---- images ------------------------------------------------------------------------------------------
LABELS = np.zeros((30, 40), dtype=np.int64)
LABELS[3:9, 5:12], LABELS[20:26, 3:9], LABELS[10:20, 25:37] = 1, 2, 7


def in_zarr(values):
    """A Zarr array in memory."""
    made = zarr.create_array({}, shape=values.shape, dtype=values.dtype, chunks=(8, 8))
    made[:] = values
    return made


IMAGE_FORMS = {
    "int64": np.asarray,
    "uint8": lambda values: values.astype(np.uint8) if values.dtype != bool else values,
    "big-endian": lambda values: values.astype(">i4") if values.dtype != bool else values,
    "Fortran": np.asfortranarray,
    "masked": np.ma.array,
    "Raster": v.Raster,
    "dask": lambda values: dask.array.from_array(values, chunks=9),
    "zarr": in_zarr,
    "xarray": xarray.DataArray,
    "with coordinates": lambda values: xarray.DataArray(
        values, dims=("y", "x"), coords={"y": 90.5 - 2.0 * np.arange(30), "x": np.arange(40) / 4}
    ),
}
IMAGE_FUNCTIONS = {
    "tessellate": (v.tessellate, "seeds", lambda image: image.labels),
    "digital_triangulation": (v.digital_triangulation, "source", lambda mesh: mesh.triangles),
    "region_table": (v.region_table, "image", lambda table: table["area"]),
    "neighbor_table": (v.neighbor_table, "image", lambda table: table["border_length"]),
    "voronoi_diagram": (v.voronoi_diagram, "image", np.asarray),
    "color_regions": (v.color_regions, "image", np.asarray),
    "outlines": (v.outlines, "image", lambda polygons: polygons.xy),
    "seeds_from_raster": (v.seeds_from_raster, "raster", lambda seeds: seeds.labels),
}
VOLUME_FUNCTIONS = {"tessellate", "region_table", "neighbor_table", "voronoi_diagram", "color_regions"}


@pytest.mark.parametrize(
    ("function", "form"),
    some(IMAGE_FUNCTIONS, IMAGE_FORMS, {"tessellate", "seeds_from_raster"}, ["uint8", "Raster", "xarray"]),
)
@pytest.mark.filterwarnings("ignore:the input has pixels of:vorotool.VorotoolWarning")
def test_images(function, form):
    """Label images, and masks, whose components are the objects."""
    call, _, read = IMAGE_FUNCTIONS[function]
    numbered = np.array([0, 1, 3, 0, 0, 0, 0, 2])[LABELS]
    for values, objects in ((LABELS, LABELS), (LABELS > 0, numbered)):
        made, expected = call(IMAGE_FORMS[form](values)), call(v.Raster(objects))
        assert np.array_equal(read(made), read(expected))


def test_a_label_image_keeps_its_frame():
    image = v.LabelImage(LABELS, v.Frame(100, -50, 40, 30))
    made = v.tessellate(image)
    assert made.frame == image.frame
    assert np.array_equal(made.labels, v.tessellate(LABELS).labels)
    v.verify_tessellation(made)
    assert v.tessellate(image, window=(100, -50, 50, 60)).labels.shape == (60, 50)


NO_IMAGES = {
    "None": None,
    "number": 5,
    "path": "a.png",
    "ragged": [[1, 2], [3]],
    "stack": np.zeros((6, 9, 9), int),
    "texts": LABELS.astype(str),
    "frame": pd.DataFrame({"a": [1], "b": [2], "c": [3]}),
    "GeoSeries": PARCELS,
    "uneven axes": xarray.DataArray(LABELS, dims=("y", "x"), coords={"y": range(30), "x": np.arange(40) ** 2}),
}


@pytest.mark.parametrize(
    ("function", "form"),
    some(IMAGE_FUNCTIONS, NO_IMAGES, {"tessellate", "seeds_from_raster"}, ["None", "stack", "GeoSeries"]),
)
def test_what_is_no_image(function, form):
    call, name, _ = IMAGE_FUNCTIONS[function]
    if form == "stack" and function in VOLUME_FUNCTIONS:
        return  # it is a volume
    refused(InputError, f"^invalid {name}: ", call, NO_IMAGES[form])


@pytest.mark.parametrize("function", sorted(IMAGE_FUNCTIONS.keys() - {"outlines", "seeds_from_raster"}))
def test_grey_values_and_colors_name_the_threshold(function):
    call, name, _ = IMAGE_FUNCTIONS[function]
    for source in (LABELS / 2, np.zeros((9, 9, 3), np.uint8)):
        refused(InputError, f"^invalid {name}: .*threshold=", call, source)


def _shown(made):
    """A result in text, but for where its parts are in memory."""
    return re.sub("0x[0-9a-f]+", "", repr(made))


@pytest.mark.parametrize(
    "function", [v.tessellate, v.digital_triangulation, v.digital_delaunay, v.repair_digital, v.compare_digital]
)
def test_narrow_arrays_of_integers_are_points_unless_they_are_said_to_be_images(function):
    narrow = np.array([[0, 9], [0, 0], [4, 0], [0, 0], [0, 0]])
    as_image, as_raster = function(narrow, image=True), function(v.Raster(narrow))
    as_given, as_points = function(narrow[[0, 2]]), function(narrow[[0, 2]].astype(float), image=False)
    for made, same in ((as_image, as_raster), (as_given, as_points)):
        assert _shown(made) == _shown(same)
    refused(UsageError, "invalid image 2: expected True, False or None", function, narrow, image=2)


# ---- frames, index, imports ---------------------------------------------------------------------------
@pytest.mark.parametrize(
    "call",
    [
        lambda frame: v.voronoi_cells(XY, frame=frame).areas,
        lambda frame: v.site_table(v.delaunay(XY), frame=frame)["area"],
        lambda frame: v.skeleton_exact([HOUSE], side="exterior", frame=frame).radius,
        lambda frame: v.skeleton_approx([HOUSE], step=1, side="exterior", frame=frame).radius,
    ],
)
def test_frames(call):
    expected = call((-5, -4, 60, 50))
    for frame in (v.Box(-5, -4, 55, 46), [-5, -4, 60, 50], np.array([-5, -4, 60, 50]), iter((-5.0, -4, 60, 50))):
        assert np.array_equal(call(frame), expected)
    for wrong in (5, "frame", (1, 2, 3), (0, 0, 1, "a"), (0, 0, 1, np.nan)):
        refused((InputError, UsageError), r"^invalid frame .*: expected a Box or four finite numbers", call, wrong)


def test_the_index_comes_back():
    frame = POINT_FORMS["GeoDataFrame"]
    mesh = v.delaunay(frame)
    assert mesh.index.equals(INDEX)
    assert v.voronoi_cells(frame, clip=PARCELS).index.equals(INDEX)
    assert v.tessellate(frame).seeds.index.equals(INDEX)
    assert v.alpha_shape(frame, r=6).family.mesh.index.equals(INDEX)
    assert v.skeleton_exact(PARCELS).polygons.index.equals(PARCELS.index)
    assert v.offset(PARCELS, -1).polygons.index.equals(PARCELS.index)
    assert v.region_table(v.tessellate(frame))["n"].tolist() == list(range(len(XY)))


def test_places_of_centerlines():
    skeleton = v.skeleton_exact([HOUSE])
    expected = v.centerline(skeleton, start=(2, 1), end=(11, 7)).length
    start, end = shapely.Point(2, 1), {"type": "Point", "coordinates": [11, 7]}
    assert v.centerline(skeleton, start=start, end=end).length == expected
    refused(InputError, r"^invalid end: point \[0\] is a Polygon", v.centerline, skeleton, start=start, end=HOUSE)
