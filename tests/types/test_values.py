"""What all values have in common: methods by type, equality, copies, short texts."""

import copy
import inspect
import io
import pickle
import sys
from dataclasses import fields

import numpy as np
import pandas
import pytest

import vorotool
from support.families.values import (
    NOT_VALUES,
    empty_values,
    example_values,
    label_image,
    volume_values,
)
from support.processes.ended import ended_python
from vorotool.numeric.checks import is_equal

VALUES = {**example_values(), **volume_values()}
TYPES = sorted(
    name
    for name in vorotool.__all__
    if inspect.isclass(getattr(vorotool, name)) and not issubclass(getattr(vorotool, name), BaseException | Warning)
)
TABLES = {"Table", "DigitalComparison", "CriticalValues", "CellStatistics", "RegionPersistence"}
METHODS = {
    "to_shapely": {"Raster", *TABLES},
    "to_geopandas": {"Raster", *TABLES},
    "__geo_interface__": {"Raster", *TABLES},
    "to_pandas": {"Raster"},
    "plot": TABLES,
    "_repr_svg_": TABLES,
    "_repr_html_": TABLES - {"Table"},
}
"""The types without a method, beside those of volumes."""
VOLUME_METHODS = {
    "to_pandas": {"LabelVolume", "SpaceCellSet", "Tetrahedralization", "SpaceAlphaComplex", "SpaceAlphaShape"}
}
ONLY = {
    "to_networkx": {
        *("Skeleton", "Triangulation", "DigitalTriangulation", "LabelImage", "LabelVolume", "PlanarGraph"),
        *("VoronoiMap", "ProximityGraph"),
    },
    "__array__": {"LabelImage", "LabelVolume", "Raster", "PointSet", "VolumePoints"},
}
"""The types with a method."""


def test_each_public_type_is_looked_at():
    assert set(VALUES) == set(TYPES) - NOT_VALUES


@pytest.mark.parametrize("name", VALUES)
def test_each_type_has_the_methods_that_make_sense(name):
    kind = type(VALUES[name])
    assert kind.__name__ == name
    for method, without in METHODS.items():
        has = name in VOLUME_METHODS.get(method, ()) if name in volume_values() else name not in without
        assert hasattr(kind, method) == has, method
    for method, having in ONLY.items():
        assert hasattr(kind, method) == (name in having), method


@pytest.mark.parametrize("name", VALUES)
def test_copies_are_equal_and_changes_are_not(name):
    value = VALUES[name]
    for other in (pickle.loads(pickle.dumps(value)), copy.copy(value), copy.deepcopy(value)):
        assert (value == other) is True
        assert (value != other) is False
    if name == "Table":
        return
    for field in fields(value):
        if not field.compare:  # which way y goes
            continue
        old = getattr(value, field.name)
        changed = copy.copy(value)
        object.__setattr__(changed, field.name, other_than(old))
        assert (changed == value) is not field.compare, field.name
        assert (value != changed) is field.compare, field.name


def other_than(value):
    """Something else of the same kind, if there is any."""
    if isinstance(value, np.ndarray) and value.size:
        made = value.copy()
        made.flat[-1] = not made.flat[-1] if made.dtype == bool else 77
        return made
    if isinstance(value, dict) and value:
        return {**value, "further": [1]}
    return "something else"


def test_comparison_never_raises():
    for value in VALUES.values():
        for other in (None, 1, "a", [1], np.arange(3), pandas.Series([1]).index, *VALUES.values()):
            if other is not value and not isinstance(other, np.ndarray):
                assert (value == other) is False
                assert (value != other) is True


@pytest.mark.parametrize(
    ("a", "b", "same"),
    [
        (np.array([1.0, np.nan]), np.array([1.0, np.nan]), True),
        (np.array([1.0, np.nan]), np.array([np.nan, 1.0]), False),
        (np.array([1, 2], ">i4"), [1, 2], True),
        (np.arange(6).reshape(2, 3), np.arange(6).reshape(3, 2), False),
        (np.arange(3), np.arange(4), False),
        (np.arange(10)[::2], np.array([0, 2, 4, 6, 8]), True),
        (np.ma.array([1, 2], mask=[0, 1]), np.ma.array([1, 9], mask=[0, 1]), True),
        (np.ma.array([1, 2], mask=[0, 1]), np.array([1, 2]), False),
        (["a", None, float("nan")], np.array(["a", None, float("nan")], dtype=object), True),
        ([pandas.NA], [pandas.NA], True),
        ([pandas.NA], [1], False),
        (pandas.Index([1, 2], name="a"), np.array([1, 2]), True),
        (pandas.MultiIndex.from_tuples([(1, "a")]), [(1, "a")], True),
        ({"a": 1, "b": 2}, {"b": 2, "a": 1}, True),
        ({"a": 1}, {"b": 1}, False),
        (float("nan"), float("nan"), True),
        ("ab", ["a", "b"], False),
        (np.array(3), np.array(3), True),
        (np.array(["a"]), np.array(["b"]), False),
    ],
)
def test_parts_of_values(a, b, same):
    assert is_equal(a, b) is same
    assert is_equal(b, a) is same


TEXTS = {
    "PointSet": "PointSet: 12 points, EPSG:2056",
    "PolygonSet": "PolygonSet: 3 polygons, 1 line, 19 vertices, EPSG:2056",
    "LabelImage": "LabelImage: 40 x 30, 9 labels, uint16",
    "Raster": "Raster: 14 x 9, uint16",
    "SeedSet": "SeedSet: 9 seeds of 9 sites, 1 to a pixel side",
}


def test_texts_are_short_and_values_are_no_keys():
    for name, value in VALUES.items():
        text = repr(value)
        assert text.startswith(f"{name}: ")
        assert len(text.splitlines()) == 1
        assert len(text) < 250
        assert text == TEXTS.get(name, text)
        assert str(value) == text
        with pytest.raises(TypeError, match="unhashable"):
            hash(value)


@pytest.mark.parametrize("name", empty_values())
def test_what_is_empty_has_all_methods(name):
    value = empty_values()[name]
    assert value == copy.deepcopy(value)
    assert repr(value)
    for method in ("to_shapely", "to_geopandas", "to_pandas", "to_networkx", "_repr_svg_", "_repr_html_"):
        if hasattr(value, method):
            getattr(value, method)()
    if hasattr(type(value), "__geo_interface__"):
        assert value.__geo_interface__["type"] == "FeatureCollection"


@pytest.mark.parametrize("value", [label_image(), VALUES["Raster"]], ids=["LabelImage", "Raster"])
def test_images_are_arrays(value):
    own = value.labels if hasattr(value, "labels") else value.values
    assert np.asarray(value) is own or np.shares_memory(np.asarray(value), own)
    assert np.asarray(value, dtype=np.float32).dtype == np.float32
    assert not np.shares_memory(np.array(value, copy=True), own)
    with pytest.raises(ValueError, match="copy"):
        np.asarray(value, dtype=np.float64, copy=False)
    assert (value.shape, value.dtype, value.ndim) == (own.shape, own.dtype, 2)
    np.testing.assert_array_equal(value[2:5, ::3], own[2:5, ::3])
    assert np.max(value) == own.max()


def test_scikit_image_takes_a_label_image():
    from skimage.measure import regionprops, regionprops_table
    from skimage.segmentation import find_boundaries

    image = label_image()
    table = vorotool.region_table(image)
    found = regionprops_table(np.asarray(image), properties=("label", "area"))
    np.testing.assert_array_equal(found["area"], table["area"])
    assert len(regionprops(np.asarray(image))) == len(table["area"])
    np.testing.assert_array_equal(find_boundaries(image), find_boundaries(image.labels))


def test_nothing_more_is_imported_than_before():
    script = (
        "import sys, vorotool\n"
        "names = {name.partition('.')[0] for name in sys.modules} - set(sys.stdlib_module_names)\n"
        "print(sorted(names & {'numpy', 'shapely', 'pandas', 'geopandas', 'networkx', 'matplotlib', 'orjson'}))\n"
        "print(sorted(name for name in sys.modules if name.startswith('vorotool')))\n"
    )
    assert ended_python("-c", script).stdout == "[]\n['vorotool']\n"


def test_values_load_no_library_of_an_extra():
    script = (
        "import sys, vorotool\n"
        "mesh = vorotool.delaunay([[0, 0], [4, 0], [0, 3]])\n"
        "repr(mesh); mesh == mesh; mesh.to_shapely(); mesh._repr_svg_(); mesh.__geo_interface__\n"
        "vorotool.edge_table(mesh)._repr_html_()\n"
        "print(sorted({'pandas', 'geopandas', 'networkx', 'matplotlib'} & set(sys.modules)))\n"
    )
    assert ended_python("-c", script).stdout == "[]\n"


@pytest.mark.parametrize(
    ("library", "extra", "call"),
    [
        ("pandas", "frames", "to_pandas"),
        ("geopandas", "frames", "to_geopandas"),
        ("networkx", "graphs", "to_networkx"),
        ("matplotlib", "plot", "plot"),
    ],
)
def test_what_lacks_is_named(monkeypatch, library, extra, call):
    mesh = vorotool.delaunay([[0, 0], [4, 0], [0, 3]])
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(vorotool.UsageError, match=rf"'vorotool\[{extra}\]'"):
        getattr(mesh, call)()


def test_values_go_through_files_of_pickles():
    held = io.BytesIO()
    pickle.dump(VALUES, held)
    held.seek(0)
    assert is_equal(pickle.load(held), VALUES)


def test_results_go_on_as_inputs():
    cells, points, table = VALUES["CellSet"], VALUES["SkeletonPoints"], VALUES["Table"]
    filled = ~cells.is_empty
    np.testing.assert_allclose(
        [each.area for each in vorotool.planar_graph(cells).polygons.to_shapely()], cells.areas[filled], rtol=1e-12
    )
    with pytest.warns(vorotool.VorotoolWarning, match="3 of 50 points lie on an earlier point"):
        np.testing.assert_array_equal(vorotool.delaunay(points).points, points.xy)
    np.testing.assert_array_equal(vorotool.delaunay(table).points, np.stack([table["x"], table["y"]], axis=1))
