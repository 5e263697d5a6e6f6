"""From values to what is written of them."""

import numpy as np
import pytest

import vorotool
from support.families.values import example_values, volume_values
from support.readers.written import streamed, written
from support.refusals import refused
from vorotool.errors import OutputError, UsageError
from vorotool.products.registry import chosen_part, parts_of, public_types

VALUES = {name: value for name, value in (example_values() | volume_values()).items() if name in public_types()}
"""A value of each type that can be written."""
VALUES["SpaceAlphaShape"] = vorotool.alpha_shape(VALUES["SpaceAlphaComplex"])  # with a surface
OF_SEVERAL_KINDS = {("AlphaHull", "hull"), ("PolygonSet", "shape")}


def test_there_is_a_value_of_each_type():
    assert set(VALUES) == set(public_types())


@pytest.mark.filterwarnings("ignore:.*a Shapefile has names of 10 bytes")
@pytest.mark.parametrize("name", VALUES)
def test_every_part_in_every_format(name, tmp_path):
    value = VALUES[name]
    for what, product in parts_of(value).items():
        for fmt in (*product.written, *product.layers):
            if name == "DigitalTriangulation" and fmt in ("edge", "ele"):
                continue  # which need be no triangulation
            if fmt == "shp" and (name, what) in OF_SEVERAL_KINDS:
                words = r"a Shapefile holds geometry of one kind, but this is .*; write a"
                refused(OutputError, words, vorotool.write, value, tmp_path / f"{what}.shp", what=what)
                assert not list(tmp_path.glob("*.shp"))
                continue
            path = tmp_path / f"{what}.{fmt}"
            vorotool.write(value, path, what=what, width=100 if fmt == "png" and name != "LabelImage" else None)
            assert path.stat().st_size > 0
            if fmt in streamed(product) and fmt != "zarr":
                assert path.read_bytes() == written(value, fmt, what)


@pytest.mark.parametrize(
    ("name", "fmt", "what"),
    [
        ("Triangulation", "csv", "edges"),
        ("Triangulation", "ele", "triangles"),
        ("Triangulation", "node", "table"),
        ("AlphaShape", "csv", "edges"),
        ("AlphaShape", "geojson", "polygons"),
        ("AlphaShape", "poly", "polygons"),
        ("AlphaComplex", "json", "family"),
        ("Skeleton", "graphml", "skeleton"),
        ("SkeletonPoints", "wkt", "points"),
    ],
)
def test_the_part_that_a_format_is_for(name, fmt, what):
    assert chosen_part(VALUES[name], fmt, None).what == what


@pytest.mark.parametrize(
    ("name", "fmt", "what", "message"),
    [
        ("Skeleton", "csv", "arcs", "Skeleton"),
        ("Offsets", "csv", "arcs", "Offsets"),
        ("Skeleton", "graphml", "branches", "'graphml'"),
        ("Table", "svg", None, "Table"),
    ],
)
def test_what_there_is_not(name, fmt, what, message):
    refused(UsageError, message, chosen_part, VALUES[name], fmt, what)


def test_what_is_no_result():
    with pytest.raises(UsageError, match=r"a list cannot be written: give a LabelImage, Table, Triangulation, .* or "):
        vorotool.write([[0, 0]], "a.csv")
    refused(UsageError, "a ndarray cannot be written", vorotool.write, np.eye(3), "a.png")
    refused(UsageError, "PointSet", vorotool.to_geojson, vorotool.PointSet([[0, 0]]))


def test_a_mistyped_result_or_layer_is_told(tmp_path):
    mesh = VALUES["Triangulation"]
    words = r"what='edge' is not a result of a Triangulation: .*; did you mean edges\?$"
    refused(UsageError, words, vorotool.write, mesh, tmp_path / "a.csv", what="edge")
    words = r"the layer 'edgs' does not exist: .*; did you mean edges\?$"
    refused(UsageError, words, vorotool.write, mesh, tmp_path / "a.svg", layers=["edgs"])
    refused(UsageError, r"or table$", vorotool.write, mesh, tmp_path / "a.csv", what="x")
